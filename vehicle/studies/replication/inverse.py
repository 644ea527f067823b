"""From an error of the response to a correction of the drive: the inverse of the FRF on the lines of the record."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]

LEAST_SHARE = 1e-2
"""Share of the largest transmissibility in the band from which on the FRF is inverted. A weaker line would call for a
hundred times the motion of the plate, and amplify as much what a sensor adds; below it the inverse falls to zero."""

PERIODS = 5.0
"""Zeros behind the record, in periods of the lower edge: as long as what ends the correction there rings."""

LOW_TAPER, HIGH_TAPER = 0.5, 1.2
"""Where the correction ends, over the edges of the band: it rises by a half-cosine from half the lower edge, and falls
up to 1.2 times the upper one. Without phase shift no line can grow from step to step, as it does below the corner of a
filter that acts forwards alone. What such a weight costs: it rings for a period of the lower edge, so that the drive
of a record that breaks off at speed is open there at the lower edge, where the accelerations hardly tell it."""


class Lines:
    """Spectral lines of a record with zeros behind it, and the weight of each.

    Args:
        samples: n of the record.
        step: of the time [s].
        band: edges [Hz].
    """

    def __init__(self, samples: int, step: float, band: tuple[float, float]) -> None:
        low, high = band
        self.samples = samples
        self.size = scipy.fft.next_fast_len(samples + int(np.ceil(PERIODS / (low * step))), real=True)
        every = scipy.fft.rfftfreq(self.size, step)
        rise = np.clip((every - LOW_TAPER * low) / (low - LOW_TAPER * low), 0.0, 1.0)
        fall = np.clip((HIGH_TAPER * high - every) / (HIGH_TAPER * high - high), 0.0, 1.0)
        weight = 0.25 * (1.0 - np.cos(np.pi * rise)) * (1.0 - np.cos(np.pi * fall))
        self.used = np.flatnonzero(weight)
        self.frequency, self.weight = every[self.used], weight[self.used]
        self.inside = (every >= low) & (every <= high)

    def in_band(self, signals: Vector) -> Vector:
        """What signals (..., n) hold in the band, both edges included."""
        spectrum = scipy.fft.rfft(signals, self.size) * self.inside
        found: Vector = scipy.fft.irfft(spectrum, self.size)[..., : self.samples]
        return found

    def correction(self, inverse: Complex, error: Vector) -> Vector:
        """Drives (p, n) that take back an error of the responses (k, n), by an inverse (m, p, k)."""
        spectrum = scipy.fft.rfft(error, self.size)[:, self.used]
        found = np.zeros((inverse.shape[1], self.size // 2 + 1), dtype=complex)
        found[:, self.used] = self.weight * np.einsum("mpk,km->pm", inverse, spectrum)
        back: Vector = scipy.fft.irfft(found, self.size)[:, : self.samples]
        return back


def regularised_inverse(frf: Complex, frequency: Vector, scale: Vector) -> Complex:
    """Inverse of least squares at every line, U = (T^H T + a^2)^-1 T^H E / (j w)^2 with T = H / ((j w)^2 scale).

    T is the transmissibility, so that the limit a = `LEAST_SHARE` max(sigma(T)) means the same at 1 Hz and at 50 Hz.
    Responses beyond the number of drives are met in the least mean square, each relative to its own size.

    Args:
        frf: H, accelerations over displacements of the plates [m/s2 per m], (k, p, m).
        frequency: lines [Hz], (m,), above 0.
        scale: size of each response [m/s2], (k,).

    Returns:
        [m per m/s2], (m, p, k).

    Source: Tikhonov's regularisation; De Cuyper, Linear feedback control for durability test rigs, KU Leuven, 2006,
    chapter 2 (time waveform replication).
    """
    square = (2j * np.pi * frequency) ** 2
    share = np.moveaxis(frf / (square * scale[:, None, None]), -1, 0)
    left, sizes, right = np.linalg.svd(share, full_matrices=False)
    limit = LEAST_SHARE * float(sizes.max())
    kept = sizes / (sizes**2 + limit**2)
    found = np.conj(np.swapaxes(right, -1, -2)) * kept[:, None, :] @ np.conj(np.swapaxes(left, -1, -2))
    return np.asarray(found / (square[:, None, None] * scale))
