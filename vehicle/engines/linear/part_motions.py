"""Kinetic energy of the parts of a car, split into rigid translations and rotations.

The parts of a unit (the body with the parts welded to it; a wheel with its knuckle, links and damper) move with the
velocities v_b of their centres of gravity and the angular velocities w_b. The rigid motion with the same momentum and
the same angular momentum L about the centre of gravity of the unit has the energy

    2 T = m |v|^2 + L' J^-1 L,    m v = sum m_b v_b,    L = sum J_b w_b + m_b (r_b - r) x v_b

and the remaining motion of the parts relative to it is orthogonal to it in M (Tisserand's mean axes), so that both
energies add up. sqrt(m) v and J^-1/2 L are six coordinates whose squares are the energies of the three translations and
of the three rotations.

Source: J. R. Canavin and P. W. Likins, Floating reference frames for flexible spacecraft, J. Spacecraft 14 (1977),
724-732, for mean axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vehicle.arrays import Vector

if TYPE_CHECKING:
    from vehicle.engines.linear.car_matrices import CarMatrices


_NO_INERTIA = 1e-12
"""Maximum ratio of a principal moment of inertia to the largest that counts as zero: point mass, masses on a line."""


def group_of(matrices: CarMatrices, body: str) -> str:
    """Return the group of parts to which a rigid body belongs in the energy shares."""
    if matrices.carried_by.get(body) == "body":
        return "body"
    if body.startswith("stabilizer"):
        return "stabilizer"
    wheel = next((wheel for wheel in matrices.system.inputs if body.endswith(f"_{wheel}")), None)
    return body if wheel is None else f"wheel_{wheel}"


def rigid_rows(matrices: CarMatrices) -> dict[str, Vector]:
    """Return the rows that map u' to the energy coordinates of each group of parts (see `group_of`).

    Returns:
        Group to rows (6, n): translations along x, y, z, rotations about them [kg^1/2 m/s].
    """
    groups: dict[str, list[str]] = {}
    for body in matrices.body_rows:
        groups.setdefault(group_of(matrices, body), []).append(body)
    return {group: _unit_rows(matrices, bodies) for group, bodies in groups.items()}


def _unit_rows(matrices: CarMatrices, bodies: list[str]) -> Vector:
    """Return the rows of the energy coordinates of the bodies of a unit; (6, n)."""
    masses = [float(matrices.body_masses[body][0, 0]) for body in bodies]
    total = sum(masses)
    centres = [matrices.body_centres[body] for body in bodies]
    centre = sum(mass * position for mass, position in zip(masses, centres, strict=True)) / total
    momentum = np.zeros_like(matrices.body_rows[bodies[0]][:3])
    angular_momentum, inertia = np.zeros_like(momentum), np.zeros((3, 3))
    for body, mass, position in zip(bodies, masses, centres, strict=True):
        rows, body_inertia = matrices.body_rows[body], matrices.body_masses[body][3:, 3:]
        arm = cross_matrix(position - centre)
        momentum += mass * rows[:3]
        # L = J_b w + m r x v, and Steiner's J_b - m [r]x [r]x.
        angular_momentum += body_inertia @ rows[3:] + mass * arm @ rows[:3]
        inertia += body_inertia - mass * arm @ arm
    moments, axes = np.linalg.eigh(inertia)
    real = moments > _NO_INERTIA * moments[-1]
    # J^-1/2 = U diag(w^-1/2) U' without the axes that have no inertia.
    root = (axes[:, real] / np.sqrt(moments[real])) @ axes[:, real].T
    return np.vstack([momentum / np.sqrt(total), root @ angular_momentum])


def cross_matrix(arm: Vector) -> Vector:
    """Return the matrix [a]x of the cross product a x b, (3, 3)."""
    x, y, z = arm
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
