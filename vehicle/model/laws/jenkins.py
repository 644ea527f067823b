"""Jenkins elements in parallel: a spring in series with a Coulomb slider each, over displacement.

Element i has the force t_i = clamp(t_i + k_i dx, l_i) after a further displacement dx. On first loading from rest the
sum follows the backbone, a concave polygon; between reversals every branch is the backbone at twice the size (Masing).
A load below the sum of the limits is held without creep.

Sources: Jenkin 1922; Masing 1926; Iwan, J. Appl. Mech. 33 (1966) 893.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.model.laws.law import Numbers


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Jenkins:
    """Elements in parallel.

    Attributes:
        stiffness: k_i [N/m]; (n,).
        limit: l_i [N]; (n,).
    """

    stiffness: Vector
    limit: Vector

    @classmethod
    def through(cls, displacement: npt.ArrayLike, force: npt.ArrayLike) -> Jenkins:
        """Return the elements whose backbone goes from the origin through points, and is flat after the last.

        k_i = s_i - s_(i+1) with the slopes s of the segments, and l_i = k_i x_i at the end x_i of segment i.

        Args:
            displacement: x_i [m], ascending and above zero; (n,).
            force: F_i [N], ascending with falling slopes; (n,).
        """
        x, f = np.asarray(displacement, dtype=float), np.asarray(force, dtype=float)
        slopes = np.diff(f, prepend=0.0) / np.diff(x, prepend=0.0)
        # The slope falls by k_i where element i begins to slide.
        stiffness = -np.diff(slopes, append=0.0)
        return cls(stiffness=stiffness, limit=stiffness * x)

    def backbone(self, displacement: Numbers) -> Vector:
        """Return the force of first loading from rest [N] at a displacement [m]; odd."""
        x = np.asarray(displacement, dtype=float)[..., None]
        return np.asarray(np.clip(self.stiffness * x, -self.limit, self.limit).sum(axis=-1))

    def path(self, displacement: Vector) -> Vector:
        """Return the force [N] along a path of displacements [m] that begins at rest at zero; (m,)."""
        forces, at, force = np.zeros(len(self.stiffness)), 0.0, []
        for x in displacement:
            forces = np.clip(forces + self.stiffness * (x - at), -self.limit, self.limit)
            at = x
            force.append(forces.sum())
        return np.array(force)
