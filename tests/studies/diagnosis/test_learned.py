"""The regression and its intervals, on a problem whose answer is known: a linear unknown in noise."""

import numpy as np
import pytest

from vehicle.studies.diagnosis.learned import Learned
from vehicle.studies.diagnosis.record_gain import GainTest

TOGETHER = 4


def drawn(count, rng):
    """Features (count, 12) of two unknowns: one that shows, whose noise grows with the second, the level."""
    values = rng.uniform(0.0, 1.0, (count, 2))
    mixing = np.random.default_rng(0).standard_normal((2, 12))
    noise = (0.1 + 0.5 * values[:, 1:]) * rng.standard_normal((count, 12))
    return values @ mixing + 0.5 * noise, values


@pytest.fixture(scope="module")
def learned():
    features, values = drawn(400, np.random.default_rng(1))
    return Learned(features, values, TOGETHER)


def test_nine_of_ten_intervals_hold_the_value_and_follow_the_noise(learned):
    features, values = drawn(300, np.random.default_rng(2))
    inside, widths = [], []
    for x, truth in zip(features, values, strict=True):
        posterior = learned.posteriors(x)[0]
        low, high = posterior.quantile(0.05), posterior.quantile(0.95)
        inside.append(low <= truth[0] <= high)
        widths.append(high - low)
    # 0.9 of 300: a standard deviation of 0.017, and of the 400 drives of the training one of 0.015.
    assert np.mean(inside) == pytest.approx(0.9, abs=0.05)
    quiet = values[:, 1] < 0.3
    assert np.mean(np.array(widths)[quiet]) < 0.75 * np.mean(np.array(widths)[values[:, 1] > 0.7])


def test_widened_intervals_are_wider_and_the_probability_is_that_of_the_draws(learned):
    x = drawn(1, np.random.default_rng(3))[0][0]
    plain, wide = (learned.posteriors(x, widened)[0] for widened in (1.0, 2.0))
    assert wide.deviation > 1.3 * plain.deviation
    assert plain.below(plain.quantile(0.5)) == pytest.approx(0.5, abs=0.02)
    assert plain.weights.sum() == pytest.approx(1.0)


def test_only_a_record_of_another_kind_is_unlike_the_drives(learned):
    alike = [learned.unlikeness(x) for x in drawn(100, np.random.default_rng(4))[0]]
    assert np.mean(np.array(alike) > np.quantile(learned.unlike, 0.95)) == pytest.approx(0.05, abs=0.06)
    other = drawn(20, np.random.default_rng(5))[0] + 3.0 * np.resize([1.0, -1.0], 12)
    assert min(learned.unlikeness(x) for x in other) > max(learned.unlike)


def test_drives_left_out_err_as_new_ones_do(learned):
    features, values = drawn(300, np.random.default_rng(6))
    new = [learned.posteriors(x)[0].mean - truth[0] for x, truth in zip(features, values, strict=True)]
    left_out = learned.left_out[:, 0] * learned.prior[0]
    # Both standard deviations scatter by 4 %.
    assert np.std(new) == pytest.approx(np.std(left_out), rel=0.15)


def test_the_gain_shows_in_what_does_not_grow_with_the_road():
    """Densities r s_i + n_i of a road r and of a friction n_i, which no unit changes together."""
    rng = np.random.default_rng(7)
    road, friction = np.exp(rng.uniform(0.0, 5.0, (400, 1))), np.exp(rng.uniform(-0.3, 0.3, (400, 1)))
    densities = np.log(road * np.linspace(0.1, 1.0, 12) + 10.0 * friction)
    densities += 0.05 * rng.standard_normal(densities.shape)
    test = GainTest(densities[:300], 12, TOGETHER)
    right = [test.gain(x) for x in densities[300:]]
    wrong = [test.gain(x + 2.0 * np.log(9.81)) for x in densities[300:]]
    assert np.mean([gain.apart > 2.6 for gain in right]) < 0.08
    assert np.mean([gain.apart > 2.6 for gain in wrong]) > 0.8
    assert np.median([gain.factor for gain in wrong]) == pytest.approx(9.81, rel=0.3)
