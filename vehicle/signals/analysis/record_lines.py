"""Selected lines of the spectrum of a whole record, with memory only for these lines.

    X_k = sum_j x_j exp(-2 pi i j k / n) = sum_b exp(-2 pi i b L k / n) Z_b(k),   blocks b of L samples

A transform of all n samples needs up to ten times the memory of the record if n has a large prime factor, such as
3 600 001 (an hour at 1 kHz). Z_b is the zoomed transform of a block, a chirp z-transform; the sum over b uses Horner's
scheme. The result agrees with the transform of all n samples to 1e-13 of the strongest line.

Source: Rabiner, Schafer and Rader, The chirp z-transform algorithm, IEEE Trans. Audio Electroacoustics 17 (1969) 86.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

LONG = 2**20
"""Maximum length of a record transformed as a whole [samples]: 17 minutes at 1 kHz."""

SHORTEST_BLOCK = 2**17
"""Minimum length of a block of a long record [samples]."""


def is_long(samples: int) -> bool:
    """Return True if a record of this length is transformed in blocks."""
    return samples > LONG


class RecordLines:
    """Transform of records of a given length to selected spectral lines.

    Args:
        samples: length n of the records.
        first, last: range of the lines k; `last` is excluded.

    Attributes:
        parts: slices of a record, transformed in turn; a short record is a single slice.
    """

    def __init__(self, samples: int, first: int, last: int) -> None:
        self.samples, self.chosen = samples, slice(first, last)
        size = max(last - first, SHORTEST_BLOCK) if is_long(samples) else samples
        self.parts = tuple(slice(begin, min(begin + size, samples)) for begin in range(0, samples, size))
        if is_long(samples):
            edges = [first / samples, last / samples]
            self.zoom = scipy.signal.ZoomFFT(size, edges, last - first, fs=1.0)
            # Whole turns of the phase are removed while they are exact integers.
            self.turn: Complex = np.exp(-2j * np.pi / samples * (np.arange(first, last) * size % samples))

    def of(self, part_values: Callable[[slice], Real]) -> Complex:
        """Return the lines of a record.

        Args:
            part_values: function that returns the samples of a slice in `parts`.

        Returns:
            Complex lines, (last - first,).
        """
        if not is_long(self.samples):
            whole: Complex = np.fft.rfft(part_values(self.parts[0]))
            return whole[self.chosen].copy()
        lines = np.zeros(self.turn.size, dtype=np.complex128)
        block = np.zeros(self.zoom.n)
        for part in self.parts[::-1]:
            samples = part_values(part)
            block[: samples.size], block[samples.size :] = samples, 0.0
            lines = lines * self.turn + self.zoom(block)
        return lines
