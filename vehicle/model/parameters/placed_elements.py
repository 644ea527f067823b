"""Connections, springs, dampers, wheels and outputs of the templates, placed on each side with their numbers."""

from collections.abc import Iterator, Mapping, Sequence

from vehicle.errors import ConfigurationError
from vehicle.model.parameters import topology
from vehicle.model.parameters.additions import law_kind
from vehicle.model.parameters.composition import (
    JointSpring,
    PlacedConnection,
    PlacedDamper,
    PlacedOutput,
    PlacedSpring,
    PlacedWheel,
    Rolling,
)
from vehicle.model.parameters.engine_orders import ORDERS, EngineOrders
from vehicle.model.parameters.force_elements import (
    Damper,
    Hydromount,
    LinearBushing,
    MainSpring,
    SlideSpring,
    Stabilizer,
)
from vehicle.model.parameters.hardpoints import axes_along
from vehicle.model.parameters.instance import LEFT, Instance, elements
from vehicle.model.parameters.rigid_part import Part
from vehicle.model.parameters.wheel_forces import WHEEL_FORCES
from vehicle.names import SIDE_SIGN


def element_kinds(car: Mapping[str, Instance]) -> dict[str, type]:
    """Return the parameter class of each table of numbers of the instances, by its path in the vehicle file."""
    kinds: dict[str, type] = {}
    for i in car.values():
        kinds |= {f"{i.name}.parts.{name}": Part for name in i.template.parts}
        for connection in i.template.connection:
            if not connection.ideal or i.has("bushings", connection.name):
                kinds[f"{i.name}.bushings.{connection.name}"] = _law_kind(i, connection)
        kinds |= {f"{i.name}.{damper.name}": Damper for damper in i.template.damper}
        kinds |= {f"{i.name}.{spring.name}": spring_kind(i.template, spring) for spring in i.template.spring}
        kinds |= {f"{i.name}.{name}": kind for name, kind in WHEEL_FORCES.items() if i.has(name)}
        kinds |= {f"{i.name}.{ORDERS}": EngineOrders} if i.has(ORDERS) else {}
    return kinds


def placed_wheels(car: Mapping[str, Instance]) -> Iterator[PlacedWheel]:
    """Yield the wheels of all axles, the right wheel first."""
    for i in car.values():
        if (wheel := i.template.wheel) is None:
            continue
        axis = i.template.steering_axis
        for side, sign in SIDE_SIGN.items():
            yield PlacedWheel(
                name=i.label("", side)[1:],
                axle=i.name,
                side=sign,
                part=i.part(wheel.part, side),
                plate=i.part("plate", side),
                center=i.point(wheel.center, side),
                patch=i.point(wheel.patch, side),
                paths=(f"{i.name}.hardpoints.{wheel.center}", f"{i.name}.hardpoints.{wheel.patch}"),
                steering_axis=None
                if axis is None
                else (
                    (i.part(axis.lower.part, side), i.point(axis.lower.at, side)),
                    (i.part(axis.upper.part, side), i.point(axis.upper.at, side)),
                ),
            )


def placed_connections(car: Mapping[str, Instance]) -> list[PlacedConnection]:
    """Return the connections of all instances: those with a law first, of these the right ones before the left ones.

    Raises:
        ConfigurationError: numbers that are missing or wrong, or a stiffness below the limit of the template.
    """
    listed = sorted(elements(car, "connection"), key=lambda element: _side_order(element[2]))
    return sorted((_connection(*element) for element in listed), key=lambda connection: connection.law is None)


def _side_order(side: str | None) -> int:
    """Return the sort key of a side: right, left, None."""
    return [*SIDE_SIGN, None].index(side)


def _connection(i: Instance, e: topology.Connection, side: str | None) -> PlacedConnection:
    """Return a connection; its law is None for an ideal ball joint."""
    has_law = not e.ideal or i.has("bushings", e.name)
    law = i.get(_law_kind(i, e), side, "bushings", e.name) if has_law else None
    rolling = _rolling(i, side) if e.carrier == "plate" else None
    left_values = i.numbers.get(LEFT, {}).get("bushings", {}).get(e.name, {})
    return PlacedConnection(
        name=i.label(e.name, side),
        moving=i.part(e.moving, side),
        carrier=i.part(e.carrier, side),
        at=i.point(e.at, side),
        point=i.point_name(e.at, side),
        law=law,
        ground=e.ground or e.carrier == "plate",
        path=f"{i.name}.bushings.{e.name}",
        axes=None if e.axes is None else axes_along(i.point(e.axes[0], side), i.point(e.axes[1], side)),
        rolling=rolling if i.driving.rolling else None,
        radius=rolling.arm[2] if rolling and not i.driving.rolling and getattr(law, "round", False) else 0.0,
        tables=i.table_paths(side, "bushings", e.name) if has_law else (),
        lowest_stiffness=e.least,
        reason=e.why,
        mirrored=side == LEFT and "table_y" not in left_values,
    )


