"""Parts of the templates with their joints, placed on each side; a parent comes before its children."""

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.composition import PlacedJoint, PlacedPart
from vehicle.model.parameters.hardpoints import Point, cross, mirrored
from vehicle.model.parameters.instance import Instance, elements
from vehicle.model.parameters.rigid_part import Part
from vehicle.model.parameters.topology import Joint
from vehicle.names import SIDE_SIGN
from vehicle.wording import did_you_mean


@dataclass(slots=True)
class _Held:
    """A part of an instance, its parent, and the joints between them with their sides."""

    instance: Instance
    name: str
    side: str | None
    parent: str
    joints: list[tuple[Joint, str | None]] = field(default_factory=list)


def placed_parts(car: Mapping[str, Instance]) -> list[PlacedPart]:
    """Return the parts of all instances; a parent comes before its children.

    Raises:
        ConfigurationError: a part without a joint, with two parents or in a loop of joints; a joint that would ignore
            the body flexibility; numbers that are missing or wrong.
    """
    held = _held_parts(car)
    return [_placed_part(label, held[label]) for label in _parents_first(held)]


def _held_parts(car: Mapping[str, Instance]) -> dict[str, _Held]:
    """Return the parts of all joints by their names in the model; raise if a part has none, or two parents."""
    held: dict[str, _Held] = {}
    for i, joint, side in elements(car, "joint"):
        for child in joint.child:
            name, _, child_side = child.partition(":")
            label, parent = i.part(child, side), i.part(joint.parent, side)
            where = f"{i.template.file}: joint of {child}"
            if name not in i.template.parts:
                raise ConfigurationError(f"{where}: is not a part of this template; name one of its parts")
            if parent == "body" and (joint.kind != "fixed" or joint.at is None):
                raise ConfigurationError(
                    f"{where}: a part on the trimmed body must be fixed, with a point in at; for a moving part use "
                    'kind = "free" and a connection, which includes the modes of the body'
                )
            part = held.setdefault(label, _Held(i, name, child_side or side, parent))
            if part.parent != parent:
                raise ConfigurationError(
                    f"{where}: the part already has the parent {part.parent}; to close a loop, use a connection"
                )
            part.joints.append((joint, side))
            if len(part.joints) > 1 and {"free", "fixed"} & {other.kind for other, _ in part.joints}:
                raise ConfigurationError(
                    f"{where}: the part already has a joint of kind {part.joints[0][0].kind}; remove this joint"
                )
    for i in car.values():
        for name, side in itertools.product(i.template.parts, i.sides()):
            if (side is not None or not i.template.mirrored) and i.label(name, side) not in held:
                raise ConfigurationError(
                    f"{i.template.file}: parts.{name}: {i.label(name, side)} has no joint; {_remedy(i, name)}"
                )
    return held


def _remedy(i: Instance, name: str) -> str:
    """Return what gives a part of one side the joint that it lacks."""
    refs = [
        (joint.parent, *joint.child)
        for joint in i.template.joint
        if any(child.partition(":")[0] == name for child in joint.child)
    ]
    if sided := next((ref for ref in itertools.chain.from_iterable(refs) if ":" in ref), ""):
        half = sided.partition(":")[0]
        return (
            f"its joint names a side ({sided}), so the part exists only once. Leave the side out: a one-piece axle "
            "consists "
            f'of two halves {half}, joined by {{ kind = "fixed", child = "{half}:right", parent = "{half}:left" }}'
        )
    return 'add a joint, or set kind = "free" and add connections'


def _parents_first(held: Mapping[str, _Held]) -> list[str]:
    """Return the names of the parts, parents before children; raise for a part on a bracket, or in a loop."""
    children: dict[str, list[str]] = {}
    for label, part in held.items():
        children.setdefault(part.parent, []).append(label)
    for bracket in children.get("body", []):
        for label in children.get(bracket, []):
            raise ConfigurationError(
                f"{held[label].instance.template.file}: joint of {label}: {bracket} is fixed to the trimmed body; a "
                "joint on it would ignore the body flexibility; use a connection instead"
            )
    order = [*children.get("body", []), *children.get("world", [])]
    for label in order:
        order[order.index(label) + 1 : order.index(label) + 1] = children.get(label, [])
    if loose := [label for label in held if label not in order]:
        raise ConfigurationError(
            f"{held[loose[0]].instance.template.file}: joints of {', '.join(loose)} form a loop without a free part; "
            "replace one of them by a connection"
        )
    return order


