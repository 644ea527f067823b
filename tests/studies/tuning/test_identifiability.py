"""Covariance and unidentifiable directions of given Jacobians."""

import numpy as np
import pytest

from vehicle.model.parameters.ranges import Range
from vehicle.studies.tuning.identifiability import WIDEST, covariance, worst_direction

A = Range(path="a", low=1.0, high=np.e**2, start=2.0)  # half width 1
B = Range(path="b", low=1.0, high=np.e**4, start=2.0)  # half width 2


def test_covariance_is_the_inverse_of_the_normal_matrix():
    rng = np.random.default_rng(1)
    jacobian = rng.standard_normal((30, 4)) @ np.triu(rng.uniform(0.5, 2.0, (4, 4)))  # strongly correlated columns
    np.testing.assert_allclose(covariance(jacobian), np.linalg.inv(jacobian.T @ jacobian), rtol=1e-9)


def test_spread_counts_in_half_widths():
    # Orthogonal columns: the standard error of u_b is 1 / 3, a sixth of its half width of 2.
    assert worst_direction(np.diag([5.0, 3.0]), [A, B]) is None
    # Now 1 / 0.5 = 2, one half width: above the limit, without partners.
    held = worst_direction(np.diag([5.0, 0.5]), [A, B])
    assert held is not None
    assert (held.path, held.partners, held.held_at) == ("b", (), 2.0)
    assert held.spread == pytest.approx(1.0)
    assert WIDEST < 1.0


def test_limit_is_half_the_deviation_that_follows_from_the_bounds():
    # A value of which only the bounds are known has the standard deviation 1 / sqrt(3) of a half width.
    for factor, identified in ((0.99, True), (1.01, False)):
        error = factor * 0.5 / np.sqrt(3.0)
        assert (worst_direction(np.array([[1.0 / error], [0.0]]), [A]) is None) is identified


def test_equal_columns_are_one_direction():
    held = worst_direction(np.array([[4.0, 2.0], [2.0, 1.0], [8.0, 4.0]]), [A, B])
    assert held is not None
    # In half widths both columns are equal: only the sum of both parameters is identifiable.
    assert {held.path, *held.partners} == {"a", "b"}
    assert held.spread == np.inf
