"""Exact response to a bump against a general integrator and against a closed form."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from scenarios.lumped.bump_response import BumpPassage, bump_passage, bump_response
from scenarios.lumped.half_car_rider_model import half_car_rider
from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from scenarios.lumped.network import ROAD, Network, masses_of, spring_damper
from tests.validation import own_function, validated
from vehicle.errors import ConfigurationError

CAR = half_car_rider_parameters()
MODEL = half_car_rider(CAR)


def integrated(model, passage, time):
    """The same by an adaptive Runge-Kutta method, restarted at every jump of the road rate."""
    n = len(model.coordinates)
    inverse = np.linalg.inv(model.mass)

    def slope(t, s):
        # the road is asked for inside the open interval, so that the jump belongs to neither side
        force = model.input_stiffness @ passage.heights(t) + model.input_damping @ passage.rates(t)
        return np.concatenate((s[n:], inverse @ (force - model.stiffness @ s[:n] - model.damping @ s[n:])))

    edges = sorted({0.0, time[-1], *passage.arrivals, *(a + passage.contact for a in passage.arrivals)})
    edges = [e for e in edges if e <= time[-1]]
    state, states = np.zeros(2 * n), np.zeros((2 * n, time.size))
    for start, end in itertools.pairwise(edges):
        gap = 1e-12 * (end - start)
        inside = (time >= start) & (time <= end)
        solved = solve_ivp(
            slope, (start + gap, end - gap), state, method="DOP853", rtol=1e-10, atol=1e-13, dense_output=True
        )
        states[:, inside] = solved.sol(np.clip(time[inside], start + gap, end - gap))
        state = solved.y[:, -1]
    return states


@pytest.mark.parametrize("speed", [20.0, 60.0])
def test_half_car_agrees_with_an_adaptive_integrator(speed):
    passage = bump_passage(CAR.bump, speed / 3.6, 2.8, start=0.0123)
    exact = bump_response(MODEL, passage, time_step=2e-3, duration=1.5)
    states = integrated(MODEL, passage, exact.time)
    # the integrator is asked for 1e-10 and errors add up over a few hundred steps
    dop853 = own_function("scipy", "matrices of the half car, DOP853, tolerance 1e-10")
    validated(
        "Quarter and half cars", f"displacements of the half car on a bump at {speed:g} km/h", exact.state[:, :7].T,
        states[:7], peak=1e-8, unit="m", source=dop853,
    )  # fmt: skip
    validated(
        "Quarter and half cars", f"velocities of the half car on a bump at {speed:g} km/h", exact.state[:, 7:].T,
        states[7:], peak=1e-7, unit="m/s", source=dop853,
    )  # fmt: skip


def test_undamped_oscillator_follows_its_closed_form():
    w0, w, h0 = 7.0, 11.0, 0.05
    spring = spring_damper({"x": 1.0, ROAD: -1.0}, 2.0 * w0**2, 0.0)
    model = Network(coordinates=("x",), masses=masses_of({"x": 2.0}), links=(spring,)).system()
    response = bump_response(
        model, BumpPassage(height=h0, omega=w, arrivals=(0.0,)), time_step=1e-3, duration=np.pi / w
    )
    t = response.time[response.time < np.pi / w]
    expected = h0 * w0**2 / (w0**2 - w**2) * (np.sin(w * t) - w / w0 * np.sin(w0 * t))
    # h0 = 0.05: rounding only
    validated(
        "Quarter and half cars", "undamped oscillator on a half-sine bump", response.displacement("x")[: t.size],
        expected,
        abs=1e-12, unit="m", source="closed form: h0 w0^2 / (w0^2 - w^2) (sin w t - w / w0 sin w0 t)",
    )  # fmt: skip


def test_acceleration_obeys_the_equation_of_motion():
    passage = bump_passage(CAR.bump, 20.0 / 3.6, 2.8)
    h = bump_response(MODEL, passage, time_step=1e-3, duration=1.0)
    np.testing.assert_allclose(h.inputs.T, passage.heights(h.time), atol=1e-12)
    force = MODEL.input_stiffness @ h.inputs.T + MODEL.input_damping @ h.input_rates.T
    moved = {
        q: np.array([h.motion(n, q) for n in MODEL.coordinates]) for q in ("displacement", "velocity", "acceleration")
    }
    left = MODEL.mass @ moved["acceleration"] + MODEL.damping @ moved["velocity"]
    left += MODEL.stiffness @ moved["displacement"]
    validated(
        "Quarter and half cars", "M x'' + C x' + K x of the half car on a bump is the force of the road", left, force,
        peak=1e-9, unit="N", source="conservation: equation of motion at every sample",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time_step": 0.0}, "bump response: time_step: found 0.0 s, must be greater than 0.0"),
        ({"time_step": float("nan")}, "bump response: time_step: found nan s, must be greater than 0.0"),
        ({"duration": 0.0}, "bump response: duration: found 0.0 s, must be at least one time step"),
    ],
)
def test_bad_grid_is_refused(change, message):
    arguments = {"time_step": 1e-3, "duration": 1.0, **change}
    with pytest.raises(ConfigurationError) as caught:
        bump_response(MODEL, bump_passage(CAR.bump, 5.0, 2.8), **arguments)
    assert str(caught.value) == message


def test_wrong_number_of_wheels_is_refused():
    with pytest.raises(ConfigurationError, match="found 1 arrivals for 2 roads, must be equal"):
        bump_response(MODEL, BumpPassage(height=0.05, omega=1.0, arrivals=(0.0,)), time_step=0.01, duration=1.0)
