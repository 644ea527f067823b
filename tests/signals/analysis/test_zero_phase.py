"""The zero-phase low-pass against the filter of scipy in the time domain."""

import numpy as np
import pytest
import scipy.signal

from vehicle.signals.analysis.zero_phase import zero_phase_low_pass


@pytest.mark.parametrize(
    ("samples", "corner", "order"), [(6001, 0.2, 4), (5000, 0.013, 4), (4000, 0.8, 8), (40, 0.3, 4), (28, 0.3, 8)]
)
def test_samples_agree_with_the_recursive_filter_up_to_both_ends(samples, corner, order):
    # A random walk about 50 mm: both ends and the offset matter. 1e-11: the recursion rounds, more for low corners.
    values = 0.05 + 1e-3 * np.cumsum(np.random.default_rng(1).normal(size=(2, samples)), axis=1)
    expected = scipy.signal.sosfiltfilt(scipy.signal.butter(order, corner, output="sos"), values, axis=1)
    filtered = zero_phase_low_pass(values, corner, order)
    assert np.abs(filtered - expected).max() < 1e-11 * np.abs(values).max()
    assert np.array_equal(filtered[0], zero_phase_low_pass(values[0], corner, order))


def test_too_few_samples_are_an_error():
    with pytest.raises(ValueError, match="found 15 samples, must be more than 15"):
        zero_phase_low_pass(np.zeros(15), 0.2, 4)
