"""Samples within ranges, and sensitivity indices against closed forms."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.ranges import Range
from vehicle.studies.sweeps.indices import LEAST_BASE, sobol_indices, sobol_sample

ANGLES = [Range(path=f"x{i}", low=-np.pi, high=np.pi) for i in range(3)]
UNIT = [Range(path=f"x{i}", low=0.0, high=2.0) for i in range(3)]


def ishigami(x, a=7.0, b=0.1):
    return np.sin(x[:, 0]) + a * np.sin(x[:, 1]) ** 2 + b * x[:, 2] ** 4 * np.sin(x[:, 0])


def test_sobol_indices_of_ishigami():
    a, b = 7.0, 0.1
    # Closed form: Ishigami and Homma 1990.
    v1, v2 = 0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2, a**2 / 8.0
    v13 = b**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    total = v1 + v2 + v13
    sobol = sobol_indices(ANGLES, ishigami(sobol_sample(ANGLES, 2048, seed=3)))
    assert sobol.paths == ("x0", "x1", "x2")
    # Three half widths of the interval: probability below 1e-8 for a normal distribution.
    for name, value, error, exact in (
        ("first", sobol.first, sobol.first_error, [v1 / total, v2 / total, 0.0]),
        ("total", sobol.total, sobol.total_error, [(v1 + v13) / total, v2 / total, v13 / total]),
    ):
        for number in range(3):
            validated(
                "Sweeps, tuning and optimisation", f"Sobol index of the Ishigami function, {name} of x{number + 1}",
                value[number], exact[number], abs=3.0 * error[number] + 0.005,
                source="closed form: Ishigami and Homma 1990",
            )  # fmt: skip
        assert np.all(error < 0.1)
    assert 0.0 < sobol.drift < 0.1


def test_a_failed_run_costs_its_base_point():
    points = sobol_sample(ANGLES, 512, seed=3)
    y = ishigami(points)
    whole = sobol_indices(ANGLES, y)
    y[[7, 8, 1003]] = np.nan
    sobol = sobol_indices(ANGLES, y)
    assert (sobol.base, sobol.left_out, sobol.scramblings) == (512, 2, 16)
    assert np.all(np.abs(sobol.total - whole.total) < 0.02) and not np.array_equal(sobol.total, whole.total)
    # A whole scrambling may also fail; an interval needs at least two.
    y[: 32 * 5] = np.nan
    assert sobol_indices(ANGLES, y).scramblings == 15


def test_intervals_of_ishigami_cover_as_stated():
    exact = np.array([0.5576, 0.2437])
    inside = []
    for seed in range(40):
        sobol = sobol_indices(ANGLES, ishigami(sobol_sample(ANGLES, 128, seed=seed)))
        inside.append(np.abs(sobol.total[[0, 2]] - exact) < sobol.total_error[[0, 2]])
    # 76 of 80 expected; a bootstrap over the points covers all. 69 or fewer: one in a thousand for 95 %.
    assert 70 <= np.sum(inside) <= 79


def g_function(x):
    """Source: Saltelli and Sobol, RESS 50 (1995): product of (|4 x - 2| + a) / (1 + a)."""
    return np.prod((np.abs(4.0 * x - 2.0) + WEIGHTS) / (1.0 + WEIGHTS), axis=1)


WEIGHTS = np.array([0.0, 1.0, 4.5, 9.0])
SHARES = 1.0 / 3.0 / (1.0 + WEIGHTS) ** 2
PRODUCT = np.prod(1.0 + SHARES)
EXACT = np.array([SHARES, SHARES * PRODUCT / (1.0 + SHARES)]) / (PRODUCT - 1.0)
CUBE = [Range(path=f"x{i}", low=0.0, high=1.0) for i in range(4)]


def test_errors_and_intervals_at_the_minimum_base():
    """At `LEAST_BASE` errors are as its reason states; below it the sample is rejected."""
    found = [sobol_indices(CUBE, g_function(sobol_sample(CUBE, LEAST_BASE, seed=seed))) for seed in range(60)]
    errors = np.abs([np.array([each.first, each.total]) - EXACT for each in found])
    widths = np.array([[each.first_error, each.total_error] for each in found])
    assert np.quantile(errors.max(axis=(1, 2)), 0.95) < 0.36
    # 480 intervals: 95 % less three standard deviations of a share of 60 independent samples is 0.92 - 0.03.
    assert 0.89 < np.mean(errors <= widths) < 0.98
    assert sum(bool(each.contradictions) for each in found) <= 6  # 5 % of 60, and three
    for base in (1, 2, 4, 32):
        with pytest.raises(ConfigurationError, match=f"found {base}, .* 64"):
            sobol_sample(CUBE, base)


def test_a_contradiction_is_named():
    """Values that follow no function of the points: S1 is far below 0, which no independent inputs can give."""
    points = sobol_sample(CUBE, 64, seed=1)
    y = g_function(points).reshape(64, 6)
    y[:, 1] = y[:, 0] - (y[:, 5] - y[:, 0].mean())
    (words, *_) = sobol_indices(CUBE, y.ravel()).contradictions
    assert words.startswith("x0: S1 is below 0") and "(S1 -" in words


def test_a_small_sample_has_a_wide_interval():
    small = sobol_indices(ANGLES, ishigami(sobol_sample(ANGLES, 64, seed=3)))
    large = sobol_indices(ANGLES, ishigami(sobol_sample(ANGLES, 1024, seed=3)))
    # With 16 times the points a quarter of the width.
    assert np.sum(small.total_error) > 2.5 * np.sum(large.total_error)


def test_bad_arguments():
    with pytest.raises(ConfigurationError, match="must be ascending"):
        Range(path="a", low=1.0, high=1.0)
    with pytest.raises(ConfigurationError, match=r"found 100, .*power of two"):
        sobol_sample(UNIT, 100)
    for values, found in (
        (np.arange(7.0), "found 7, .*multiple of 5"), ([1.0, 2.0, np.nan, 3.0, 4.0, *range(5)], "1 of 2 base points"),
        (np.ones(5), "equal"),
    ):  # fmt: skip
        with pytest.raises(DataError, match=found):
            sobol_indices(UNIT, values)
