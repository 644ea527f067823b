"""Names of the whole package: corners, sides, axes, engines, channels with their units."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence

from vehicle.errors import ConfigurationError

CORNERS = {"front_right": "fr", "front_left": "fl", "rear_right": "rr", "rear_left": "rl"}
"""Names of the wheels of a car with two axles, by corner in words; a car may have fewer."""

SIDE_SIGN = {"right": 1.0, "left": -1.0}
"""Sign of y on each side: +y points to the driver's right."""

ENGINES = ("mujoco", "reduced", "auto")
"""Engines of a run: complete MuJoCo model, reduced model, or the reduced model inside its valid range."""

FMI_VERSIONS = ("2", "3")
"""Versions of the Functional Mock-up Interface (FMI) of an exported car, the default first."""

AXES = ("x", "y", "z")

_UNITS = {
    r"\w+_acc_[xyz]": "m/s2",
    r"\w+_velocity": "m/s",
    r"\w+_force(_[xyz])?": "N",
    r"plate_\w+_displacement": "m",
    r"suspension_travel_\w+": "m",
    r"\w+_torque": "N m",
    r"\w+_coefficient": "N s/m",
    r"coordinate_\d+": "-",
    r"force_[\w.-]+": "N",
    r"torque_[\w.-]+": "N m",
    "angle_crank": "rad",
    "speed_crank": "1/min",
}


def side_of(wheel: str, wheels: Iterable[str]) -> str:
    """Return a wheel in words: the side for a car with one axle, else the corner, else the name of the wheel.

    Args:
        wheel: name of the wheel, for example "fr".
        wheels: names of all wheels of the car.
    """
    sides = {name: sides.replace("_", " ") for sides, name in CORNERS.items()}
    if len({name[0] for name in wheels}) == 1 and wheel in sides:
        return sides[wheel].split()[1]
    return sides.get(wheel, wheel)


def wheel_words(wheel: str, wheels: Iterable[str]) -> str:
    """Return the name of a wheel: "right front wheel" for a car with one axle, else "rear right wheel"."""
    side = side_of(wheel, wheels)
    return f"{side} front wheel" if side in SIDE_SIGN and wheel.startswith("f") else f"{side} wheel"


def slip_words(velocities: Mapping[str, float], wheels: Collection[str]) -> str:
    """Return slip velocities in mm/s: "6", or with the dampers if they differ: "6 (front) and 20 (rear)".

    Args:
        velocities: wheel of each damper to its slip velocity [m/s].
        wheels: names of all wheels of the car.
    """
    by_limit: dict[str, list[str]] = {}
    for wheel, velocity in velocities.items():
        by_limit.setdefault(f"{1e3 * velocity:g}", []).append(wheel)
    if len(by_limit) == 1:
        return next(iter(by_limit))
    sides = {wheel: side_of(wheel, wheels) for wheel in velocities}
    parts = []
    for limit, dampers in by_limit.items():
        names = []
        for wheel in dampers:
            axle = sides[wheel].rpartition(" ")[0]
            alike = all(other in dampers for other, side in sides.items() if side.startswith(f"{axle} "))
            names.append(axle if axle and alike else sides[wheel])
        parts.append(f"{limit} ({', '.join(dict.fromkeys(names))})")
    return " and ".join(parts)


def point_words(point: str) -> str:
    """Return the name of a part or point in words: "seat rail", "front right suspension mount".

    Args:
        point: name in channels, for example "seat_rail" or "suspension_mount_fr".
    """
    part, _, wheel = point.rpartition("_")
    corner = next((corner for corner, name in CORNERS.items() if name == wheel), None)
    return (f"{corner}_{part}" if part and corner else point).replace("_", " ")


def channel_words(channel: str) -> str:
    """Return the name of a channel in words: "front left knuckle z" for knuckle_fl_acc_z, other channels unchanged.

    Args:
        channel: name of a channel, or of an FRF as "knuckle_fl_acc_z/plate_fl".
    """
    output, _, plate = channel.partition("/")
    point, _, axis = output.rpartition("_acc_")
    output = f"{point_words(point)} {axis}" if point else output
    return f"{output} to {plate}" if plate else output


def axle_and_side(wheel: str) -> tuple[str, str]:
    """Return axle and side of a wheel in words: "front", "right" for fr; "middle", "left" for middle_l.

    Args:
        wheel: name of the wheel, see `is_wheel`.
    """
    axle = wheel[:-1].rstrip("_").replace("_", " ")
    return {"f": "front", "r": "rear"}.get(axle, axle), {"r": "right", "l": "left"}[wheel[-1]]


def across(wheel: str) -> str:
    """Return the other wheel of the axle: "fl" for "fr"."""
    return wheel[:-1] + ("l" if wheel.endswith("r") else "r")


def is_wheel(name: str) -> bool:
    """Return True for a valid name of a wheel: a corner, or the side of a further axle like middle_r."""
    return name in CORNERS.values() or re.fullmatch(r"[a-z]\w*_[rl]", name) is not None


def in_order(wheels: Iterable[str]) -> tuple[str, ...]:
    """Return wheels in the order of files: the corners, then the wheels of further axles."""
    corners = list(CORNERS.values())
    return tuple(sorted(wheels, key=lambda wheel: (corners.index(wheel) if wheel in corners else len(corners), wheel)))


def acceleration_channels(points: Iterable[str]) -> tuple[str, ...]:
    """Return the channels `<point>_acc_<axis>` of output points."""
    return tuple(f"{point}_acc_{axis}" for point in points for axis in AXES)


def wheel_channels(wheels: Iterable[str], dampers: Sequence[str]) -> tuple[str, ...]:
    """Return the channels of wheels and dampers, ordered by corner.

    Args:
        wheels: names of the wheels.
        dampers: names of the dampers; the damper of a corner is "damper_" and the wheel.
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
    """Return the unit of each channel, derived from its name.

    Args:
        channels: names of channels.

    Raises:
        ConfigurationError: the name is not of a channel.
    """
    units = {}
    for channel in channels:
        unit = next((unit for form, unit in _UNITS.items() if re.fullmatch(form, channel)), None)
        if unit is None:
            raise ConfigurationError(
                f"no channel {channel!r}; channels have names like seat_rail_acc_z, damper_fr_velocity, "
                "damper_fr_force, tyre_fr_force_z, plate_fr_displacement"
            )
        units[channel] = unit
    return units
