"""Four dampers on a road: the reduced engine against MuJoCo for every channel, and warnings outside the valid range.

Both engines take one model; MuJoCo at a quarter of a millisecond is exact to 0.1 % here. What is left is geometry, of
second order in the motion: it falls with the level, and over 10 s of class A it leaves 0.48 % in the RMS of the worst
channel. Along and across of the wheel carriers, which are made of rotations, 2.5 s leave more of it to chance: 1.6 %.
"""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.engines.reduced.stated_errors import NAMED_ERROR
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


@pytest.mark.parametrize("road_class", ["B", "C"])
def test_a_road_ends_without_an_alarm(car, road_class):
    """Comfort, its axes and the forces agree within 1 % there: rotations and a pull of the tyres are notices."""
    runs = [car.run(road(car, road_class, 6.0), engine=engine) for engine in ("reduced", "mujoco")]
    statistics = runs[0].recording.statistics
    assert statistics.warnings == runs[1].recording.statistics.warnings == ()
    reduced, stepped = (run.comfort().values for run in runs)
    for name in stepped:
        if not name.endswith("_error"):
            assert reduced[name] == pytest.approx(stepped[name], rel=0.015 if name.endswith(("_x", "_y")) else 0.005), (
                name
            )
    found = {
        channel: float(np.std(runs[0][channel]) / np.std(runs[1][channel])) - 1.0
        for channel in statistics.errors
        if "@" not in channel
    }
    off = [channel for channel, error in found.items() if abs(error) > 0.02]
    assert len(off) >= 2 or road_class == "B"
    for channel in off:
        assert 0.5 < statistics.errors[channel] / found[channel] < 2.0, channel
    assert all(abs(error) < 0.01 for channel, error in found.items() if channel.endswith(("_force", "_force_z")))
    notices = [text for text in statistics.notices if "linear geometry" in text]
    named = any(abs(error) > NAMED_ERROR for error in statistics.errors.values())
    assert len(notices) == named and (named or road_class == "B")
    assert all("weighted comfort" in text and text.endswith("where these channels matter") for text in notices)
    # What is read decides on the engine of "auto".
    for channels, engine in ((["seat_rail_acc_z"], "reduced"), ([*off[:1], "seat_rail_acc_z"], "mujoco")):
        if off:
            run = car.run(road(car, road_class, 6.0), engine="auto", channels=channels)
            assert run.recording.statistics.engine == engine
