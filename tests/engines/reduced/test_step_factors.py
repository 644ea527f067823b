"""Exact step of a pole against quadrature and a fine solver."""

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.validation import foreign, validated
from vehicle.engines.reduced.phi_functions import SERIES_BELOW, phi_functions
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.step_factors import SLOWEST, car_factors

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
        scalar_rows=Outputs(poles=np.zeros((0, 1), dtype=complex), height=np.zeros((0, 2)), velocity=np.zeros((0, 2))),
        scalar_force=np.zeros((1, 0), dtype=complex),
        applied=np.zeros((1, 0), dtype=complex),
        matrices=None,  # type: ignore[arg-type]
    )


@pytest.mark.parametrize("pole", [-3.0 + 170.0j, -0.1 + 4.0j, -2500.0, -1e5, -1e-3, 0.0])
def test_a_step_is_exact_for_a_cubic_plate_and_a_linear_force(pole):
    height, velocity, residue = 30.0 + 7.0j, -2.0 + 0.5j, 2.0 - 1.0j
    (factors,) = car_factors([one_pole(pole, height, velocity)], STEP, [0], exact=True)
    cubic = np.polynomial.Polynomial([0.7, -20.0, 900.0, 4e4])
    rate, force, force_slope, begin = cubic.deriv(), 3.0, 0.8, 0.2 - 0.4j

    def slope(t, x):
        mean = force + force_slope * (t / STEP - 0.5)
        return pole * x + height * cubic(t) + velocity * rate(t) + residue * mean

    expected = solve_ivp(slope, (0.0, STEP), [begin], method="DOP853", rtol=1e-12, atol=1e-13).y[0, -1]
    # Mean forces and slopes of two dampers, z', z; the state lacks what they add at the end of a step.
    still = np.zeros(4)
    eta = begin - factors.direct[0] @ np.array([*still, rate(0.0), cubic(0.0)])
    inputs = [*still, rate(0.0), (cubic(STEP) - cubic(0.0)) / STEP, *[cubic(0.0)] * factors.plate_inputs]
    assert factors.plate_inputs == (abs(pole) < SLOWEST)
    eta += factors.step[0] @ np.array([eta, *inputs])
    end = eta + factors.direct[0] @ np.array([force, 0.0, force_slope, 0.0, rate(STEP), cubic(STEP)])
    # The tolerance of the solver over some hundred of its steps.
    validated(
        "Reduced engine", f"state of a pole at {pole:g} 1/s after a step with a cubic plate and a linear force",
        end, expected, abs=1e-9 * max(abs(expected), abs(begin)), source=foreign("scipy", "DOP853, tolerance 1e-12"),
    )  # fmt: skip
