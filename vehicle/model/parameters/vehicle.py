"""Complete parameters of a car on its rig: a vehicle file and the composition of its templates."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.applied_force import CRANK
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.body import TrimmedBody, require_inertia_table
from vehicle.model.parameters.compose import APPLY_FORCES, compose
from vehicle.model.parameters.composition import Composition
from vehicle.model.parameters.curves import with_curve_files
from vehicle.model.parameters.drive_torque import with_drive_torques
from vehicle.model.parameters.driving import Driving, driving_of
from vehicle.model.parameters.force_elements import Damper
from vehicle.model.parameters.further_forces import new_tables
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.plausible import require_plausible, require_rolling
from vehicle.model.parameters.quantity import Validated, field_quantity, quantity
from vehicle.model.parameters.shipped import FOCUS_FILE, vehicle_file
from vehicle.model.parameters.toml_file import build, convert
from vehicle.model.parameters.whole_body import varied_table
from vehicle.names import AXES, CORNERS, SIDE_SIGN, acceleration_channels, wheel_channels, wheel_words
from vehicle.wording import choose_from

FIRST_STEP = 1e-3
"""Default time step [s] before it is checked; small enough for steel and rubber of a car up to 100 Hz."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Solver(Validated):
    """Numerics of the time simulation."""

    record_rate: float = quantity("Hz", "sampling rate of the recorded channels", at_least=125.0, at_most=1e5)
    timestep: float | None = quantity(
        "s", "time step [s]; default: the largest stable and accurate step", at_least=1e-6,
        at_most=0.005, default=None,
    )  # fmt: skip

    @property
    def step(self) -> float:
        """Time step [s]; `FIRST_STEP` if the file has none."""
        return FIRST_STEP if self.timestep is None else self.timestep


@dataclass(frozen=True, kw_only=True, slots=True)
class Head(Validated):
    """Parameters of a vehicle file outside all tables."""

    name: str = quantity("-", "name of the car")
    gravity: float = quantity("m/s2", "gravity", at_least=0.0, at_most=30.0, why="9.81 on Earth; 0: no weight")
    shaker_wheel: str = quantity(
        "-",
        "wheel that a displacement column moves if its name contains no wheel",
        choices=tuple(CORNERS.values()),
        default="fr",
    )
    shaker_wheel_in_source: str = quantity(
        "-",
        "side of the shaker wheel in the words of the publication of the car",
        choices=("right", "left", "unsaid"),
        default="unsaid",
    )
    apply_forces: bool = True
    """false leaves out all applied forces: tables [force.NAME], of wheels and of engines"""


