"""Recorded accelerations: true in the band of use, without what lies above half the sampling rate, up to both ends."""

import numpy as np

from scenarios.signals.random_road import random_road
from tests.validation import validated
from vehicle.engines.simulation.recorded_acceleration import AHEAD, WEIGHTS, acceleration
from vehicle.runs.car import Car

INTERVAL = 1e-3


def gain(frequency):
    """Recorded over true acceleration of a sine."""
    turn = np.exp(2j * np.pi * frequency * INTERVAL * np.arange(-AHEAD, AHEAD + 1))
    return float(np.real(WEIGHTS @ turn)) / -((2.0 * np.pi * frequency * INTERVAL) ** 2)


def test_a_sine_is_true_in_the_band_of_use_and_gone_at_half_the_rate():
    for frequency, exact, allowed in ((50.0, 1.0, 2e-6), (100.0, 1.0, 2e-4), (150.0, 1.0, 4e-3), (500.0, 0.0, 1e-12)):
        validated(
            "Integration in MuJoCo", f"recorded over true acceleration of a sine of {frequency:g} Hz at 1000 Hz",
            gain(frequency), exact, abs=allowed, source="closed form: second derivative of a sine",
        )  # fmt: skip
    # What would be folded to 100 Hz and below.
    assert all(abs(gain(frequency)) < 10.0 ** (-38.0 / 20.0) for frequency in (900.0, 950.0, 1050.0, 1100.0))


def test_both_ends_are_as_good_as_the_middle():
    time = INTERVAL * np.arange(-60, 400 + AHEAD)
    # At rest until 0, then up without a jump of the acceleration's first derivatives.
    position = np.where(time > 0.0, np.clip(time, 0.0, None) ** 6, 0.0)
    found = acceleration(position[60:], INTERVAL)
    assert found.shape == (400,)
    np.testing.assert_allclose(found, 30.0 * time[60:460] ** 4, rtol=0.0, atol=1e-9)


def test_engines_record_alike_up_to_the_last_sample():
    road = random_road(rms=2e-5, seed=3, wheel="fr", duration=1.0)
    car = Car.load(None, ["solver.timestep=0.000125", "damper.coulomb_friction=0"])
    stepped, reduced = car.run(road), car.run(road, engine="reduced")
    for name in ("knuckle_fr_acc_z", "seat_rail_acc_z", "engine_acc_z"):
        size = np.std(stepped[name])
        assert np.max(np.abs(stepped[name][-10:] - reduced[name][-10:])) < 5e-3 * size, name
