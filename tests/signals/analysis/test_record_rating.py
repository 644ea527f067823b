"""Ratings of long records: the mean of their windows by a second, plain form; and what they must tell apart."""

import numpy as np
import pytest

from tests.benchmarks.record_alignment import STEP, made_pair, right_below
from tests.signals.analysis.test_curve_rating import slow_magnitude
from vehicle.signals.analysis.record_rating import rate_record


def plain_rating(truth, curve):
    """Overall rating of one curve, step by step as the standard writes it."""
    count = truth.size
    norm = max(abs(value) for value in truth)
    marks = []
    for one, other in zip(truth, curve, strict=True):
        away = abs(one - other)
        marks.append(
            1.0 if away < 0.05 * norm else 0.0 if away > 0.5 * norm else ((0.5 * norm - away) / (0.45 * norm)) ** 2
        )
    best, found, pair = np.corrcoef(truth, curve)[0, 1], 0, (truth, curve)
    for shift in range(1, int(0.2 * count + 1e-9) + 1):
        for ways in ((truth[:-shift], curve[shift:]), (truth[shift:], curve[:-shift])):
            value = np.corrcoef(*ways)[0, 1]
            if value > best + 1e-12:
                best, found, pair = value, shift, ways
    slopes = []
    for values in pair:
        slope = np.gradient(values)
        slopes.append([slope[max(0, i - r) : i + r + 1].mean() for i in range(slope.size)
                       for r in [min(4, i, slope.size - 1 - i)]])  # fmt: skip
    error = np.abs(np.subtract(slopes[1], slopes[0])).sum() / np.abs(slopes[0]).sum()
    parts = (np.mean(marks), 1.0 - found / (0.2 * count), slow_magnitude(pair[1], pair[0]), max(0.0, 1.0 - error / 2.0))
    return float(np.dot((0.4, 0.2, 0.2, 0.2), parts))


def test_a_long_record_is_rated_as_the_mean_of_its_windows():
    """At 100 Hz, so that a window has 100 samples; three of them, weighted by the RMS of both records."""
    truth, curve = (values[::10][:300] for values in made_pair(4.0, 0.013, 0.0, band=(0.5, 12.0), noise=0.2))
    truth = truth * np.repeat([1.0, 0.3, 2.0], 100)
    found = rate_record(truth, curve, 10.0 * STEP)
    assert found.windows == 3 and found.window == pytest.approx(1.0)
    pairs = list(zip(truth.reshape(3, 100), curve.reshape(3, 100), strict=True))
    weights = [np.sqrt(np.mean(one**2 + other**2)) for one, other in pairs]
    assert found.overall == pytest.approx(
        np.average([plain_rating(*pair) for pair in pairs], weights=weights), rel=1e-9
    )


def test_a_record_that_is_right_at_low_frequencies_only_is_poor():
    found = rate_record(*right_below(3.0, 12.0), STEP)
    assert found.grade == "poor" and found.overall < 0.5 and found.windows == 12


def test_rest_has_no_weight_and_a_wrong_motion_has():
    first, _ = made_pair(8.0, 0.0, 0.0)
    event = np.where(np.arange(first.size) < 2000, first, 0.0)
    assert rate_record(event, event, STEP).overall == pytest.approx(1.0)
    assert rate_record(event, event + 0.5 * np.roll(event, 5000), STEP).overall < 0.9
    assert rate_record(np.zeros(3000), np.zeros(3000), STEP).overall == pytest.approx(1.0)
