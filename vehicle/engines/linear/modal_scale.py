"""Scale of a complex mode: Modal A, which determines its share in every response."""

import numpy as np

from vehicle.arrays import Complex
from vehicle.engines.linear.system import LinearSystem


def modal_a(system: LinearSystem, pole: complex, shape: Complex) -> complex:
    """Return Modal A [kg/s] of a mode with pole s and shape u: u^T D'(s) u with the dynamic stiffness D.

    D(s) = s^2 M + s C + K + sum_b h_b^T K2 tau / (1 + s tau) (s e_b + g_b), so near s the receptance is
    u u^T / (A (j w - s)): the residue of the response at i to a force at k is u_i u_k / A. It is exact for
    symmetric matrices. Preloads disturb the symmetry slightly; the matrices of a rolling car are unsymmetric (slip,
    gyroscopic moments).

    Args:
        system: the matrices.
        pole: s [rad/s].
        shape: displacements u, (n,), that joints and locked pairs allow.

    Source: Ewins, Modal Testing, 2nd ed., section 2.8; field "Modal A" of dataset 55 of the universal files.
    """
    time = system.branch_time
    # d/ds of K2 tau (s e + g)/(1 + s tau) is K2 tau (e - tau g)/(1 + s tau)^2.
    rate = system.branch_stiffness * time / (1.0 + pole * time) ** 2
    motion, effect = system.branch_rows @ shape, system.effects @ shape
    if system.branch_drifts is not None:
        motion = motion - time * (system.branch_drifts @ shape)
    return complex(shape @ (2.0 * pole * system.mass + system.damping) @ shape + np.sum(rate * motion * effect))
