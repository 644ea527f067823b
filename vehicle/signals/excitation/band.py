"""Frequency band of a periodic random signal: spectral lines within the band, and their synthesis."""

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Complex, Vector
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.slip_set import CHOSEN

LOWER_BAND_EDGE_HZ = 2.0
"""Default lower band edge of generated roads [Hz]."""

SHAKER_EDGE_HZ = CHOSEN.shaker_edge_hz
"""Lower edge of the shipped shaker inputs [Hz], half power."""

SHAKER_ROLL_OFF_ORDER = 2
"""Order of the Butterworth edge of the shipped inputs. Assumed: an electrodynamic shaker with limited stroke follows a
constant velocity no further down, but without a sharp limit; FRFs remain defined from 1 Hz."""

LOWEST_FREQUENCY_HZ = 1.0
"""Lowest line of the shipped inputs [Hz]: the lower end of the source's range of interest."""

UPPER_BAND_EDGE_HZ = 50.0
"""Upper edge of the shipped random inputs [Hz]: the upper end of the source's range of interest."""


def samples_of(duration: float, rate: float) -> int:
    """Return the number of steps N, at least 32, in `duration` [s] at `rate` [Hz]; a record has N + 1 samples."""
    steps = duration * rate
    if not (np.isfinite(steps) and duration > 0.0 and rate > 0.0):
        raise ConfigurationError(f"duration {duration!r} s at {rate!r} Hz: both must be above 0 and finite")
    whole = round(steps)
    if abs(steps - whole) > 1e-6 or whole < 32:
        raise ConfigurationError(
            f"duration {duration:g} s at {rate:g} Hz gives {steps:.9g} time steps; must be a whole number, at least 32"
        )
    return whole


def lines_in_band(*, steps: int, rate: float, lower: float, upper: float) -> NDArray[np.int64]:
    """Return the numbers k of the spectral lines f = k * rate / steps within lower <= f <= upper."""
    if not 0.0 < lower < upper or not upper <= 0.4 * rate:
        raise ConfigurationError(
            f"band {lower!r} to {upper!r} Hz: must be 0 < lower < upper <= {0.4 * rate:g} Hz (0.8 of half the rate)"
        )
    line = rate / steps
    # The tolerance keeps lines at the band edges in spite of rounding.
    first = max(int(np.ceil(lower / line * (1.0 - 1e-12))), 1)
    last = int(np.floor(upper / line * (1.0 + 1e-12)))
    if last < first:
        raise ConfigurationError(
            f"band {lower:g} to {upper:g} Hz has no line (they are {line:g} Hz apart); choose a longer duration"
        )
    return np.arange(first, last + 1)


def positive(name: str, value: float, unit: str) -> None:
    """Reject a value that is not positive and finite."""
    if not 0.0 < value < np.inf:
        raise ConfigurationError(f"{name} {value!r} {unit}: must be above 0 and finite")


def period_of(coefficients: Complex, lines: NDArray[np.int64], steps: int) -> Vector:
    """Return one period x[i] = sum over k of Re(c_k exp(2 pi j k i / N)), i = 0 ... N - 1.

    Args:
        coefficients: complex amplitude c_k of each line, shape (m,).
        lines: line numbers k, shape (m,), below N / 2.
        steps: samples N of the period.

    Returns:
        The period, shape (N,).
    """
    spectrum = np.zeros(steps // 2 + 1, dtype=np.complex128)
    spectrum[lines] = coefficients * (0.5 * steps)
    return np.fft.irfft(spectrum, steps)
