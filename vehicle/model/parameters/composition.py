"""A car as file and templates compose it: parts, joints, connections, springs, dampers, outputs, wheels, placed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from vehicle.model.parameters.axes import Axes
from vehicle.model.parameters.elements import Bushing, Damper, ForceTable, Hydromount
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.loads import Load
from vehicle.model.parameters.parts import Part


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedJoint:
    """One freedom of a part: `kind` free, ball, hinge or slide, at a point [m] and along an axis."""

    name: str
    kind: str
    at: Point = (0.0, 0.0, 0.0)
    axis: Point = (0.0, 0.0, 1.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedPart:
    """A rigid part on another one; a parent comes before its children.

    Attributes:
        name: as "knuckle_fr".
        parent: name of the part that it is on; "world", or "body" for the trimmed body.
        cog: centre of gravity [m].
        numbers: mass and inertia, as of the right side; of a load on a part, those of the load.
        side: +1, or -1 where it is mirrored: its products xy and yz turn.
        shape: role of its shape.
        points: what it hangs on, by name without the side [m].
        joints: its freedoms; none where it is fixed.
        seat: where a part that is fixed to the trimmed body sits [m], None of others.
        path: of its numbers in the vehicle file.
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


@dataclass(frozen=True, kw_only=True, slots=True)
class Rolling:
    """A tyre that rolls: speed of the car [m/s], wheel centre from the patch [m]."""

    speed: float
    arm: Point


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedConnection:
    """Two parts that meet at a point [m]; `law` None of an ideal ball joint; `path` of its numbers; `axes` of the law,
    by default those of the carrier; `rolling` None of all but tyres that roll."""

    name: str
    moving: str
    carrier: str
    at: Point
    point: str
    law: Bushing | Hydromount | None
    ground: bool
    path: str
    axes: Axes | None = None
    rolling: Rolling | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedSpring:
    """A spring between points of two parts [N/m]; a table takes the place of its stiffness."""

    name: str
    parts: tuple[str, str]
    at: tuple[Point, Point]
    point: str
    stiffness: float
    path: str
    shape: str
    table: ForceTable | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class JointSpring:
    """A spring on a joint: [N/m] and [N s/m] on a slide, [N m/rad] on a hinge; `parameter`: name of its stiffness."""

    joint: str
    stiffness: float
    path: str
    parameter: str
    damping: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedDamper:
    """A damper on a slide; of a controlled one, parts and points [m] of its sensors, on the wheel and on the body."""

    name: str
    joint: str
    law: Damper
    path: str
    sensors: tuple[str, ...] = ()
    at: tuple[Point, ...] = ()


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedOutput:
    """A place on a part [m] whose acceleration is recorded."""

    name: str
    on: str
    at: Point
    point: str


@dataclass(frozen=True, kw_only=True, slots=True)
class PlacedWheel:
    """A wheel on its plate.

    Attributes:
        name: as "fr".
        axle: name of its instance, as "front".
        side: +1 of a right wheel, -1 of a left one.
        part: the part that rolls.
        plate: body under it.
        center: its centre [m].
        patch: middle of its contact patch [m].
        paths: of both points in the vehicle file.
    """

    name: str
    axle: str
    side: float
    part: str
    plate: str
    center: Point
    patch: Point
    paths: tuple[str, str]


class Source(NamedTuple):
    """What an element was made from: `make(instance, entry, side)` makes it again."""

    make: Callable[[Any, Any, str | None], Any]
    instance: Any
    entry: Any
    side: str | None


@dataclass(frozen=True, kw_only=True, slots=True)
class Composition:
    """Everything that a car consists of beside its trimmed body, in the order of the model.

    Attributes:
        parts, connections, springs, joint_springs, dampers, outputs, wheels: as of their classes.
        points: hardpoints by name, as "strut_top_fr" [m].
        kinds: parameter class of each table of the vehicle file, by its path.
        meanings: of each hardpoint, by its path.
        sources: of the elements of instances, by the kind of element, in the order of its first ones.
    """

    parts: tuple[PlacedPart, ...] = ()
    connections: tuple[PlacedConnection, ...] = ()
    springs: tuple[PlacedSpring, ...] = ()
    joint_springs: tuple[JointSpring, ...] = ()
    dampers: tuple[PlacedDamper, ...] = ()
    outputs: tuple[PlacedOutput, ...] = ()
    wheels: tuple[PlacedWheel, ...] = ()
    points: Mapping[str, Point] = field(default_factory=dict)
    kinds: Mapping[str, type] = field(default_factory=dict)
    meanings: Mapping[str, str] = field(default_factory=dict)
    sources: Mapping[str, tuple[Source, ...]] = field(default_factory=dict, compare=False, repr=False)

    @property
    def loads(self) -> tuple[PlacedPart, ...]:
        """Parts that are loads of the vehicle file."""
        return tuple(one for one in self.parts if isinstance(one.numbers, Load))

    def attachments(self) -> dict[str, Point]:
        """Points at which something acts on the trimmed body, or is measured on it, by name [m]."""
        found = {one.point: one.at for one in self.connections if "body" in (one.moving, one.carrier)}
        found |= {one.point: one.at[1] for one in self.springs if one.parts[1] == "body"}
        found |= {one.point: one.at[0] for one in self.springs if one.parts[0] == "body"}
        found |= {
            f"sensor/{one.name}/{end}": at
            for one in self.dampers
            for end, (part, at) in enumerate(zip(one.sensors, one.at, strict=True))
            if part == "body" and at not in found.values()
        }
        found |= {one.name: one.seat for one in self.parts if one.seat is not None and one.seat not in found.values()}
        return found | {one.point: one.at for one in self.outputs if one.on == "body"}
