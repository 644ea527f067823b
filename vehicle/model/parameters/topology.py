"""The elements of a template: parts, joints, connections, springs, dampers, outputs and wheels, by names alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class RolePart:
    """A part: which shape it is drawn with, and the points that it hangs on; their mean is its centre of gravity."""

    shape: str = quantity("-", "role of its shape; none for no shape", default="rod")
    points: tuple[str, ...] = quantity("-", "points that it hangs on")

    def __post_init__(self) -> None:
        validate(self)
        if not self.points:
            raise ConfigurationError("RolePart.points: found none; a part hangs on one point or more")


@dataclass(frozen=True, kw_only=True, slots=True)
class Joint:
    """What holds `child`: free, or on `parent`, fixed or with the freedom of its kind; two of one pair stack.

    Of kind "spin" are a tyre and what turns with it on their hub: fixed where the tyre stands, turning where it rolls.
    """

    kind: str = quantity("-", "kind", choices=("free", "fixed", "ball", "hinge", "slide", "cardan", "spin"))
    child: tuple[str, ...]
    parent: str = "world"
    name: str | None = None
    at: str | None = None
    along: tuple[str, ...] | None = None
    """two points on its axis; of a cardan: of the rod, about whose axis it cannot turn"""
    axis: Point | None = quantity("-", "direction of the axis, right side", length=3, default=None)

    def __post_init__(self) -> None:
        validate(self)
        if self.kind in ("ball", "hinge", "slide", "cardan", "spin") and self.at is None:
            raise ConfigurationError(f"Joint.at: missing; a {self.kind} has a point")
        if self.kind in ("hinge", "slide", "cardan") and (self.along is None) == (self.axis is None):
            raise ConfigurationError(f"Joint.along: a {self.kind} needs two points in along, or its axis, one of them")
        if self.along is not None and (len(self.along) != 2 or self.along[0] == self.along[1]):
            raise ConfigurationError(f"Joint.along: found {list(self.along)}; needed are two different points")
        if self.axis is not None and not any(self.axis):
            raise ConfigurationError(f"Joint.axis: found {list(self.axis)}; an axis has a length above 0")
        if self.kind == "free" and self.parent != "world":
            raise ConfigurationError(f"Joint.parent: found {self.parent!r}; a free part has no parent")
        if not self.child:
            raise ConfigurationError("Joint.child: found none; a joint holds one part or more")


@dataclass(frozen=True, kw_only=True, slots=True)
class Connection:
    """A bushing, or an ideal ball joint that closes a loop: the vehicle gives its numbers at `bushings.<name>`."""

    name: str
    moving: str
    carrier: str
    at: str
    ideal: bool = False
    """an ideal ball joint where the vehicle gives no numbers"""
    ground: bool = False
    """the car stands on it"""
    axes: tuple[str, ...] | None = None
    """two points: x of its law lies along them, y level; by default those of the carrier"""
    least: float = 0.0
    """least stiffness along each axis [N/m] with which the car does not fall"""
    why: str = ""

    def __post_init__(self) -> None:
        if self.axes is not None and (len(self.axes) != 2 or self.axes[0] == self.axes[1]):
            raise ConfigurationError(f"Connection.axes: found {list(self.axes)}; needed are two different points")
        if self.axes is not None and (self.ground or self.carrier == "plate"):
            raise ConfigurationError(
                "Connection.axes: found on the ground, whose axes are those of the car; leave them out"
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class End:
    """One end of a spring or of a damper: a point of a part."""

    part: str
    at: str


@dataclass(frozen=True, kw_only=True, slots=True)
class Spring:
    """A spring between two points, or on a joint; the vehicle gives its numbers at `<name>`."""

    name: str
    lower: End | None = None
    upper: End | None = None
    joint: str | None = None
    shape: str = "coil_spring"
    """role of the shape of one between two points"""

    def __post_init__(self) -> None:
        if (self.lower is None) != (self.upper is None) or (self.lower is None) == (self.joint is None):
            raise ConfigurationError("Spring.lower: needed are lower and upper, or a joint")


@dataclass(frozen=True, kw_only=True, slots=True)
class Damper:
    """A damper on a slide; the vehicle gives its numbers at `<name>`.

    A semi-active one needs its ends: there the sensors of its control sit, on the wheel side and on the body side.
    """

    name: str
    joint: str
    lower: End | None = None
    upper: End | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Output:
    """A place whose acceleration is recorded."""

    name: str
    on: str
    at: str
    first: bool = False
    """of the first instance it has this name alone, in place of an output of the vehicle file"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wheel:
    """The part that rolls, its centre, and the middle of its contact patch: it gets a plate, and corner names."""

    part: str
    center: str
    patch: str


@dataclass(frozen=True, kw_only=True, slots=True)
class Template:
    """A template with all that it uses."""

    file: str
    mirrored: bool
    hardpoints: Mapping[str, str] = field(default_factory=dict)
    ports: Mapping[str, str] = field(default_factory=dict)
    parts: Mapping[str, RolePart] = field(default_factory=dict)
    wheel: Wheel | None = None
    joint: tuple[Joint, ...] = ()
    connection: tuple[Connection, ...] = ()
    spring: tuple[Spring, ...] = ()
    damper: tuple[Damper, ...] = ()
    output: tuple[Output, ...] = ()
    above: tuple[tuple[str, ...], ...] = ()
    """pairs of points, the first of which lies above the second"""
