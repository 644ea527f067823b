"""Axes of a device in any direction, for example a phone: the vertical from gravity, the direction of travel.

A device at rest measures +g upwards. It is turned by the smallest angle that makes its mean point along z. With the
mean direction u and w = u x z that is R = 1 + [w] + [w]^2/(1 + u_z) (Rodrigues).

The direction of travel is stated, or follows from the slow horizontal accelerations a and the speed v of the record:

    d = cov(a, v')/var(v'),    standard error of its angle: std(a_across)/(std(v') sqrt(N)),

N = 2 B T independent samples of a band B over the time T. |d| = 1 for a device that measures the speed up of the car.
The x axis of the car points backwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import AXES
from vehicle.signals.formats.units import STANDARD_GRAVITY
from vehicle.signals.records.finding import findings_of
from vehicle.studies.diagnosis.drive_record import SLOW_BAND, DriveRecord, slow
from vehicle.studies.diagnosis.features import rows_of_points

OFFSET = 0.15
"""Largest deviation of the mean of a device from gravity [-]: offsets of cheap sensors reach 0.1 g."""

ANGLE = np.radians(5.0)
"""Largest standard error of the direction of travel [rad]: at twice that y gets 3 % of the power of x."""

LENGTH = (0.7, 1.3)
"""Range of |d| [-]: a speed that is late or smoothed has smaller changes, a road that rises adds its slope."""

STATED = tuple(f"{sign}{axis}" for axis in AXES for sign in ("", "-"))
"""Statements of the direction of travel: an axis of the device, or its opposite."""


def oriented(record: DriveRecord, points: Sequence[str], forward: str = "") -> tuple[DriveRecord, tuple[str, ...]]:
    """Return a record in the axes of the car as far as they are known, and the points with unknown horizontal axes.

    Args:
        record: record of the drive.
        points: points with a device in any direction.
        forward: axis of the device that points forward, of `STATED`; empty if it is unknown.

    Raises:
        ConfigurationError: the record has not all three axes of a point, or another or a vertical axis forward.
        DataError: the mean of a device is not gravity.
    """
    if forward and (forward not in STATED or not points):
        raise ConfigurationError(
            f"--forward {forward}: must be one of {', '.join(STATED)}, with --free POINT for the point of the device"
        )
    samples, unknown = record.samples.copy(), list[str]()
    # Gravity is expected here, and no offset to take out.
    devices = {f"{point}_acc_{axis}" for point in points for axis in AXES}
    expected = {
        each
        for each in findings_of(record.notices, kinds=("gravity",))
        if {*each.partition(":")[0].split(", ")} <= devices
    }
    notices = [notice for notice in record.notices if notice not in expected]
    for point in points:
        rows = rows_of_points(record.channels, [point])
        if not rows:
            raise ConfigurationError(
                f"--free {point}: needs all three axes of the point; set --map {point}_acc_x=NAME, also for y and z"
            )
        axes = list(rows[0])
        turn = _upright(record, point, samples[axes].mean(axis=1))
        samples[axes] = turn @ samples[axes]
        if forward:
            direction = turn[:2, AXES.index(forward[-1])] * (-1.0 if forward[0] == "-" else 1.0)
            if np.hypot(*direction) < 0.5:
                raise ConfigurationError(f"--forward {forward}: this axis of {point} is vertical; choose another one")
        else:
            direction, error = _travel(record, samples[axes[:2]])
            if not error <= ANGLE:
                unknown.append(point)
                notices.append(
                    f"{point}: the direction of travel is unknown; with --forward AXIS, or a speed in the record that "
                    "changes, intervals are a tenth narrower"
                )
                continue
            notices.append(
                f"{point}: direction of travel from braking and speeding up, standard error "
                f"{number(np.degrees(error), 2)} deg"
            )
        c, s = -direction / np.hypot(*direction)
        samples[axes[:2]] = np.array([[c, s], [-s, c]]) @ samples[axes[:2]]
    return replace(record, samples=samples, notices=tuple(notices)), tuple(unknown)


def _upright(record: DriveRecord, point: str, mean: Vector) -> Vector:
    """Return the rotation of the mean acceleration of a device to the vertical; (3, 3)."""
    length = float(np.linalg.norm(mean))
    if abs(length / STANDARD_GRAVITY - 1.0) > OFFSET:
        raise DataError(
            f"{record.name}: the mean of {point} is {length:.3g} m/s2, but gravity shows the vertical of a device in "
            f"any direction; give a record with gravity ({STANDARD_GRAVITY:.3g} m/s2), or leave --free out"
        )
    x, y, up = mean / length
    if up < -1.0 + 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    cross = np.array([[0.0, 0.0, -x], [0.0, 0.0, -y], [x, y, 0.0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1.0 + up))


def _travel(record: DriveRecord, horizontal: Vector) -> tuple[Vector, float]:
    """Return the direction d of travel in two horizontal axes, (2,), and its standard error [rad], inf if unknown."""
    if record.speed is None:
        return np.zeros(2), np.inf
    a = slow(horizontal, record.rate)
    a = a - a.mean(axis=1, keepdims=True)
    change = slow(np.gradient(record.speed, 1.0 / record.rate), record.rate)
    change = change - change.mean()
    power = float(np.mean(change**2))
    if power == 0.0:
        return np.zeros(2), np.inf
    d = a @ change / (change.size * power)
    length = float(np.hypot(*d))
    if not LENGTH[0] <= length <= LENGTH[1]:
        return d, np.inf
    across = (d[0] * a[1] - d[1] * a[0]) / length
    count = 2.0 * SLOW_BAND * change.size / record.rate
    return d, float(np.std(across) / (length * np.sqrt(power * count)))
