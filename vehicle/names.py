"""Names that more than one room uses, each written once: corners, sides, axes, engines, channels with their units."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from vehicle.errors import ConfigurationError

CORNERS = {"front_right": "fr", "front_left": "fl", "rear_right": "rr", "rear_left": "rl"}
"""Words for the corners of a car with two axles to the names of its wheels; a car tells which of them it has."""

SIDE_SIGN = {"right": 1.0, "left": -1.0}
"""Sign of y of each side: +y points to the driver's right."""

ENGINES = ("mujoco", "reduced", "auto")
"""What computes a run: the complete car, its poles, or the poles where they are valid."""

AXES = ("x", "y", "z")

_UNITS = {
    r"\w+_acc_[xyz]": "m/s2",
    r"\w+_velocity": "m/s",
    r"\w+_force(_[xyz])?": "N",
    r"plate_\w+_displacement": "m",
    r"suspension_travel_\w+": "m",
    r"\w+_torque": "N m",
    r"\w+_coefficient": "N s/m",
}


def side_of(wheel: str, wheels: Iterable[str]) -> str:
    """The word for a wheel among those of its car: its side where the car has one axle, else its corner, else its name.

    Args:
        wheel: its name, as "fr".
        wheels: names of all wheels of the car.
    """
    sides = {name: sides.replace("_", " ") for sides, name in CORNERS.items()}
    if len({name[0] for name in wheels}) == 1 and wheel in sides:
        return sides[wheel].split()[1]
    return sides.get(wheel, wheel)


def wheel_words(wheel: str, wheels: Iterable[str]) -> str:
    """A wheel in a sentence: "right front wheel" of a car with one axle there, else "rear right wheel"."""
    side = side_of(wheel, wheels)
    return f"{side} front wheel" if side in SIDE_SIGN and wheel.startswith("f") else f"{side} wheel"


def axle_and_side(wheel: str) -> tuple[str, str]:
    """Axle and side of a wheel in words: "front", "right" of fr, "middle", "left" of middle_l.

    Args:
        wheel: its name, as of `is_wheel`.
    """
    axle = wheel[:-1].rstrip("_").replace("_", " ")
    return {"f": "front", "r": "rear"}.get(axle, axle), {"r": "right", "l": "left"}[wheel[-1]]


def across(wheel: str) -> str:
    """The wheel on the other side of its axle, as "fl" of "fr"."""
    return wheel[:-1] + ("l" if wheel.endswith("r") else "r")


def is_wheel(name: str) -> bool:
    """Whether a wheel may have this name: a corner, or the side of a further axle, as middle_r."""
    return name in CORNERS.values() or re.fullmatch(r"[a-z]\w*_[rl]", name) is not None


def in_order(wheels: Iterable[str]) -> tuple[str, ...]:
    """Wheels in the order of files: the corners, then those of further axles."""
    corners = list(CORNERS.values())
    return tuple(sorted(wheels, key=lambda wheel: (corners.index(wheel) if wheel in corners else len(corners), wheel)))


def acceleration_channels(points: Iterable[str]) -> tuple[str, ...]:
    """Channels `<place>_acc_<axis>` of places."""
    return tuple(f"{point}_acc_{axis}" for point in points for axis in AXES)


def wheel_channels(wheels: Iterable[str], dampers: Sequence[str]) -> tuple[str, ...]:
    """Channels of wheels and dampers: those of a corner together.

    Args:
        wheels: names of the wheels.
        dampers: names of the dampers; that of a corner is "damper_" and its wheel.
    """
    channels: list[str] = []
    corner_dampers = {wheel: f"damper_{wheel}" for wheel in wheels}
    for wheel, damper in corner_dampers.items():
        channels += [f"{damper}_velocity", f"{damper}_force"] if damper in dampers else []
        channels += [f"tyre_{wheel}_force_z", f"plate_{wheel}_displacement"]
    return (
        *channels,
        *(
            f"{damper}_{quantity}"
            for damper in dampers
            if damper not in corner_dampers.values()
            for quantity in ("velocity", "force")
        ),
    )


def channel_units(channels: Iterable[str]) -> dict[str, str]:
    """Channels to their units, which their names tell.

    Args:
        channels: names.

    Raises:
        ConfigurationError: there can be no such channel.
    """
    units = {}
    for channel in channels:
        unit = next((unit for form, unit in _UNITS.items() if re.fullmatch(form, channel)), None)
        if unit is None:
            raise ConfigurationError(
                f"no channel {channel!r}; channels are called as seat_rail_acc_z, damper_fr_velocity, damper_fr_force, "
                "tyre_fr_force_z, plate_fr_displacement"
            )
        units[channel] = unit
    return units
