"""Quarter and half car of the damper study: Lagrange's equations, symmetry, closed forms, decoupling."""

import dataclasses

import numpy as np
import pytest
import sympy

from scenarios.lumped.damper_choice import damper_choice_parameters
from scenarios.lumped.road_holding import half_car_model, quarter_car_model
from vehicle.errors import ConfigurationError

PARAMETERS = damper_choice_parameters()
QUARTER, HALF = PARAMETERS.quarter_car, PARAMETERS.half_car
LINES = np.linspace(0.0, 30.0, 301)


def test_half_car_matrices_are_those_of_lagranges_equations():
    t = sympy.Symbol("t")
    uf, ur, x, th = q = [sympy.Function(n)(t) for n in ("uf", "ur", "x", "th")]
    zf, zr = z = [sympy.Function(n)(t) for n in ("zf", "zr")]
    f, r = HALF.front, HALF.rear
    front, rear = x - HALF.front_arm * th - uf, x + HALF.rear_arm * th - ur
    parts = (
        (front, f.suspension_stiffness, f.suspension_damping),
        (rear, r.suspension_stiffness, r.suspension_damping),
        (zf - uf, f.tyre_stiffness, f.tyre_damping),
        (zr - ur, r.tyre_stiffness, r.tyre_damping),
    )
    kinetic = (
        f.unsprung_mass * uf.diff(t) ** 2
        + r.unsprung_mass * ur.diff(t) ** 2
        + HALF.sprung_mass * x.diff(t) ** 2
        + HALF.pitch_inertia * th.diff(t) ** 2
    ) / 2
    potential = sum(k * s**2 / 2 for s, k, _ in parts)
    dissipation = sum(c * s.diff(t) ** 2 / 2 for s, _, c in parts)
    rows = [sympy.expand(kinetic.diff(c.diff(t)).diff(t) + dissipation.diff(c.diff(t)) + potential.diff(c)) for c in q]
    model = half_car_model(HALF).model
    for matrix, columns, sign in (
        (model.mass, [c.diff(t, 2) for c in q], 1.0),
        (model.damping, [c.diff(t) for c in q], 1.0),
        (model.stiffness, q, 1.0),
        (model.input_stiffness, z, -1.0),
        (model.input_damping, [c.diff(t) for c in z], -1.0),
    ):
        expected = sign * np.array([[float(row.coeff(c)) for c in columns] for row in rows])
        np.testing.assert_allclose(matrix, expected, rtol=0, atol=1e-12 * max(1.0, np.abs(expected).max()))  # rounding


def test_quarter_car_response_is_the_closed_form_of_the_source():
    """Section II: H_u = (ks + j w cs - w^2 Ms) (kt + j w ct) / det A, H_s = (ks + j w cs) (kt + j w ct) / det A."""
    car = dataclasses.replace(QUARTER, wheel=dataclasses.replace(QUARTER.wheel, tyre_damping=250.0))
    w = 2.0 * np.pi * LINES
    suspension = car.wheel.suspension_stiffness + 1j * w * 4000.0
    tyre = car.wheel.tyre_stiffness + 1j * w * 250.0
    a = tyre + suspension - w**2 * car.wheel.unsprung_mass
    b = suspension - w**2 * car.sprung_mass
    determinant = a * b - suspension**2
    wheel, body = quarter_car_model(car, 4000.0).response(LINES)
    np.testing.assert_allclose(wheel, b * tyre / determinant, rtol=1e-10)
    np.testing.assert_allclose(body, suspension * tyre / determinant, rtol=1e-10)


def test_static_loads_are_those_of_the_axles():
    front, rear = half_car_model(HALF).tyres
    total = HALF.sprung_mass + HALF.front.unsprung_mass + HALF.rear.unsprung_mass
    assert front.static_load + rear.static_load == pytest.approx(9.81 * total)
    moment = 9.81 * (HALF.sprung_mass * HALF.rear_arm + HALF.front.unsprung_mass * (HALF.front_arm + HALF.rear_arm))
    assert front.static_load * (HALF.front_arm + HALF.rear_arm) == pytest.approx(moment)


def test_given_damping_replaces_the_cars_own():
    default = half_car_model(HALF).model.damping
    explicit = half_car_model(HALF, HALF.front.suspension_damping, HALF.rear.suspension_damping).model.damping
    np.testing.assert_array_equal(default, explicit)
    swapped = half_car_model(HALF, 1.0, 2.0).model.damping
    assert swapped[0, 0] == 1.0
    assert swapped[1, 1] == 2.0


@pytest.mark.parametrize("bad", [[-1.0], [float("nan")]])
def test_bad_frequency_is_refused(bad):
    with pytest.raises(ConfigurationError, match=r"frequency: must be finite numbers of at least 0\.0 Hz"):
        quarter_car_model(QUARTER).response(bad)
