"""Axes of a device in any direction: vertical from gravity, direction of travel from the speed or a statement."""

import re

import numpy as np
import pytest
import scipy

from vehicle.errors import ConfigurationError, DataError
from vehicle.studies.diagnosis.device_axes import oriented
from vehicle.studies.diagnosis.drive_record import DriveRecord

RATE, COUNT = 100.0, 4000
CHANNELS = tuple(f"seat_rail_acc_{axis}" for axis in "xyz")
ANY = scipy.spatial.transform.Rotation.random(rng=3).as_matrix()


def motion():
    """Random vibration without mean."""
    samples = np.array([[0.5], [0.3], [1.0]]) * np.random.default_rng(7).standard_normal((3, COUNT))
    return samples - samples.mean(axis=1, keepdims=True)


def device(samples, turn, speed=None):
    with_gravity = turn @ (samples + np.array([[0.0], [0.0], [9.80665]]))
    return DriveRecord(name="drive", channels=CHANNELS, samples=with_gravity, rate=RATE, highest=40.0,
                       speeds=(20.0, 20.0), speed=speed)  # fmt: skip


@pytest.mark.parametrize("turn", [np.eye(3), np.diag([1.0, -1.0, -1.0]), ANY], ids=["upright", "on its head", "any"])
def test_a_device_in_any_direction_is_turned_upright(turn):
    found, unknown = oriented(device(motion(), turn), ["seat_rail"])
    assert found.samples[2] == pytest.approx(motion()[2] + 9.80665, abs=1e-9)
    # The horizontal axes keep any angle: their squares add up.
    assert np.sum(found.samples[:2] ** 2) == pytest.approx(np.sum(motion()[:2] ** 2))
    assert unknown == ("seat_rail",) and "direction of travel is unknown" in found.notices[-1]


def test_braking_and_speeding_up_show_the_direction_of_travel():
    # Four changes of the speed by +-1 m/s within 40 s; the x axis of the car points backwards.
    time, samples = np.arange(COUNT) / RATE, motion()
    speed = 20.0 + np.sin(2.0 * np.pi * 0.1 * time)
    samples[0] -= np.gradient(speed, 1.0 / RATE)
    found, unknown = oriented(device(samples, ANY, speed), ["seat_rail"])
    assert unknown == ()
    error = re.search(r"braking and speeding up, standard error ([\d.]+) deg", found.notices[-1])
    assert error is not None and float(error[1]) < 5.0
    turned = (found.samples[0] + 1j * found.samples[1]) @ (samples[0] - 1j * samples[1])
    assert abs(np.degrees(np.angle(turned))) < 3.0 * float(error[1])
    # A speed that is no speed of this record shows no direction.
    other = 20.0 + np.cos(2.0 * np.pi * 0.07 * time)
    assert oriented(device(samples, ANY, other), ["seat_rail"])[1] == ("seat_rail",)


@pytest.mark.parametrize(("forward", "column", "sign"), [("y", 1, 1.0), ("-x", 0, -1.0)])
def test_a_stated_axis_becomes_the_forward_axis(forward, column, sign):
    plain = device(motion(), np.eye(3))
    found, unknown = oriented(plain, ["seat_rail"], forward)
    assert unknown == ()
    assert found.samples[0] == pytest.approx(-sign * motion()[column], abs=1e-9)
    # A rotation, not a reflection.
    assert np.linalg.det(found.samples[:, [1, 7, 30]]) == pytest.approx(np.linalg.det(plain.samples[:, [1, 7, 30]]))


def test_wrong_devices_are_refused():
    with pytest.raises(DataError, match="but gravity shows the vertical"):
        oriented(device(motion() - np.array([[0.0], [0.0], [9.80665]]), np.eye(3)), ["seat_rail"])
    with pytest.raises(ConfigurationError, match="needs all three axes"):
        oriented(device(motion(), np.eye(3)), ["engine"])
    with pytest.raises(ConfigurationError, match="this axis of seat_rail is vertical"):
        oriented(device(motion(), np.eye(3)), ["seat_rail"], "z")
    with pytest.raises(ConfigurationError, match="must be one of x, -x"):
        oriented(device(motion(), np.eye(3)), ["seat_rail"], "up")
