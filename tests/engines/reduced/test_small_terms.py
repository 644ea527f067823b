"""Terms of the reduced engine that no run shows clearly, by their closed forms."""

import numpy as np
import pytest

from vehicle.engines.linear.displacement_laws import _about_rest
from vehicle.engines.reduced.equivalent_damping import equivalent_damping, equivalent_laws
from vehicle.engines.reduced.plate_samples import plate_samples
from vehicle.engines.simulation.force_differences import DIFFERENCE_STEP
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal


def test_a_slope_that_is_held_over_a_step_keeps_its_sine():
    """Held values have the factor sin(w h/2)/(w h/2) in their first harmonic; the samples are larger by its inverse."""
    omega, step, steps = 40.0 * np.pi, 2.4e-3, 200
    time = np.linspace(0.0, 0.6, 601)
    signal = Signal(time=time, displacement={"fr": np.zeros(601)}, slope_velocity={"fr": np.sin(omega * time)})
    table = np.asarray(plate_samples(signal, step, steps, 0)[:])
    inside = slice(5, 195)  # without the ends, where a difference has one neighbour
    held, exact = table[inside, 2], np.sin(omega * step * (np.arange(steps + 1) + 0.5))[inside]
    half = 0.5 * omega * step
    # The next term of the series is (w h)^4 / 5760 (7 - ...), 1e-5 here; the correction itself is 4e-3.
    np.testing.assert_allclose(held, exact * half / np.sin(half), atol=5e-5)


def test_the_equivalent_damping_takes_the_force_without_its_mean(car: Car):
    velocity = 0.3 + np.sin(0.1 * np.arange(1000))
    force = 1000.0 * velocity + 200.0  # a gas force does no work over a stroke that returns
    wanted = 1000.0 * np.var(velocity) / np.mean(velocity**2)
    assert equivalent_damping(car.vehicle.damper, velocity, force) == pytest.approx(wanted)


def test_equivalent_spring_and_damper_of_rubber_friction():
    """Jenkins elements in harmonic motion: their loss 4 F (A - F/k) is that of a damper, pi c w A^2; their stiffness is
    k (theta - sin(2 theta)/2)/pi with cos(theta) = 1 - 2 F/(k A)."""
    model = Car.load("sedan_steering").poles
    samples, interval, period = 4000, 1e-3, 1000
    stiffness, stroke = model.laws[0].elements
    amplitude, omega = 3.0 * float(stroke[-1]), 2.0 * np.pi / (period * interval)
    x, sliders, force = amplitude * np.sin(omega * interval * np.arange(-samples, samples)), 0.0 * stroke, []
    for each in x:
        sliders = np.clip(sliders, each - stroke, each + stroke)
        force.append(-float(stiffness @ sliders))
    poles, row = len(model.poles), model.law_outputs.poles[0].real
    state = np.zeros((2 * poles + 8 + model.slope.shape[1] + model.element_forces.shape[1], samples))
    largest = int(np.argmax(np.abs(row)))
    state[largest], state[-len(model.laws)] = x[samples:] / row[largest], force[samples:]
    k, c = equivalent_laws(model, np.fft.rfft(state, axis=1), interval, samples)
    theta = np.arccos(1.0 - 2.0 * stroke / amplitude)
    of_elements = stiffness * (theta - 0.5 * np.sin(2.0 * theta)) / np.pi
    assert k[0] + np.sum(stiffness) == pytest.approx(np.sum(of_elements), rel=1e-3)
    loss = np.sum(4.0 * stiffness * stroke * (amplitude - stroke))
    assert c[0] == pytest.approx(loss / (np.pi * omega * amplitude**2), rel=1e-3)
    assert k[1] == c[1] == 0.0


def test_a_breakpoint_near_rest_keeps_the_slopes_of_both_segments():
    """F has the slope k before and k + a behind a point p near rest; K holds the central difference between them."""
    k, a, p = 3.0e4, 1.0e4, 0.3 * DIFFERENCE_STEP
    tangent = k + a * (DIFFERENCE_STEP - p) / (2.0 * DIFFERENCE_STEP)
    breakpoints, changes = _about_rest(np.array([p]), np.array([a]))
    assert np.signbit(breakpoints).tolist() == [False, True] and not breakpoints.any()
    behind, before = changes
    assert (tangent + behind, tangent - before) == (pytest.approx(k + a), pytest.approx(k))
