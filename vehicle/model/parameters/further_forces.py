"""Placement of the forces of a vehicle file: on parts, on joints, of turning wheels and engines."""

import cmath
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from vehicle.errors import ConfigurationError, VehicleError
from vehicle.model.parameters.additions import named_part, named_point, new_loads
from vehicle.model.parameters.applied_force import CRANK, AppliedForce, require_harmonics
from vehicle.model.parameters.composition import PlacedConnection, PlacedPart, PlacedWheel
from vehicle.model.parameters.driving import SPIN, Crank, RunUp
from vehicle.model.parameters.engine_orders import ENGINE, ORDERS, EngineOrders
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.instance import Instance
from vehicle.model.parameters.placed_force import NONE, PlacedForce
from vehicle.model.parameters.quantity import NAME_PATTERN
from vehicle.model.parameters.toml_file import build, convert
from vehicle.wording import did_you_mean

PLACE_KEYS = ("on", "at", "force", "moment", "axes", "against", "joint")
"""Keys of a force that place it; the others describe its history."""

AXES_OF = ("vehicle", "part")
"""Axes of the direction of a force: those of the vehicle, or of the part that it acts on, which turn with it."""

LARGEST_TORQUE = 5000.0
"""Largest moment or torque of a force of the vehicle file [N m]."""

