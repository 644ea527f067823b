"""Correction of a drive from the error of the response by the regularised inverse of the FRF."""

import numpy as np
import scipy

from vehicle.arrays import Complex, Vector

LEAST_SHARE = 1e-2
"""Minimum inverted transmissibility over the maximum in the band. A weaker line would need a hundred times the motion
of the plate, and amplify sensor noise as much; below this limit the inverse falls to zero."""

PERIODS = 5.0
"""Length of the zero padding after the record, in periods of the lower edge: the ringing of the taper decays in it."""

LOW_TAPER, HIGH_TAPER = 0.5, 1.2
"""Ends of the weight of the correction, over the edges of the band: it rises by a half-cosine from half the lower edge,
and falls up to 1.2 times the upper edge. Without phase shift no line can grow from step to step, as it does below the
corner of a causal filter. The weight rings for a period of the lower edge: if the record ends while the car moves, the
drive at this end is uncertain at the lower edge, where the accelerations are insensitive to it."""


class Lines:
    """Spectral lines of a zero-padded record, with the weight of each line.

    Args:
        samples: number n of samples of the record.
        step: sampling interval [s].
        band: lower and upper edge [Hz].
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
        """Return signals (..., n) limited to the band, both edges included."""
        limited: Vector = scipy.fft.irfft(scipy.fft.rfft(signals, self.size) * self.inside, self.size)[
            ..., : self.samples
        ]
        return limited

    def spectrum(self, signals: Vector) -> Complex:
        """Return the spectra (k, m) of signals (k, n) at the lines with a weight."""
        return np.asarray(scipy.fft.rfft(signals, self.size)[:, self.used])

    def correction(self, inverse: Complex, error: Vector) -> Vector:
        """Return the correction of the drives (p, n) for an error of the responses (k, n), by an inverse (m, p, k)."""
        spectrum = self.spectrum(error)
        drive_spectrum = np.zeros((inverse.shape[1], self.size // 2 + 1), dtype=complex)
        drive_spectrum[:, self.used] = self.weight * np.einsum("mpk,km->pm", inverse, spectrum)
        drive: Vector = scipy.fft.irfft(drive_spectrum, self.size)[:, : self.samples]
        return drive


def regularised_inverse(frf: Complex, frequency: Vector, scale: Vector) -> Complex:
    """Return the regularised least-squares inverse of the FRF at every line.

        U = (T^H T + a^2)^-1 T^H E / (j w)^2   with   T = H / ((j w)^2 scale)

    T is the transmissibility, so the limit a = `LEAST_SHARE` max(sigma(T)) has the same meaning at 1 Hz and at 50 Hz.
    With more responses than drives the sum of squared errors is minimal, each response relative to its scale.

    Args:
        frf: H, accelerations over plate displacements [m/s2 per m], (k, p, m).
        frequency: frequencies of the lines [Hz], (m,), above 0.
        scale: RMS of each response [m/s2], (k,).

    Returns:
        Inverse FRF [m per m/s2], (m, p, k).

    Source: Tikhonov's regularisation; De Cuyper, Linear feedback control for durability test rigs, KU Leuven, 2006,
    chapter 2 (time waveform replication).
    """
    square = (2j * np.pi * frequency) ** 2
    share = np.moveaxis(frf / (square * scale[:, None, None]), -1, 0)
    left, sizes, right = np.linalg.svd(share, full_matrices=False)
    limit = LEAST_SHARE * float(sizes.max())
    kept = sizes / (sizes**2 + limit**2)
    inverse = np.conj(np.swapaxes(right, -1, -2)) * kept[:, None, :] @ np.conj(np.swapaxes(left, -1, -2))
    return np.asarray(inverse / (square[:, None, None] * scale))
