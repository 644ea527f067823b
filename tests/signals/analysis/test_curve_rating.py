"""The rating of ISO/TS 18571 by hand, by its properties, and by dynamic time warping written as a double loop."""

import numpy as np
import pytest

from vehicle.signals.analysis.curve_rating import best_shift, rate_curves

TIME = np.arange(400) * 1e-3
PULSE = np.sin(2.0 * np.pi * 8.0 * TIME) * np.exp(-6.0 * TIME)


def rate_curve(measured, simulated, step=1.0):
    """The rating of one curve."""
    return rate_curves([measured], [simulated], step)[0]


def test_equal_curves_are_excellent():
    found = rate_curve(PULSE, PULSE)
    assert (found.corridor, found.phase, found.magnitude, found.slope, found.shift) == (1.0, 1.0, 1.0, 1.0, 0)
    assert found.overall == pytest.approx(1.0) and found.grade == "excellent"


def test_a_constant_distance_by_hand():
    """T alternates between 1 and -1; C lies d beside it: the corridor is ((0.5 - d) / 0.45)^2, the slope untouched."""
    truth = np.where(np.arange(200) // 20 % 2, 1.0, -1.0)
    for distance, expected in ((0.04, 1.0), (0.2, (0.3 / 0.45) ** 2), (0.6, 0.0)):
        found = rate_curve(truth, truth + distance)
        assert found.corridor == pytest.approx(expected) and found.slope == pytest.approx(1.0)
        assert found.phase == 1.0
        # No warping brings C nearer than d anywhere, and |T| = 1.
        assert found.magnitude == pytest.approx(max(0.0, 1.0 - distance / 0.5))


def test_a_scaled_curve_loses_magnitude_and_slope():
    found = rate_curve(PULSE, 1.2 * PULSE)
    assert found.slope == pytest.approx(1.0 - 0.2 / 2.0) and found.phase == 1.0
    assert 1.0 - 0.2 / 0.5 < found.magnitude < 1.0  # warping helps on the flanks, not at the peaks


@pytest.mark.parametrize("late", [13, -13, 0])
def test_a_shifted_curve_loses_only_phase(late):
    long = np.sin(2.0 * np.pi * 8.0 * np.arange(-60, 460) * 1e-3) * np.exp(-((np.arange(-60, 460) - 200.0) ** 2) / 8e3)
    truth, curve = long[60:460], long[60 - late : 460 - late]
    found = rate_curve(truth, curve)
    assert found.shift == late
    assert found.phase == pytest.approx(1.0 - 13 / 80.0 if late else 1.0)
    assert found.magnitude == pytest.approx(1.0) and found.slope == pytest.approx(1.0)


def test_among_equal_shifts_the_smallest_is_used():
    wave = np.sin(2.0 * np.pi * np.arange(400) / 40.0)
    assert best_shift(wave, wave) == 0 and best_shift(wave, np.roll(wave, 10)) == 10


def test_a_curve_at_rest():
    zero = np.zeros(50)
    assert rate_curve(zero, zero).overall == pytest.approx(1.0)
    found = rate_curve(zero, PULSE[:50])
    assert (found.magnitude, found.slope) == (0.0, 0.0) and found.corridor == np.mean(PULSE[:50] == 0.0)
    assert found.grade == "poor"


def slow_magnitude(curve, truth):
    """Warping cell by cell, as the standard writes it."""
    count, window = curve.size, int(np.ceil(0.1 * curve.size))
    total = np.full((count, count), np.inf)
    for i in range(count):
        for j in range(max(0, i - window + 1), min(count, i + window)):
            before = [total[i - 1, j] if i else np.inf, total[i, j - 1] if j else np.inf,
                      total[i - 1, j - 1] if i and j else np.inf]  # fmt: skip
            total[i, j] = (curve[i] - truth[j]) ** 2 + (min(before) if i or j else 0.0)
    i = j = count - 1
    away, size = abs(curve[i] - truth[j]), abs(truth[j])
    while i or j:
        steps = [(i - 1, j), (i, j - 1), (i - 1, j - 1)]
        ways = [(total[a, b] if a >= 0 and b >= 0 else np.inf, a, b) for a, b in steps]
        _, i, j = ways[int(np.argmin([way[0] for way in ways]))]
        away, size = away + abs(curve[i] - truth[j]), size + abs(truth[j])
    return max(0.0, 1.0 - away / size / 0.5)


def test_warping_equals_a_double_loop():
    noise = np.random.default_rng(5).standard_normal((2, 90))
    truth = np.sin(np.arange(90) / 5.0) + 0.1 * noise[0]
    curve = 1.1 * np.sin(np.arange(90) / 4.8) + 0.1 * noise[1]
    found = rate_curve(truth, curve)
    k = found.shift
    first, second = (truth[: 90 - k], curve[k:]) if k >= 0 else (truth[-k:], curve[:k])
    assert 0.0 < found.magnitude < 1.0
    assert found.magnitude == pytest.approx(slow_magnitude(second, first), rel=1e-12)


def test_ratings_equal_a_public_implementation():
    """objective-rating-metrics 1.3 (PyPI) on this pair, six digits."""
    truth = np.sin(2.0 * np.pi * 7.0 * TIME) * np.exp(-4.0 * TIME)
    curve = 0.9 * np.sin(2.0 * np.pi * 7.4 * TIME + 0.3) * np.exp(-4.5 * TIME) + 0.02
    found = rate_curve(truth, curve, 1e-3)
    expected = (0.444114, 0.8375, 0.900937, 0.874596, 0.700252)
    assert (found.corridor, found.phase, found.magnitude, found.slope, found.overall) == pytest.approx(
        expected, abs=1e-6
    )
