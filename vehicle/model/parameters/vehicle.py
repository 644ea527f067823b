"""The complete parameter set of a car on its rig: a file with numbers, composed from templates."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.additions import new_loads
from vehicle.model.parameters.base_car import vehicle_table
from vehicle.model.parameters.body import TrimmedBody, require_inertia_table
from vehicle.model.parameters.compose import compose
from vehicle.model.parameters.composition import Composition
from vehicle.model.parameters.curves import with_curve_files
from vehicle.model.parameters.driving import Driving, driving_of, require_rolling
from vehicle.model.parameters.force_elements import Damper
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.optional_keys import optional_paths
from vehicle.model.parameters.plausible import require_plausible
from vehicle.model.parameters.quantity import field_quantity, quantity, validate
from vehicle.model.parameters.shipped import FOCUS_FILE, vehicle_file
from vehicle.model.parameters.toml_file import build, convert
from vehicle.model.parameters.whole_body import varied_table
from vehicle.names import AXES, CORNERS, SIDE_SIGN, acceleration_channels, wheel_channels, wheel_words

FIRST_STEP = 1e-3
"""Step that is tried first where none is given [s]: it does for steel and rubber of a car up to 100 Hz."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Solver:
    """Numerics of the time simulation."""

    record_rate: float = quantity("Hz", "sampling rate of the recorded channels", at_least=125.0, at_most=1e5)
    timestep: float | None = quantity(
        "s", "step of the integration; the largest that answers the car by default", at_least=1e-6, at_most=0.005,
        default=None,
    )  # fmt: skip

    def __post_init__(self) -> None:
        validate(self)

    @property
    def step(self) -> float:
        """The step [s]; where none is given, the one that is tried first."""
        return FIRST_STEP if self.timestep is None else self.timestep


@dataclass(frozen=True, kw_only=True, slots=True)
class Head:
    """What a vehicle file says of the car as a whole."""

    name: str = quantity("-", "name of the car")
    gravity: float = quantity(
        "m/s2", "gravity", at_least=0.0, at_most=30.0, why="9.81 on Earth; 0 leaves the weight out"
    )
    shaker_wheel: str = quantity(
        "-",
        "wheel whose plate a column of displacements without a wheel in its name drives",
        choices=tuple(CORNERS.values()),
        default="fr",
    )
    shaker_wheel_in_source: str = quantity(
        "-",
        "side on which the source of the car says that wheel is",
        choices=("right", "left", "unsaid"),
        default="unsaid",
    )

    def __post_init__(self) -> None:
        validate(self)


