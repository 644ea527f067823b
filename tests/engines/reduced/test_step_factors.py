"""Exact step of a pole against quadrature and a fine solver."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.validation import foreign, validated
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.step_factors import SERIES_BELOW, phi_functions, step_factors

STEP = 0.01


@pytest.mark.parametrize("x", [0.0, 1e-9, -0.3 + 0.2j, 1.999j, SERIES_BELOW * 1.001, -3.0 + 40.0j, -250.0], ids=str)
def test_phi_functions_are_the_moments_of_the_exponential(x):
    computed = phi_functions(np.array([x], dtype=complex), 4)
    moments = []
    for j, phi in enumerate(computed):
        moment = mpmath.quad(lambda t, j=j: mpmath.exp(x * (1 - t)) * t**j, np.linspace(0, 1, 21).tolist())
        expected = complex(moment / mpmath.factorial(j))
        # The recursion loses a digit a turn at |x| = 2; 1e-12 of the largest value is what a step needs.
        assert abs(phi[0] - expected) <= 1e-12 * max(abs(expected), 1e-3)
        moments.append(expected)
    validated(
        "Reduced engine", f"phi functions of the exponential at {x:.4g}", np.ravel(computed), np.array(moments),
        rel=1e-12, abs=1e-15, source=foreign("mpmath", "quadrature of the moments"),
    )  # fmt: skip


def one_pole(pole, height, velocity):
    """Return a model of a single pole, without the data of its outputs."""
    return PoleModel(
        poles=np.array([pole], dtype=complex),
        pairs=int(np.imag(pole) > 0.0),
        height=np.array([[height, 0.0]], dtype=complex),
        velocity=np.array([[velocity, 0.0]], dtype=complex),
        force=np.array([[2.0 - 1.0j, 0.0]]),
        slip=np.zeros((2, 1), dtype=complex),
        modal=np.zeros((1, 1), dtype=complex),
        branch=np.zeros((0, 1), dtype=complex),
        slope=np.zeros((1, 0), dtype=complex),
        matrices=None,  # type: ignore[arg-type]
    )


@pytest.mark.parametrize("pole", [-3.0 + 170.0j, -0.1 + 4.0j, -2500.0, -1e5])
def test_a_step_is_exact_for_a_cubic_plate_and_a_constant_force(pole):
    factors = step_factors(one_pole(pole, 30.0 + 7.0j, -2.0 + 0.5j), STEP)
    cubic = np.polynomial.Polynomial([0.7, -20.0, 900.0, 4e4])
    rate, force, start = cubic.deriv(), 3.0, 0.2 - 0.4j

    def slope(t, x):
        return pole * x + (30.0 + 7.0j) * cubic(t) + (-2.0 + 0.5j) * rate(t) + (2.0 - 1.0j) * force

    expected = solve_ivp(slope, (0.0, STEP), [start], method="DOP853", rtol=1e-12, atol=1e-13).y[0, -1]
    plate_start, plate_end = (np.array([cubic(t), 0.0, rate(t), 0.0]) for t in (0.0, STEP))
    eta = start - factors.ahead[0] @ plate_start
    end = (
        factors.decay[0] * eta
        + factors.plate[0] @ plate_start
        + factors.force[0, 0] * force
        + factors.ahead[0] @ plate_end
    )
    # The tolerance of the solver over some hundred of its steps.
    validated(
        "Reduced engine", f"state of a pole at {pole:g} 1/s after a step with a cubic plate and a constant force",
        end, expected, abs=1e-9 * max(abs(expected), abs(start)), source=foreign("scipy", "DOP853, tolerance 1e-12"),
    )  # fmt: skip
