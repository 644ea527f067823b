"""Selected lines of the spectrum of a whole record, with memory and time only for these lines.

    X_k = sum_j x_j exp(-2 pi i j k / n) = sum_b exp(-2 pi i b L k / n) Z_b(k),   blocks b of L samples

A transform of all n samples needs up to ten times the memory of the record if n has a large prime factor, as
60 001 or 3 600 001 (a minute and an hour at 1 kHz), and five times the time of a neighbouring n. Z_b is the zoomed
transform of a block, a chirp z-transform; the sum over b uses Horner's scheme. The result agrees with the transform of
all n samples to 1e-13 of the strongest line.

Source: Rabiner, Schafer and Rader, The chirp z-transform algorithm, IEEE Trans. Audio Electroacoustics 17 (1969) 86.
"""

from collections.abc import Callable

import numpy as np

from vehicle.signals.analysis.fast_length import fast_length
from vehicle.signals.analysis.samples import Complex, Vector

LONG = 2**20
"""Maximum length of a record transformed as a whole [samples]: 17 minutes at 1 kHz."""

SHORTEST_BLOCK = 2**17
"""Minimum length of a block of a long record [samples]."""


LARGEST_FACTOR = 50
"""Prime factor of a length from which the transform of all samples is slow."""


def is_long(samples: int) -> bool:
    """Return True if a record of this length is transformed in blocks."""
    return samples > LONG


def _is_slow(samples: int) -> bool:
    """Return True if a length has a large prime factor."""
    for factor in range(2, LARGEST_FACTOR):
        while samples % factor == 0:
            samples //= factor
    return samples > 1


class ChirpTransform:
    """Chirp z-transform of a block: X_k = sum_j x_j exp(-2 pi i j k / n).

    It is a convolution, because 2 j q = j^2 + q^2 - (q - j)^2 with k = first + q.

    Args:
        samples: length n of the record.
        size: length of the block.
        first, last: range of the lines k = first + q; `last` is excluded.
    """

    def __init__(self, samples: int, size: int, first: int, last: int) -> None:
        self.count, j = last - first, np.arange(max(size, last - first))
        # Whole turns of the phase are removed while they are exact integers.
        turns = j * j % (2 * samples)
        chirp = np.exp(-1j * np.pi / samples * turns)
        self.after, self.before = chirp[: self.count], chirp[:size]
        if first:
            self.before = self.before * np.exp(-2j * np.pi / samples * (j[:size] * first % samples))
        self.length = fast_length(size + self.count - 1)
        kernel = np.zeros(self.length, dtype=np.complex128)
        # conj(chirp) at the differences q - j >= 0, then at q - j < 0 from the end of the circle.
        kernel[: self.count] = self.after.conj()
        kernel[self.length - size + 1 :] = chirp[1:size][::-1].conj()
        self.kernel = np.fft.fft(kernel)

    def __call__(self, block: Vector) -> Complex:
        """Return the lines of a block; (last - first,). block: samples, at most `size`."""
        spectrum = np.fft.fft(block * self.before[: block.size], self.length)
        spectrum *= self.kernel
        return np.asarray(np.fft.ifft(spectrum, out=spectrum)[: self.count] * self.after)


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
        self.whole = not is_long(samples) and not _is_slow(samples)
        if not self.whole:
            self.zoom = ChirpTransform(samples, size, first, last)
            self.turn: Complex = np.exp(-2j * np.pi / samples * (np.arange(first, last) * size % samples))

    def of(self, part_values: Callable[[slice], Vector]) -> Complex:
        """Return the lines of a record.

        Args:
            part_values: function that returns the samples of a slice in `parts`.

        Returns:
            Complex lines, (last - first,).
        """
        if self.whole:
            whole: Complex = np.fft.rfft(part_values(self.parts[0]))
            return whole[self.chosen].copy()
        lines = np.zeros(self.turn.size, dtype=np.complex128)
        for part in self.parts[::-1]:
            # Horner over the blocks, the last block first.
            lines *= self.turn
            lines += self.zoom(part_values(part))
        return lines
