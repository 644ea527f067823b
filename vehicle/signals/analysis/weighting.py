"""Frequency weightings of ISO 2631-1, BS 6841, ISO 5349-1, EN 12299, of a steering wheel: factors, weighted records."""

from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.analysis.samples import Complex, Vector, checked_signals, checked_time_step

LEAST_SAMPLING_RATE = 25.0
"""Minimum sampling rate of a weighted record [Hz], for vibration up to 10 Hz, the range in which Wk is highest."""
LINES_AT_ONCE = 2**18
"""Lines of a long record weighted in a batch."""
KEPT_LINES = 2**16
"""Maximum number of lines with cached factors: a megabyte."""


@dataclass(frozen=True, slots=True)
class Weighting:
    """Frequency weighting with the parameters of the standard; an infinite frequency omits its factor."""

    name: str
    """name in the standard"""
    f1: float
    """lower band limit, second-order Butterworth [Hz]"""
    f2: float
    """upper band limit, second-order Butterworth [Hz]"""
    f3: float
    """acceleration-velocity transition, numerator [Hz]"""
    f4: float
    """acceleration-velocity transition, denominator [Hz]"""
    q4: float
    """resonant quality factor at f4 [-]"""
    f5: float
    """upward step, numerator [Hz]"""
    q5: float
    """resonant quality factor at f5 [-]"""
    f6: float
    """upward step, denominator [Hz]"""
    q6: float
    """resonant quality factor at f6 [-]"""
    gain: float = 1.0
    """factor K [-]"""

    @property
    def lowest_frequency(self) -> float:
        """Lower end of the frequency range of the standard [Hz]: 0.5 (Wf: 0.1), which is f1 10^(1/10) rounded."""
        return 1.25 * self.f1

    @property
    def highest_frequency(self) -> float:
        """Upper end of the frequency range of the standard [Hz]: 80 (Wh: 1000), which is f2 10^(-1/10) rounded."""
        return float(f"{0.8 * self.f2:.2g}")

    @property
    def settling_s(self) -> float:
        """Time after which the response to a step stays below 1 % of its peak [s]: 1.4 / f1, 3.5 s (Wf: 17.5 s)."""
        return 1.4 / self.f1

    @property
    def shortest_record_s(self) -> float:
        """Minimum length that resolves the third octave at the lowest frequency [s]: 8.6 s (Wf: 43.2 s).

        T B >= 1 with B = (2^(1/6) - 2^(-1/6)) f = 0.2316 f: 4.3 periods of f. In a shorter record, the lowest band
        is not resolved; for a good estimate ISO 2631-1:1997, 5.5, requires B T = 25 (108 s at 1 Hz).
        """
        return float(1.0 / ((2.0 ** (1 / 6) - 2.0 ** (-1 / 6)) * self.lowest_frequency))

    @property
    def decay_s(self) -> float:
        """Time [s] in which the response to an impulse falls by exp(-17.8) = 2e-8, by the slowest pole -w1/sqrt(2)."""
        return 4.0 / self.f1

    @property
    def sections(self) -> Vector:
        """Return the factors of H as rows b0, b1, b2, a0, a1, a2; (2, 3 or 4, 6).

        H = product of (b0 + b1 jf + b2 (jf)^2) / (a0 + a1 jf + a2 (jf)^2) with f [Hz]; see `transfer_function`.
        """
        # Divided by powers of 2 pi: s becomes jf, w_i becomes f_i.
        root, f1, f2, f4, f5, f6 = np.sqrt(2.0), self.f1, self.f2, self.f4, self.f5, self.f6
        rows = [[0.0, 0.0, self.gain, f1**2, root * f1, 1.0], [f2**2, 0.0, 0.0, f2**2, root * f2, 1.0]]
        rows += [[1.0, 1.0 / self.f3, 0.0, 1.0, 1.0 / (self.q4 * f4), f4**-2]]
        if np.isfinite(f5):
            rows += [[f5**2, f5 / self.q5, 1.0, f6**2, f6 / self.q6, 1.0]]
        return np.array(rows)

    def transfer_function(self, frequency: ArrayLike) -> Complex:
        """Return the complex factor H at frequencies [Hz] of any shape.

        With s = j 2 pi f and w_i = 2 pi f_i:
        H = K * s^2 / (s^2 + sqrt(2) w1 s + w1^2)                          band limit below
              * w2^2 / (s^2 + sqrt(2) w2 s + w2^2)                         band limit above
              * (1 + s/w3) / (1 + s/(Q4 w4) + (s/w4)^2)                    acceleration-velocity transition
              * (1 + s/(Q5 w5) + (s/w5)^2) / (1 + s/(Q6 w6) + (s/w6)^2) * (w5/w6)^2   upward step

        Source: ISO 2631-1:1997, annex A; ISO 8041:2005, parameters of the frequency weightings.
        """
        f = np.asarray(frequency, dtype=np.float64)
        if not np.isfinite(f).all():
            raise ConfigurationError(f"{self.name}: frequencies must be finite")
        s, factor = 1j * f, np.ones(f.shape, dtype=np.complex128)
        for b0, b1, b2, a0, a1, a2 in self.sections:
            factor = factor * ((b0 + s * (b1 + s * b2)) / (a0 + s * (a1 + s * a2)))
        return np.asarray(factor, dtype=np.complex128)

    def spectrum_factor(self, frequency: ArrayLike) -> Vector:
        """Return |H| [-], the factor of a third octave RMS value; a density is multiplied by its square."""
        return np.asarray(np.abs(self.transfer_function(frequency)))


_NONE = float("inf")

