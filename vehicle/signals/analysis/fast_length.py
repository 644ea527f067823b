"""Lengths with fast Fourier transforms, equal to `scipy.fft.next_fast_len`, whose import takes a tenth of a second."""


def fast_length(samples: int) -> int:
    """Return the smallest product of powers of 2, 3 and 5 that is not smaller than a number of samples.

    `numpy.fft` transforms such lengths fastest, and gives the bits of `scipy.fft`.
    """
    best = 1 << max(samples - 1, 0).bit_length()
    fives = 1
    while fives < best:
        odd = fives
        while odd < best:
            # Smallest 2^k odd that is at least `samples`: k is the number of bits of ceil(samples/odd) - 1.
            best = min(best, odd << max(-(-samples // odd) - 1, 0).bit_length())
            odd *= 3
        fives *= 5
    return best
