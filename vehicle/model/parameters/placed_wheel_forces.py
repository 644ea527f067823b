"""Imbalance, non-uniformity and brake variation of the wheels of a car, placed."""

from collections.abc import Iterable, Mapping
from typing import Any

from vehicle.model.parameters.applied_force import AppliedForce, Harmonics
from vehicle.model.parameters.composition import PlacedConnection, PlacedPart, PlacedWheel
from vehicle.model.parameters.driving import SPIN
from vehicle.model.parameters.further_forces import ForceTargets
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.instance import Instance
from vehicle.model.parameters.placed_force import NONE, PlacedForce
from vehicle.model.parameters.wheel_forces import WHEEL_FORCES, BrakeVariation, Imbalance, Nonuniformity
from vehicle.names import SIDE_SIGN

ALONG, ACROSS, UP = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def wheel_forces(
    car: Mapping[str, Instance],
    wheels: Iterable[PlacedWheel],
    parts: Iterable[PlacedPart],
    connections: Iterable[PlacedConnection],
    targets: ForceTargets,
) -> list[PlacedForce]:
    """Return the forces of all wheels, with the forces that act on a tyre in place of a part.

    An imbalance exerts m r (V/R)^2 from the axle to the mass, along x and along z. A non-uniform tyre and a varying
    brake need a wheel that turns: at rest they are left out.

    Raises:
        ConfigurationError: a value is wrong.
    """
    tyres = {tyre.carrier: tyre for tyre in connections if tyre.rolling is not None}
    spins = {part.name: joint.name for part in parts for joint in part.joints if joint.name.startswith(SPIN)}
    forces: list[PlacedForce] = []
    for wheel in wheels:
        instance, side = car[wheel.axle], next(name for name, sign in SIDE_SIGN.items() if sign == wheel.side)
        for table, table_class in WHEEL_FORCES.items():
            if instance.table_paths(side, table):
                values: Any = instance.get(table_class, side, table)
                forces += _forces(wheel, table, values, targets, tyres.get(wheel.plate), spins.get(wheel.part, ""))
    return forces


def _forces(
    wheel: PlacedWheel, table: str, values: Any, targets: ForceTargets, tyre: PlacedConnection | None, spin: str
) -> list[PlacedForce]:
    """Return the forces of a table of a wheel, with its rolling tyre and its joint on the hub if it turns."""
    angle = f"wheel_{wheel.name}"
    speed = targets.speeds[angle]

    def force(name: str, harmonics: Harmonics, direction: Point, at: Point, **ends: Any) -> PlacedForce:
        law = AppliedForce(harmonics=harmonics, angle=angle)
        path = f"{wheel.axle}.{table}"
        unit = ("m" if direction[2] else "m/s") if "tyre" in ends else "N" if any(direction) else "N m"
        return PlacedForce(name=name, at=at, force=direction, law=law, speed=speed, path=path, unit=unit, **ends)

    x, y, z = wheel.center
    if isinstance(values, Imbalance):
        amplitude, at = values.mass * values.radius * speed**2, (x, y + wheel.side * values.offset, z)
        return [
            force(f"{table}_{wheel.name}_{axis}", ((1.0, amplitude, values.angle - behind),), way, at, on=wheel.part)
            for axis, way, behind in (("x", ALONG, 0.0), ("z", UP, 90.0))
        ]
    forces = []
    if isinstance(values, BrakeVariation) and values.torque and spin:
        forces.append(force(f"{table}_{wheel.name}", values.torque, NONE, NONE, joint=spin))
    if isinstance(values, Nonuniformity) and tyre is not None and tyre.law is not None:
        stiffness = tyre.law.stiffness[2]
        radial = values.runout or tuple((order, size / stiffness, phase) for order, size, phase in values.rfv)
        tread = tuple((order, size * speed, phase) for order, size, phase in values.rolling_runout)
        outwards = (0.0, wheel.side, 0.0)
        if radial:
            forces.append(force(f"runout_{wheel.name}", radial, UP, wheel.patch, tyre=wheel.name))
        if values.lfv:
            forces.append(force(f"lateral_{wheel.name}", values.lfv, outwards, wheel.patch, on=wheel.part))
        if tread:
            forces.append(force(f"tread_{wheel.name}", tread, ALONG, wheel.patch, tyre=wheel.name))
    return forces
