"""Some lines of the spectrum of a whole record, in the memory of those lines.

    X_k = sum_j x_j exp(-2 pi i j k / n) = sum_b exp(-2 pi i b L k / n) Z_b(k),   blocks b of L samples

A transform of all n samples works in up to ten times the record where n has a large prime factor, as 3 600 001 has: an
hour at 1 kHz. Z_b is the zoomed transform of a block, a chirp z-transform; the sum over b is Horner's. It agrees with
the transform of all n samples to 1e-13 of the strongest line.

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
"""Samples up to which a record is transformed as a whole: 17 minutes at 1 kHz."""

SHORTEST_BLOCK = 2**17
"""Samples of a block of a long record at least."""


def is_long(samples: int) -> bool:
    """Whether a record is worked on in blocks."""
    return samples > LONG


class RecordLines:
    """Lines of the spectra of records of one length.

    Args:
        samples: n.
        first, last: the lines k, the last one excluded.

    Attributes:
        parts: pieces of a record that are looked at one after the other; of a short one, all of it.
    """

    def __init__(self, samples: int, first: int, last: int) -> None:
        self.samples, self.chosen = samples, slice(first, last)
        size = max(last - first, SHORTEST_BLOCK) if is_long(samples) else samples
        self.parts = tuple(slice(begin, min(begin + size, samples)) for begin in range(0, samples, size))
        if is_long(samples):
            edges = [first / samples, last / samples]
            self.zoom = scipy.signal.ZoomFFT(size, edges, last - first, fs=1.0)
            # The phase of a whole number of turns is taken off while it is exact.
            self.turn: Complex = np.exp(-2j * np.pi / samples * (np.arange(first, last) * size % samples))

    def of(self, piece: Callable[[slice], Real]) -> Complex:
        """Lines of a record.

        Args:
            piece: gives each of the `parts` of the record.

        Returns:
            (last - first,).
        """
        if not is_long(self.samples):
            whole: Complex = scipy.fft.rfft(piece(self.parts[0]))
            return whole[self.chosen].copy()
        found = np.zeros(self.turn.size, dtype=np.complex128)
        block = np.zeros(self.zoom.n)
        for part in self.parts[::-1]:
            values = piece(part)
            block[: values.size], block[values.size :] = values, 0.0
            found = found * self.turn + self.zoom(block)
        return found
