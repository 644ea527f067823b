"""Decoupling of a part on its mounts: kinetic energy of its modes in translations and rotations about its centre.

With the velocity p = (v, w) of the centre of gravity of the part and M = diag(m, m, m, J), a mode has the energies

    T_jk = Re(conj(p_j) M_jk p_k) / (p^H M p),    j, k = x, y, z, rotations about x, y, z;

their sum is 1. The share of a motion is the sum of its row. Products of inertia couple two rotations, so that single
terms, and rarely a share, may be negative. In the car the modes are those of the car; grounded, the body is fixed,
mounts have their static tangent at the operating point, and Maxwell branches and damping are left out. Parts between
the part and the body, such as a torque arm or the fluid of a mount, are free.

Torque roll axis: the axis s = J^-1 e about which a free part turns under a torque about the crankshaft e. The torque
excites one mode alone if K s = W^2 M s with K of the mounts over the six motions; W^2 = s'Ks / s'Ms, the residual is
|M^-1 K s - W^2 s| / |W^2 s|. Source: Jeong and Singh, J. Sound Vib. 234 (2000), 85-114.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.natural_modes import natural_modes
from vehicle.engines.linear.part_motions import cross_matrix
from vehicle.engines.linear.system import LinearSystem
from vehicle.errors import ConfigurationError

MOTIONS = ("x", "y", "z", "about x", "about y", "about z")
"""Motions of a part: translations, and rotations about its centre of gravity."""

TAKES_PART = 0.2
"""Share of the kinetic energy of a mode of the car from which on it is a mode of the part."""

HIGHEST = 60.0
"""Highest natural frequency in the car [Hz]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DecouplingMode:
    """Mode of the part.

    Attributes:
        frequency: natural frequency [Hz].
        damping_ratio: damping ratio [-]; 0 grounded.
        table: T_jk, (6, 6); the sum is 1.
        energy: share of the part in the kinetic energy of the mode.
    """

    frequency: float
    damping_ratio: float
    table: Vector
    energy: float

    @property
    def shares(self) -> Vector:
        """Share of each of `MOTIONS`; (6,)."""
        return np.asarray(self.table.sum(axis=1))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Decoupling:
    """Modes of a part on its mounts.

    Attributes:
        part: name of the part.
        grounded: True if the body is fixed.
        modes: modes, the lowest first.
        roll_axis: direction of the torque roll axis, grounded mounts.
        angle: angle between it and the crankshaft [deg].
        roll_frequency: frequency W of a turn about it [Hz].
        residual: |M^-1 K s - W^2 s| / |W^2 s| [-].
    """

    part: str
    grounded: bool
    modes: tuple[DecouplingMode, ...]
    roll_axis: Vector
    angle: float
    roll_frequency: float
    residual: float


def decoupling(
    matrices: CarMatrices,
    part: str,
    *,
    grounded: bool = False,
    stuck: bool = True,
    crankshaft: tuple[float, float, float] = (0.0, 1.0, 0.0),
) -> Decoupling:
    """Return the modes of a part on its mounts.

    Args:
        matrices: matrices of the assembled car.
        part: a part that moves freely on its mounts, for example "engine".
        grounded: fix the body; by default, modes of the whole car.
        stuck: True for locked dampers of the car.
        crankshaft: direction of the crankshaft.

    Raises:
        ConfigurationError: no free part has this name, or the crankshaft has no direction.
    """
    rows, inertia = _rigid(matrices, part)
    if not np.linalg.norm(crankshaft) > 0.0:
        raise ConfigurationError(f"crankshaft: must be a direction of three numbers, not {list(crankshaft)}")
    system, hung = matrices.system, _hung(matrices, rows, part)
    stiffness = _mount_stiffness(system, rows, hung)
    shaft = np.array(crankshaft) / np.linalg.norm(crankshaft)
    # s = J^-1 e.
    axis = np.linalg.solve(inertia[3:, 3:], shaft)
    axis /= np.linalg.norm(axis)
    turn = np.concatenate([np.zeros(3), axis])
    # W^2 = s'Ks / s'Ms, and what is left of M^-1 K s.
    square = float(turn @ stiffness @ turn / (turn @ inertia @ turn))
    missed = np.linalg.solve(inertia, stiffness @ turn) - square * turn
    if grounded:
        reduced = (hung.T @ matrix @ hung for matrix in (system.stiffness, system.mass))
        squares, shapes = scipy.linalg.eigh(*reduced)
        poles, motions = 1j * np.sqrt(np.maximum(squares, 0.0)), (hung @ shapes).T
    else:
        natural = natural_modes(first_order(system, stuck=stuck))
        poles, motions = natural.pole, natural.motion
    modes = []
    for pole, motion in zip(poles, motions, strict=True):
        velocity = rows @ motion
        # T_jk before its division by the sum.
        table = np.real(np.conj(velocity)[:, None] * inertia * velocity[None, :])
        share = float(np.sum(table)) / float(np.vdot(motion, system.mass @ motion).real)
        if share >= TAKES_PART and abs(pole) <= 2.0 * np.pi * HIGHEST:
            modes.append(
                DecouplingMode(
                    frequency=abs(pole) / (2.0 * np.pi),
                    damping_ratio=-pole.real / max(abs(pole), 1e-300) + 0.0,
                    table=table / np.sum(table),
                    energy=share,
                )
            )
    return Decoupling(
        part=part,
        grounded=grounded,
        modes=tuple(modes),
        roll_axis=axis,
        angle=float(np.degrees(np.arccos(min(abs(float(axis @ shaft)), 1.0)))),
        roll_frequency=float(np.sqrt(max(square, 0.0))) / (2.0 * np.pi),
        residual=float(np.linalg.norm(missed) / abs(square)) if square else float("inf"),
    )


