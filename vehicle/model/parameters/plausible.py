"""Checks of a whole vehicle: plausibility, from a micro car to a loaded van, and data of rolling tyres and wheels.

Ranges of single parameters are in their declarations. The checks here need two parameters, or the role of a part. They
are wide: they detect errors of typing and of units.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.body import MOMENTS
from vehicle.model.parameters.composition import PlacedWheel
from vehicle.model.parameters.driving import ROUND
from vehicle.model.parameters.force_elements import Tyre
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.placed_force import PlacedForce
from vehicle.model.parameters.rigid_part import Load
from vehicle.names import AXES

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle

ENGINE = "engine"
"""Name of the power unit among the parts."""
ENGINE_MASS = (20.0, 1000.0, "an electric motor has 30 kg, a large diesel with its gearbox 600 kg")
PART_MASS = (0.02, 150.0, "mass of a part: a bolt of a link has 0.02 kg, a wheel of a van 50 kg")
AXLE_MASS = (0.02, 1000.0, "mass of a part across an axle: a rack has 3 kg, the driven beam of a truck 600 kg")
HALF_AXLE_MASS = (0.02, 500.0, "half of an axle of one piece: the driven beam of a truck has 600 kg")
UNIT_MASS = (
    0.02,
    5000.0,
    "mass of a part outside the axles: a battery has 15 kg, a cab of a truck 600 kg, a box 3000 kg",
)
GYRATION = (1e-3, 1.0, "radius of gyration: thicker than a wire, smaller than the car is wide")
UNIT_GYRATION = (1e-3, 4.0, "radius of gyration: thicker than a wire, not above that of a body 8 m long")
OFFSET_M = 1.0
"""Maximum offset of a centre of gravity from the mean of the hardpoints of the part [m]."""

WHEEL_RADIUS = (0.15, 0.7, "loaded radius: 0.23 m of a micro car, 0.4 m of a van")
HALF_TRACK = (0.3, 1.3, "half the track: 0.45 m of a micro car, 0.95 m of a van")
WHEELBASE = (0.5, 8.0, "from the first to the last point on the ground: a wheelbase of 1.5 to 5 m")
PATCH_ASIDE_M = 0.2
"""Maximum horizontal distance of contact patch and wheel centre, due to camber and trail [m]."""

BODY_GYRATION = (0.2, 4.0, "radius of gyration of a body 2 to 8 m long")


def require_plausible(vehicle: Vehicle) -> None:
    """Check that a car is plausible.

    Raises:
        ConfigurationError: a value out of range; with parameter, value, range and reason.
    """
    require_parts(vehicle)
    for wheel in vehicle.composition.wheels:
        _wheel(wheel)
    _ground(vehicle)
    require_body(vehicle)


def _within(path: str, value: float, unit: str, limits: tuple[float, float, str]) -> None:
    low, high, why = limits
    if not low <= value <= high:
        raise ConfigurationError(f"{path}: found {value:g} {unit}, must be {low:g} to {high:g} {unit} ({why})")


def require_parts(vehicle: Vehicle) -> None:
    """Check mass, inertia and offset of all parts; errors: see `require_plausible`.

    The limits belong to the place of a part: on one side of an axle, half of it, across it, or outside the axles.
    """
    axles: dict[str, tuple[str, ...]] = {}
    for wheel in vehicle.composition.wheels:
        axles[wheel.axle] = (*axles.get(wheel.axle, ()), f"_{wheel.name}")
    parts = vehicle.composition.parts
    # A half that is fixed to the same part of the other side, and that part.
    pairs = [(part.name, part.parent) for part in parts if not part.joints]
    halves = {name for pair in pairs if _corner(pair[0]) == _corner(pair[1]) for name in pair}
    for placed in parts:
        part, path = placed.numbers, placed.path
        if isinstance(part, Load):
            continue  # checked by its declaration
        sides = axles.get(path.partition(".")[0])
        mass, gyration = UNIT_MASS, UNIT_GYRATION
        if sides is not None:
            mass, gyration = PART_MASS if placed.name.endswith(sides) else AXLE_MASS, GYRATION
            mass = HALF_AXLE_MASS if placed.name in halves else mass
        elif placed.name == ENGINE:
            mass, gyration = ENGINE_MASS, GYRATION
        _within(f"{path}.mass", part.mass, "kg", mass)
        for axis, moment in zip(AXES, part.inertia or (), strict=True):
            low, high, why = gyration
            limits = (part.mass * low**2, part.mass * high**2, f"{why}, at {part.mass:g} kg")
            _within(f"{path}.inertia.{axis}", moment, "kg m2", limits)
        for axis, offset in zip(AXES, part.offset, strict=True):
            limits = (-OFFSET_M, OFFSET_M, "parts lie near their hardpoints; a value in mm? set metres")
            _within(f"{path}.offset.{axis}", offset, "m", limits)


def _corner(name: str) -> str:
    """Return the name of a part without its side: "axle_r" of "axle_rr"."""
    return name[:-1] if name.endswith(("r", "l")) else name


def _wheel(wheel: PlacedWheel) -> None:
    center, patch = wheel.paths
    _within(f"{center}.z less {patch}.z", wheel.center[2] - wheel.patch[2], "m", WHEEL_RADIUS)
    _within(f"{center}.y", wheel.side * wheel.center[1], "m", HALF_TRACK)
    for axis, a, b in zip(AXES[:2], wheel.patch[:2], wheel.center[:2], strict=True):
        limits = (-PATCH_ASIDE_M, PATCH_ASIDE_M, "the tyre touches the plate below the wheel centre")
        _within(f"{patch}.{axis} less {center}.{axis}", a - b, "m", limits)


def _ground(vehicle: Vehicle) -> None:
    """Check the ground contacts: wheelbase, and no hardpoint below the lowest plate."""
    ground = [contact for contact in vehicle.composition.connections if contact.ground]
    if not ground:
        raise ConfigurationError(
            f"{vehicle.name}: the car has no contact with the ground; add an axle with wheels, or blocks"
        )
    along = [contact.at[0] for contact in ground]
    first, last = (ground[along.index(end)] for end in (min(along), max(along)))
    _within(f"{last.point}.x less {first.point}.x", last.at[0] - first.at[0], "m", WHEELBASE)
    low = min(vehicle.composition.wheels, key=lambda wheel: wheel.patch[2], default=None)
    for name, point in vehicle.points.items():
        if low is not None and point[2] < low.patch[2]:
            raise ConfigurationError(
                f"{_point_path(vehicle, name)}.z: found {point[2]:g} m, must be at least {low.patch[2]:g} m, the "
                f"height of the plate ({low.paths[1]}.z)"
            )


def _point_path(vehicle: Vehicle, name: str) -> str:
    """Return the path in the vehicle file of a point of the model."""
    paths = [path for path in vehicle.composition.meanings if name.startswith(path.rpartition(".")[2])]
    return max(paths, key=len, default=f"hardpoints.{name}")


def require_body(vehicle: Vehicle) -> None:
    """Check centre of gravity and moments of inertia of the body; errors: see `require_plausible`."""
    body, every = vehicle.body, list[Point](vehicle.points.values())
    for index, axis in enumerate(AXES):
        low, high = min(point[index] for point in every), max(point[index] for point in every)
        why = "inside the car, between the outermost hardpoints"
        _within(f"body.cog.{axis}", body.cog[index], "m", (low, high, why))
    low, high, why = BODY_GYRATION
    at_cog = body.inertia.about == "cog"
    far, reference = (0.0, "CoG") if at_cog else (sum(value**2 for value in body.cog), "origin")
    for name in MOMENTS[:3]:
        limits = (body.mass * low**2, body.mass * (high**2 + far), f"about the {reference}; {why}")
        _within(f"body.inertia.{name}", getattr(body.inertia, name), "kg m2", limits)


def require_rolling(vehicle: Vehicle) -> None:
    """Check the data that tyres and wheels of a rolling car need.

    Raises:
        ConfigurationError: the first parameter that is missing or wrong.
    """
    driving, car = vehicle.driving, vehicle.composition
    if not driving.rolling:
        return
    standing = "to let the tyres stand, set --tyre standing or driving.speed=0"
    remedy = f"set it, or {standing}"
    on_plates = {link.carrier: link for link in car.connections}
    if not car.wheels or any(link.ground and link.rolling is None for link in car.connections):
        raise ConfigurationError(
            f"driving.speed: found {driving.speed:g} m/s, but {vehicle.name} also stands on the ground without "
            f"wheels; {standing}"
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
                f'{tyre.path}: its template fixes {wheel.part} to the hub; use a joint of kind = "spin", like '
                f"wheel.toml; {remedy}"
            )
        if abs(wheel.center[0] - wheel.patch[0]) > ROUND:
            raise ConfigurationError(
                f"{wheel.paths[1]}.x: found {wheel.patch[0]:g} m, must be {wheel.center[0]:g} m, equal to "
                f"{wheel.paths[0]}.x, or the load would drive or brake the rolling wheel"
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
        for force in car.forces:
            _require_no_mean_about(force, wheel, spinning, tyre.moving)
        for part in car.parts:
            if part.name not in spinning:
                continue
            x, _, z = (a - b for a, b in zip(part.cog, wheel.center, strict=True))
            ixx, _, izz = part.numbers.inertia or (0.0, 0.0, 0.0)
            if max(abs(x), abs(z), abs(ixx - izz), *map(abs, part.numbers.products)) > ROUND:
                raise ConfigurationError(
                    f"{part.path}: turns with the wheel, so it must be round about the axle: inertia.x = "
                    "inertia.z, no products, and an offset only along y"
                )


def _require_no_mean_about(force: PlacedForce, wheel: PlacedWheel, spinning: set[str], hub: str) -> None:
    """Check that a force has no mean moment M about the axle of a rolling wheel, which nothing at rest balances.

    A steady M drives or brakes the wheel: the road exerts M/R along x at the contact, and the car takes its reaction.

    Raises:
        ConfigurationError: M is not zero.
    """
    x, _, z = (a - b for a, b in zip(force.at, wheel.center, strict=True))
    arm = force.moment[1] + z * force.force[0] - x * force.force[2]
    if force.joint:
        arm = float(force.joint == f"spin_{wheel.name}")
    elif (force.on in spinning) == (force.against in spinning):
        return
    if abs(arm * force.mean) <= ROUND * abs(force.mean):
        return
    moment = arm * force.mean * (-1.0 if force.against in spinning else 1.0)
    contact, way = abs(moment) / (wheel.center[2] - wheel.patch[2]), "x" if moment > 0.0 else "-x"
    patch = f"{wheel.paths[1].rpartition('.')[2]}_{wheel.name}"
    remedy = (
        f"set on={hub}, which carries the wheel"
        if any(force.force)
        else f"for steady {'braking' if moment > 0.0 else 'driving'} set mean=0 and add two forces of the mean "
        f"{contact:.4g} N: along {way} on {hub} at {patch}, and opposite on body"
    )
    raise ConfigurationError(
        f"{force.path}.mean: found {force.mean:g} {force.unit}, a mean moment of {moment:.4g} N m about the axle of "
        f"wheel {wheel.name}, which turns freely, so there is no equilibrium; {remedy}"
    )
