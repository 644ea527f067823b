"""The logarithm of a ratio of FRFs and its standard deviation."""

import numpy as np
import pytest

from vehicle.signals.analysis.frf_agreement import log_ratio
from vehicle.studies.tuning.frf_target import FLOOR, LEAST_COHERENCE, log_deviation


def test_magnitude_and_phase_of_the_ratio():
    turned = 2.0 * np.exp(1j * np.radians([170.0, -170.0, 10.0]))
    base = np.exp(1j * np.radians([-170.0, 170.0, 0.0]))
    logarithm = log_ratio(turned, base)
    np.testing.assert_allclose(logarithm.real, np.log(2.0))
    # A phase difference of 340 degrees is -20: full turns drop out.
    np.testing.assert_allclose(np.degrees(logarithm.imag), [-20.0, 20.0, 10.0])


def test_undefined_where_either_is():
    assert np.isnan(log_ratio([np.nan, 1.0, 0.0, 1.0], [1.0, np.nan, 1.0, 0.0])).all()


def test_deviation_is_that_of_an_averaged_estimate():
    # Second derivation: H1 from n averages of noisy Gaussian spectra, many times.
    averages, count, coherence = 40, 4000, 0.8
    draw = np.random.default_rng(1).standard_normal((4, count, averages))
    drive, noise = draw[0] + 1j * draw[1], draw[2] + 1j * draw[3]
    answer = drive + np.sqrt(1.0 / coherence - 1.0) * noise
    estimate = np.sum(np.conj(drive) * answer, axis=1) / np.sum(np.abs(drive) ** 2, axis=1)
    expected = log_deviation(coherence, averages)
    # 4000 repetitions know a deviation to 1.1 %, and n / (n - 1) of a finite average adds 1.3 %.
    assert np.std(np.log(np.abs(estimate))) == pytest.approx(expected, rel=0.05)
    assert np.std(np.angle(estimate)) == pytest.approx(expected, rel=0.05)


def test_floor_and_limit():
    deviation = log_deviation([1.0, LEAST_COHERENCE, 0.99 * LEAST_COHERENCE, np.nan], 8.0)
    assert deviation[0] == FLOOR
    assert np.isfinite(deviation[1]) and np.isnan(deviation[2:]).all()
