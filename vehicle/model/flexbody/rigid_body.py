"""Rigid-body properties of the trimmed body in the form MuJoCo takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.inertia_tensor import about_cog, inertia_tensor, nearest_physical
from vehicle.model.parameters.body import MOMENTS, TrimmedBody

Vector = npt.NDArray[np.float64]

LARGEST_REPAIR = 0.02
"""Largest change of a component of the tensor over its largest principal moment: moments of a body are measured, by
swinging it, within 1 to 2 %, so a tensor this far beside a physical one may be that of a real body. The published one
needs 0.018."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RigidBody:
    """Mass [kg], centre of gravity [m] and inertia tensor about it [kg m2] with negative products."""

    mass: float
    cog: Vector
    inertia: Vector
    report: str
    """what had to be repaired in the tensor, in words"""
    repaired: bool

    @property
    def full_inertia(self) -> Vector:
        """(Ixx, Iyy, Izz, Ixy, Ixz, Iyz) as MuJoCo's fullinertia."""
        tensor = self.inertia
        return np.array([tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]])


def cog_inertia(body: TrimmedBody) -> Vector:
    """Inertia tensor of a trimmed body about its CoG as given [kg m2], products negative; shape (3, 3)."""
    own = body.inertia
    tensor = inertia_tensor(ixx=own.ixx, iyy=own.iyy, izz=own.izz, ixy=own.ixy, izx=own.izx, iyz=own.iyz)
    return tensor if own.about == "cog" else about_cog(tensor, body.mass, body.cog)


def rigid_body(body: TrimmedBody) -> RigidBody:
    """Mass properties of a trimmed body about its CoG, the tensor repaired to the nearest physical one where it is not.

    Args:
        body: parameters.

    Returns:
        Mass properties that MuJoCo accepts, and a sentence about the repair.

    Raises:
        ConfigurationError: the tensor is farther from a physical one than `LARGEST_REPAIR`.
    """
    given, own = cog_inertia(body), body.inertia
    low, middle, high = (float(moment) for moment in np.linalg.eigvalsh(given))
    # Where the smallest moment exceeds the sum of the others, all are negative and no tensor of a body is near.
    near = middle + high > low
    change = float(np.abs(nearest_physical(given).change).max()) if near else np.inf
    if not change <= LARGEST_REPAIR * high:
        values = ", ".join(f"{name} {getattr(own, name):g}" for name in MOMENTS)
        raise ConfigurationError(
            f"body.inertia: {values} kg m2 about the {'CoG' if own.about == 'cog' else 'origin'}: with body.mass "
            f"({body.mass:g} kg) at body.cog {list(body.cog)} the principal moments about the centre of gravity are "
            f"{low:.4g}, {middle:.4g} and {high:.4g} kg m2. Of a real body none is negative, and the two smaller add "
            f"up to the largest at least ({low + middle:.4g} >= {high:.4g}?). The nearest physical tensor differs by "
            f"{change:.3g} kg m2, allowed are {LARGEST_REPAIR * high:.3g} ({LARGEST_REPAIR:.0%} of the largest); "
            "check signs and digits, and body.inertia.about (cog or origin): about the origin the moments hold m r2 of "
            "the centre of gravity"
        )
    physical = nearest_physical(given)
    return RigidBody(
        mass=body.mass,
        cog=np.array(body.cog),
        inertia=physical.inertia,
        report=physical.describe(),
        repaired=physical.repaired,
    )
