"""Comfort value of Bommer 2006, its statistical error, and a check that the vibration is stationary."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import DataError
from vehicle.signals.analysis.comfort_error import overall_error, overall_waves
from vehicle.signals.analysis.samples import Complex, Vector, checked_rows
from vehicle.signals.analysis.spectra import band_periodogram, band_rms, rms_of

COMFORT_BAND = (2.0, 50.0)
"""Band of the comfort value [Hz] (Bommer 2006, chapter 4)"""
DRIFT_LIMIT = 0.01
"""Maximum drift of the RMS; above it a comfort value is rejected (bad-inputs item 43) [-]"""
SIGNIFICANCE = 3.0
"""Minimum drift over the standard error of a random record; a smaller drift counts as scatter [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Settling:
    """Change of the RMS from the first to the second half of a record."""

    halves: tuple[float, float]
    """RMS of each half [unit of the signal]"""
    drift: float
    """(second - first) / mean of both [-]"""
    standard_error: float
    """standard deviation of the drift of a stationary Gaussian record with this spectrum [-]"""
    settled: bool
    """True if |drift| is within 1 % or within three standard errors"""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ComfortValues:
    """Comfort values of r records of equal length."""

    axes: Vector
    """RMS in x, y, z [m/s2], shape (r, 3)"""
    overall: Vector
    """sqrt(x^2 + y^2 + z^2) [m/s2], shape (r,)"""
    error: Vector
    """normalised standard error of `overall`, see `vehicle.signals.analysis.comfort_error` [-], shape (r,)"""
    waves: Complex
    """slow variations of `overall`, see `vehicle.signals.analysis.comfort_error` [m/s2], shape (r, WAVES + 1)"""
    lines: Complex
    """lines of the periodogram in the band, |line|^2 = S df; shape (r, 3, m)"""


def comfort_values(
    time_step: float, acceleration: ArrayLike, band: tuple[float, float] = COMFORT_BAND
) -> ComfortValues:
    """Return the comfort values sqrt(RMSx^2 + RMSy^2 + RMSz^2) of unweighted accelerations in a band.

    The value of a record is independent of the other records.

    Args:
        time_step: sampling interval [s].
        acceleration: accelerations in x, y, z [m/s2], shape (r, 3, n).
        band: (low, high) [Hz]; lines at its edges count with their `band_shares`.

    Raises:
        DataError: not three axes, or a record that `band_rms` rejects.

    Source: Bommer 2006, chapter 4.
    """
    array = np.asarray(acceleration, dtype=np.float64)
    if array.ndim != 3 or array.shape[1] != 3:
        raise DataError(f"acceleration: found shape {array.shape}, must be (r, 3, n), with the axes x, y and z")
    spectrum = band_periodogram(time_step, array.reshape(-1, array.shape[2]), band)
    axes = rms_of(spectrum).reshape(-1, 3)
    x, y, z = axes.T
    assert spectrum.lines is not None  # a periodogram
    lines = spectrum.lines.reshape(*axes.shape, -1)
    return ComfortValues(
        axes=axes,
        overall=np.sqrt(x * x + y * y + z * z),
        error=overall_error(lines),
        waves=overall_waves(lines),
        lines=lines,
    )


def rms_standard_error(time_step: float, signals: ArrayLike, band: tuple[float, float] = COMFORT_BAND) -> Vector:
    """Return the normalised standard error of the band RMS of stationary Gaussian records, shape (k,).

    Var[ms] = (1/T) int S^2 df  and  rms = sqrt(ms), so  error = sqrt(int S^2 df / T) / (2 int S df)

    For white noise of bandwidth B the error is 1 / (2 sqrt(B T)). A periodogram line is S times a chi-square variable
    with two degrees of freedom over two, hence E[P^2] = 2 S^2, and sum(P^2 df) / 2 estimates int S^2 df without bias.
    Meaningless for a deterministic signal such as a sine or a bump. The error is 0 for a signal without power in the
    band.

    Args:
        time_step: sampling interval [s].
        signals: stationary Gaussian records, shape (n,) or (k, n).
        band: (low, high) [Hz].

    Source: Bendat and Piersol, Random Data, 4th ed., chapter 8 (bandwidth-time product).
    """
    spectrum = band_periodogram(time_step, signals, band)
    mean_square = spectrum.density.sum(axis=1) * spectrum.resolution_hz
    # df = 1/T, so int S^2 df / T is the sum over the lines times df^2
    variance = 0.5 * (spectrum.density**2).sum(axis=1) * spectrum.resolution_hz**2
    error = np.zeros_like(mean_square)
    np.divide(np.sqrt(variance), 2.0 * mean_square, out=error, where=mean_square > 0.0)
    return np.asarray(error)


def settling(
    time_step: float, signals: ArrayLike | Sequence[Vector], band: tuple[float, float] = COMFORT_BAND
) -> tuple[Settling, ...]:
    """Compare the band RMS of the two halves of each signal; a decaying transient causes a drift.

    drift = (second - first) / mean. The halves of a stationary random record differ by chance as well: the standard
    error of the RMS is sqrt(2) times larger for a half, and 2 times larger for the difference, than for the whole
    record. A drift counts only above both 1 % and three standard errors of the difference.

    Args:
        time_step: sampling interval [s].
        signals: records, shape (n,) or (k, n), or a sequence of (n,).
        band: (low, high) [Hz].

    Source: bad-inputs item 43.
    """
    rows = checked_rows("signals", signals)
    middle = rows[0].size // 2
    if middle < 2:
        raise DataError(f"signals: found {rows[0].size} samples, must be at least 4 (two halves of 2)")
    results = []
    for row in rows:
        a, b = (band_rms(time_step, half, band)[0] for half in (row[:middle], row[-middle:]))
        # sqrt(2) for half of the record, and sqrt(2) for the difference of two halves.
        e = 2.0 * rms_standard_error(time_step, row, band)[0]
        drift = float(2.0 * (b - a) / (a + b)) if a + b > 0.0 else 0.0
        results.append(
            Settling(
                halves=(float(a), float(b)),
                drift=drift,
                standard_error=float(e),
                settled=abs(drift) <= max(DRIFT_LIMIT, SIGNIFICANCE * float(e)),
            )
        )
    return tuple(results)
