"""Figures of periodic states: first slip against states beside it, damping on another path, what is refused."""

import numpy as np
import pytest

from vehicle import Car, ConfigurationError, Signal
from vehicle.runs.car.levels import FREQUENCY


@pytest.fixture(scope="module")
def run():
    time = np.linspace(0.0, 1.0, 1001)
    wave = 1e-3 * np.sin(2.0 * np.pi * 3.0 * time)
    car = Car.load("focus_road")
    signal = Signal(time=time, displacement=dict.fromkeys(car.vehicle.wheels, wave), source="sine")
    return car.run(signal, engine="reduced")


def test_the_first_slip_is_between_two_levels(run):
    level = run.figure("slip_level:heave")
    found = run.car.levels(frequency=FREQUENCY, level=level * np.array([0.998, 1.002]), samples=512)
    slips = found.effort.max(axis=0) >= 1.0
    assert slips[:, 1].any() and not slips[:, 0].any()


def test_the_damping_at_a_millimetre_needs_no_fine_path(run):
    """The mode of a path with other levels, at the same frequency of the peak."""
    states = run.car.levels(frequency=np.geomspace(2.0, 7.0, 60), level=np.geomspace(2e-5, 1e-3, 15))
    assert run.figure("level_damping:heave") == pytest.approx(states.mode(states.falling_peak())[1][-1], rel=0.02)


def test_motions_are_those_of_plates(run):
    with pytest.raises(ConfigurationError, match="motion 'front wheel hop': must be one of heave, pitch, roll, warp"):
        run.figure("slip_level:front wheel hop")


def test_a_linear_car_has_no_first_slip(run):
    signal = run.signal
    linear = Car.load("focus_road", ["*.damper.friction_law=coulomb", "*.damper.coulomb_friction=0"])
    with pytest.raises(ConfigurationError, match="the car is linear"):
        linear.run(signal, engine="reduced").figure("slip_level:heave")