HEAD = tuple(Head.__dataclass_fields__)
"""Keys of a vehicle file that stand above all tables."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Vehicle:
    """Everything that defines a car on its rig; SI units, frame of the hardpoints.

    Attributes:
        table: the vehicle file as used, nested tables; two cars with the same one are equal.
        name, gravity: as there; [m/s2].
        shaker_wheel: wheel that a shaker drives where nothing else is said, as "fr".
        shaker_wheel_in_source: its side in the words of the source: "right", "left" or "unsaid".
        body: trimmed body.
        solver: numerics.
        driving: whether its wheels roll.
        composition: everything else, placed and named.
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

    @property
    def points(self) -> Mapping[str, Point]:
        """Hardpoints by name, as "strut_top_fr" [m]."""
        return self.composition.points

    @property
    def wheels(self) -> tuple[str, ...]:
        """Names of the wheels that stand on plates, as "fr"."""
        return tuple(wheel.name for wheel in self.composition.wheels)

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
        """A wheel for captions, by side and by channel, as "driver's left front wheel (fl)".

        Args:
            wheel: its name.
            source: whether to add what the source calls it.
        """
        words = wheel_words(wheel, self.wheels)
        said = self.shaker_wheel_in_source if source and wheel == self.shaker_wheel else "unsaid"
        note = "" if said == "unsaid" else f"'{said} wheel' in the words of the source"
        side = "driver's " if words.split()[0] in SIDE_SIGN else ""
        return f"{side}{words} ({'; '.join(filter(None, (wheel, note)))})"

    def require_wheels(self, wheels: Iterable[str]) -> None:
        """Refuse wheels that the car does not have.

        Args:
            wheels: their names.

        Raises:
            ConfigurationError: naming the first of them.
        """
        for wheel in wheels:
            if wheel not in self.wheels:
                words = {name: f"{name} ({corner})" for corner, name in CORNERS.items()}
                has = ", ".join(words.get(name, name) for name in self.wheels)
                raise ConfigurationError(f"wheel {words.get(wheel, wheel)}: {self.name} does not have it; it has {has}")

    def require_channels(self, channels: Iterable[str], known: Sequence[str]) -> None:
        """Refuse channels that are none of the car.

        Args:
            channels: their names.
            known: those of the car that are asked for.

        Raises:
            ConfigurationError: naming the first of them.
        """
        for name in channels:
            if name not in known:
                what = "channel" if len(known) >= len(self.channels) else "acceleration channel"
                raise ConfigurationError(f"no {what} {name!r}; there are {', '.join(known)}")

    @property
    def seated(self) -> bool:
        """Whether the place `seat` is a cushion: on a part of its own, not a point of the body."""
        return any(output.name == "seat" and output.on != "body" for output in self.composition.outputs)

    @property
    def load_channels(self) -> tuple[str, ...]:
        """Names of the channels that are recorded on request, in the order of the files.

        Forces `<connection>_force_<axis>` [N] on the moving part, in the axes of the carrier; `<spring>_force` [N] of
        the main springs, compression positive; `<joint>_torque` [N m] or `<joint>_spring_force` [N] of springs in
        joints, on the part behind the joint; `suspension_travel_<wheel>` [m] of the wheel centre against the body,
        upwards from the design position.
        """
        own, kinds = (
            self.composition,
            {joint.name: joint.kind for part in self.composition.parts for joint in part.joints},
        )
        ends = {"slide": "spring_force"}
        found = [f"{one.name}_force_{axis}" for one in own.connections for axis in AXES]
        found += [f"{spring.name}_force" for spring in own.springs]
        found += [f"{spring.joint}_{ends.get(kinds[spring.joint], 'torque')}" for spring in own.joint_springs]
        found += [f"suspension_travel_{wheel}" for wheel in self.wheels]
        recorded = set(self.channels)
        return tuple(name for name in found if name not in recorded)

    @property
    def setting_channels(self) -> tuple[str, ...]:
        """Coefficients `<damper>_coefficient` [N s/m] of the controlled dampers, recorded on request."""
        return tuple(f"{one.name}_coefficient" for one in self.composition.dampers if one.law.controlled is not None)

    @property
    def requested_channels(self) -> tuple[str, ...]:
        """Names of all channels that are recorded on request alone, in the order of the files."""
        return (*self.load_channels, *self.setting_channels)

    @property
    def damper(self) -> Damper:
        """Numbers of the first damper, which are those of all where the file gives one table.

        Raises:
            ConfigurationError: the car has none.
        """
        if not self.composition.dampers:
            raise ConfigurationError(f"{self.name}: has no damper")
        return self.composition.dampers[0].law

    def quantity_of(self, path: str) -> Mapping[str, Any]:
        """What is declared of a parameter, as of `quantity`: unit, meaning, range; nothing of a name.

        Args:
            path: whole path, of a value or of a component.
        """
        kinds: dict[str, type] = {"body": TrimmedBody, "solver": Solver, "driving": Driving, **self.composition.kinds}
        keys = path.removesuffix(".").split(".")
        # A component of a vector is one key behind its table, a number of a mode of the body two.
        for place, inner in (
            (".".join(keys[:at]), ".".join(keys[at:])) for at in range(len(keys) - 1, len(keys) - 4, -1)
        ):
            sideless = ".".join(word for word in place.split(".") if word not in ("right", "left"))
            if sideless in kinds:
                return field_quantity(kinds[sideless], inner)
        words = path.removesuffix(".x").removesuffix(".y").removesuffix(".z").split(".")
        if "hardpoints" in words[-2:-1] or (words[0] in ("outputs", "connection", "load") and words[-1] == "at"):
            meaning = self.composition.meanings.get(".".join(words), "point of the car")
            return {"unit": "m", "meaning": meaning, "length": len(AXES)}
        return field_quantity(Head, path)