NEGLIGIBLE, SMALLEST = 1e-6, 1e-6
"""Share of the largest harmonic of an engine below which a harmonic is rounding, and amplitude [N or N m] likewise."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ForceTargets:
    """Parts, points, joints and angles that a force of the vehicle file can name.

    Attributes:
        parts: parts of the car and the trimmed body, with their centres of gravity [m].
        points: hardpoints by name [m].
        joints: kind of each hinge and slide by its name.
        spinning: parts that turn with a rolling wheel.
        speeds: angular speed [rad/s] of each angle: crank, and each wheel, for example "wheel_fr"; 0 at rest.
        run_up: run-up of the crankshaft, whose highest speed is in `speeds`; None at constant speed.
    """

    parts: Mapping[str, Point]
    points: Mapping[str, Point]
    joints: Mapping[str, str]
    spinning: frozenset[str]
    speeds: Mapping[str, float]
    run_up: RunUp | None = None


def force_targets(
    parts: Iterable[PlacedPart],
    points: Mapping[str, Point],
    wheels: Iterable[PlacedWheel],
    connections: Iterable[PlacedConnection],
    crank: Crank | None,
    body: Point,
) -> ForceTargets:
    """Return what a force can refer to.

    Args:
        parts, wheels, connections: elements of the car.
        points: its hardpoints by name [m].
        crank: speed of the crankshaft; None at rest.
        body: centre of gravity of the trimmed body [m].
    """
    listed = list(parts)
    speeds = {CRANK: 0.0 if crank is None else crank.highest} | {f"wheel_{wheel.name}": 0.0 for wheel in wheels}
    for tyre in connections:
        if tyre.rolling is not None:
            radius = getattr(tyre.law, "rolling_radius", None) or tyre.rolling.arm[2]
            speeds[tyre.carrier.replace("plate_", "wheel_", 1)] = tyre.rolling.speed / radius
    joints = {joint.name: joint.kind for part in listed for joint in part.joints if joint.kind in ("hinge", "slide")}
    return ForceTargets(
        parts={"body": body, **{part.name: part.cog for part in listed}},
        points=points,
        joints=joints,
        spinning=frozenset(part.name for part in listed if any(joint.name.startswith(SPIN) for joint in part.joints)),
        speeds=speeds,
        run_up=None if crank is None else crank.run_up,
    )


def new_tables(overrides: Iterable[str]) -> list[str]:
    """Return the paths of overrides that set keys of a load or of a force, which are optional in a vehicle file."""
    keys = "|".join((*PLACE_KEYS, *AppliedForce.__dataclass_fields__))
    texts = list(overrides)
    names = [text.partition("=")[0].strip() for text in texts]
    new = re.compile(rf"force\.[A-Za-z0-9_-]+\.({keys})|outputs\.[A-Za-z0-9_-]+\.(on|at)")
    return new_loads(texts) + [name for name in names if new.fullmatch(name)]


def further_force(name: str, value: Any, targets: ForceTargets) -> PlacedForce:
    """Return a force that the vehicle file adds.

    Raises:
        ConfigurationError: a name that does not exist, or a wrong value.
    """
    path = f"force.{name}"
    table = convert(dict, value, path)
    if not NAME_PATTERN.fullmatch(name):
        raise ConfigurationError(f"{path}: found {name!r}, must consist of letters, digits, '_', '.', '-'")
    law = build(AppliedForce, {key: inner for key, inner in table.items() if key not in PLACE_KEYS}, path)
    if law.angle is not None and law.angle not in targets.speeds:
        near = did_you_mean(law.angle, targets.speeds)
        raise ConfigurationError(f"{path}.angle: unknown angle {law.angle!r}{near}")
    speed = 2.0 * math.pi * law.frequency if law.frequency else targets.speeds.get(law.angle or "", 0.0)
    require_harmonics(f"{path}.harmonics", law.harmonics, of_wheel=law.angle not in (None, CRANK))
    if "joint" in table:
        return _torque(path, table, targets, law, speed)
    directions = [key for key in ("force", "moment") if key in table]
    if len(directions) != 1:
        number = "both" if directions else "neither"
        raise ConfigurationError(f"{path}: found {number} of force and moment; set the direction of one of them")
    direction = _direction(f"{path}.{directions[0]}", table[directions[0]])
    if directions == ["moment"]:
        _require_torque(path, law)
    axes = convert(str, table.get("axes", AXES_OF[0]), f"{path}.axes")
    if axes not in AXES_OF:
        raise ConfigurationError(f"{path}.axes: must be one of {', '.join(AXES_OF)}, not {axes!r}")
    on = named_part(path, table, "on", {*targets.parts})
    if axes == "part" and on in targets.spinning:
        raise ConfigurationError(
            f"{path}.axes: found 'part' on {on}, which turns with the wheel; instead set two forces along "
            "axes of the vehicle, with harmonics of the wheel angle, like an imbalance"
        )
    against = named_part(path, table, "against", {*targets.parts}) if "against" in table else ""
    if against == on:
        raise ConfigurationError(
            f"{path}.against: found {against!r}, the part that the force acts on; name another part"
        )
    at = named_point(path, table, targets.points)[0] if "at" in table else targets.parts[on]
    return PlacedForce(
        name=name,
        on=on,
        at=at,
        force=direction if directions == ["force"] else NONE,
        moment=direction if directions == ["moment"] else NONE,
        against=against,
        law=law,
        speed=speed,
        path=path,
        unit="N" if directions == ["force"] else "N m",
        follows=axes == AXES_OF[1],
        run_up=targets.run_up if law.angle == CRANK else None,
    )


def _require_torque(path: str, law: AppliedForce) -> None:
    """Check that a moment or a torque is plausible for a car.

    Raises:
        ConfigurationError: its mean, or an amplitude of its harmonics, is above `LARGEST_TORQUE`.
    """
    amplitudes = [abs(law.factor) * amplitude for _, amplitude, _ in law.harmonics]
    largest = max([abs(law.mean), *amplitudes])
    if largest > LARGEST_TORQUE:
        key = "mean" if largest == abs(law.mean) else "harmonics"
        raise ConfigurationError(
            f"{path}.{key}: found {largest:g} N m, must be at most {LARGEST_TORQUE:g} N m (a block gets up to 1000 N m "
            "from its pistons); give N m, not N mm"
        )


def _torque(path: str, table: Mapping[str, Any], targets: ForceTargets, law: AppliedForce, speed: float) -> PlacedForce:
    """Return the torque of a table on a joint."""
    for key in ("on", "at", "force", "moment", "axes", "against"):
        if key in table:
            raise ConfigurationError(f"{path}.{key}: found with joint, whose torque has no {key}; remove one of them")
    joint = convert(str, table["joint"], f"{path}.joint")
    if joint not in targets.joints:
        near = did_you_mean(joint, targets.joints)
        raise ConfigurationError(f"{path}.joint: {joint!r} is not a hinge or slide{near}")
    if targets.joints[joint] == "hinge":
        _require_torque(path, law)
    return PlacedForce(
        name=path.partition(".")[2],
        joint=joint,
        law=law,
        speed=speed,
        path=path,
        unit="N m" if targets.joints[joint] == "hinge" else "N",
        run_up=targets.run_up if law.angle == CRANK else None,
    )


def _direction(path: str, value: Any) -> Point:
    """Return a unit vector of a direction of the vehicle file."""
    direction: Point = convert(Point, value, path)
    length = math.hypot(*direction) if len(direction) == 3 else math.nan
    if not (math.isfinite(length) and length > 0.0):
        raise ConfigurationError(f"{path}: must be three numbers, not all zero; found {list(direction)}")
    x, y, z = (component / length for component in direction)
    return (x, y, z)


def engine_forces(car: Mapping[str, Instance], targets: ForceTargets) -> list[PlacedForce]:
    """Return the forces of the orders of all engines on their blocks; none at standstill of the crankshaft.

    The order 1 of the pistons is half a vector that turns with the crankshaft and half a vector that turns backward.
    Counterweights at the share k of the pistons leave 1/2 - k of the first, a balance shaft at the share s leaves
    (1 - s)/2 of the second: 1 - k - s/2 along the cylinders, and k - s/2 a quarter turn later across them.

    Raises:
        ConfigurationError: a value is wrong, or the engine does not give its torque.
    """
    forces = []
    for instance in car.values():
        if not instance.table_paths(None, ORDERS):
            continue
        # The numbers of a crank drive need numpy, which a car without it does not load.
        from vehicle.model.parameters.slider_crank import block_forces

        engine, path = instance.get(EngineOrders, None, ORDERS), f"{instance.name}.{ORDERS}"
        part, speed = instance.part(ENGINE, None), targets.speeds[CRANK]
        try:
            block = block_forces(engine, speed, round(engine.highest_order))
        except VehicleError as error:
            text = str(error)
            named = text.replace("EngineOrders", path, 1) if "EngineOrders" in text else f"{path}.pressure: {text}"
            raise ConfigurationError(named) from None
        rising: float | None = None
        gas = dict[float, complex]()
        if targets.run_up is not None and speed > 0.0:
            # All but the torque of the gas grows with the square of the speed.
            rising = speed / (2.0 * math.pi)
            gas = block_forces(engine, 0.0, round(engine.highest_order)).torque
            for order, amplitude in gas.items():
                block.torque[order] -= amplitude
        shaft, cylinders, across = engine.axes
        forward, backward, first = engine.counterweight_share, 0.5 * engine.backward_balance_share, 1.0
        turned_force = {first: 1j * (forward - backward) * block.force[first]}
        turned_moment = {first: -1j * (forward - backward) * block.moment[first]}
        for histories in (block.force, block.moment):
            histories[first] *= 1.0 - forward - backward
        for name, harmonics, force, moment in (
            ("force", block.force, cylinders, NONE),
            ("force_across", turned_force, across, NONE),
            ("moment_across", block.moment, NONE, across),
            ("moment_along", turned_moment, NONE, cylinders),
            ("torque", block.torque, NONE, shaft),
            ("torque_gas", gas, NONE, shaft),
        ):
            largest = max(map(abs, harmonics.values()), default=0.0)
            listed = tuple(
                (order, abs(amplitude), math.degrees(cmath.phase(amplitude)))
                for order, amplitude in harmonics.items()
                if abs(amplitude) > NEGLIGIBLE * largest and largest > SMALLEST
            )
            if listed and speed > 0.0:
                forces.append(
                    PlacedForce(
                        name=f"{instance.name}_{name}",
                        on=part,
                        at=engine.at or targets.parts[part],
                        force=force,
                        moment=moment,
                        law=AppliedForce(
                            harmonics=listed, angle=CRANK, reference_frequency=None if name == "torque_gas" else rising
                        ),
                        speed=speed,
                        path=path,
                        unit="N" if any(force) else "N m",
                        run_up=targets.run_up,
                    )
                )
    return forces
