"""Rigid-body mass properties of the body in the form required by MuJoCo."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.inertia_tensor import about_cog, inertia_tensor, nearest_physical
from vehicle.model.parameters.body import MOMENTS, BodyInertia, TrimmedBody
from vehicle.model.parameters.hardpoints import Point

LARGEST_REPAIR = 0.02
"""Maximum change of a tensor component by the repair, over the largest principal moment [1]. Swing tests measure
moments of inertia within 1 to 2 %, so the tensor of a real body may be this far from a physical tensor. The published
tensor needs 0.018."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RigidBody:
    """Mass [kg], centre of gravity [m] and inertia tensor about the CoG [kg m2] with negative products."""

    mass: float
    cog: Vector
    inertia: Vector
    report: str
    """summary of the repair of the tensor"""
    repaired: bool

    @property
    def full_inertia(self) -> Vector:
        """Components (Ixx, Iyy, Izz, Ixy, Ixz, Iyz) in the order of `fullinertia` of MuJoCo [kg m2]."""
        tensor = self.inertia
        return np.array([tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]])


def cog_inertia(body: TrimmedBody) -> Vector:
    """Return the inertia tensor of a body about its CoG, without repair [kg m2], products negative; shape (3, 3)."""
    return _cog_inertia(body.mass, body.cog, body.inertia)


def rigid_body(body: TrimmedBody) -> RigidBody:
    """Return the mass properties of a body about its CoG; replace a non-physical tensor by the nearest physical one.

    Returns:
        Mass properties accepted by MuJoCo, with a summary of the repair.

    Raises:
        ConfigurationError: the repair would exceed `LARGEST_REPAIR`.
    """
    return _rigid_body(body.mass, body.cog, body.inertia)


def _cog_inertia(mass: float, cog: Point, inertia: BodyInertia) -> Vector:
    """Return the inertia tensor about the CoG; see `cog_inertia`."""
    tensor = inertia_tensor(
        ixx=inertia.ixx, iyy=inertia.iyy, izz=inertia.izz, ixy=inertia.ixy, izx=inertia.izx, iyz=inertia.iyz
    )
    return tensor if inertia.about == "cog" else about_cog(tensor, mass, cog)


# Thousands of cars of a sweep have the same body.
@lru_cache(maxsize=16)
def _rigid_body(mass: float, cog: Point, inertia: BodyInertia) -> RigidBody:
    """Return the mass properties of a body; see `rigid_body`."""
    tensor = _cog_inertia(mass, cog, inertia)
    low, middle, high = (float(moment) for moment in np.linalg.eigvalsh(tensor))
    # With low >= middle + high all moments are negative, and no physical tensor is near.
    near = middle + high > low
    physical = nearest_physical(tensor) if near else None
    change = np.inf if physical is None else float(np.abs(physical.change).max())
    if physical is None or not change <= LARGEST_REPAIR * high:
        values = ", ".join(f"{name} {getattr(inertia, name):g}" for name in MOMENTS)
        raise ConfigurationError(
            f"body.inertia: {values} kg m2 about the {'CoG' if inertia.about == 'cog' else 'origin'}: with body.mass "
            f"({mass:g} kg) at body.cog {list(cog)} the principal moments about the centre of gravity are "
            f"{low:.4g}, {middle:.4g} and {high:.4g} kg m2. For a real body, all must be positive, and the sum of the "
            f"two smaller at least the largest ({low + middle:.4g} >= {high:.4g}?). The nearest physical tensor "
            f"differs by {change:.3g} kg m2 but must differ by at most {LARGEST_REPAIR * high:.3g} "
            f"({LARGEST_REPAIR:.0%} of the "
            "largest). Check signs and digits, and body.inertia.about (cog or origin): moments about the origin "
            "include m r2 of the centre of gravity"
        )
    position = np.array(cog)
    for array in (position, physical.inertia):
        array.flags.writeable = False
    return RigidBody(
        mass=mass, cog=position, inertia=physical.inertia, report=physical.describe(), repaired=physical.repaired
    )
