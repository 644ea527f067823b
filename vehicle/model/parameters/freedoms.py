"""Joints of a template as freedoms of a part: where they are and along which axes, on each side."""

from __future__ import annotations

import math

from vehicle.model.parameters.composition import PlacedJoint
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.instance import Instance
from vehicle.model.parameters.topology import Joint
from vehicle.names import SIDE_SIGN


def freedoms(i: Instance, joint: Joint, side: str | None, label: str) -> list[PlacedJoint]:
    """Joints of the model for one of a template: none of a fixed one, two of a Cardan joint.

    A slide is a vector. An axis that a part turns about is a pseudovector: equal coordinates are mirrored motions.

    Args:
        i: instance that the joint is of.
        joint: as of the template.
        side: "right" or "left"; None of what exists once, whose axis is taken as written.
        label: name of the child in the model.
    """
    if joint.kind in ("free", "fixed"):
        return [PlacedJoint(name=label, kind="free")] if joint.kind == "free" else []
    name, at = label if joint.name is None else i.label(joint.name, side), i.point(joint.at or "", side)
    if joint.kind == "ball":
        return [PlacedJoint(name=name, kind="ball", at=at)]
    sign = SIDE_SIGN.get(side or "", 1.0)
    if joint.along is not None:
        start, end = (i.point(ref, side) for ref in joint.along)
        way = (end[0] - start[0], end[1] - start[1], end[2] - start[2])
    else:
        x, y, z = joint.axis or (0.0, 0.0, 1.0)
        way = (x, sign * y, z)
    axis = _unit(way)
    if joint.kind == "slide":
        return [PlacedJoint(name=name, kind="slide", at=at, axis=axis)]
    if joint.kind == "hinge":
        return [PlacedJoint(name=name, kind="hinge", at=at, axis=_times(sign, axis))]
    # Cardan: two hinges square to the rod and to each other, so it cannot turn about its own axis.
    first = _unit(_cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 0.0, 1.0)))
    both = (first, _times(sign, _cross(axis, first)))
    return [PlacedJoint(name=f"{name}_cardan_{n}", kind="hinge", at=at, axis=one) for n, one in enumerate(both, 1)]


def _unit(vector: Point) -> Point:
    length = math.sqrt(sum(x * x for x in vector))
    return (vector[0] / length, vector[1] / length, vector[2] / length)


def _times(factor: float, vector: Point) -> Point:
    return (factor * vector[0], factor * vector[1], factor * vector[2])


def _cross(a: Point, b: Point) -> Point:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
