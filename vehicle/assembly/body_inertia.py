"""Rigid-body properties of the trimmed body in the form MuJoCo takes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.flexbody.inertia import about_cog, inertia_tensor, nearest_physical
from vehicle.parameters.body import TrimmedBody

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RigidBody:
    """Mass [kg], centre of gravity [m] and inertia tensor about it [kg m2] with negative products."""

    mass: float
    cog: Vector
    inertia: Vector
    report: str
    """what had to be repaired in the tensor, in words"""

    @property
    def full_inertia(self) -> Vector:
        """(Ixx, Iyy, Izz, Ixy, Ixz, Iyz) as MuJoCo's fullinertia."""
        tensor = self.inertia
        return np.array([tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]])


def rigid_body(body: TrimmedBody) -> RigidBody:
    """Tensor about the CoG of the chosen variant, repaired to the nearest physical one where it is not.

    Args:
        body: parameters; their tensor is about the origin of the vehicle frame.

    Returns:
        Mass properties that MuJoCo accepts, and a sentence about the repair.
    """
    origin = inertia_tensor(ixx=body.ixx, iyy=body.iyy, izz=body.izz, ixy=body.ixy, izx=body.izx, iyz=body.iyz)
    physical = nearest_physical(about_cog(origin, body.mass, body.cog))
    return RigidBody(mass=body.mass, cog=np.array(body.cog), inertia=physical.inertia, report=physical.describe())
