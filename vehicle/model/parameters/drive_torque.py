"""Drive torques of a car in steady acceleration: moments on the hubs, with a reaction on another part."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.applied_force import AppliedForce
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.composition import Composition, PlacedPart
from vehicle.model.parameters.driving import Driving, driven_wheels
from vehicle.model.parameters.placed_force import DRIVING, PlacedForce

ENGINE, WHEEL, BODY = "engine", "wheel", "body"
"""Part with the differential in most cars; word for motors in the wheels; trimmed body if it is rigid."""


def with_drive_torques(car: Composition, driving: Driving, body: TrimmedBody) -> Composition:
    """Return a car with the drive torque X R of each driven wheel as a moment on its hub, with reaction.

    Args:
        car: composition of the car; R is the loaded radius at rest, which the trim corrects.
        driving: its driving state.
        body: its body; a rigid one may have the differential.

    Raises:
        ConfigurationError: the car cannot accelerate so, or a name is wrong.
    """
    if not driving.accelerates:
        return car
    require_acceleration(car, driving)
    shares, parts = driven_wheels(driving, car.wheels), [part.name for part in car.parts]
    reaction = driving.drive_reaction or (ENGINE if ENGINE in parts else WHEEL)
    if reaction not in (*parts, WHEEL, *([] if body.flexible else [BODY])):
        allowed = "wheel, or the name of a rigid part, for example engine"
        raise ConfigurationError(f"driving.drive_reaction: found {reaction!r}, must be {allowed}")
    if driving.acceleration <= 0.0 or reaction == WHEEL:
        return car
    fixed = {part.name: part.parent for part in car.parts if not part.joints}
    moving = {link.carrier: link.moving for link in car.connections}
    hubs = {wheel.name: _carried_by(moving[wheel.plate], fixed) for wheel in car.wheels}
    axles = {wheel.name: [hubs[other.name] for other in car.wheels if other.axle == wheel.axle] for wheel in car.wheels}
    inside = {
        name
        for name, others in axles.items()
        # The axle of one piece usually has the differential; its torques then are between parts of the axle.
        if (driving.drive_reaction is None and others.count(hubs[name]) > 1)
        or hubs[name] == _carried_by(reaction, fixed)
    }
    mass = body.mass + _mass(car.parts)
    torques = [
        PlacedForce(
            name=f"drive_{wheel.name}",
            on=moving[wheel.plate],
            against=reaction,
            at=wheel.center,
            moment=(0.0, 1.0, 0.0),
            # X is to the front, and acts at the contact, R below the wheel centre: its moment on the hub is -X R.
            law=AppliedForce(
                mean=-mass * driving.acceleration * shares[wheel.name] * (wheel.center[2] - wheel.patch[2])
            ),
            speed=0.0,
            path=DRIVING,
            unit="N m",
        )
        for wheel in car.wheels
        if shares[wheel.name] and wheel.name not in inside
    ]
    last = [force for force in car.forces if force.tyre]
    return replace(car, forces=(*(force for force in car.forces if not force.tyre), *torques, *last))


def _carried_by(part: str, fixed: Mapping[str, str]) -> str:
    """Return the part that carries a part without a joint between them, or the part itself."""
    while part in fixed and fixed[part] not in (BODY, "world"):
        part = fixed[part]
    return part


def _mass(parts: Sequence[PlacedPart]) -> float:
    return float(sum(part.numbers.mass for part in parts))


def require_acceleration(car: Composition, driving: Driving) -> None:
    """Check that a car can brake, drive and turn.

    Raises:
        ConfigurationError: it stands on blocks, or does not have two axles.
    """
    name = "acceleration" if driving.acceleration else "lateral"
    message = f"driving.{name}: found {getattr(driving, name):g} m/s2, but"
    plates = {wheel.plate for wheel in car.wheels}
    blocks = [link.path for link in car.connections if link.ground and link.carrier not in plates]
    if blocks:
        raise ConfigurationError(
            f"{message} the car also stands on {blocks[0]}, whose share of the forces is unknown; use a car on four "
            "wheels, for example focus_road"
        )
    if len({wheel.axle for wheel in car.wheels}) != 2:
        raise ConfigurationError(f"{message} the car must stand on two axles with wheels")
