"""Shares of the modes of a linear car in an acceleration that its plates or its applied forces cause.

With the first-order form x' = A x + (b0 + s b1) z and A = V diag(s_k) V^-1, an acceleration is a sum over the poles,

    a(jw) = (jw)^2 (sum_k c V_k (V^-1 (b0 + s_k b1) z(jw))_k / (jw - s_k) + g z(jw)),

exact at each line. A mode is a pair of conjugate poles; its share is its part in phase with the sum,

    share_k = sum over lines of Re(a_k conj(a)) / sum over lines of |a|^2.

All shares, with those of the real poles and of the direct term g, add up to 1. Applied forces of one frequency drive
the states by f (`vehicle.engines.linear.forced_response`), and a_k = (jw)^2 c V_k (V^-1 f)_k / (jw - s_k).
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.first_order import FirstOrder, first_order
from vehicle.engines.linear.system import LinearSystem

LINES_AT_ONCE = 2**14
"""Lines whose poles are computed together, which limits the memory: 50 MB for 181 poles."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ModeShares:
    """Contributions of modes to an acceleration.

    Attributes:
        poles: poles with a positive imaginary part, one of each pair [rad/s]; (k,).
        shares: share of each pair [-]; (k,).
        acceleration: the sum over all poles [m/s2]; (m,).
    """

    poles: Complex
    shares: Vector
    acceleration: Complex


def mode_shares(
    system: LinearSystem, channel: str, frequency: npt.ArrayLike, plates: npt.ArrayLike, *, stuck: bool
) -> ModeShares:
    """Return the shares of the modes in an acceleration channel.

    Args:
        system: matrices of the car.
        channel: acceleration channel.
        frequency: lines [Hz], (m,).
        plates: complex amplitudes of the plate displacements at the lines [m], (w, m).
        stuck: True for locked dampers, False for their viscous part without friction.
    """
    form = first_order(system, stuck=stuck)
    lines, driven = 2j * np.pi * np.asarray(frequency, dtype=float), np.asarray(plates, dtype=complex)
    poles, vectors = np.linalg.eig(form.state)
    inputs = np.linalg.solve(vectors, np.hstack([form.input, form.input_rate]).astype(complex))
    w = driven.shape[0]
    # (b0 + s b1)/(s - p) is (b0 + p b1)/(s - p) + b1, and b1 moves no coordinate at once.
    residues = inputs[:, :w] + poles[:, None] * inputs[:, w:]
    return _shares(form, channel, lines, poles, vectors, residues, driven)


def forced_mode_shares(
    matrices: CarMatrices, channel: str, frequency: float, forces: npt.ArrayLike, *, stuck: bool
) -> ModeShares:
    """Return the shares of the modes in an acceleration channel that applied forces of one frequency cause.

    Args:
        matrices: matrices of the car.
        channel: acceleration channel.
        frequency: the frequency [Hz].
        forces: complex amplitudes of the forces in the order of `matrices.force_rows` [N, N m, m or m/s]; (f,).
        stuck: True for locked dampers, False for their viscous part without friction.
    """
    system, form, s = matrices.system, first_order(matrices.system, stuck=stuck), 2j * np.pi * frequency
    rows, slips, runouts = (
        part.T @ np.asarray(forces) for part in (matrices.force_rows, matrices.force_slips, matrices.force_heights)
    )
    tyres = system.input_stiffness + s * matrices.level_damping
    pushed = np.linalg.solve(form.basis.T @ system.mass @ form.basis, form.basis.T @ (rows + tyres @ runouts))
    # x' = A x + f: velocities by forces, branches by slips.
    states = np.concatenate([np.zeros(form.placed), pushed, system.branch_stiffness * slips])
    poles, vectors = np.linalg.eig(form.state)
    return _shares(form, channel, np.array([s]), poles, vectors, np.linalg.solve(vectors, states)[:, None], None)


def _shares(
    form: FirstOrder,
    channel: str,
    lines: Complex,
    poles: Complex,
    vectors: Complex,
    residues: Complex,
    plates: Complex | None,
) -> ModeShares:
    """Return the shares at the lines jw (m,) of poles driven by plates (w, m) with residues (s, w), or by (s, 1)."""
    row, direct = form.output(channel)
    outputs = (row @ vectors[: row.shape[0]])[:, None]
    acceleration = np.empty(lines.size, dtype=np.complex128)
    power, in_phase = 0.0, np.zeros(poles.size)
    for first in range(0, lines.size, LINES_AT_ONCE):
        part = slice(first, first + LINES_AT_ONCE)
        driven = residues if plates is None else residues @ plates[:, part]
        parts = lines[part] ** 2 * outputs * driven / (lines[part] - poles[:, None])
        total = parts.sum(axis=0)
        if plates is not None:
            total = total + lines[part] ** 2 * (direct @ plates[:, part])
        acceleration[part] = total
        power += float(np.sum(np.abs(total) ** 2))
        in_phase += (parts * np.conj(total)).real.sum(axis=1)
    # Re(a_k a*) over |a|^2, each summed over the lines.
    in_phase /= power or 1.0
    upper = np.flatnonzero(poles.imag > 0.0)
    # LAPACK returns the poles of a real matrix in pairs, the positive imaginary part first.
    return ModeShares(poles=poles[upper], shares=in_phase[upper] + in_phase[upper + 1], acceleration=acceleration)