_PARAMETERS: dict[str, tuple[float, ...]] = {  # f1, f2, f3, f4, q4, f5, q5, f6, q6, gain
    # ISO 2631-1:1997 annex A, the same in ISO 8041:2005
    "Wk": (0.4, 100.0, 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91),
    "Wd": (0.4, 100.0, 2.0, 2.0, 0.63, _NONE, 1.0, _NONE, 1.0),
    "Wf": (0.08, 0.63, _NONE, 0.25, 0.86, 0.0625, 0.80, 0.10, 0.80),
    "Wc": (0.4, 100.0, 8.0, 8.0, 0.63, _NONE, 1.0, _NONE, 1.0),
    "We": (0.4, 100.0, 1.0, 1.0, 0.63, _NONE, 1.0, _NONE, 1.0),
    "Wj": (0.4, 100.0, _NONE, _NONE, 1.0, 3.75, 0.91, 5.32, 0.91),
    # BS 6841:1987 writes the step without (f5/f6)^2 and K = 0.4; ISO 8041:2005 writes K = 1.024: the same, for
    # 1.024 (2.5/4)^2 = 0.4
    "Wb": (0.4, 100.0, 16.0, 16.0, 0.55, 2.5, 0.9, 4.0, 0.95, 1.024),
    # EN 12299:2009, annex C: other quality factors, K = 0.4 without (f5/f6)^2
    "Wb_en12299": (0.4, 100.0, 16.0, 16.0, 0.63, 2.5, 0.8, 4.0, 0.8, 1.024),
    # ISO 5349-1:2001, annex A, with the exact frequencies of ISO 8041:2005
    "Wh": (10.0**0.8, 10.0**3.1, 50.0 / np.pi, 50.0 / np.pi, 0.64, _NONE, 1.0, _NONE, 1.0),
    # Giacomin, Shayaa, Dormegnie, Richard, Int. J. Industrial Ergonomics 33 (2004) 527-541: straight lines of 0 dB an
    # octave from 3 to 6.3 Hz, -6 to 50 Hz, 0 to 160 Hz, -10 to 315 Hz. This filter is fitted to them, within 0.53 dB.
    "Ws": (2.4, 394.0, 14.77, 7.8534, 0.5919, 86.965, 0.5832, 142.06, 1.1167, 3.2645),
}

WEIGHTINGS: MappingProxyType[str, Weighting] = MappingProxyType(
    {name: Weighting(name, *parameters) for name, parameters in _PARAMETERS.items()}
)
"""The weightings by name."""


def weighting(name: str) -> Weighting:
    """Return the weighting of a name; raise `ConfigurationError` for an unknown name."""
    if name not in WEIGHTINGS:
        raise ConfigurationError(f"weighting: must be one of {', '.join(WEIGHTINGS)}, not {name!r}")
    return WEIGHTINGS[name]


def weighted_record(time_step: float, signals: ArrayLike, name: str) -> Vector:
    """Return records filtered by the analogue weighting, which is at rest before the first sample.

    The record, extended by zeros until the filter has decayed, is transformed, multiplied by the exact complex H(f) of
    the standard and transformed back. For a record sampled without aliasing, which equals its band-limited
    interpolation, the product is exact in magnitude and phase up to Nyquist, at any sampling rate. Recursive filters
    from the bilinear transform, band limits prewarped, are 1.4 % low at 80 Hz for Wk at 1 kHz and 5.9 % at 500 Hz:
    the transform compresses the frequency axis, and the weighting decreases with frequency.

    H is causal, so the output is zero before the input begins, except for content at Nyquist: the band-limited
    interpolation of a single sample rings before it, by 0.2 % of the peak of the response for Wk at 1 kHz, 0.5 % at
    500 Hz (Wj, with the smallest decrease: 2.4 and 5.6 %), and 0.005 and 0.03 % a tenth of a second earlier.
    The zeros prevent wrap-around from the end of the record to its beginning.

    Args:
        time_step: sampling interval [s].
        signals: accelerations [m/s2] (or rad/s2), shape (n,) or (k, n).
        name: name of the weighting.

    Returns:
        Weighted records, shape of `signals`.

    Raises:
        DataError: sampled below 25 Hz (Wf: 2.5 times 0.63 Hz is enough), not finite.
        ConfigurationError: unknown weighting.

    Source: ISO 2631-1:1997, annex A (filters defined by their analogue transfer function).
    """
    step = checked_time_step(time_step)
    curve = weighting(name)
    array = checked_signals("acceleration", signals)
    needed = min(LEAST_SAMPLING_RATE, 2.5 * curve.f2)
    if 1.0 / step < needed * (1.0 - 1e-9):
        raise DataError(
            f"sampling rate: found {1.0 / step:g} Hz, must be at least {needed:g} Hz for {name}; sample faster"
        )
    samples = array.shape[1]
    length = fast_length(samples + int(np.ceil(curve.decay_s / step)))
    # numpy.fft allocates no extra work arrays.
    spectrum, frequency = np.fft.rfft(array, length, axis=1), np.fft.rfftfreq(length, step)
    if frequency.size <= KEPT_LINES:
        spectrum *= _factors(name, length, step)
    else:
        for first in range(0, frequency.size, LINES_AT_ONCE):
            block = slice(first, first + LINES_AT_ONCE)
            spectrum[:, block] *= curve.transfer_function(frequency[block])
    weighted = np.fft.irfft(spectrum, length, axis=1)[:, :samples]
    return np.asarray(weighted.reshape(np.shape(signals)), dtype=np.float64)


@lru_cache(maxsize=8)
def _factors(name: str, length: int, step: float) -> Complex:
    """Return the complex factors of a weighting at the lines of a record, cached for the runs of a sweep."""
    return weighting(name).transfer_function(np.fft.rfftfreq(length, step))