def _placed_part(label: str, part: _Held) -> PlacedPart:
    """Return a part with its numbers, points and joints; a part without inertia becomes a rod."""
    i, name, side = part.instance, part.name, part.side
    template, sign = i.template.parts[name], SIDE_SIGN.get(side or "", 1.0)
    numbers, rod = i.get(Part, side, "parts", name), None
    if numbers.inertia is None:
        if len(template.points) < 2:
            raise ConfigurationError(
                f"{i.name}.parts.{name}.inertia: missing; only a rod between two points needs none"
            )
        start, end = (mirrored(i.point(point, side), sign) for point in template.points[:2])
        rod = (start, end)
        numbers = numbers.as_rod(start, end)
    center = _mean_point(i, name, side, template.points if numbers.between is None else numbers.between)
    first, first_side = part.joints[0]
    return PlacedPart(
        name=label,
        parent=part.parent,
        cog=numbers.cog(center, sign),
        numbers=numbers,
        side=sign,
        shape=template.shape,
        points={point: i.point(point, side) for point in template.points},
        joints=tuple(
            itertools.chain.from_iterable(_placed_joints(i, joint, where, label) for joint, where in part.joints)
        ),
        seat=i.point(first.at or "", first_side) if part.parent == "body" else None,
        path=f"{i.name}.parts.{name}",
        tables=i.table_paths(side, "parts", name),
        center=center,
        rod=rod,
    )


def _mean_point(i: Instance, name: str, side: str | None, points: tuple[str, ...]) -> Point:
    """Return the mean of points of a part [m]; raise for a name that the template does not have."""
    for point in points:
        if point not in i.template.hardpoints:
            near = did_you_mean(point, i.template.hardpoints)
            raise ConfigurationError(f"{i.name}.parts.{name}.between: unknown hardpoint {point!r}{near}")
    chosen = [i.point(point, side) for point in points]
    x, y, z = (sum(axis) / len(chosen) for axis in zip(*chosen, strict=True))
    return (x, y, z)


def _placed_joints(i: Instance, joint: Joint, side: str | None, label: str) -> Iterator[PlacedJoint]:
    """Yield the joints of the model for a joint of a template: none for a fixed joint, two hinges for a Cardan joint.

    The axis of a slide is a vector. The axis of a hinge is a pseudovector: equal coordinates are mirrored motions.
    """
    if joint.kind in ("free", "fixed"):
        if joint.kind == "free":
            yield PlacedJoint(name=label, kind="free")
        return
    name, at = label if joint.name is None else i.label(joint.name, side), i.point(joint.at or "", side)
    if joint.kind == "ball":
        yield PlacedJoint(name=name, kind="ball", at=at)
        return
    sign = SIDE_SIGN.get(side or "", 1.0)
    if joint.along is not None:
        start, end = (i.point(ref, side) for ref in joint.along)
        direction = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    else:
        x, y, z = joint.axis or (0.0, 0.0, 1.0)
        direction = (x, sign * y, z)
    axis = _unit(direction)
    if joint.kind == "slide":
        yield PlacedJoint(name=name, kind="slide", at=at, axis=axis)
    elif joint.kind == "hinge":
        yield PlacedJoint(name=name, kind="hinge", at=at, axis=_times(sign, axis))
    else:
        # Cardan: two hinges perpendicular to the rod and to each other, so the rod cannot turn about its own axis.
        first = _unit(cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 0.0, 1.0)))
        yield PlacedJoint(name=f"{name}_cardan_1", kind="hinge", at=at, axis=first)
        yield PlacedJoint(name=f"{name}_cardan_2", kind="hinge", at=at, axis=_times(sign, cross(axis, first)))


def _unit(vector: Point) -> Point:
    length = math.sqrt(sum(x * x for x in vector))
    return (vector[0] / length, vector[1] / length, vector[2] / length)


def _times(factor: float, vector: Point) -> Point:
    return (factor * vector[0], factor * vector[1], factor * vector[2])
