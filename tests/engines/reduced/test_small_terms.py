"""Terms of the reduced engine that no run shows clearly, by their closed forms."""

import numpy as np
import pytest

from vehicle.engines.linear.displacement_laws import DIFFERENCE_STEP, _about_rest
from vehicle.engines.reduced.equivalent_damping import equivalent_damping
from vehicle.engines.reduced.plate_samples import plate_samples
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


def test_a_breakpoint_near_rest_keeps_the_slopes_of_both_segments():
    """F has the slope k before and k + a behind a point p near rest; K holds the central difference between them."""
    k, a, p = 3.0e4, 1.0e4, 0.3 * DIFFERENCE_STEP
    tangent = k + a * (DIFFERENCE_STEP - p) / (2.0 * DIFFERENCE_STEP)
    breakpoints, changes = _about_rest(np.array([p]), np.array([a]))
    assert np.signbit(breakpoints).tolist() == [False, True] and not breakpoints.any()
    behind, before = changes
    assert (tangent + behind, tangent - before) == (pytest.approx(k + a), pytest.approx(k))
