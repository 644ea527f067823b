"""The scale of a complex mode: its share in every response."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.linear.system import LinearSystem


def modal_a(system: LinearSystem, pole: complex, shape: npt.NDArray[np.complex128]) -> complex:
    """Modal A of a mode with pole s and shape u: u^T D'(s) u, D the dynamic stiffness.

    D(s) = s^2 M + s C + K + sum_b e_b^T K2 s tau / (1 + s tau) e_b, so near s the receptance is u u^T / (A (j w - s)):
    the residue of the response at i to a force at k is u_i u_k / A. It is exact where the matrices are symmetric, which
    preloads disturb slightly.

    Args:
        system: the matrices.
        pole: s [rad/s].
        shape: u, (n,), of motions that joints and locked pairs allow.

    Returns:
        A [kg/s] for a shape without unit.

    Source: Ewins, Modal Testing, 2nd ed., section 2.8; field "Modal A" of dataset 55 of the universal files.
    """
    time = system.branch_time
    rate = system.branch_stiffness * time / (1.0 + pole * time) ** 2
    motion = system.branch_rows @ shape
    return complex(shape @ (2.0 * pole * system.mass + system.damping) @ shape + np.sum(rate * motion**2))
