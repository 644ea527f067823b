"""Cumulative RMS of a record over frequency, and RMS in third octave bands.

The periodogram has the mean square P_k = S_k df at f_k = k df. Each line is spread evenly over the df around it, so
that the mean square below a frequency f,

    M(f) = integral of S from f_low to f,

is piecewise linear and exact at the edges of the lines. The cumulative RMS is sqrt(M(f)), the RMS in a band
sqrt(M(f2) - M(f1)); bands side by side add up to the whole without gap or overlap. A frequency weighting H multiplies
P_k by |H(f_k)|^2.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import DataError
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.spectra import periodogram
from vehicle.signals.analysis.weighting import weighting

NOMINAL = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)
"""Nominal midband frequencies of a decade [Hz] (IEC 61260-1:2014, annex E)."""

HALF_BAND = 10.0**0.05
"""Upper band edge over the exact midband frequency 10^(n/10) Hz (IEC 61260-1:2014, base ten)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ThirdOctaves:
    """RMS in adjacent third octave bands.

    Attributes:
        nominal: nominal midband frequencies [Hz]; (b,).
        edges: exact band edges 10^((2 n - 1)/20) ... [Hz]; (b + 1,).
        rms: RMS in each band [unit of the record]; (b,). NaN where the record is shorter than 1 / bandwidth.
        standard_error: normalised standard error 1 / (2 sqrt(B T)) of stationary Gaussian vibration with a flat
            density in the band [-]; (b,).
    """

    nominal: Vector
    edges: Vector
    rms: Vector
    standard_error: Vector


class CumulativeSpectrum:
    """Mean square of a record below any frequency, see the module.

    Args:
        time_step: sampling interval [s].
        signal: record, shape (n,); its mean is left out.
        weighting_name: frequency weighting, as "Wk"; None for the unweighted record.

    Raises:
        DataError: the record is too short or not finite.
        ConfigurationError: unknown weighting.
    """

    def __init__(self, time_step: float, signal: ArrayLike, weighting_name: str | None = None) -> None:
        spectrum = periodogram(time_step, signal)
        self.duration = 1.0 / spectrum.resolution_hz
        power = spectrum.density[0, 1:] * spectrum.resolution_hz
        if weighting_name is not None:
            power = power * weighting(weighting_name).spectrum_factor(spectrum.frequency[1:]) ** 2
        # Line k, from 1 on, covers (k - 1/2) df to (k + 1/2) df.
        self._edges = (np.arange(power.size + 1) + 0.5) * spectrum.resolution_hz
        self._below = np.concatenate([[0.0], np.cumsum(power)])

    def mean_square(self, low: ArrayLike, high: ArrayLike) -> Vector:
        """Return the mean square between frequencies [Hz], shape of `low` and `high`."""
        below = [np.interp(np.asarray(edge, dtype=float), self._edges, self._below) for edge in (low, high)]
        return np.asarray(below[1] - below[0])

    def cumulative_rms(self, frequency: ArrayLike, lowest: float) -> Vector:
        """Return the RMS from the lowest frequency up to each frequency [Hz], shape of `frequency`."""
        return np.sqrt(np.maximum(self.mean_square(lowest, frequency), 0.0))

    def third_octaves(self, lowest: float, highest: float) -> ThirdOctaves:
        """Return the RMS in the third octave bands whose nominal midbands are in [lowest, highest] Hz."""
        numbers = np.array([n for n in range(-30, 51) if lowest * 0.999 <= nominal_midband(n) <= highest * 1.001])
        if not numbers.size:
            raise DataError(f"{lowest:g} to {highest:g} Hz: no centre of a third octave; choose a wider range")
        edges = 10.0 ** (np.append(numbers, numbers[-1] + 1) / 10.0) / HALF_BAND
        if edges[-1] > self._edges[-1]:
            raise DataError(
                f"the highest third octave ends at {edges[-1]:.4g} Hz but must be at most {self._edges[-1]:.4g} Hz for "
                "this sampling rate; choose a lower range, or sample faster"
            )
        width = np.diff(edges)
        resolved = width * self.duration >= 1.0
        rms = np.sqrt(np.maximum(self.mean_square(edges[:-1], edges[1:]), 0.0))
        return ThirdOctaves(
            nominal=np.array([nominal_midband(n) for n in numbers]),
            edges=edges,
            rms=np.where(resolved, rms, np.nan),
            standard_error=0.5 / np.sqrt(width * self.duration),
        )


def nominal_midband(number: int) -> float:
    """Return the nominal frequency [Hz] of the band with the exact midband frequency 10^(number/10) Hz."""
    decade, step = divmod(number, 10)
    return float(f"{NOMINAL[step]}e{decade}")
