"""The first-order form of a linear system: x' = A x + b0 z + b1 z' + bF F - N phi, v = V x + d z'.

The states are (y, y', f_b): with u = N y the free motions of the joints, y' their velocities, f_b the Maxwell branches.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.linear.system import Array, LinearSystem


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
    def models(self) -> tuple[int, ...]:
        """Shape of the stack of systems; empty for a single one."""
        return self.state.shape[:-2]

    def shape(self, states: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Displacements of the coordinates (n, ...) of states (s, ...)."""
        return np.asarray(self.basis @ states[: self.basis.shape[1]])

    def output(self, name: str) -> tuple[Array, Array]:
        """Coefficients of an output on the free motions (..., m) and on the inputs (..., w)."""
        row, inputs = self.system.output(name)
        return row @ self.basis, inputs


def free_basis(system: LinearSystem, *, stuck: bool = False) -> Array:
    """Orthonormal basis of the motions that the joints, and sliding pairs that are stuck, allow; (n, m)."""
    rows = system.constraints
    if stuck:
        rows = np.vstack([rows, system.slide_rows])
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
    stack, w, p = mass.shape[:-2], len(system.inputs), slides.shape[-2]
    right = np.concatenate(
        [
            -(basis.T @ system.stiffness @ basis),
            -(basis.T @ system.damping @ basis),
            -np.swapaxes(rows, -1, -2),
            basis.T @ system.input_stiffness,
            basis.T @ system.input_damping,
            (system.load @ basis)[..., None],
            np.swapaxes(slides, -1, -2),
        ],
        axis=-1,
    )
    ends = np.cumsum([2 * m + count, w, w, 1])
    accelerations, push, drag, load, grip = np.split(np.linalg.solve(mass, right), ends, axis=-1)
    size = 2 * m + count
    state = np.zeros((*stack, size, size))
    state[..., :m, m : 2 * m] = np.eye(m)
    state[..., m : 2 * m, :] = accelerations
    state[..., 2 * m :, m : 2 * m] = system.branch_stiffness[..., None] * rows
    state[..., range(2 * m, size), range(2 * m, size)] = -1.0 / system.branch_time
    still = np.zeros((*stack, m, w))
    return FirstOrder(
        system=system,
        basis=basis,
        state=state,
        input=np.concatenate([still, push, np.zeros((*stack, count, w))], axis=-2),
        input_rate=np.concatenate([still, drag, system.branch_stiffness[..., None] * system.branch_inputs], axis=-2),
        load=_padded(load, m, count)[..., 0],
        friction=_padded(grip, m, count),
        slide=np.concatenate([np.zeros((*stack, p, m)), slides, np.zeros((*stack, p, count))], axis=-1),
        slide_rate=system.slide_inputs,
    )


def _padded(speeds: Array, before: int, after: int) -> Array:
    """Effects on the velocities as effects on all states."""
    shape = (*speeds.shape[:-2],)
    return np.concatenate(
        [np.zeros((*shape, before, speeds.shape[-1])), speeds, np.zeros((*shape, after, speeds.shape[-1]))], axis=-2
    )
