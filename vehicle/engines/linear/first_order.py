"""First-order form of a linear system: x' = A x + b0 z + b1 z' + bF F - N phi, v = V x + d z'.

The states are (y, y', f_b): the free motions y of the joints with u = N y, their velocities y', the forces f_b of the
Maxwell branches. Cyclic coordinates are the last of the free motions, and their positions are not states.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Vector
from vehicle.engines.linear.system import LinearSystem


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FirstOrder:
    """First-order form; s states, m free motions, w inputs, p sliding pairs, leading axes for a stack of systems.

    Attributes:
        system: the linear system of second order.
        basis: orthonormal basis N of the free motions, Jc N = 0; (n, m); the identity without joints.
        state: A; (..., s, s).
        input, input_rate: b0, b1; (..., s, w).
        load: bF; (..., s).
        friction: N, effect of the sliding forces phi; (..., s, p).
        slide, slide_rate: V and d of the sliding velocities; (..., p, s), (..., p, w).
    """

    system: LinearSystem
    basis: Vector
    state: Vector
    input: Vector
    input_rate: Vector
    load: Vector
    friction: Vector
    slide: Vector
    slide_rate: Vector

    @property
    def placed(self) -> int:
        """Return the number of free motions whose position is a state: all except cyclic ones."""
        return int(self.basis.shape[1]) - len(self.system.cyclic)

    @property
    def velocities(self) -> slice:
        """Return the states that are velocities; those of cyclic motions come last."""
        return slice(self.placed, self.placed + self.basis.shape[1])

    @property
    def branches(self) -> slice:
        """Return the states that are forces of Maxwell branches."""
        return slice(self.placed + self.basis.shape[1], self.state.shape[-1])

    @property
    def models(self) -> tuple[int, ...]:
        """Return the shape of the stack of systems; empty for a single system."""
        return self.state.shape[:-2]

    def shape(self, states: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return the displacements of the coordinates (n, ...) in states (s, ...), zero for cyclic coordinates."""
        return np.asarray(self.basis[:, : self.placed] @ states[: self.placed])

    def shapes(self, vectors: npt.NDArray[Any], poles: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return the displacements of all coordinates (n, p) in eigenvectors (s, p) with poles (p,) [rad/s]."""
        displacements = self.shape(vectors)
        if self.system.cyclic:
            # A cyclic coordinate has its velocity as a state: u = u'/s.
            displacements = displacements + self.basis[:, self.placed :] @ (
                vectors[self.velocities][self.placed :] / poles
            )
        return displacements

    def output(self, name: str) -> tuple[Vector, Vector]:
        """Return the coefficients of an output on the non-cyclic free motions (..., m) and on the inputs (..., w)."""
        row, inputs = self.system.output(name)
        return row @ self.basis[:, : self.placed], inputs


def free_basis(system: LinearSystem, *, stuck: bool = False) -> Vector:
    """Return an orthonormal basis of the motions that joints, and stuck sliding pairs, allow; (n, m).

    Joints do not constrain cyclic coordinates: each is a separate free motion, after the others.
    """
    rows = system.constraints
    if stuck:
        rows = np.vstack([rows, system.slide_rows])
    if system.cyclic:
        cyclic, others = list(system.cyclic), np.setdiff1d(np.arange(system.size), system.cyclic)
        others_basis = _null_space(rows[:, others])
        basis = np.zeros((system.size, others_basis.shape[1] + len(cyclic)))
        # Block diagonal: the motions of the other coordinates, then a unit motion of each cyclic one.
        basis[others, : others_basis.shape[1]] = others_basis
        basis[cyclic, others_basis.shape[1] + np.arange(len(cyclic))] = 1.0
        return basis
    return _null_space(rows)


def _null_space(rows: Vector) -> Vector:
    """Return an orthonormal basis of the solutions of rows u = 0; (n, m), not writeable."""
    return _null_space_of(rows.tobytes(), *rows.shape)


# The cars of a sweep have the same joints.
@lru_cache(maxsize=8)
def _null_space_of(entries: bytes, count: int, size: int) -> Vector:
    rows = np.frombuffer(entries).reshape(count, size)
    basis = np.asarray(scipy.linalg.null_space(rows)) if count else np.eye(size)
    basis.flags.writeable = False
    return basis


def first_order(system: LinearSystem, *, stuck: bool = False) -> FirstOrder:
    """Convert a linear system to its first-order form.

    Args:
        system: the matrices.
        stuck: lock the sliding pairs (of a single system) instead of leaving their forces open.
    """
    basis = free_basis(system, stuck=stuck)
    mass = basis.T @ system.mass @ basis
    rows = system.branch_rows @ basis
    slides = system.slide_rows @ basis
    m, count = basis.shape[1], rows.shape[-2]
    position_count = m - len(system.cyclic)
    stack, w, p = mass.shape[:-2], len(system.inputs), slides.shape[-2]
    # (N' M N) y'' = -K y - C y' - H' f_b + Bk z + Bc z' + l F + S' phi, each along N' and N, side by side.
    right = np.concatenate(
        [
            -(basis.T @ system.stiffness @ basis)[..., :position_count],
            -(basis.T @ system.damping @ basis),
            -np.swapaxes(system.effects @ basis, -1, -2),
            basis.T @ system.input_stiffness,
            basis.T @ system.input_damping,
            (system.load @ basis)[..., None],
            np.swapaxes(slides, -1, -2),
        ],
        axis=-1,
    )
    size = position_count + m + count
    splits = np.cumsum([size, w, w, 1])
    accelerations, push, drag, load, grip = np.split(np.linalg.solve(mass, right), splits, axis=-1)
    v, f = slice(position_count, position_count + m), slice(position_count + m, size)
    state = np.zeros((*stack, size, size))
    # y' = y' for all motions with a position, then the row of y'', then f_b' = K2 (e u' + g u) - f_b/tau.
    state[..., :position_count, v] = np.eye(position_count, m)
    state[..., v, :] = accelerations
    state[..., f, v] = system.branch_stiffness[..., None] * rows
    if system.branch_drifts is not None:
        state[..., f, :position_count] = (
            system.branch_stiffness[..., None] * (system.branch_drifts @ basis)[..., :position_count]
        )
    state[..., range(f.start, size), range(f.start, size)] = -1.0 / system.branch_time
    zero_rows = np.zeros((*stack, position_count, w))
    return FirstOrder(
        system=system,
        basis=basis,
        state=state,
        input=np.concatenate([zero_rows, push, np.zeros((*stack, count, w))], axis=-2),
        input_rate=np.concatenate(
            [zero_rows, drag, system.branch_stiffness[..., None] * system.branch_inputs], axis=-2
        ),
        load=_padded(load, position_count, count)[..., 0],
        friction=_padded(grip, position_count, count),
        slide=np.concatenate([np.zeros((*stack, p, position_count)), slides, np.zeros((*stack, p, count))], axis=-1),
        slide_rate=system.slide_inputs,
    )


def _padded(speeds: Vector, before: int, after: int) -> Vector:
    """Extend effects on the velocities by zeros to effects on all states."""
    shape = (*speeds.shape[:-2],)
    return np.concatenate(
        [np.zeros((*shape, before, speeds.shape[-1])), speeds, np.zeros((*shape, after, speeds.shape[-1]))], axis=-2
    )