def vehicle_of(table: Mapping[str, Any], folder: Path | None = None) -> Vehicle:
    """Compose and validate a car.

    Args:
        table: vehicle file, as of `read_table`.
        folder: where it lies; its own templates are there, or in `templates` there.

    Returns:
        The car.

    Raises:
        ConfigurationError: a name or a value is wrong; the message names it.
    """
    for key in ("name", "gravity", "body", "solver"):
        if key not in table:
            raise ConfigurationError(f"{key}: missing; every vehicle file has it")
    table = with_curve_files(table, folder or Path())
    head = build(Head, {key: table[key] for key in HEAD if key in table})
    require_inertia_table(convert(dict, table["body"], "body"))
    body = build(TrimmedBody, table["body"], "body")
    solver = build(Solver, convert(dict, table["solver"], "solver"), "solver")
    folders = () if folder is None else (folder, folder / "templates")
    vehicle = Vehicle(
        table=table,
        name=head.name,
        gravity=head.gravity,
        shaker_wheel=head.shaker_wheel,
        shaker_wheel_in_source=head.shaker_wheel_in_source,
        body=body,
        solver=solver,
        driving=driving_of(table),
        composition=compose(table, folders),
    )
    if "shaker_wheel" in table:
        vehicle.require_wheels((head.shaker_wheel,))
    require_plausible(vehicle)
    require_rolling(vehicle)
    return vehicle


def overridden(file: Path, overrides: Iterable[str]) -> dict[str, Any]:
    """A vehicle file with other values in their places, and optional ones where it has none.

    Args:
        file: TOML file.
        overrides: texts "path.to.parameter=value".

    Raises:
        ConfigurationError: the file or an override is wrong.
    """
    table = vehicle_table(file)
    if "/" in (name := _body_file(table)):
        raise ConfigurationError(
            f"body.superelement: found {name!r}, allowed are names of letters, digits, '_', '.', '-'; a file elsewhere "
            f"is given with --set body.superelement={name}"
        )
    texts = list(overrides)
    found = varied_table(table, texts, lambda: [*optional_paths(table, file.parent), *new_loads(texts)])
    if "/" in (name := _body_file(found)):
        place = Path(name).expanduser()
        if not place.is_absolute():  # workers of a sweep may run elsewhere
            raise ConfigurationError(
                f"--set body.superelement={name}: allowed are names of letters, digits, '_', '.', '-', of a file "
                f"beside the vehicle file or of the package, or a whole path: {place.resolve()}"
            )
        if not place.is_file():
            raise ConfigurationError(f"--set body.superelement={name}: no such file, or not a file")
        found["body"]["superelement"] = str(place)
    return found


def _body_file(table: Mapping[str, Any]) -> str:
    """The file of the body in a table that is not checked yet."""
    body = table.get("body")
    name = body.get("superelement") if isinstance(body, Mapping) else None
    return name if isinstance(name, str) else ""


def load_vehicle(path: Path | None = None, overrides: Iterable[str] = ()) -> Vehicle:
    """Read and validate a vehicle file.

    Args:
        path: TOML file, or the name of a shipped car; the Ford-Focus-like car of Bommer 2006 by default.
        overrides: texts "path.to.parameter=value".

    Returns:
        The parameter set.

    Raises:
        ConfigurationError: the file, a name or a value is wrong; the message names it.
    """
    file = FOCUS_FILE if path is None else vehicle_file(path)
    try:
        return vehicle_of(overridden(file, overrides), file.parent)
    except ConfigurationError as error:
        if path is None:
            raise
        text = str(error)
        raise ConfigurationError(text if text.startswith((str(path), "--set")) else f"{path}: {text}") from None
