"""Four dampers on a road: the reduced engine against MuJoCo for every channel, and warnings outside the valid range.

Both engines take one model; MuJoCo at a quarter of a millisecond is exact to 0.1 % here. What is left is geometry, of
second order in the motion: it falls with the level, and over 10 s of class A it leaves 0.48 % in the RMS of the worst
channel. Along and across of the wheel carriers, which are made of rotations, 2.5 s leave more of it to chance: 1.6 %.
"""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road


def road(car, road_class, duration):
    return Road(road_class, 80.0, duration=duration, seed=2).under(car.vehicle).signal()


@pytest.fixture(scope="module")
def car():
    return Car.load("focus_road", ["solver.timestep=2.5e-4"])


def test_every_channel_of_class_a_agrees(car):
    signal = road(car, "A", 2.5)
    reduced, stepped = (car.run(signal, engine=engine) for engine in ("reduced", "mujoco"))
    assert reduced.recording.statistics.within_validity
    assert all(reduced.slip_share(wheel) > 0.1 for wheel in car.vehicle.wheels)
    worst = {}
    for channel in car.vehicle.channels:
        ours, theirs = (float(np.std(run[channel])) for run in (reduced, stepped))
        worst[channel] = abs(ours / theirs - 1.0)
    rotation_channels = {name for name in worst if name.startswith("knuckle") and not name.endswith("z")}
    assert len(rotation_channels) == 8 and len(worst) > 50
    for few, words in ((True, "wheel carriers along and across"), (False, "all other channels")):
        group = np.array([value for name, value in worst.items() if (name in rotation_channels) == few])
        validated(
            "Reduced engine", f"RMS of {words} on a road of class A over that of MuJoCo", 1.0 + group, 1.0,
            abs=0.02 if few else 0.005, source="second derivation: MuJoCo, step 0.25 ms",
        )  # fmt: skip


@pytest.mark.parametrize(("road_class", "said"), [("B", "rotates by"), ("C", "would lift off its plate")])
def test_rougher_roads_leave_the_validity_and_that_is_said(car, road_class, said):
    recording = car.run(road(car, road_class, 10.0), engine="reduced", channels=["seat_rail_acc_z"]).recording
    assert not recording.statistics.within_validity
    assert any(said in warning for warning in recording.statistics.warnings)
