"""Driving state of a car: speed and hold of the course; templates with rolling or fixed wheels."""

import contextlib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.quantity import Validated, quantity, validate
from vehicle.model.parameters.toml_file import build, convert
from vehicle.model.parameters.topology import Template

SPIN = "spin"
"""Name of the hinge about which a wheel turns on its hub."""

ROUND = 1e-6
"""Tolerance [m, kg m2] within which a part that turns with the wheel is a body of revolution."""


def _steady(meaning: str) -> Any:
    """Declare a steady acceleration, 0 by default."""
    grip = "1.5 g, the grip of racing tyres"
    return quantity("m/s2", f"steady {meaning}", at_least=-15.0, at_most=15.0, why=grip, default=0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Driving(Validated):
    """Constant speed straight ahead with freely rolling wheels; at speed 0 the tyres are at rest, as on a rig.

    A steady acceleration moves the static equilibrium about which the car rides, and neither its speed nor its course:
    `docs/theory/steady-acceleration.md`.

    The hold of the course represents the driver: free rolling leaves the position of the car along x and y and its
    heading without any stiffness. Comfort does not depend on it: `docs/theory/rolling-tyre.md`.
    """

    speed: float = quantity(
        "m/s",
        "speed of the car, forwards; 0: the tyres stand on the plates",
        at_least=0.0,
        at_most=120.0,
        why="400 km/h",
        default=0.0,
    )
    hold_frequency: float = quantity(
        "Hz",
        "natural frequency of the car on the soft springs that keep its course (x, y, yaw), up to 200 km/h; "
        "above, it falls with 1/speed",
        at_least=0.01,
        at_most=0.5,
        why="a driver corrects the course at 0.05 to 0.3 Hz; modes of the car begin at 1 Hz",
        default=0.1,
    )
    hold_damping: float = quantity(
        "-", "damping ratio of the car on the soft springs that keep its course", at_least=0.1, at_most=2.0, default=0.7
    )
    acceleration: float = _steady("acceleration along the road, forwards positive (ISO 8855), braking negative")
    lateral: float = _steady("lateral acceleration, to the left positive (ISO 8855), as in a bend to the left")
    brake_balance: float = quantity(
        "-",
        "share of the foremost axle in the brake force; the wheels of an axle brake alike",
        at_least=0.0,
        at_most=1.0,
        default=0.7,
    )
    driven_axle: str | None = quantity(
        "-", "axle that drives, or all for equal shares of all axles; default: the foremost axle", default=None
    )
    drive_reaction: str | None = quantity(
        "-",
        "part with the reaction of the drive torque, which has the differential; wheel for motors in the wheels; "
        "default: engine, or wheel in a car without one and for an axle of one piece, which has its differential",
        default=None,
    )
    friction: float = quantity(
        "-",
        "largest ratio of horizontal force to load of a tyre in steady acceleration",
        at_least=0.05,
        at_most=2.0,
        why="0.1 on ice, 1 on a dry road",
        default=1.0,
    )

    @property
    def rolling(self) -> bool:
        """True if the wheels turn."""
        return self.speed > 0.0

    @property
    def accelerates(self) -> bool:
        """True if the car brakes, drives or turns steadily."""
        return self.acceleration != 0.0 or self.lateral != 0.0

    @property
    def words(self) -> str:
        """State of tyres and car for summaries and captions, for example "rolling at 80 km/h, acceleration -3 m/s2"."""
        steady = {"acceleration": self.acceleration, "lateral acceleration": self.lateral}
        return ", ".join([tyre_words([self]), *(f"{name} {value:g} m/s2" for name, value in steady.items() if value)])


STANDING = Driving()

SAME_SPEED = 2e-3
"""Relative difference of a speed in m/s that was rounded from km/h: 22.2 for 80."""


HIGHEST_RPM = 10000.0
"""Highest speed of a crankshaft [1/min]."""


class RunUp(NamedTuple):
    """Speed of an angle that changes linearly between points and is constant after the last one.

    Attributes:
        times: times of the points from 0 on [s].
        speeds: speeds at these times [rad/s].
    """

    times: tuple[float, ...]
    speeds: tuple[float, ...]

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return self.times[-1]


@dataclass(frozen=True, kw_only=True, slots=True)
class Crank(Validated):
    """Speed of the crankshaft, for the forces over its angle: constant, linear in time in a run-up, or of a file."""

    rpm: float | None = quantity(
        "1/min",
        "speed of the crankshaft; for a run-up, the speed at its start",
        at_least=300.0,
        at_most=HIGHEST_RPM,
        why="engines idle at 600 to 1000",
        default=None,
    )
    end_rpm: float | None = quantity(
        "1/min",
        "speed at the end of a run-up; default: constant speed",
        at_least=300.0,
        at_most=HIGHEST_RPM,
        default=None,
    )
    run_up_time: float | None = quantity(
        "s", "time from the start of the run to the end of the run-up", at_least=1.0, at_most=3600.0, default=None
    )
    file: str | None = quantity("-", "file with a measured speed over time, instead of rpm", is_file=True, default=None)
    channel: str | None = quantity(
        "-",
        "channel of the file by number or name; default: the only channel in 1/min or rpm",
        is_file=True,
        default=None,
    )

    def __post_init__(self) -> None:
        validate(self)
        if (self.rpm is None) == (self.file is None):
            raise ConfigurationError("Crank.rpm: set either rpm or file, the measured speed")
        if (self.end_rpm is None) != (self.run_up_time is None):
            raise ConfigurationError("Crank.end_rpm: a run-up needs end_rpm and run_up_time; set both")
        if self.file is None and self.channel is not None:
            raise ConfigurationError("Crank.file: missing, but channel is set; set file, or remove channel")
        if self.file is not None and self.end_rpm is not None:
            raise ConfigurationError(
                "Crank.end_rpm: found together with file, which already contains the run-up; leave end_rpm out"
            )

    @property
    def run_up(self) -> RunUp | None:
        """Run-up of the crankshaft; None at constant speed.

        Raises:
            ConfigurationError, DataError: its file cannot be read or has no speed.
        """
        if self.file is not None:
            # Files are read without numpy until a file is named.
            from vehicle.model.parameters.crank_file import measured_speed

            return RunUp(*measured_speed(self.file, self.channel or ""))
        if self.end_rpm is None or self.run_up_time is None or self.end_rpm == self.rpm:
            return None
        assert self.rpm is not None
        return RunUp((0.0, self.run_up_time), (self.rpm * math.pi / 30.0, self.end_rpm * math.pi / 30.0))

    @property
    def highest(self) -> float:
        """Highest speed [rad/s]."""
        run_up = self.run_up
        return max(run_up.speeds) if run_up else (self.rpm or 0.0) * math.pi / 30.0


def crank_of(table: Mapping[str, Any]) -> Crank | None:
    """Return the crankshaft of a vehicle file; None if it has none. Errors: see `build`."""
    return build(Crank, convert(dict, table["crank"], "crank"), "crank") if "crank" in table else None


def require_speed_once(texts: Iterable[str], speed: float) -> bool:
    """Return True if texts "path=value" give the speed of the car, which an input gives too: 0, or the same speed.

    Args:
        texts: changes of the car.
        speed: speed of the road [m/s]; NaN for a speed that varies.

    Raises:
        ConfigurationError: a text gives another speed, so that the plates and the tyres would have different ones.
    """
    agrees = False
    for text in texts:
        path, _, value = (part.strip() for part in text.partition("="))
        if path not in ("driving.speed", "speed"):
            continue
        agrees = False
        with contextlib.suppress(ValueError):
            agrees = float(value) == 0.0 or math.isclose(float(value), speed, rel_tol=SAME_SPEED)
        if not agrees:
            road = "its recorded speed" if math.isnan(speed) else f"{3.6 * speed:.4g} km/h of --speed, {speed:.4g} m/s"
            raise ConfigurationError(
                f"{text.strip()}: the road already sets another speed, {road}; leave driving.speed out and set "
                "--speed, or set --tyre standing for tyres that do not roll"
            )
    return agrees


def tyre_words(cars: Iterable[Driving]) -> str:
    """Return the state of the tyres in one or several runs: "standing", "rolling at 50, 80 and 120 km/h"."""
    speeds = sorted({car.speed for car in cars})
    rolling = [f"{3.6 * speed:.4g}" for speed in speeds if speed > 0.0]
    listed = " and ".join(part for part in (", ".join(rolling[:-1]), *rolling[-1:]) if part)
    return " or ".join([*(["standing"] if 0.0 in speeds else []), *([f"rolling at {listed} km/h"] if rolling else [])])


def driving_of(table: Mapping[str, Any]) -> Driving:
    """Return the table `driving` of a vehicle file; without it the tyres are at rest. Errors: see `build`."""
    return build(Driving, convert(dict, table.get("driving", {}), "driving"), "driving")


def as_driven(template: Template, driving: Driving) -> Template:
    """Return a template with its "spin" joints replaced: hinges if the car drives, fixed joints otherwise.

    A rolling tyre is on a hinge about y on its hub; parts that turn with it are fixed to the tyre. The force of the
    road then acts on the hub: the steady spin turns the point of contact back as fast as the wheel turns.

    Args:
        template: template, with or without joints of kind "spin".
        driving: driving state of the car.
    """
    spins = [joint for joint in template.joint if joint.kind == SPIN]
    if not spins:
        return template
    joints, hubs = [], {}
    for joint in template.joint:
        if joint.kind != SPIN:
            joints.append(joint)
        elif not driving.rolling:
            joints.append(replace(joint, kind="fixed", at=None))
        else:
            tyre, *others = joint.child
            hubs[tyre] = joint.parent
            joints.append(replace(joint, kind="hinge", name=SPIN, child=(tyre,), axis=(0.0, 1.0, 0.0)))
            if others:
                joints.append(replace(joint, kind="fixed", at=None, child=tuple(others), parent=tyre))
    connections = tuple(
        replace(connection, moving=hubs.get(connection.moving, connection.moving))
        if connection.carrier == "plate"
        else connection
        for connection in template.connection
    )
    return replace(template, joint=tuple(joints), connection=connections)


def driven_wheels(driving: Driving, wheels: Iterable[Any]) -> dict[str, float]:
    """Return the share of each wheel in the force along the road, by name; the wheels of an axle have equal shares.

    Args:
        driving: driving state.
        wheels: wheels of a car on two axles, see `vehicle.model.parameters.composition.PlacedWheel`.

    Raises:
        ConfigurationError: the driven axle is unknown.
    """
    axles = {wheel.name: wheel.axle for wheel in sorted(wheels, key=lambda wheel: float(wheel.center[0]))}
    names = list(dict.fromkeys(axles.values()))
    if driving.acceleration <= 0.0:
        shares = dict(zip(names, (driving.brake_balance, 1.0 - driving.brake_balance), strict=False))
    else:
        driven = driving.driven_axle or names[0]
        if driven not in (*names, "all"):
            raise ConfigurationError(f"driving.driven_axle: found {driven!r}, must be one of {', '.join(names)}, all")
        shares = {name: 1.0 / len(names) if driven == "all" else float(name == driven) for name in names}
    return {wheel: shares[axle] / list(axles.values()).count(axle) for wheel, axle in axles.items()}
