"""Dampers of a template, placed; a semi-active one with the places of its sensors."""

from __future__ import annotations

from vehicle.errors import ConfigurationError
from vehicle.model.parameters import topology
from vehicle.model.parameters.composition import PlacedDamper
from vehicle.model.parameters.elements import Damper
from vehicle.model.parameters.instance import Instance


def placed_damper(i: Instance, e: topology.Damper, side: str | None) -> PlacedDamper:
    """A damper with its numbers.

    Args:
        i: the instance that it is of.
        e: as the template has it.
        side: "right" or "left"; None of what exists once.

    Raises:
        ConfigurationError: numbers that are missing or wrong, or a control where the template knows no ends.
    """
    law, ends = i.get(Damper, side, e.name), [end for end in (e.lower, e.upper) if end is not None]
    if law.controlled is None:
        ends = []
    elif len(ends) < 2:
        raise ConfigurationError(
            f"{i.name}.{e.name}.control.law: found {law.controlled.law!r}, but {i.template.file} does not say where "
            f"the sensors sit; give its damper {e.name} both ends, lower and upper = {{ part = NAME, at = POINT }}"
        )
    return PlacedDamper(
        name=i.label(e.name, side),
        joint=i.label(e.joint, side),
        law=law,
        path=f"{i.name}.{e.name}",
        sensors=tuple(i.part(end.part, side) for end in ends),
        at=tuple(i.point(end.at, side) for end in ends),
    )
