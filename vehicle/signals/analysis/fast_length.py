"""Length of a record for which its FFT is fast."""

from __future__ import annotations


def fast_length(samples: int) -> int:
    """Return the smallest product of powers of 2, 3 and 5 that is at least `samples`.

    The same number as `scipy.fft.next_fast_len` for real records; `numpy.fft` has no such function, and `scipy.fft`
    takes longer to load than the transforms of a run.

    Args:
        samples: length of the record, at least 1.
    """
    length = 1 << (samples - 1).bit_length()
    power_of_5 = 1
    while power_of_5 < length:
        odd = power_of_5
        while odd < length:
            length = min(length, odd << (-(-samples // odd) - 1).bit_length())
            odd *= 3
        power_of_5 *= 5
    return length
