"""Predictive probability of a published interval: calibration by Monte Carlo, near misses, limits."""

import itertools
import math

import numpy as np
import pytest
from scipy import stats

from scenarios.interval_probability import interval_probability
from tests.validation import validated

TICKS = np.arange(-6.0, 7.0, 2.0)
"""Labels of an axis, in standard deviations from the true mean."""


def mean_error(distribution, size, samples=1500):
    """Largest mean error of the probability over the ticks of an axis, for samples of a size [-]."""
    labels = distribution.mean() + distribution.std() * TICKS
    truth = np.diff(distribution.cdf(labels))
    drawn = distribution.rvs(size=(samples, size), random_state=np.random.default_rng(20))
    intervals = list(itertools.pairwise(labels))
    estimates = [[interval_probability(values, interval) for interval in intervals] for values in drawn]
    return float(np.max(np.abs(np.mean(estimates, axis=0) - truth)))


@pytest.mark.parametrize(
    ("distribution", "size", "limit"),
    [
        (stats.norm(3.0, 2.0), 8, 0.045),
        (stats.norm(3.0, 2.0), 48, 0.012),
        (stats.gumbel_r(), 8, 0.10),
        (stats.gumbel_r(), 48, 0.10),
    ],
    ids=["normal 8", "normal 48", "Gumbel 8", "Gumbel 48"],
)
def test_mean_error_over_an_axis(distribution, size, limit):
    # The mean probability of 1500 samples has an error of 0.2 / sqrt(1500) = 0.005.
    validated(
        "Statistics and intervals",
        f"mean error of the probability of an interval, {distribution.dist.name}, {size} values",
        mean_error(distribution, size), 0.0, abs=limit, source="second derivation: Monte Carlo, 1500 samples",
    )  # fmt: skip


def test_rank_of_a_further_normal_value_is_uniform():
    # The defining property of a predictive distribution: P(new value below the estimated quantile) is its probability.
    drawn = np.random.default_rng(4).normal(5.0, 0.1, (20_000, 9))
    ranks = [interval_probability(values[1:], (-math.inf, values[0])) for values in drawn]
    assert stats.kstest(ranks, "uniform").pvalue > 0.01


def test_two_ends_of_a_known_sample():
    # t with 7 degrees of freedom: 2.365 is its 97.5 % quantile.
    values = np.array([-1.0, 1.0] * 4)
    half = stats.t.ppf(0.975, 7) * np.std(values, ddof=1) * math.sqrt(9.0 / 8.0)
    validated(
        "Statistics and intervals", "probability between the 2.5 % and 97.5 % quantiles of a further value",
        interval_probability(values, (-half, half)), 0.95, rel=1e-6,
        source="closed form: t with 7 degrees of freedom, s sqrt(1 + 1 / n)",
    )  # fmt: skip
    assert interval_probability(values, (half, math.inf)) == pytest.approx(0.025)
    assert interval_probability(values, (-math.inf, math.inf)) == 1.0


def test_probability_falls_with_distance_and_is_never_zero():
    values = [0.45, 0.46, 0.47, 0.44, 0.45, 0.48, 0.46, 0.46]
    for direction in (1.0, -1.0):
        far = [interval_probability(values, tuple(sorted((0.46 + direction * d, 0.46 + direction * (d + 0.2)))))
               for d in np.linspace(0.0, 5.0, 40)]  # fmt: skip
        assert np.all(np.diff(far) < 0.0) and far[-1] > 0.0


def test_a_spread_narrower_than_a_tick_is_almost_sure():
    assert interval_probability(0.5 + 0.005 * np.arange(-4, 5), (0.4, 0.6)) > 0.99


def test_equal_values_are_compared_and_an_error_of_another_cause_spreads_them():
    assert interval_probability([0.1] * 9, (0.1, 0.2)) == 1.0
    assert interval_probability([0.1] * 9, (0.11, 0.2)) == 0.0
    assert interval_probability([0.1], (0.0, 0.2)) == 1.0
    validated(
        "Statistics and intervals", "probability beyond one standard error of the model",
        interval_probability([0.1], (0.11, math.inf), error=0.01), stats.norm.sf(1.0), rel=1e-6,
        source="closed form: normal distribution",
    )  # fmt: skip
    assert 0.1 < interval_probability([0.1] * 9, (0.11, 0.2), error=0.01) < 0.25


@pytest.mark.parametrize(
    ("values", "interval", "error", "text"),
    [
        ([], (0.0, 1.0), 0.0, "at least one finite number"),
        ([math.nan, 1.0], (0.0, 1.0), 0.0, "at least one finite number"),
        ([1.0, 2.0], (1.0, 0.0), 0.0, "from the lower to the higher"),
        ([1.0, 2.0], (0.0, 1.0), -1.0, "must not be negative"),
    ],
)
def test_values_that_are_none_are_refused(values, interval, error, text):
    with pytest.raises(ValueError, match=text):
        interval_probability(values, interval, error=error)
