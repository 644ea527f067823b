"""Measures of the vibration exposure to a weighted acceleration: RMS, MTVV, crest factor, VDV, MSDV and vector sums."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.samples import Vector, checked_single, checked_time_step

RunningAverage = Literal["linear", "exponential"]


def _one(weighted: ArrayLike) -> Vector:
    return checked_single("weighted acceleration", "axis", weighted)


def weighted_rms(weighted: ArrayLike) -> float:
    """Return a_w = sqrt(mean a_w(t)^2) [m/s2] of a weighted record (n,). Source: ISO 2631-1:1997, 6.1."""
    return float(np.sqrt(np.mean(_one(weighted) ** 2)))


def mtvv(
    time_step: float, weighted: ArrayLike, *, average: RunningAverage = "linear", integration_s: float = 1.0
) -> float:
    """Return the maximum transient vibration value, the largest running RMS [m/s2].

    linear:       a(t)^2 = 1/tau int_(t-tau)^t a_w^2 dt'
    exponential:  a(t)^2 = 1/tau int_(-inf)^t a_w^2 exp((t' - t)/tau) dt'

    The signal is zero before the record, so a record shorter than tau has a value, too.

    Args:
        time_step: sampling interval [s].
        weighted: weighted acceleration [m/s2], shape (n,).
        average: "linear" or "exponential".
        integration_s: integration time tau [s]; 1 s in the standard.

    Source: ISO 2631-1:1997, 6.3.1, equations 2 to 4.
    """
    step = checked_time_step(time_step)
    square = _one(weighted) ** 2
    length = round(integration_s / step)
    if length < 1:
        raise ConfigurationError(f"integration_s: found {integration_s:g} s, must be at least the time step")
    if average == "linear":
        total = np.cumsum(square, out=square)
        # Windows that begin before the record, where the signal is zero, count too.
        window_sums = total[length:] - total[: max(square.size - length, 0)]
        running = np.max(window_sums, initial=total[:length].max()) / length
    elif average == "exponential":
        # Square after a first-order filter: y_n = d y_(n-1) + (1 - d) a_n^2, d = exp(-dt/tau).
        decay = float(np.exp(-step / integration_s))
        running = scipy.signal.lfilter([1.0 - decay], [1.0, -decay], square).max()
    else:
        raise ConfigurationError(f"running average: must be 'linear' or 'exponential', not {average!r}")
    return float(np.sqrt(max(float(running), 0.0)))


def crest_factor(weighted: ArrayLike) -> float | None:
    """Return the crest factor max|a_w| / RMS [-] of a weighted record [m/s2], (n,), at least 1; None for zeros.

    Source: ISO 2631-1:1997, 6.2.1.
    """
    record = _one(weighted)
    rms = weighted_rms(record)
    return float(np.abs(record).max() / rms) if rms > 0.0 else None


def vibration_dose_value(time_step: float, weighted: ArrayLike) -> float:
    """Return VDV = (int a_w^4 dt)^(1/4) [m/s^1.75] of a weighted record (n,). Source: ISO 2631-1:1997, equation 5."""
    record = _one(weighted)
    # scaled by the peak, so that the fourth power of a tiny or huge acceleration neither vanishes nor overflows
    peak = float(np.abs(record).max())
    if peak == 0.0:
        return 0.0
    scaled = record / peak
    return float(peak * (np.sum(np.power(scaled, 4, out=scaled)) * checked_time_step(time_step)) ** 0.25)


def estimated_vibration_dose_value(rms: float, duration_s: float) -> float:
    """Return eVDV = 1.4 a_w T^(1/4) [m/s^1.75] from a weighted RMS [m/s2] and a duration [s].

    Valid for crest factors below about 6. Source: ISO 2631-1:1997, annex B; BS 6841:1987.
    """
    if not (np.isfinite([rms, duration_s]).all() and rms >= 0.0 and duration_s > 0.0):
        raise ConfigurationError(
            f"eVDV: found RMS {rms!r} m/s2, must be at least 0, and duration {duration_s!r} s, must be above 0"
        )
    return float(1.4 * rms * duration_s**0.25)


def motion_sickness_dose_value(time_step: float, weighted: ArrayLike) -> float:
    """Return MSDV = sqrt(int a_w^2 dt) [m/s^1.5] of a record (n,) weighted by Wf. Source: ISO 2631-1:1997, annex D."""
    return float(np.sqrt(np.sum(_one(weighted) ** 2) * checked_time_step(time_step)))


def vector_sum(values: Sequence[float], factors: Sequence[float], *, power: float = 2.0) -> float:
    """Return the vector sum (sum (k_i a_i)^power)^(1/power): power 2 for RMS values, 4 for dose values (BS 6841).

    Over the axes of a point this is the point vibration total value; over points, with factors 1, the overall
    vibration total value.

    Args:
        values: measures a_i of the axes or points.
        factors: multiplying factors k_i [-].
        power: exponent, 2 or 4.

    Source: ISO 2631-1:1997, 6.5 and 8.2.3; BS 6841:1987.
    """
    if len(values) != len(factors):
        raise ConfigurationError(
            f"vector sum: found {len(values)} values and {len(factors)} factors, must be a factor for each value"
        )
    scaled = np.abs(np.asarray(values, dtype=np.float64) * np.asarray(factors, dtype=np.float64))
    return float(np.sum(scaled**power) ** (1.0 / power))