HEAD = tuple(Head.__dataclass_fields__)
"""Keys of a vehicle file outside all tables."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Vehicle:
    """Parameters of a car on its rig, in SI units and in the frame of the hardpoints.

    Attributes:
        table: vehicle file with overrides, nested tables; cars with equal tables are equal.
        name: name of the car.
        gravity: gravity [m/s2].
        shaker_wheel: wheel that a shaker drives by default, for example "fr".
        shaker_wheel_in_source: side of that wheel in the words of the source: "right", "left" or "unsaid".
        body: trimmed body.
        solver: numerics.
        driving: speed and hold of the course.
        composition: all other elements, placed and named.
    """

    table: Mapping[str, Any]
    name: str = field(compare=False)
    gravity: float = field(compare=False)
    shaker_wheel: str = field(compare=False)
    shaker_wheel_in_source: str = field(compare=False)
    body: TrimmedBody = field(compare=False)
    solver: Solver = field(compare=False)
    driving: Driving = field(compare=False)
    composition: Composition = field(compare=False)

    def __repr__(self) -> str:
        """One line."""
        return f"Vehicle({self.name}, wheels {', '.join(self.wheels)})"

    @property
    def points(self) -> Mapping[str, Point]:
        """Hardpoints by name, for example "strut_top_fr" [m]."""
        return self.composition.points

    @property
    def wheels(self) -> tuple[str, ...]:
        """Names of the wheels with a plate, for example "fr"."""
        return tuple(wheel.name for wheel in self.composition.wheels)

    @property
    def damped_wheels(self) -> tuple[str, ...]:
        """Names of the wheels with a damper of their own, "damper_" and the name; an axle may have none."""
        names = {damper.name for damper in self.composition.dampers}
        return tuple(wheel for wheel in self.wheels if f"damper_{wheel}" in names)

    @property
    def slip_velocities(self) -> dict[str, float]:
        """Return the velocity above which each damper slips [m/s], by wheel: the name after "damper_"."""
        return {damper.name.removeprefix("damper_"): damper.law.slip_velocity for damper in self.composition.dampers}

    @property
    def acceleration_channels(self) -> tuple[str, ...]:
        """Names of the recorded accelerations, in the order of the files."""
        return acceleration_channels(output.name for output in self.composition.outputs)

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of all channels of a recording, in the order of the files."""
        dampers = [damper.name for damper in self.composition.dampers]
        return (*self.acceleration_channels, *wheel_channels(self.wheels, dampers))

    def wheel_text(self, wheel: str, *, source: bool = True) -> str:
        """Return a wheel for captions, by side and by channel, for example "driver's left front wheel (fl)".

        Args:
            wheel: name of the wheel.
            source: True to add the name in the source.
        """
        position = wheel_words(wheel, self.wheels)
        side_in_source = self.shaker_wheel_in_source if source and wheel == self.shaker_wheel else "unsaid"
        note = "" if side_in_source == "unsaid" else f"'{side_in_source} wheel' in the words of the publication"
        side = "driver's " if position.split()[0] in SIDE_SIGN else ""
        return f"{side}{position} ({'; '.join(filter(None, (wheel, note)))})"

    def require_wheels(self, wheels: Iterable[str]) -> None:
        """Check that the car has some wheels.

        Raises:
            ConfigurationError: the first wheel that does not exist.
        """
        for wheel in wheels:
            if wheel not in self.wheels:
                names = {name: f"{name} ({corner})" for corner, name in CORNERS.items()}
                has = ", ".join(names.get(name, name) for name in self.wheels)
                raise ConfigurationError(
                    f"wheel {names.get(wheel, wheel)}: {self.name} has no such wheel; choose from {has}"
                )

    def require_channels(self, channels: Iterable[str], existing: Sequence[str]) -> None:
        """Check that channels exist.

        Raises:
            ConfigurationError: the first channel that does not exist.
        """
        for name in channels:
            if name not in existing:
                channel_type = "channel" if len(existing) >= len(self.channels) else "acceleration channel"
                raise ConfigurationError(f"no {channel_type} {name!r}{choose_from(name, existing)}")

    @property
    def seated(self) -> bool:
        """True if the output `seat` is on a cushion, not on the body."""
        return any(output.name == "seat" and output.on != "body" for output in self.composition.outputs)

    @property
    def load_channels(self) -> tuple[str, ...]:
        """Names of the forces and travels that are recorded on request, in the order of the files.

        Forces `<connection>_force_<axis>` [N] on the moving part, in the axes of the carrier; `<spring>_force` [N] of
        the main springs, compression positive; `<joint>_torque` [N m] or `<joint>_spring_force` [N] of springs in
        joints, on the child of the joint; `suspension_travel_<wheel>` [m] of the wheel centre against the body,
        upwards from the design position. Parts of a sum: `<damper>_stop_force` of `<damper>_force`, and of
        `tyre_<wheel>_force_x` of a rolling tyre `tyre_<wheel>_slip_force_x` and `tyre_<wheel>_slope_force_x`.
        """
        car, ends = self.composition, {"slide": "spring_force"}
        kinds = {joint.name: joint.kind for part in car.parts for joint in part.joints}
        channels = [f"{link.name}_force_{axis}" for link in car.connections for axis in AXES]
        channels += [f"{link.name}_{term}_force_x" for link in car.connections if link.rolling
                     for term in ("slip", "slope")]  # fmt: skip
        channels += [f"{damper.name}_stop_force" for damper in car.dampers if damper.law.stop]
        channels += [f"{spring.name}_force" for spring in car.springs]
        channels += [f"{spring.joint}_{ends.get(kinds[spring.joint], 'torque')}" for spring in car.joint_springs]
        channels += [f"suspension_travel_{wheel}" for wheel in self.wheels]
        recorded = set(self.channels)
        return tuple(name for name in channels if name not in recorded)

    @property
    def setting_channels(self) -> tuple[str, ...]:
        """Coefficients `<damper>_coefficient` [N s/m] of the controlled dampers, recorded on request."""
        return tuple(
            f"{damper.name}_coefficient" for damper in self.composition.dampers if damper.law.controlled is not None
        )

    @property
    def force_channels(self) -> dict[str, str]:
        """Units of the histories of applied forces and of the crankshaft by channel, recorded on request.

        `force_<name>` [N] or `torque_<name>` [N m] of a force that acts, with its mean; of a crankshaft that turns
        `angle_crank` [rad] from its position at t = 0, and `speed_crank` [1/min].
        """
        forces = self.composition.forces
        units = {force.channel: force.unit for force in forces if force.channel and force.acts}
        crank = {"angle_crank": "rad", "speed_crank": "1/min"} if self.composition.speeds.get(CRANK) else {}
        others = {*self.channels, *self.load_channels}
        return {name: unit for name, unit in (units | crank).items() if name not in others}

    @property
    def requested_channels(self) -> tuple[str, ...]:
        """Names of all channels that are recorded on request alone, in the order of the files."""
        return (*self.load_channels, *self.setting_channels, *self.force_channels)

    @property
    def damper(self) -> Damper:
        """Parameters of the first damper; of all dampers if the file has one table for them.

        Raises:
            ConfigurationError: the car has no damper.
        """
        if not self.composition.dampers:
            raise ConfigurationError(f"{self.name}: has no damper; add a section [front.damper], or use another car")
        return self.composition.dampers[0].law

    def quantity_of(self, path: str) -> Mapping[str, Any]:
        """Return the declaration of a parameter, see `quantity`: unit, meaning, range; empty for a name.

        Args:
            path: whole path of a value or of a component.
        """
        kinds: dict[str, type] = {"body": TrimmedBody, "solver": Solver, "driving": Driving, **self.composition.kinds}
        keys = path.removesuffix(".").split(".")
        # The table ends one, two (component of a vector) or three (mode of the body) keys before the end.
        for at in range(len(keys) - 1, len(keys) - 4, -1):
            sideless = ".".join(key for key in keys[:at] if key not in ("right", "left"))
            if sideless in kinds:
                return field_quantity(kinds[sideless], ".".join(keys[at:]))
        keys_of_point = path.removesuffix(".x").removesuffix(".y").removesuffix(".z").split(".")
        if "hardpoints" in keys_of_point[-2:-1] or (
            keys_of_point[0] in ("outputs", "connection", "load", "force") and keys_of_point[-1] == "at"
        ):
            meaning = self.composition.meanings.get(".".join(keys_of_point), "point of the car")
            return {"unit": "m", "meaning": meaning, "length": len(AXES)}
        return field_quantity(Head, path)


