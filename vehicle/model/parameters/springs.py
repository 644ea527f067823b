"""Springs of a template, placed: between two points, or on a joint."""

from __future__ import annotations

from vehicle.model.parameters.composition import JointSpring, PlacedSpring
from vehicle.model.parameters.elements import MainSpring, SlideSpring, Stabilizer
from vehicle.model.parameters.instance import Instance
from vehicle.model.parameters.topology import Spring


def spring_kind(i: Instance, spring: Spring) -> type[MainSpring] | type[SlideSpring] | type[Stabilizer]:
    """Class of the numbers of a spring: between points, on a slide, on a hinge."""
    if spring.joint is None:
        return MainSpring
    slides = any(joint.kind == "slide" for joint in i.template.joint if joint.name == spring.joint)
    return SlideSpring if slides else Stabilizer


def placed_spring(i: Instance, spring: Spring, side: str | None) -> PlacedSpring | JointSpring:
    """A spring of an instance.

    Args:
        i: the instance.
        spring: as of its template.
        side: "right" or "left"; None of what exists once.

    Raises:
        ConfigurationError: its numbers are missing or wrong.
    """
    path, numbers = f"{i.name}.{spring.name}", i.get(spring_kind(i, spring), side, spring.name)
    if spring.lower is not None and spring.upper is not None and isinstance(numbers, MainSpring):
        ends = (spring.lower, spring.upper)
        return PlacedSpring(
            name=i.label(spring.name, side),
            parts=(i.part(spring.lower.part, side), i.part(spring.upper.part, side)),
            at=(i.point(spring.lower.at, side), i.point(spring.upper.at, side)),
            point=next((i.point_name(end.at, side) for end in ends if end.part == "body"), ""),
            stiffness=numbers.stiffness,
            table=numbers.table,
            path=path,
            shape=spring.shape,
        )
    joint = i.label(spring.joint or "", side)
    if isinstance(numbers, Stabilizer):
        stiffness = numbers.torsional_stiffness
        return JointSpring(joint=joint, stiffness=stiffness, path=path, parameter="torsional_stiffness")
    damping = numbers.damping if isinstance(numbers, SlideSpring) else 0.0
    return JointSpring(joint=joint, stiffness=numbers.stiffness, damping=damping, path=path, parameter="stiffness")
