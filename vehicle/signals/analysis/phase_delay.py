"""Delay between two FRFs of one path, from the slope of their phase difference."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.samples import Vector

LARGEST_DELAY = 0.1
"""Maximum |delay| of the search [s]: five times the delay of a Bessel filter of order 8 with a corner of 25 Hz."""

PER_PERIOD = 12.0
"""Values of the search per period of the highest frequency."""

ROUNDS = 20
"""Maximum number of Gauss-Newton steps; five are sufficient from a twelfth of a period away."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PhaseDelay:
    """Delay of a second FRF against a first.

    Attributes:
        delay: delay d of best agreement [s].
        error: standard error from the phases that remain [s].
        agreement: weighted mean of cos(remaining phase) [-]; 1 for FRFs that differ by a delay alone.
    """

    delay: float
    error: float
    agreement: float


def phase_delay(frequency: Vector, first: npt.ArrayLike, second: npt.ArrayLike, weight: Vector) -> PhaseDelay | None:
    """Return the delay d of an FRF H_2 = H_1 exp(-2 pi i f d), whatever the levels of both.

    maximise  sum_k w_k cos(phi_k + 2 pi f_k d),   phi_k = arg(H_2 / H_1),

    by a search over +-`LARGEST_DELAY`, then by Gauss-Newton on the remaining phases. The standard error is
    s / sqrt(sum_k w_k (2 pi f_k)^2) with s^2 the mean of w_k phi_k^2, times sqrt((1 + rho) / (1 - rho)) for a
    correlation rho of neighbouring phases (Bartlett 1946).

    Args:
        frequency: lines [Hz], (m,).
        first, second: FRFs, (m,); NaN where undefined.
        weight: weights of the lines [-], (m,).

    Returns:
        The delay; None if fewer than three lines are defined.

    Source: Piersol, Time delay estimation using phase data, IEEE Trans. ASSP 29(3), 1981, 471-477.
    """
    h_1, h_2 = np.asarray(first, dtype=complex), np.asarray(second, dtype=complex)
    usable = np.isfinite(h_1) & np.isfinite(h_2) & (np.abs(h_1) > 0.0) & (np.abs(h_2) > 0.0) & (weight > 0.0)
    if np.count_nonzero(usable) < 3:
        return None
    omega, w = 2.0 * np.pi * frequency[usable], weight[usable] / weight[usable].sum()
    # Unit vectors exp(i phi_k), whatever the levels.
    turn = h_2[usable] * np.conj(h_1[usable])
    turn /= np.abs(turn)
    step = 2.0 * np.pi / float(omega[-1]) / PER_PERIOD
    # Maximum of sum w cos(phi + w d) over all delays of the grid; (delays, lines).
    grid = step * np.arange(-np.ceil(LARGEST_DELAY / step), np.ceil(LARGEST_DELAY / step) + 1)
    delay = float(grid[np.argmax((np.exp(1j * grid[:, None] * omega) @ (w * turn)).real)])
    power = float(w @ omega**2)
    for _ in range(ROUNDS):
        # sin in place of the angle: phases near +-180 degrees, as between two different resonances, have no weight.
        change = -float((w * omega) @ np.sin(np.angle(turn * np.exp(1j * omega * delay)))) / power
        delay += change
        if abs(change) < 1e-9:
            break
    phase = np.angle(turn * np.exp(1j * omega * delay))
    spread = float(w @ phase**2)
    # Correlation of neighbouring lines leaves fewer independent lines.
    rho = float(phase[1:] @ phase[:-1]) / max(float(phase @ phase), 1e-300)
    independent = omega.size * (1.0 - rho) / (1.0 + rho) if rho > 0.0 else omega.size
    error = np.sqrt(spread / max(independent - 1.0, 1.0) / power)
    return PhaseDelay(delay=delay, error=float(error), agreement=float(w @ np.cos(phase)))
