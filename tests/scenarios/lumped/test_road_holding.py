"""Measures of tyre-load fluctuation and ride against slow loops, quadrature and Lyapunov's equation."""

import dataclasses

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import solve_continuous_lyapunov

from scenarios.lumped import road_holding
from scenarios.lumped.axle import Axle
from scenarios.lumped.damper_choice import RoadHoldingQuarterCar, damper_choice_parameters
from scenarios.lumped.road_holding import (
    half_car_model,
    printed_load_fluctuation,
    quarter_car_model,
    ride_measures,
    tyre_load_ratio,
    tyre_load_ratio_of_density,
)
from tests.validation import foreign, validated

P = damper_choice_parameters()
# an undamped tyre, so that white road velocity gives finite variances (Lyapunov)
CAR = RoadHoldingQuarterCar(
    sprung_mass=300.0,
    wheel=Axle(
        unsprung_mass=40.0, suspension_stiffness=2.4e4, suspension_damping=2000.0, tyre_stiffness=2e5, tyre_damping=0.0
    ),
)


def test_printed_measure_is_equation_10():
    total = 0.0
    for n in range(25):
        amplitude = np.sqrt(quad(lambda f: 4.85e-4 * np.exp(-0.19 * f), n, n + 1)[0])
        mean = quad(
            lambda f: float(np.abs(quarter_car_model(P.quarter_car, 3000.0).response(f)[0, 0])),
            n,
            n + 1,
        )[0]
        total += abs(amplitude - amplitude * mean)
    expected = P.quarter_car.wheel.tyre_stiffness * total
    expected /= (P.quarter_car.sprung_mass + P.quarter_car.wheel.unsprung_mass) * 9.81
    rate = printed_load_fluctuation(quarter_car_model(P.quarter_car, 3000.0), P.highway, P.bands)[0]
    assert rate == pytest.approx(expected, rel=1e-3)  # ten midpoints in each band


def test_signed_sum_is_smaller_and_only_rises():
    rates = [
        printed_load_fluctuation(quarter_car_model(P.quarter_car, c), P.highway, P.bands, signed=True)[0]
        for c in (1000.0, 2000.0, 4000.0, 8000.0)
    ]
    assert rates[0] < 0.0
    assert np.all(np.diff(rates) > 0.0)


def test_finer_lines_change_nothing_that_counts(monkeypatch):
    car = half_car_model(P.half_car, 1500.0, 1500.0)
    before = (printed_load_fluctuation(car, P.highway, P.bands), tyre_load_ratio(car, P.highway, P.bands))
    monkeypatch.setattr(road_holding, "LINES_PER_BAND", 2 * road_holding.LINES_PER_BAND)
    monkeypatch.setattr(road_holding, "LINES_PER_HERTZ", 2 * road_holding.LINES_PER_HERTZ)
    after = (printed_load_fluctuation(car, P.highway, P.bands), tyre_load_ratio(car, P.highway, P.bands))
    np.testing.assert_allclose(after, before, rtol=1e-3)  # as the constants say


def test_physical_measure_is_the_integral_of_the_complex_difference():
    model = quarter_car_model(P.quarter_car, 2500.0)

    def spectrum(f):
        return 4.85e-4 * np.exp(-0.19 * f) * np.abs(1.0 - model.response(f)[0, 0]) ** 2

    expected = 297160.0 * np.sqrt(quad(spectrum, 0.0, 25.0, limit=200)[0]) / ((290.15 + 62.01) * 9.81)
    validated(
        "Quarter and half cars", "dynamic wheel load of the choice of dampers, of the static one",
        tyre_load_ratio(model, P.highway, P.bands)[0], expected, rel=1e-3, source=foreign("scipy", "quad"),
    )  # fmt: skip


def stationary_variances(damping, intensity):
    """Return the variances of tyre deflection and travel under white road velocity, by Lyapunov's equation."""
    k, kt = CAR.wheel.suspension_stiffness, CAR.wheel.tyre_stiffness
    m, mu = CAR.sprung_mass, CAR.wheel.unsprung_mass
    # states: road - wheel, wheel - body, wheel velocity, body velocity
    system = np.array(
        [
            [0.0, 0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0, -1.0],
            [kt / mu, -k / mu, -damping / mu, damping / mu],
            [0.0, k / m, damping / m, -damping / m],
        ]
    )
    drive = np.array([[1.0], [0.0], [0.0], [0.0]])
    covariance = solve_continuous_lyapunov(system, -intensity * drive @ drive.T)
    acceleration = system[3]
    return covariance[0, 0], covariance[1, 1], float(acceleration @ covariance @ acceleration)


@pytest.mark.parametrize("damping", [800.0, 2000.0, 5000.0])
def test_ride_measures_agree_with_lyapunovs_equation(damping):
    speed = 22.0
    edges = np.geomspace(1e-3, 2000.0, 8001)
    lines, width = np.sqrt(edges[1:] * edges[:-1]), np.diff(edges)
    density = 256e-6 * 0.1**2 * speed / lines**2  # ISO 8608, class C
    measures = ride_measures(CAR, damping, lines, density, width)
    # one-sided velocity density (2 pi f)^2 G is constant; white noise of two-sided intensity half of it per hertz
    intensity = 0.5 * (2.0 * np.pi) ** 2 * 256e-6 * 0.1**2 * speed
    tyre, travel, acceleration = stationary_variances(damping, intensity)
    load = 2e5 * np.sqrt(tyre) / ((300.0 + 40.0) * 9.81)
    # the spectra fall as 1/f^2: beyond 2000 Hz lies less than 0.5 % of the variance, the midpoint rule is closer
    lyapunov = foreign("scipy", "Lyapunov equation under white road velocity")
    for name, value, exact, rel in (
        ("dynamic wheel load", measures.tyre_load, load, 3e-3),
        ("RMS travel", measures.travel, np.sqrt(travel), 3e-3),
        ("RMS body acceleration", measures.acceleration, np.sqrt(acceleration), 5e-3),
    ):
        validated(
            "Quarter and half cars", f"quarter car on a road of class C, {damping:g} N s/m, {name}", value, exact,
            rel=rel, source=lyapunov,
        )  # fmt: skip


def test_weight_acts_on_the_acceleration_alone():
    lines, width = np.arange(0.5, 30.0), np.ones(30)
    density = 64e-6 * 0.1**2 * 20.0 / lines**2
    plain, half = (ride_measures(CAR, 1500.0, lines, density, width, weight) for weight in (1.0, 0.5))
    assert half.acceleration == pytest.approx(0.5 * plain.acceleration)
    assert (half.tyre_load, half.travel) == (plain.tyre_load, plain.travel)


def test_tyre_damping_enters_the_tyre_force():
    damped = dataclasses.replace(CAR, wheel=dataclasses.replace(CAR.wheel, tyre_damping=2000.0))
    lines = np.array([15.0])
    model = quarter_car_model(damped)
    response = model.response(lines)[0, 0]
    expected = abs((2e5 + 2j * np.pi * 15.0 * 2000.0) * (1.0 - response)) / model.tyres[0].static_load
    validated(
        "Quarter and half cars", "dynamic wheel load with tyre damping at 15 Hz",
        tyre_load_ratio_of_density(model, lines, np.ones(1), 1.0)[0], expected, rel=1e-12,
        source="closed form: |(k + i w c) (1 - H)| / static load",
    )  # fmt: skip
