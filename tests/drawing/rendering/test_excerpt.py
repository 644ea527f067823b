"""Which part of a record a film shows, and how slowly."""

import dataclasses

import numpy as np
import pytest

from tests.drawing.rendering.conftest import FakeCar, FakeRun, fabricated
from vehicle.drawing.rendering.excerpt import AFTER_EVENT, BEFORE_EVENT, EVENT_SLOW, FPS, choose_excerpt
from vehicle.drawing.rendering.layout import Layout
from vehicle.drawing.rendering.recorded_run import level_words
from vehicle.drawing.rendering.shot import Shot, Take

HUB, SLIP = "knuckle_fl_acc_z", 6e-3


def changed(car, duration=20.0, **channels):
    """A record of rest but for the given channels, as functions of time."""
    recording = fabricated(car, duration, level=0.0)
    rest = {name: np.zeros_like(recording.time) for name in recording.channels}
    return dataclasses.replace(
        recording, channels={**rest, **{name: form(recording.time) for name, form in channels.items()}}
    )


def sine(frequency):
    return lambda time: np.sin(2.0 * np.pi * frequency * time)


@pytest.mark.parametrize(("frequency", "slow"), [(4.0, 1.0), (14.0, 1.0), (16.0, 3.0), (28.0, 4.0)])
def test_a_wheel_that_moves_fast_is_shown_slowly(car, frequency, slow):
    """4 frames in a period: 28 Hz needs 112 frames per second, so a film with 30 is 4 times slower (3.73)."""
    recording = changed(car, knuckle_fl_acc_z=sine(frequency), plate_fl_displacement=sine(frequency))
    chosen = choose_excerpt(recording, "fl", HUB, SLIP)
    assert chosen.slow == slow and chosen.length == pytest.approx(10.0 / slow)
    assert FPS * slow / frequency > 2.0
    assert choose_excerpt(recording, "fl", HUB, SLIP, slow=1.0, duration=3.0).length == 3.0


def test_energy_of_motion_counts_and_not_acceleration(car):
    """1 m/s2 at 28 Hz is 5.7 mm/s; 0.3 m/s2 at 2 Hz is 24 mm/s: the eye follows the slow motion."""
    recording = changed(
        car,
        knuckle_fl_acc_z=lambda time: sine(28.0)(time) + 0.3 * sine(2.0)(time),
        plate_fl_displacement=sine(2.0),
    )
    assert choose_excerpt(recording, "fl", HUB, SLIP).slow == 1.0


def bump(time):
    """A bump of 0.33 s at 12 s in noise that is 2 % of its height."""
    noise = 0.02 * np.random.default_rng(1).standard_normal(time.size)
    return 0.1 * (np.where(np.abs(time - 12.0) < 1.0 / 6.0, np.cos(3.0 * np.pi * (time - 12.0)) ** 2, 0.0) + noise)


def test_a_bump_is_shown_with_the_time_around_it(car):
    recording = changed(car, plate_fl_displacement=bump, knuckle_fl_acc_z=sine(3.0))
    chosen = choose_excerpt(recording, "fl", HUB, SLIP)
    assert chosen.reason == "the event" and chosen.slow == EVENT_SLOW
    assert chosen.start == pytest.approx(12.0 - 1.0 / 6.0 - BEFORE_EVENT, abs=0.05)
    assert chosen.start + chosen.length == pytest.approx(12.0 + 1.0 / 6.0 + AFTER_EVENT, abs=0.05)
    # What is given is kept, and does not change the rest: a film of the same event is as slow.
    assert choose_excerpt(recording, "fl", HUB, SLIP, start=1.0).start == 1.0
    for given in ({"start": 11.8}, {"duration": 2.0}, {"start": 11.8, "duration": 2.0}):
        film = choose_excerpt(recording, "fl", HUB, SLIP, **given)
        assert film.slow == EVENT_SLOW and film.length == pytest.approx(given.get("duration", 10.0) / EVENT_SLOW)
    assert choose_excerpt(recording, "fl", HUB, SLIP, duration=8.0, slow=2.0).length == 4.0


def test_the_height_of_a_large_bump_is_no_power_of_ten(car):
    recording = changed(car, plate_fl_displacement=bump)
    height = 1e3 * np.max(recording["plate_fl_displacement"])
    assert 100.0 < height < 110.0 and level_words(recording, "fl", 0.01) == f"{height:.0f} mm bump"


def test_rest_is_not_exaggerated(car):
    """Rounding of 1e-14 m was shown 1000 times larger, on scales that ended at 4e-11 mm."""
    recording = changed(car, 1.0, seat_rail_acc_z=lambda time: 1e-12 * sine(3.0)(time))
    rest = dataclasses.replace(recording, poses=np.repeat(recording.poses[:1], len(recording.poses), axis=0))
    prepared = Shot(FakeRun(car=FakeCar(model=car), recording=rest), Layout(width=320, height=180), Take())
    assert prepared.cut.exaggeration == 1.0 and prepared.scale_top >= 1e-6
    assert any("true to scale (at rest)" in line for line in prepared.overlay.heading)
    assert min(trace.top for trace in prepared.overlay.strip.traces) >= 1e-3
