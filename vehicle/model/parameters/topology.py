"""Elements of a template: parts, joints, connections, springs, dampers, outputs and wheels, without numbers."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.quantity import quantity, validate


@dataclass(frozen=True, kw_only=True, slots=True)
class RolePart:
    """Part of a template: role of its visible shape, and its points, whose mean is the centre of gravity."""

    shape: str = quantity("-", "role of the part in drawings, or 'none' to leave it out", default="rod")
    points: tuple[str, ...] = quantity("-", "points of the part")

    def __post_init__(self) -> None:
        validate(self)
        if not self.points:
            raise ConfigurationError("RolePart.points: empty; a part needs at least one point")


@dataclass(frozen=True, kw_only=True, slots=True)
class Joint:
    """Joint between `child` and `parent`; several joints of one pair are in series.

    Kind "free" leaves six degrees of freedom. Kind "spin" connects a tyre, and parts that turn with it, to the hub:
    fixed if the tyre is at rest, a hinge if it rolls.
    """

    kind: str = quantity("-", "kind", choices=("free", "fixed", "ball", "hinge", "slide", "cardan", "spin"))
    child: tuple[str, ...]
    parent: str = "world"
    name: str | None = None
    at: str | None = None
    along: tuple[str, ...] | None = None
    """two points on the axis; for a cardan joint, two points of the rod, which cannot turn about its axis"""
    axis: Point | None = quantity("-", "direction of the axis, right side", length=3, default=None)

    def __post_init__(self) -> None:
        validate(self)
        if self.kind in ("ball", "hinge", "slide", "cardan", "spin") and self.at is None:
            raise ConfigurationError(f"Joint.at: missing; a joint of kind {self.kind} needs a point")
        if self.kind in ("hinge", "slide", "cardan") and (self.along is None) == (self.axis is None):
            raise ConfigurationError(
                f"Joint.along: a joint of kind {self.kind} needs either two points in along, or axis"
            )
        if self.along is not None and (len(self.along) != 2 or self.along[0] == self.along[1]):
            raise ConfigurationError(f"Joint.along: must be two different points, not {list(self.along)}")
        if self.axis is not None and not any(self.axis):
            raise ConfigurationError("Joint.axis: must not be a zero vector")
        if self.kind == "free" and self.parent != "world":
            raise ConfigurationError(f"Joint.parent: found {self.parent!r}, but a free part has no parent; remove it")
        if not self.child:
            raise ConfigurationError("Joint.child: empty; a joint needs at least one part")


@dataclass(frozen=True, kw_only=True, slots=True)
class Connection:
    """Bushing, or ideal ball joint that closes a loop; the vehicle file has its numbers at `bushings.<name>`."""

    name: str
    moving: str
    carrier: str
    at: str
    ideal: bool = False
    """ideal ball joint if the vehicle file has no numbers"""
    ground: bool = False
    """contact of the car with the ground"""
    axes: tuple[str, ...] | None = None
    """two points on the x axis of the law, y horizontal; by default the axes of the carrier"""
    least: float = 0.0
    """minimum stiffness along each axis [N/m] that supports the car"""
    why: str = ""

    def __post_init__(self) -> None:
        if self.axes is not None and (len(self.axes) != 2 or self.axes[0] == self.axes[1]):
            raise ConfigurationError(f"Connection.axes: must be two different points, not {list(self.axes)}")
        if self.axes is not None and (self.ground or self.carrier == "plate"):
            raise ConfigurationError(
                "Connection.axes: given for a contact with the ground, which uses the axes of the car; remove them"
            )


@dataclass(frozen=True, kw_only=True, slots=True)
class End:
    """End of a spring or of a damper: a point of a part."""

    part: str
    at: str


@dataclass(frozen=True, kw_only=True, slots=True)
class Spring:
    """Spring between two points, or on a joint; the vehicle file has its numbers at `<name>`."""

    name: str
    lower: End | None = None
    upper: End | None = None
    joint: str | None = None
    shape: str = "coil_spring"
    """role of the shape of one between two points"""

    def __post_init__(self) -> None:
        if (self.lower is None) != (self.upper is None) or (self.lower is None) == (self.joint is None):
            raise ConfigurationError("Spring.lower: a spring needs lower and upper, or a joint")


@dataclass(frozen=True, kw_only=True, slots=True)
class Damper:
    """Damper on a slide; the vehicle file has its numbers at `<name>`.

    A semi-active damper needs its ends, on the wheel side and on the body side: the positions of its sensors.
    """

    name: str
    joint: str
    lower: End | None = None
    upper: End | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Output:
    """Point whose acceleration is recorded."""

    name: str
    on: str
    at: str
    first: bool = False
    """in the first instance it keeps its plain name and replaces an output of the vehicle file"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wheel:
    """Wheel of a template: rolling part, wheel centre and middle of the contact patch. It has a plate below."""

    part: str
    center: str
    patch: str


@dataclass(frozen=True, kw_only=True, slots=True)
class SteeringAxis:
    """Steering axis of a wheel: the line through two points about which the wheel turns when it is steered."""

    lower: End
    upper: End


@dataclass(frozen=True, kw_only=True, slots=True)
class Template:
    """Template, merged with the included templates."""

    file: str
    mirrored: bool
    hardpoints: Mapping[str, str] = field(default_factory=dict)
    ports: Mapping[str, str] = field(default_factory=dict)
    port_defaults: Mapping[str, str] = field(default_factory=dict)
    """parts that ports stand for if the vehicle file does not bind them"""
    parts: Mapping[str, RolePart] = field(default_factory=dict)
    wheel: Wheel | None = None
    steering_axis: SteeringAxis | None = None
    joint: tuple[Joint, ...] = ()
    connection: tuple[Connection, ...] = ()
    spring: tuple[Spring, ...] = ()
    damper: tuple[Damper, ...] = ()
    output: tuple[Output, ...] = ()
    above: tuple[tuple[str, ...], ...] = ()
    """pairs of points, the first above the second"""