def _rolling(i: Instance, side: str | None) -> Rolling | None:
    """Return the speed and the arm of a rolling tyre; None for a template without a wheel."""
    wheel = i.template.wheel
    if wheel is None:
        return None
    low, high = i.point(wheel.patch, side), i.point(wheel.center, side)
    arm = (high[0] - low[0], high[1] - low[1], high[2] - low[2])
    return Rolling(speed=i.driving.speed, arm=arm)


def _law_kind(i: Instance, e: topology.Connection) -> type[LinearBushing] | type[Hydromount]:
    return law_kind(i.numbers.get("bushings", {}).get(e.name, {}), plate=e.carrier == "plate")


def spring_kind(
    template: topology.Template, spring: topology.Spring
) -> type[MainSpring] | type[SlideSpring] | type[Stabilizer]:
    """Return the parameter class of a spring of a template: between two points, on a slide or on a hinge."""
    if spring.joint is None:
        return MainSpring
    slides = any(joint.kind == "slide" for joint in template.joint if joint.name == spring.joint)
    return SlideSpring if slides else Stabilizer


def placed_springs(car: Mapping[str, Instance]) -> tuple[list[PlacedSpring], list[JointSpring]]:
    """Return the springs of all instances: those between two points, and those on joints.

    Raises:
        ConfigurationError: numbers that are missing or wrong.
    """
    between, on_joints = list[PlacedSpring](), list[JointSpring]()
    for i, e, side in elements(car, "spring"):
        law, tables = i.get(spring_kind(i.template, e), side, e.name), i.table_paths(side, e.name)
        path = f"{i.name}.{e.name}"
        if isinstance(law, MainSpring):
            between.append(
                PlacedSpring(
                    name=i.label(e.name, side),
                    parts=(i.part(e.lower.part, side), i.part(e.upper.part, side)),
                    at=(i.point(e.lower.at, side), i.point(e.upper.at, side)),
                    point=next((i.point_name(end.at, side) for end in (e.lower, e.upper) if end.part == "body"), ""),
                    law=law,
                    path=path,
                    shape=e.shape,
                    tables=tables,
                )
            )
        else:
            on_joints.append(JointSpring(joint=i.label(e.joint or "", side), law=law, path=path, tables=tables))
    return between, on_joints


def placed_dampers(car: Mapping[str, Instance]) -> list[PlacedDamper]:
    """Return the dampers of all instances; a controlled damper with the positions of its sensors.

    Raises:
        ConfigurationError: numbers that are missing or wrong, or a control where the template has no ends.
    """
    return [_damper(*element) for element in elements(car, "damper")]


def _damper(i: Instance, e: topology.Damper, side: str | None) -> PlacedDamper:
    """Return a damper; its ends are the positions of the sensors if the damper is controlled."""
    law, ends = i.get(Damper, side, e.name), [end for end in (e.lower, e.upper) if end is not None]
    if law.controlled is None:
        ends = []
    elif len(ends) < 2:
        raise ConfigurationError(
            f"{i.name}.{e.name}.control.law: found {law.controlled.law!r}, but {i.template.file} does not state "
            f"where its sensors are; set both ends of its damper {e.name}: lower and upper = {{ part = NAME, at "
            f"= POINT }}"
        )
    return PlacedDamper(
        name=i.label(e.name, side),
        joint=i.label(e.joint, side),
        law=law,
        path=f"{i.name}.{e.name}",
        sensors=tuple(i.part(end.part, side) for end in ends),
        at=tuple(i.point(end.at, side) for end in ends),
        tables=i.table_paths(side, e.name),
    )


def placed_outputs(car: Mapping[str, Instance], further: Sequence[PlacedOutput]) -> list[PlacedOutput]:
    """Return the outputs of the instances, then of the vehicle file.

    An output marked `first` keeps its plain name in the first instance, where it takes precedence over an output of
    the vehicle file.
    """
    outputs, firsts = list[PlacedOutput](), set[str]()
    for instance in car.values():
        listed = sorted(elements({instance.name: instance}, "output"), key=lambda element: _side_order(element[2]))
        for i, e, side in listed:
            name = e.name if e.first and e.name not in firsts else i.label(e.name, side)
            firsts |= {e.name} if e.first else set()
            on, at = i.part(e.on, side), i.point(e.at, side)
            outputs.append(PlacedOutput(name=name, on=on, at=at, point=i.point_name(e.at, side)))
    return [*outputs, *(output for output in further if output.name not in firsts)]
