"""Checks of a damper test before it is fitted: dead or copied sensors, units, and channels of different motions."""

import itertools
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import DataError

DEAD = 1e-6
"""Standard deviation over the largest value of a constant channel: rounding of seven digits."""

LEAST_DAMPING = 20.0
"""Minimum RMS force over RMS velocity [N s/m]: dampers of cars have 500 to 5000 N s/m, and more at low velocities."""

LARGEST = {"displacement": (1.0, "m", "mm"), "force": (1e5, "N", "N")}
"""Maximum stroke [m] and force [N] of a test, and the unit that a file with more probably has."""

SAME_MOTION = 0.5
"""Minimum correlation of displacement and integrated velocity: a delay of a sixth of a cycle."""

SAME_UNIT = 2.0
"""Maximum ratio of the displacement and the integrated velocity; units differ by a factor of ten and more."""

DISSIPATED = 0.1
"""Minimum correlation of force and velocity: a damper has more than 0.5, a spring and an unconnected sensor about 0."""

ONE_WAY = 0.01
"""Minimum ratio of the highest velocities of both directions; after a single stroke a machine rings by less."""


def require_sensors(path: Path, values: Mapping[str, Vector], names: Mapping[str, str]) -> None:
    """Check that displacement and force change, that no channel is a copy of another, and the size of both.

    Args:
        path: file of the test.
        values: time [s], displacement [m], force [N] and, if measured, velocity [m/s] by role; (n,) each.
        names: name of the channel of each role in the file.
    """
    for role in ("displacement", "force"):
        if is_dead(values[role]):
            raise DataError(
                f"{path}: the {role}, channel {names[role]!r}, is constant, {_value(values[role], role)}: the sensor "
                f"is dead or not connected; choose another channel with --channel {role}=NAME"
            )
        largest, unit, other = LARGEST[role]
        size = float(np.ptp(values[role]) if role == "displacement" else np.max(np.abs(values[role])))
        if size > largest:
            word = "stroke" if role == "displacement" else "force"
            raise DataError(
                f"{path}: the {word} is {number(size, 3)} {unit} but must be at most {largest:g} {unit}; check the "
                "unit "
                f"of channel {names[role]!r}, for example --unit {role}={other}"
            )
    for role, copy in itertools.combinations(values, 2):
        if is_copy(values[role], values[copy]):
            raise DataError(
                f"{path}: the channels {names[role]!r} and {names[copy]!r} contain the same values, so they cannot be "
                f"{role} and {copy}; choose others with --channel {role}=NAME and --channel {copy}=NAME"
            )


def is_dead(values: Vector) -> bool:
    """Return True if a channel is constant up to rounding."""
    return bool(np.std(values) <= DEAD * np.max(np.abs(values)))


def is_copy(first: Vector, second: Vector) -> bool:
    """Return True if two channels have the same digits: equal up to a factor of units, a power of 1000."""
    if is_dead(first) or is_dead(second):
        return False
    scale = float(first @ second) / float(first @ first)
    power = np.log10(abs(scale) or 1.0) / 3.0
    return bool(np.std(second - scale * first) <= DEAD * np.max(np.abs(second)) and abs(power - round(power)) < DEAD)


def usable_velocity(
    path: Path, time: Vector, x: Vector, measured: Vector, names: Mapping[str, str], notices: list[str]
) -> Vector | None:
    """Return a measured velocity with the sign of the displacement; None, with a notice, if its sensor is dead.

    Displacement and integrated velocity are compared without their linear parts: an offset of the velocity sensor is
    a drift, and noise of the displacement counts less than in its derivative.
    """
    path_of_velocity = scipy.integrate.cumulative_simpson(measured, x=time, initial=0.0)
    moved, travelled = (scipy.signal.detrend(each) for each in (x, path_of_velocity))
    sizes = float(np.std(moved)), float(np.std(travelled))
    if sizes[0] <= DEAD * float(np.ptp(x)):  # a single stroke of constant velocity
        return measured
    if is_dead(measured) or sizes[1] <= DEAD * sizes[0]:
        notices.append(
            f"the velocity, channel {names['velocity']!r}, is constant, {_value(measured, 'velocity')}: the sensor is "
            "dead or not connected, and the derivative of the displacement is used"
        )
        return None
    ratio, correlation = sizes[1] / sizes[0], float(np.mean(moved * travelled)) / (sizes[0] * sizes[1])
    if abs(correlation) < SAME_MOTION:
        raise DataError(
            f"{path}: the channels {names['displacement']!r} and {names['velocity']!r} belong to different motions: "
            f"the correlation of displacement and integrated velocity is {number(correlation, 2)} but must be at least "
            f"{SAME_MOTION:g}; choose another channel with --channel displacement=NAME or --channel velocity=NAME"
        )
    if not 1.0 / SAME_UNIT <= ratio <= SAME_UNIT:
        raise DataError(
            f"{path}: the measured velocity is {number(ratio, 2)} times the derivative of the displacement; correct "
            "the unit of one of them, for example --unit velocity=m/s or --unit displacement=m"
        )
    if correlation < 0.0:
        notices.append(
            f"the channels {names['displacement']!r} and {names['velocity']!r} have opposite directions; the velocity "
            "is inverted"
        )
        return -measured
    return measured


def require_damping(path: Path, force: Vector, velocity: Vector, names: Mapping[str, str]) -> None:
    """Check that the damper moves in both directions, and that its force follows the velocity and has a usual size."""
    slowest, fastest = 1e3 * float(np.min(velocity)), 1e3 * float(np.max(velocity))
    if min(fastest, -slowest) < ONE_WAY * max(fastest, -slowest):
        raise DataError(
            f"{path}: the damper moves in one direction only, at {number(slowest, 2)} to {number(fastest, 2)} mm/s; "
            "record at least a whole cycle, rebound and bump"
        )
    changing = force - np.mean(force)
    size, speed = float(np.sqrt(np.mean(changing**2))), float(np.sqrt(np.mean(velocity**2)))
    correlation = float(np.mean(changing * velocity)) / (size * speed)
    if abs(correlation) < DISSIPATED:
        raise DataError(
            f"{path}: the force, channel {names['force']!r}, does not follow the velocity: their correlation is "
            f"{number(correlation, 2)}, a damper has more than {DISSIPATED:g}; check the sensor, or choose another "
            "channel with --channel force=NAME or --channel displacement=NAME"
        )
    if size < LEAST_DAMPING * speed:
        raise DataError(
            f"{path}: the force, channel {names['force']!r}, is {number(size, 2)} N RMS at {number(speed, 2)} m/s RMS "
            f"but must be at least {LEAST_DAMPING:g} N s/m times the velocity; if its values are in kN, set --unit "
            "force=kN"
        )


def _value(values: Vector, role: str) -> str:
    """Return the mean of a constant channel with its unit."""
    unit, factor = {"displacement": ("mm", 1e3), "velocity": ("mm/s", 1e3), "force": ("N", 1.0)}[role]
    return f"{number(factor * float(np.mean(values)), 3)} {unit}"
