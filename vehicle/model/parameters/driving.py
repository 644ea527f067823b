"""Driving state of a car: speed and hold of the course; templates with rolling or fixed wheels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.force_elements import Tyre
from vehicle.model.parameters.quantity import Validated, quantity
from vehicle.model.parameters.toml_file import build, convert
from vehicle.model.parameters.topology import Template

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle

SPIN = "spin"
"""Name of the hinge about which a wheel turns on its hub."""

ROUND = 1e-6
"""Tolerance [m, kg m2] within which a part that turns with the wheel is a body of revolution."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Driving(Validated):
    """Constant speed straight ahead with freely rolling wheels; at speed 0 the tyres are at rest, as on a rig.

    The hold of the course represents the driver: free rolling leaves the position of the car along x and y and its
    heading without any stiffness. Comfort does not depend on it: `docs/theory/rolling-tyre.md`.
    """

    speed: float = quantity(
        "m/s",
        "speed of the car, forward; 0: the tyres stand",
        at_least=0.0,
        at_most=120.0,
        why="400 km/h",
        default=0.0,
    )
    hold_frequency: float = quantity(
        "Hz",
        "natural frequency of the mass of the car on the hold of its course, along x, y and in yaw",
        at_least=0.01,
        at_most=0.5,
        why="a driver corrects the course at 0.05 to 0.3 Hz; modes of the car begin at 1 Hz",
        default=0.1,
    )
    hold_damping: float = quantity("-", "damping ratio of that motion", at_least=0.1, at_most=2.0, default=0.7)

    @property
    def rolling(self) -> bool:
        """True if the wheels turn."""
        return self.speed > 0.0

    @property
    def words(self) -> str:
        """State of the tyres for summaries and captions, as "rolling at 80 km/h"."""
        return tyre_words([self])


STANDING = Driving()


def tyre_words(cars: Iterable[Driving]) -> str:
    """Return the state of the tyres in one or several runs: "standing", "rolling at 50, 80 and 120 km/h".

    Args:
        cars: driving state of each run.
    """
    speeds = sorted({car.speed for car in cars})
    rolling = [f"{3.6 * speed:.4g}" for speed in speeds if speed > 0.0]
    listed = " and ".join(part for part in (", ".join(rolling[:-1]), *rolling[-1:]) if part)
    return " or ".join([*(["standing"] if 0.0 in speeds else []), *([f"rolling at {listed} km/h"] if rolling else [])])


def driving_of(table: Mapping[str, Any]) -> Driving:
    """Return the table `driving` of a vehicle file; without it the tyres are at rest. Errors: see `build`."""
    return build(Driving, convert(dict, table.get("driving", {}), "driving"), "driving")


def as_driven(template: Template, driving: Driving) -> Template:
    """Return a template with its "spin" joints replaced: hinges if the car drives, fixed joints otherwise.

    A rolling tyre is on a hinge about y on its hub; parts that turn with it are fixed to the tyre. The force of the
    road then acts on the hub: the steady spin turns the point of contact back as fast as the wheel turns.

    Args:
        template: template, with or without joints of kind "spin".
        driving: driving state of the car.
    """
    spins = [joint for joint in template.joint if joint.kind == SPIN]
    if not spins:
        return template
    joints, hubs = [], {}
    for joint in template.joint:
        if joint.kind != SPIN:
            joints.append(joint)
        elif not driving.rolling:
            joints.append(replace(joint, kind="fixed", at=None))
        else:
            tyre, *others = joint.child
            hubs[tyre] = joint.parent
            joints.append(replace(joint, kind="hinge", name=SPIN, child=(tyre,), axis=(0.0, 1.0, 0.0)))
            if others:
                joints.append(replace(joint, kind="fixed", at=None, child=tuple(others), parent=tyre))
    connections = tuple(
        replace(connection, moving=hubs.get(connection.moving, connection.moving))
        if connection.carrier == "plate"
        else connection
        for connection in template.connection
    )
    return replace(template, joint=tuple(joints), connection=connections)


def require_rolling(vehicle: Vehicle) -> None:
    """Check the data that tyres and wheels of a rolling car need.

    Raises:
        ConfigurationError: the first parameter that is missing or wrong.
    """
    driving, car = vehicle.driving, vehicle.composition
    if not driving.rolling:
        return
    standing = "let the tyres stand: --tyre standing, or driving.speed=0"
    remedy = f"set it, or {standing}"
    on_plates = {link.carrier: link for link in car.connections}
    if not car.wheels or any(link.ground and link.rolling is None for link in car.connections):
        raise ConfigurationError(
            f"driving.speed: found {driving.speed:g} m/s, but {vehicle.name} has other ground contacts "
            f"than wheels; {standing}"
        )
    for wheel in car.wheels:
        tyre = on_plates[wheel.plate]
        if not isinstance(tyre.law, Tyre):
            raise ConfigurationError(f"{tyre.path}: found a hydromount, which cannot roll; {standing}")
        for key in ("slip_stiffness", "cornering_stiffness", "carcass_longitudinal", "carcass_lateral"):
            if getattr(tyre.law, key) is None:
                raise ConfigurationError(
                    f"{tyre.path}.{key}: missing; a rolling tyre needs it (driving.speed {driving.speed:g} m/s); "
                    f"{remedy}"
                )
        if tyre.moving == wheel.part:
            raise ConfigurationError(
                f'{tyre.path}: its template fixes {wheel.part} to the hub; use a joint of kind = "spin", as '
                f"wheel.toml has; {remedy}"
            )
        if abs(wheel.center[0] - wheel.patch[0]) > ROUND:
            raise ConfigurationError(
                f"{wheel.paths[1]}.x: found {wheel.patch[0]:g} m, must be that of {wheel.paths[0]}, "
                f"{wheel.center[0]:g} m: ahead of the centre the load would drive or brake a rolling wheel"
            )
        spinning = {part.name for part in car.parts if part.parent == wheel.part and not part.joints} | {wheel.part}
        held = [(link.path, {link.moving, link.carrier}) for link in car.connections]
        held += [(f"outputs.{link.name}", {link.on}) for link in car.outputs]
        for path, parts in held:
            if parts & spinning:
                raise ConfigurationError(
                    f"{path}: is on {', '.join(sorted(parts & spinning))}, which turns with the rolling wheel; put it "
                    "on the hub"
                )
        for part in car.parts:
            if part.name not in spinning:
                continue
            x, _, z = (a - b for a, b in zip(part.cog, wheel.center, strict=True))
            ixx, _, izz = part.numbers.inertia or (0.0, 0.0, 0.0)
            if max(abs(x), abs(z), abs(ixx - izz), *map(abs, part.numbers.products)) > ROUND:
                raise ConfigurationError(
                    f"{part.path}: turns with the wheel and is no body of revolution about its axle; must have "
                    "inertia.x = inertia.z, no products, and an offset along y alone"
                )
