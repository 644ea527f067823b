"""Extremes of the windows of a record."""

import numpy as np
import pytest

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.segments import window_extremes


def test_each_window_gives_its_largest_magnitude_and_an_incomplete_window_is_ignored():
    signal = [0.0, -3.0, 1.0, 2.0, 0.5, -0.5, 9.0]
    assert window_extremes(0.25, signal).tolist() == [3.0, 2.0, 0.5]
    assert window_extremes(0.25, signal, 0.75).tolist() == [3.0, 2.0]


def test_percentiles_of_white_gaussian_windows():
    # P(max of N |x| < z) = erf(z / sqrt 2)^N: its median for N = 500 is at 3.197.
    signal = np.random.default_rng(1).standard_normal(500 * 4000)
    found = window_extremes(1e-3, signal)
    assert found.shape == (4000,)
    # Standard error of a median, 1 / (2 sqrt(n) density there): 0.0055.
    assert np.median(found) == pytest.approx(3.197, abs=0.02)


def test_what_is_refused():
    for signal, window, error, message in (
        (np.ones(4), 0.5, DataError, r"0\.4 s, .* 0\.5 s"),
        (np.ones((2, 10)), 0.5, DataError, "found 2 signals"),
        (np.ones(10), 0.0, ConfigurationError, "window: found 0"),
    ):
        with pytest.raises(error, match=message):
            window_extremes(0.1, signal, window)