def vehicle_of(table: Mapping[str, Any], folder: Path | None = None) -> Vehicle:
    """Compose and validate a car.

    Args:
        table: vehicle file, see `read_table`.
        folder: folder of the file; user templates are there, or in its folder `templates`.

    Raises:
        ConfigurationError: a name or a value is wrong.
    """
    for key in ("name", "gravity", "body", "solver"):
        if key not in table:
            raise ConfigurationError(f"{key}: missing; every vehicle file needs it")
    table = with_curve_files(table, folder or Path())
    head = build(Head, {key: table[key] for key in HEAD if key in table})
    require_inertia_table(convert(dict, table["body"], "body"))
    body = build(TrimmedBody, table["body"], "body")
    solver = build(Solver, convert(dict, table["solver"], "solver"), "solver")
    folders = () if folder is None else (folder, folder / "templates")
    driving = driving_of(table)
    vehicle = Vehicle(
        table=table,
        **{name: getattr(head, name) for name in HEAD if name != APPLY_FORCES},
        body=body,
        solver=solver,
        driving=driving,
        composition=with_drive_torques(compose(table, folders), driving, body),
    )
    if "shaker_wheel" in table:
        vehicle.require_wheels((head.shaker_wheel,))
    require_plausible(vehicle)
    require_rolling(vehicle)
    return vehicle


def overridden(file: Path, overrides: Iterable[str]) -> dict[str, Any]:
    """Read a vehicle file and replace or add values.

    Raises:
        ConfigurationError: the file or an override is wrong.
    """
    table = vehicle_table(file)
    if "/" in (name := _body_file(table)):
        raise ConfigurationError(
            f"body.superelement: found {name!r}, must be a name of letters, digits, '_', '.', '-'; set a file in "
            f"another folder with --set body.superelement={name}"
        )
    return varied_file(table, overrides, file.parent)


def varied_file(table: Mapping[str, Any], overrides: Iterable[str], folder: Path) -> dict[str, Any]:
    """Return a vehicle file after one variation, see `varied_table`, with the absolute path of a given body model.

    Raises:
        ConfigurationError: an override is wrong.
    """
    texts = list(overrides)
    merged = varied_table(table, texts, lambda: [*optional_paths(table, folder), *new_tables(texts)])
    if "/" in (name := _body_file(merged)):
        model_file = Path(name).expanduser()
        if not model_file.is_absolute():  # workers of a sweep may run elsewhere
            raise ConfigurationError(
                f"--set body.superelement={name}: must be a name of letters, digits, '_', '.', '-', for a file in the "
                f"same folder as the vehicle file or in the package, or an absolute path: {model_file.resolve()}"
            )
        if not model_file.is_file():
            raise ConfigurationError(f"--set body.superelement={name}: the file does not exist, or is a folder")
        merged["body"]["superelement"] = str(model_file)
    return merged


def _body_file(table: Mapping[str, Any]) -> str:
    """Return the file name of the body model in a table that is not checked yet."""
    body = table.get("body")
    name = body.get("superelement") if isinstance(body, Mapping) else None
    return name if isinstance(name, str) else ""


def load_vehicle(path: Path | None = None, overrides: Iterable[str] = ()) -> Vehicle:
    """Read and validate a vehicle file.

    Args:
        path: TOML file, or the name of a shipped car; the Ford-Focus-like car of Bommer 2006 by default.
        overrides: texts "path.to.parameter=value".

    Raises:
        ConfigurationError: the file, a name or a value is wrong.
    """
    return load_file(path, overrides)[1]


def load_file(path: Path | None = None, overrides: Iterable[str] = ()) -> tuple[Mapping[str, Any], Vehicle]:
    """Read and validate a vehicle file; arguments and errors as in `load_vehicle`.

    Returns:
        The file with the overrides, in which `curve` still names files of force laws, and the vehicle.
    """
    file = FOCUS_FILE if path is None else vehicle_file(path)
    try:
        table = overridden(file, overrides)
        return table, vehicle_of(table, file.parent)
    except ConfigurationError as error:
        if path is None:
            raise
        text = error.args[0]
        raise ConfigurationError(text if text.startswith((str(path), "--set")) else f"{path}: {text}") from None