def _rigid(matrices: CarMatrices, part: str) -> tuple[Vector, Vector]:
    """Return the rows of the velocity at the centre of gravity of a part with what is fixed to it, and its M."""
    bodies = [body for body in matrices.body_rows if matrices.carried_by[body] == part]
    if not bodies:
        names = sorted({owner for body, owner in matrices.carried_by.items() if body in matrices.body_rows})
        raise ConfigurationError(f"part {part!r}: unknown; choose from {', '.join(names)}")
    masses = np.array([matrices.body_masses[body][0, 0] for body in bodies])
    centres = np.array([matrices.body_centres[body] for body in bodies])
    centre = masses @ centres / np.sum(masses)
    inertia = np.diag([*[float(np.sum(masses))] * 3, 0.0, 0.0, 0.0])
    for body, mass, position in zip(bodies, masses, centres, strict=True):
        arm = cross_matrix(position - centre)
        # Steiner: J - m [a]x [a]x.
        inertia[3:, 3:] += matrices.body_masses[body][3:, 3:] - mass * arm @ arm
    rows = matrices.body_rows[part].copy()
    # v at the centre of the whole: v + w x a = v - [a]x w.
    rows[:3] -= cross_matrix(centre - matrices.body_centres[part]) @ rows[3:]
    return rows, inertia


def _hung(matrices: CarMatrices, rows: Vector, part: str) -> Vector:
    """Return a basis of the motions of a part, and of what hangs between it and the body alone; (n, motions)."""
    system = matrices.system
    body = np.any(matrices.body_rows["body"] != 0.0, axis=0)
    body[matrices.modal] = True
    # Coordinates that share a spring or a joint, the body left out: what is reached from the part hangs on it.
    coupled = (system.stiffness != 0.0) | (system.constraints.T != 0.0) @ (system.constraints != 0.0)
    coupled[body], coupled[:, body] = False, False
    member = np.any(rows != 0.0, axis=0) & ~body
    while np.any(more := np.any(coupled[member], axis=0) & ~member):
        member |= more
    wheels = np.any(matrices.tyre_rows[:, member] != 0.0)
    if wheels or np.linalg.matrix_rank(rows[:, member]) != 6 or np.any(rows[:, body]):
        raise ConfigurationError(
            f"part {part!r}: is held by joints or wheels; give a part that is held only by its mounts"
        )
    joints = system.constraints[:, member]
    joints = joints[np.any(joints != 0.0, axis=1)]
    free = scipy.linalg.null_space(joints) if len(joints) else np.eye(int(np.count_nonzero(member)))
    basis = np.zeros((system.size, free.shape[1]))
    basis[member] = free
    return basis


def _mount_stiffness(system: LinearSystem, rows: Vector, hung: Vector) -> Vector:
    """Return the stiffness of a part over its motions, of what hangs on it by static condensation; (6, 6)."""
    over_part = rows @ hung
    still = scipy.linalg.null_space(over_part)
    # Coordinates: six motions of the part in the smallest way, then motions that leave the part at rest.
    whole = np.hstack([np.linalg.pinv(over_part), still])
    stiffness = whole.T @ hung.T @ system.stiffness @ hung @ whole
    coupling, condensed = stiffness[:6, 6:], stiffness[6:, 6:]
    # Static condensation: K_aa - K_ab K_bb^-1 K_ba.
    return np.asarray(stiffness[:6, :6] - coupling @ np.linalg.pinv(condensed) @ coupling.T)
