"""Samples of a period and its harmonics."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vehicle.arrays import Complex, Indices, Vector


@dataclass(frozen=True, slots=False)
class Cycle:
    """Equidistant samples of a period.

    A motion of odd harmonics only has x(t + T/2) = -x(t): the samples of half a period represent it.

    Attributes:
        samples: number n of samples of the whole period, even.
        odd: True if all motions have odd harmonics only.
    """

    samples: int
    odd: bool

    @property
    def stored(self) -> int:
        """Return the number of samples that are stored: n, or n/2 of an odd motion."""
        return self.samples // 2 if self.odd else self.samples

    @property
    def sign(self) -> float:
        """Return the factor of the stored samples in their continuation: -1 for an odd motion."""
        return -1.0 if self.odd else 1.0

    @cached_property
    def harmonics(self) -> Indices:
        """Return the harmonics k of the motion, below the Nyquist frequency; (k,)."""
        return np.arange(1, self.samples // 2, 2) if self.odd else np.arange(self.samples // 2)

    def amplitudes(self, samples: Vector) -> Complex:
        """Return c_k of x = Re sum of c_k exp(j k w t); (..., stored) to (..., k)."""
        whole = np.concatenate([samples, -samples], axis=-1) if self.odd else samples
        result = np.fft.rfft(whole)[..., self.harmonics] * (2.0 / self.samples)
        if not self.odd:
            result[..., 0] *= 0.5
        return np.asarray(result)

    def histories(self, amplitudes: Complex) -> Vector:
        """Return the stored samples of x = Re sum of c_k exp(j k w t); (..., k) to (..., stored)."""
        spectrum = np.zeros((*amplitudes.shape[:-1], self.samples // 2 + 1), dtype=complex)
        spectrum[..., self.harmonics] = amplitudes * (0.5 * self.samples)
        if not self.odd:
            spectrum[..., 0] *= 2.0
        return np.asarray(np.fft.irfft(spectrum, self.samples)[..., : self.stored])
