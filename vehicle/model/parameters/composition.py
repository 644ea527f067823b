"""The composition of a car: parts, joints, connections, springs, dampers, outputs and wheels, placed, with numbers.

Elements with numbers have a `path`, of the table of their numbers in the vehicle file, and `tables`: the paths of all
tables that hold them, that of the instance and that of one side, which takes precedence. `with_numbers` reads them
again from a file in which only numbers of the element differ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Any, Self, TypeVar

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.driving import RunUp
from vehicle.model.parameters.force_elements import (
    Damper,
    Hydromount,
    LinearBushing,
    MainSpring,
    SlideSpring,
    Stabilizer,
)
from vehicle.model.parameters.force_table import ForceTable
from vehicle.model.parameters.hardpoints import Axes, Point
from vehicle.model.parameters.paths import value_at
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.model.parameters.quantity import type_hints
from vehicle.model.parameters.rigid_part import Load, Part
from vehicle.model.parameters.tested_range import merged_law
from vehicle.model.parameters.toml_file import build
from vehicle.names import AXES

T = TypeVar("T")


Built = dict[tuple[type, tuple[str, ...]], Any]
"""Numbers by their class and their tables: elements on both sides of a car share them."""


def _numbers(parameters: type[T], file: Mapping[str, Any], tables: tuple[str, ...], built: Built) -> T:
    """Build the numbers of an element from its tables in a vehicle file, once for all elements with these tables."""
    key = parameters, tables
    if key not in built:
        merged = reduce(merged_law, (value_at(file, path) for path in tables))
        fields = type_hints(parameters)  # type: ignore[arg-type]
        built[key] = build(parameters, {name: value for name, value in merged.items() if name in fields}, tables[-1])
    numbers: T = built[key]
    return numbers


class _WithLaw:
    """An element whose numbers are one law."""

    __slots__ = ()
    law: Any
    tables: tuple[str, ...]

    def with_numbers(self, file: Mapping[str, Any], built: Built) -> Self:
        """Return the element with the numbers of another vehicle file; `built`: numbers of earlier elements."""
        return replace(self, law=_numbers(type(self.law), file, self.tables, built))  # type: ignore[type-var]


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedJoint:
    """A joint of a part: `kind` free, ball, hinge or slide, at a point [m] and along an axis."""

    name: str
    kind: str
    at: Point = (0.0, 0.0, 0.0)
    axis: Point = (0.0, 0.0, 1.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedPart:
    """A rigid part on its parent.

    Attributes:
        name: name in the model, for example "knuckle_fr".
        parent: name of the part that carries it; "world", or "body" for the trimmed body.
        cog: centre of gravity [m].
        numbers: mass and inertia, of the right side; a `Load` for a load of the vehicle file.
        side: +1, or -1 if the part is mirrored: its products xy and yz change their sign.
        shape: role of its visible shape.
        points: points of other parts on it, by name without the side [m].
        joints: its joints to the parent; none for a fixed part.
        seat: point at which a part is fixed to the trimmed body [m]; None for other parts.
        path, tables: see the module.
        center: mean of the points that define the centre of gravity, without the offset of the numbers [m].
        rod: ends of a part with the inertia of a rod, right side [m]; None for other parts.
    """

    name: str
    parent: str
    cog: Point
    numbers: Part | Load
    side: float
    shape: str
    points: Mapping[str, Point]
    joints: tuple[PlacedJoint, ...]
    seat: Point | None
    path: str
    tables: tuple[str, ...] = field(default=(), compare=False)
    center: Point = field(default=(0.0, 0.0, 0.0), compare=False)
    rod: tuple[Point, Point] | None = field(default=None, compare=False)

    def with_numbers(self, file: Mapping[str, Any], built: Built) -> PlacedPart:
        """Return the part with the numbers of another vehicle file; `built`: numbers of earlier elements."""
        if isinstance(self.numbers, Load):
            return replace(self, numbers=_numbers(Load, file, self.tables, built))
        numbers = _numbers(Part, file, self.tables, built)
        numbers = numbers if self.rod is None else numbers.as_rod(*self.rod)
        return replace(self, numbers=numbers, cog=numbers.cog(self.center, self.side))


@dataclass(frozen=True, kw_only=True, slots=True)
class Rolling:
    """Data of a rolling tyre: speed of the car [m/s], vector from the contact patch to the wheel centre [m]."""

    speed: float
    arm: Point


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedConnection(_WithLaw):
    """A connection of two parts at a point [m].

    Attributes:
        name, moving, carrier: names of the connection and of both parts.
        at: the point [m].
        point: name of the point.
        law: numbers of the force law; None for an ideal ball joint.
        ground: True for a contact with the ground.
        path, tables: see the module.
        axes: axes of the law; None: axes of the carrier.
        rolling: data of a rolling tyre; None for all other connections.
        radius: loaded radius R of a round tyre at rest [m]; 0 for all other connections.
        lowest_stiffness: limit of the template along each axis [N/m].
        reason: reason of that limit.
        mirrored: True if the table along y belongs to the right side, and the connection is on the left.
    """

    name: str
    moving: str
    carrier: str
    at: Point
    point: str
    law: LinearBushing | Hydromount | None
    ground: bool
    path: str
    axes: Axes | None = None
    rolling: Rolling | None = None
    radius: float = 0.0
    tables: tuple[str, ...] = field(default=(), compare=False)
    lowest_stiffness: float = 0.0
    reason: str = ""
    mirrored: bool = False

    def table(self, axis: str) -> ForceTable | None:
        """Return the force over the displacement along an axis of the law; None for a linear axis."""
        table: ForceTable | None = getattr(self.law, f"table_{axis}", None)
        return table.opposite if table is not None and self.mirrored and axis == "y" else table

    def __post_init__(self) -> None:
        for axis, stiffness in zip(AXES, self.law.stiffness if self.law else (), strict=False):
            if stiffness < self.lowest_stiffness:
                raise ConfigurationError(
                    f"{self.path}.stiffness.{axis}: found {stiffness:g} N/m, must be at least "
                    f"{self.lowest_stiffness:g} N/m ({self.reason})"
                )


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedSpring(_WithLaw):
    """A spring between points of two parts; `point`: name of the point on the trimmed body."""

    name: str
    parts: tuple[str, str]
    at: tuple[Point, Point]
    point: str
    law: MainSpring
    path: str
    shape: str
    tables: tuple[str, ...] = field(default=(), compare=False)

    @property
    def stiffness(self) -> float:
        """Stiffness [N/m]; a table replaces it."""
        return self.law.stiffness

    @property
    def table(self) -> ForceTable | None:
        """Force over displacement; None for a linear spring."""
        return self.law.table


@dataclass(frozen=True, kw_only=True, slots=True)
class JointSpring(_WithLaw):
    """A spring on a slide or on a hinge."""

    joint: str
    law: SlideSpring | Stabilizer
    path: str
    tables: tuple[str, ...] = field(default=(), compare=False)

    @property
    def parameter(self) -> str:
        """Name of the stiffness parameter."""
        return "stiffness" if isinstance(self.law, SlideSpring) else "torsional_stiffness"

    @property
    def stiffness(self) -> float:
        """Stiffness [N/m] on a slide, [N m/rad] on a hinge."""
        return self.law.stiffness if isinstance(self.law, SlideSpring) else self.law.torsional_stiffness

    @property
    def damping(self) -> float:
        """Damping [N s/m] on a slide; zero on a hinge."""
        return self.law.damping if isinstance(self.law, SlideSpring) else 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedDamper(_WithLaw):
    """A damper on a slide; for a controlled damper, parts and points [m] of its sensors on wheel and body."""

    name: str
    joint: str
    law: Damper
    path: str
    sensors: tuple[str, ...] = ()
    at: tuple[Point, ...] = ()
    tables: tuple[str, ...] = field(default=(), compare=False)


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedOutput:
    """A measurement point [m] on a part, whose acceleration is recorded."""

    name: str
    on: str
    at: Point
    point: str


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedWheel:
    """Placed wheel with the plate below.

    Attributes:
        name: name of the wheel, for example "fr".
        axle: name of its instance, for example "front".
        side: +1 for a right wheel, -1 for a left wheel.
        part: name of the rolling part.
        plate: name of the plate.
        center: wheel centre [m].
        patch: middle of the contact patch [m].
        paths: paths of both points in the vehicle file.
        steering_axis: part and point [m] of the lower and of the upper end of the steering axis; None for a wheel that
            is not steered.
    """

    name: str
    axle: str
    side: float
    part: str
    plate: str
    center: Point
    patch: Point
    paths: tuple[str, str]
    steering_axis: tuple[tuple[str, Point], tuple[str, Point]] | None = None


WITH_NUMBERS = ("parts", "connections", "springs", "joint_springs", "dampers")
"""Elements of a composition that have numbers."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Composition:
    """All elements of a car other than its trimmed body, in the order of the model.

    Attributes:
        parts, connections, springs, joint_springs, dampers, outputs, wheels, forces: elements, parents before children.
        speeds: angular speed [rad/s] of "crank" and of each wheel, for example "wheel_fr"; 0 at rest.
        crank_run_up: run-up of the crankshaft, whose highest speed is in `speeds`; None at constant speed.
        points: hardpoints by name, for example "strut_top_fr" [m].
        kinds: parameter class of each table of the vehicle file, by its path.
        meanings: meaning of each hardpoint, by its path.
    """

    parts: tuple[PlacedPart, ...] = ()
    connections: tuple[PlacedConnection, ...] = ()
    springs: tuple[PlacedSpring, ...] = ()
    joint_springs: tuple[JointSpring, ...] = ()
    dampers: tuple[PlacedDamper, ...] = ()
    outputs: tuple[PlacedOutput, ...] = ()
    wheels: tuple[PlacedWheel, ...] = ()
    forces: tuple[PlacedForce, ...] = ()
    speeds: Mapping[str, float] = field(default_factory=dict)
    crank_run_up: RunUp | None = None
    points: Mapping[str, Point] = field(default_factory=dict)
    kinds: Mapping[str, type] = field(default_factory=dict)
    meanings: Mapping[str, str] = field(default_factory=dict)

    @property
    def loads(self) -> tuple[PlacedPart, ...]:
        """Parts that are loads of the vehicle file."""
        return tuple(part for part in self.parts if isinstance(part.numbers, Load))

    def with_numbers(self, file: Mapping[str, Any], changed: Mapping[str, None]) -> Composition | None:
        """Return the composition with the numbers of another vehicle file.

        Args:
            file: vehicle file that differs in numbers of the changed tables alone.
            changed: paths of the changed tables.

        Returns:
            The composition; None if an element of a changed table is not covered.

        Raises:
            ConfigurationError: a value is wrong.
        """
        updated: dict[str, Any] = {}
        left, built = set(changed), Built()
        for group in WITH_NUMBERS:
            before: tuple[Any, ...] = getattr(self, group)
            chosen = {element.path for element in before if element.tables and element.path in changed}
            if chosen:
                updated[group] = tuple(
                    element.with_numbers(file, built) if element.path in chosen else element for element in before
                )
                left -= chosen
                # The angle of a wheel and the run-out of its tyre depend on numbers of the tyre.
                if self.forces and any(
                    getattr(element, "rolling", None) for element in before if element.path in chosen
                ):
                    return None
        return None if left else replace(self, **updated)

    def turning(self, name: str | None = None) -> tuple[str, float]:
        """Return name and angular speed [rad/s] of a rotating part or of a force with a frequency.

        Args:
            name: crank, a wheel, or a force with a frequency; by default the angle of the first force.

        Raises:
            ConfigurationError: nothing of this name turns.
        """
        by_force = {force.name: force.speed for force in self.forces if force.law.angle is None}
        speeds = {each: speed for each, speed in {**self.speeds, **by_force}.items() if speed > 0.0}
        first = next((force.law.angle or force.name for force in self.forces if force.harmonics), None)
        chosen = name or first or next(iter(speeds), None)
        if chosen not in speeds:
            missing = "nothing rotates" if chosen is None else f"{chosen} does not rotate"
            message = f"choose from {', '.join(speeds)}" if speeds else "set --speed or crank.rpm"
            raise ConfigurationError(f"angle: {missing}; {message}")
        return chosen, speeds[chosen]

    def attachments(self) -> dict[str, Point]:
        """Return the points [m] of the trimmed body at which a force acts or an output is measured, by name."""
        points = {link.point: link.at for link in self.connections if "body" in (link.moving, link.carrier)}
        points |= {spring.point: spring.at[1] for spring in self.springs if spring.parts[1] == "body"}
        points |= {spring.point: spring.at[0] for spring in self.springs if spring.parts[0] == "body"}
        points |= {
            f"sensor/{damper.name}/{end}": at
            for damper in self.dampers
            for end, (part, at) in enumerate(zip(damper.sensors, damper.at, strict=True))
            if part == "body" and at not in points.values()
        }
        points |= {
            part.name: part.seat for part in self.parts if part.seat is not None and part.seat not in points.values()
        }
        points |= {output.point: output.at for output in self.outputs if output.on == "body"}
        on_body = [force for force in self.forces if "body" in (force.on, force.against)]
        return points | {f"force/{force.name}": force.at for force in on_body if force.at not in points.values()}
