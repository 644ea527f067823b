"""The first-order form of a linear system: x' = A x + b0 z + b1 z' + bF F - N phi, v = V x + d z'.

The states are (y, y', f_b): with u = N y the free motions of the joints, y' their velocities, f_b the Maxwell branches.
Cyclic coordinates are the last of the free motions, and their places are left out of the states.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.engines.linear.system import Array, LinearSystem


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FirstOrder:
    """First-order form; s states, m free motions, w inputs, p sliding pairs, leading axes for many systems.

    Attributes:
        system: what it is the form of.
        basis: orthonormal basis N of the free motions, Jc N = 0; (n, m); the identity without joints.
        state: A; (..., s, s).
        input, input_rate: b0, b1; (..., s, w).
        load: bF; (..., s).
        friction: N phi, effect of the sliding forces; (..., s, p).
        slide, slide_rate: V, d; (..., p, s), (..., p, w).
    """

    system: LinearSystem
    basis: Array
    state: Array
    input: Array
    input_rate: Array
    load: Array
    friction: Array
    slide: Array
    slide_rate: Array

    @property
    def placed(self) -> int:
        """Number of free motions whose place is a state: all but the cyclic ones."""
        return int(self.basis.shape[1]) - len(self.system.cyclic)

    @property
    def velocities(self) -> slice:
        """States that are velocities; those of the cyclic ones last."""
        return slice(self.placed, self.placed + self.basis.shape[1])

    @property
    def branches(self) -> slice:
        """States that are forces of Maxwell branches."""
        return slice(self.placed + self.basis.shape[1], self.state.shape[-1])

    @property
    def models(self) -> tuple[int, ...]:
        """Shape of the stack of systems; empty for a single one."""
        return self.state.shape[:-2]

    def shape(self, states: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Displacements of the coordinates (n, ...) of states (s, ...), cyclic ones left out."""
        return np.asarray(self.basis[:, : self.placed] @ states[: self.placed])

    def shapes(self, vectors: npt.NDArray[Any], poles: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Displacements of all coordinates (n, p) in eigenvectors (s, p) with these poles [rad/s]; (p,)."""
        found = self.shape(vectors)
        if self.system.cyclic:
            found = found + self.basis[:, self.placed :] @ (vectors[self.velocities][self.placed :] / poles)
        return found

    def output(self, name: str) -> tuple[Array, Array]:
        """Coefficients of an output on the free motions but cyclic ones (..., m) and on the inputs (..., w)."""
        row, inputs = self.system.output(name)
        return row @ self.basis[:, : self.placed], inputs


def free_basis(system: LinearSystem, *, stuck: bool = False) -> Array:
    """Orthonormal basis of the motions that the joints, and sliding pairs that are stuck, allow; (n, m).

    No joint holds a cyclic coordinate: each is a motion of its own, behind the others.
    """
    rows = system.constraints
    if stuck:
        rows = np.vstack([rows, system.slide_rows])
    if system.cyclic:
        cyclic, others = list(system.cyclic), np.setdiff1d(np.arange(system.size), system.cyclic)
        held = np.asarray(scipy.linalg.null_space(rows[:, others])) if len(rows) else np.eye(len(others))
        basis = np.zeros((system.size, held.shape[1] + len(cyclic)))
        basis[others, : held.shape[1]] = held
        basis[cyclic, held.shape[1] + np.arange(len(cyclic))] = 1.0
        return basis
    return np.eye(system.size) if len(rows) == 0 else np.asarray(scipy.linalg.null_space(rows))


def first_order(system: LinearSystem, *, stuck: bool = False) -> FirstOrder:
    """First-order form of a system.

    Args:
        system: the matrices.
        stuck: lock the sliding pairs (of a single system) instead of leaving their forces open.

    Returns:
        The form.
    """
    basis = free_basis(system, stuck=stuck)
    mass = basis.T @ system.mass @ basis
    rows = system.branch_rows @ basis
    slides = system.slide_rows @ basis
    m, count = basis.shape[1], rows.shape[-2]
    placed = m - len(system.cyclic)
    stack, w, p = mass.shape[:-2], len(system.inputs), slides.shape[-2]
    right = np.concatenate(
        [
            -(basis.T @ system.stiffness @ basis)[..., :placed],
            -(basis.T @ system.damping @ basis),
            -np.swapaxes(system.effects @ basis, -1, -2),
            basis.T @ system.input_stiffness,
            basis.T @ system.input_damping,
            (system.load @ basis)[..., None],
            np.swapaxes(slides, -1, -2),
        ],
        axis=-1,
    )
    size = placed + m + count
    ends = np.cumsum([size, w, w, 1])
    accelerations, push, drag, load, grip = np.split(np.linalg.solve(mass, right), ends, axis=-1)
    v, f = slice(placed, placed + m), slice(placed + m, size)
    state = np.zeros((*stack, size, size))
    state[..., :placed, v] = np.eye(placed, m)
    state[..., v, :] = accelerations
    state[..., f, v] = system.branch_stiffness[..., None] * rows
    if system.branch_drifts is not None:
        state[..., f, :placed] = system.branch_stiffness[..., None] * (system.branch_drifts @ basis)[..., :placed]
    state[..., range(f.start, size), range(f.start, size)] = -1.0 / system.branch_time
    still = np.zeros((*stack, placed, w))
    return FirstOrder(
        system=system,
        basis=basis,
        state=state,
        input=np.concatenate([still, push, np.zeros((*stack, count, w))], axis=-2),
        input_rate=np.concatenate([still, drag, system.branch_stiffness[..., None] * system.branch_inputs], axis=-2),
        load=_padded(load, placed, count)[..., 0],
        friction=_padded(grip, placed, count),
        slide=np.concatenate([np.zeros((*stack, p, placed)), slides, np.zeros((*stack, p, count))], axis=-1),
        slide_rate=system.slide_inputs,
    )


def _padded(speeds: Array, before: int, after: int) -> Array:
    """Effects on the velocities as effects on all states."""
    shape = (*speeds.shape[:-2],)
    return np.concatenate(
        [np.zeros((*shape, before, speeds.shape[-1])), speeds, np.zeros((*shape, after, speeds.shape[-1]))], axis=-2
    )
