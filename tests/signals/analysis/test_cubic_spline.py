"""The cubic spline against scipy, and against polynomials that it must reproduce."""

import numpy as np
import pytest
import scipy.interpolate

from vehicle.signals.analysis.cubic_spline import CubicSpline


@pytest.mark.parametrize("samples", [4, 5, 2000])
def test_values_and_derivatives_have_the_bits_of_scipy(samples):
    random = np.random.default_rng(3)
    x = np.cumsum(random.uniform(0.5, 1.5, samples)) * 1e-3
    y = random.normal(size=samples)
    at = np.concatenate([x, random.uniform(x[0] - 1e-3, x[-1] + 1e-3, 500)])
    spline, expected = CubicSpline(x, y), scipy.interpolate.CubicSpline(x, y)
    for order in range(3):
        assert np.array_equal(spline(at, order), expected(at, order)), order
    assert spline(float(x[1])).shape == ()


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_a_polynomial_of_few_samples_is_exact(degree):
    x = np.arange(degree + 1.0)
    polynomial = np.polynomial.Polynomial([2.0, -1.0, 0.5, 0.25][: degree + 1])
    spline, at = CubicSpline(x, polynomial(x)), np.linspace(0.0, float(degree), 7)
    assert spline(at) == pytest.approx(polynomial(at), abs=1e-12)
    assert spline(at, 1) == pytest.approx(polynomial.deriv()(at), abs=1e-12)
