"""Shares of the modes of a linear car in an acceleration that its plates cause.

With the first-order form x' = A x + (b0 + s b1) z and A = V diag(s_k) V^-1, an acceleration is a sum over the poles,

    a(jw) = (jw)^2 (sum_k c V_k (V^-1 (b0 + s_k b1) z(jw))_k / (jw - s_k) + g z(jw)),

exact at each line. A mode is a pair of conjugate poles; its share is its part in phase with the sum,

    share_k = sum over lines of Re(a_k conj(a)) / sum over lines of |a|^2.

All shares, with those of the real poles and of the direct term g, add up to 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.system import LinearSystem

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]


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
    row, direct = form.output(channel)
    poles, vectors = np.linalg.eig(form.state)
    weights = row @ vectors[: row.shape[0]]
    inputs = np.linalg.solve(vectors, np.hstack([form.input, form.input_rate]).astype(complex))
    w = driven.shape[0]
    residues = weights[:, None] * (inputs[:, :w] + poles[:, None] * inputs[:, w:])
    parts = lines**2 * (residues @ driven) / (lines - poles[:, None])
    acceleration = parts.sum(axis=0) + lines**2 * (direct @ driven)
    power = float(np.sum(np.abs(acceleration) ** 2)) or 1.0
    in_phase = (parts * np.conj(acceleration)).real.sum(axis=1) / power
    upper = np.flatnonzero(poles.imag > 0.0)
    # LAPACK returns the poles of a real matrix in pairs, the positive imaginary part first.
    return ModeShares(poles=poles[upper], shares=in_phase[upper] + in_phase[upper + 1], acceleration=acceleration)
