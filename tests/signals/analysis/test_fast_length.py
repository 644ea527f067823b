"""Fast lengths of an FFT against scipy."""

import numpy as np
import scipy.fft

from vehicle.signals.analysis.fast_length import fast_length


def test_lengths_are_those_of_scipy():
    wanted = [*range(1, 3000), *np.random.default_rng(0).integers(1, 10**8, 200).tolist()]
    assert [fast_length(samples) for samples in wanted] == [scipy.fft.next_fast_len(n, real=True) for n in wanted]
