"""Mass, centre of gravity and inertia of a body, and its six mass-normalised rigid motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.arrays import Vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MassProperties:
    """Mass properties of a rigid body.

    Attributes:
        mass: m [kg].
        cog: c [m], shape (3,).
        inertia: tensor about the CoG with negative products [kg m2], shape (3, 3).
    """

    mass: float
    cog: Vector
    inertia: Vector

    @classmethod
    def of_points(cls, masses: Vector, positions: Vector) -> MassProperties:
        """Return the mass properties of point masses: M = sum m, c = sum m r / M, sum m (|d|^2 1 - d d').

        Args:
            masses: point masses m [kg], shape (n,).
            positions: their positions r = c + d [m], shape (n, 3).
        """
        mass = float(masses.sum())
        cog = np.asarray(masses @ positions / mass)
        return cls(mass=mass, cog=cog, inertia=_steiner(masses, positions - cog))

    def with_points(self, masses: Vector, positions: Vector) -> MassProperties:
        """Return the mass properties with additional point masses [kg], (n,), at positions [m], (n, 3)."""
        total = self.mass + float(masses.sum())
        cog = (self.mass * self.cog + masses @ positions) / total
        # About the new centre of gravity, to which the old one is at a distance.
        tensor = self.inertia + _steiner(np.array([self.mass]), np.atleast_2d(self.cog - cog))
        return MassProperties(mass=total, cog=np.asarray(cog), inertia=tensor + _steiner(masses, positions - cog))

    def without(self, parts: MassProperties) -> MassProperties:
        """Return the mass properties of what is left of this body without some of its parts.

        m' = m - m_p, m' c' = m c - m_p c_p, and I' = I - I_p, each tensor about c'.

        Args:
            parts: mass properties of these parts, lighter than the body.
        """
        mass = self.mass - parts.mass
        cog = (self.mass * self.cog - parts.mass * parts.cog) / mass
        whole, part = (
            entry.inertia + _steiner(np.array([entry.mass]), np.atleast_2d(entry.cog - cog)) for entry in (self, parts)
        )
        return MassProperties(mass=mass, cog=np.asarray(cog), inertia=whole - part)

    def rigid_motions(self, positions: Vector) -> tuple[Vector, Vector]:
        """Return the six mass-normalised rigid motions, R' M R = 1: translations, then rotations about the CoG.

        Args:
            positions: points of the body [m], shape (n, 3).

        Returns:
            Displacements of the points [kg^-1/2], shape (6, n, 3); rotations [rad kg^-1/2 / m], shape (6, 3).
        """
        shapes, turns = np.zeros((6, len(positions), 3)), np.zeros((6, 3))
        # Rotations L^-1 with I = L L': L^-1 I L^-T = 1.
        turns[3:] = np.linalg.inv(np.linalg.cholesky(self.inertia))
        for axis in range(3):
            shapes[axis, :, axis] = 1.0 / np.sqrt(self.mass)
            shapes[3 + axis] = np.cross(turns[3 + axis], positions - self.cog)
        return shapes, turns


def _steiner(masses: Vector, arms: ArrayLike) -> Vector:
    """Return the sum of m (|r|^2 1 - r r') [kg m2], shape (3, 3)."""
    r = np.asarray(arms)
    moments = (r.T * masses) @ r
    return np.asarray(np.trace(moments) * np.eye(3) - moments)
