"""Numbers of the elements of a car in its model, by name: laws, springs on joints, masses.

The model keeps those of laws in custom fields of these names, and `vehicle.engines.simulation.row_layout` reads them.
Cars that differ only in these numbers share a model: see `vehicle.engines.linear.variant_matrices`.
"""

import dataclasses
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.assembly.connections import ElementLaw, element_law, fluid_law
from vehicle.model.flexbody.rigid_body import rigid_body
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.laws import control_laws
from vehicle.model.laws.damper import actuator_parameters, damper_curve, pack
from vehicle.model.laws.presliding import presliding_elements
from vehicle.model.parameters.air_spring import AirSpring
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.composition import JointSpring, PlacedConnection, PlacedDamper, PlacedPart, PlacedSpring
from vehicle.model.parameters.force_elements import Damper, Tyre
from vehicle.model.parameters.force_table import ForceTable
from vehicle.model.parameters.placed_force import DRIVING, PlacedForce
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES

Numbers = dict[str, Vector]

FLUID, DECOUPLER = "fluid/", "decoupler/"
"""Beginnings of the names of the fluids of hydromounts, and of their decouplers, in the model."""

FORCE, TORQUE = "force/", "torque/"
"""Beginnings of the names of the custom fields of a force at a point and of a torque on a joint."""

TURNING, AVERAGED = 12, 13
"""Indices of the rotational stiffness, and of the mark of an averaged stiffness, in the field of a law along three
axes. A law may have any number of further values after them."""


def connection_numbers(connection: PlacedConnection, body: TrimmedBody, superelement: Superelement) -> Numbers:
    """Return the numbers of the law of a connection; empty for an ideal ball joint. Arguments: see `element_law`."""
    law = element_law(connection, body, superelement)
    if law is None:
        return {}
    name, numbers = connection_name(connection), Numbers()
    for axis, local in zip(AXES, law.local, strict=True):
        numbers |= _table(f"{name}/{axis}", connection.table(axis), float(local))
    for axis, friction in zip(AXES, law.friction, strict=True):
        if friction is not None:
            numbers[f"friction/{name}/{axis}"] = np.column_stack([friction.stiffness, friction.limit]).ravel()
    if getattr(connection.law, "one_sided", False):
        numbers[f"one_sided/{name}"] = np.ones(1)
    if connection.rolling is not None and isinstance(connection.law, Tyre):
        numbers[f"rolling/{name}"] = np.array([connection.rolling.speed, connection.law.trail, *connection.rolling.arm])
    if isinstance(connection.law, AirSpring):
        air = connection.law
        numbers[f"air/{name}"] = np.array([air.air_area, air.air_volume, air.air_area_slope])
    if connection.radius > 0.0:
        numbers[f"round/{name}"] = np.array([connection.radius])
    numbers |= _law_numbers(name, law)
    fluid = fluid_law(connection, body, superelement)
    if fluid is not None:
        name = fluid_name(connection)
        numbers |= _law_numbers(name, fluid.law)
        numbers |= {f"joint/{name}": np.array([0.0, fluid.damping])}
        numbers[f"inertia/{name}"] = np.array([fluid.mass, fluid.share])
        if fluid.decoupler is not None:
            name, (mass, damping, membrane) = f"{DECOUPLER}{connection.name}", fluid.decoupler
            numbers |= {f"joint/{name}": np.array([membrane, damping]), f"table/{name}": fluid.seat.ravel()}
            numbers[f"inertia/{name}"] = np.array([mass, fluid.share])
    return numbers


def _law_numbers(name: str, law: ElementLaw) -> Numbers:
    """Return the numbers of a law along three axes."""
    # The damper of a branch, not its time: MJCF text keeps six digits but drops numbers below 1e-5.
    constants = [law.stiffness, law.damping, law.branch_stiffness, law.branch_stiffness * law.branch_time]
    numbers = {f"law/{name}": np.concatenate([*constants, [law.rotational_stiffness, float(law.averaged)]])}
    if law.directions is not None:
        numbers[f"directions/{name}"] = law.directions.ravel()
    return numbers


def fluid_name(connection: PlacedConnection) -> str:
    """Return the name of the fluid of a hydromount in the model: of its rows, its body and its joint."""
    return f"{FLUID}{connection.name}"


def connection_name(connection: PlacedConnection) -> str:
    """Return the name of a connection in the model."""
    return f"{'ball' if connection.law is None else 'bushing'}/{connection.name}"


def spring_numbers(spring: PlacedSpring) -> Numbers:
    """Return the numbers of a spring between two points."""
    return {f"law/{spring.name}": np.array([spring.stiffness]), **_table(spring.name, spring.table)}


def damper_numbers(placed: PlacedDamper) -> Numbers:
    """Return the numbers of a damper: stop, steeper segments of the curve, presliding, control, function, actuator."""
    numbers, (segments, elements, control, actuator) = _table(placed.name, placed.law.stop), _packed(placed.law)
    for number, segment in enumerate(segments):
        numbers[f"law/valve/{placed.name}" + (f"/{number}" if number else "")] = segment
    if control is not None:
        numbers[f"control/{placed.name}"] = control
    if placed.law.function is not None:
        # The name is in that of the field, because a field has numbers only.
        numbers[f"function/{placed.name}/{placed.law.function}"] = np.ones(1)
    if placed.law.friction_function is not None:
        numbers[f"limit/{placed.name}/{placed.law.friction_function}"] = np.ones(1)
    if elements.size:
        numbers[f"presliding/{placed.name}"] = elements.ravel()
    numbers[f"actuator/{placed.name}"] = actuator
    return numbers


@lru_cache(maxsize=16)
def _packed(law: Damper) -> tuple[Vector, Vector, Vector | None, Vector]:
    """Return steeper segments, presliding elements, control and record; cached, as an axle has equal dampers."""
    control = None if law.controlled is None else control_laws.pack(law.controlled)
    # A model has no address: it is valid in one process.
    record = pack(dataclasses.replace(law, friction_function=None))
    return damper_curve(law).clamped(), presliding_elements(law), control, actuator_parameters(record)


def joint_numbers(spring: JointSpring) -> Numbers:
    """Return stiffness and damping of a spring on a joint."""
    return {f"joint/{spring.joint}": np.array([spring.stiffness, spring.damping])}


def mode_numbers(body: TrimmedBody, superelement: Superelement) -> Numbers:
    """Return stiffness w2 and damping 2 zeta w of the modal coordinates; empty for a rigid body."""
    if not body.flexible:
        return {}
    omega = 2.0 * np.pi * superelement.frequencies * body.frequency_scale
    pairs = zip(omega, superelement.damping_ratio, strict=True)
    return {f"joint/mode_{n}": np.array([w**2, 2.0 * ratio * w]) for n, (w, ratio) in enumerate(pairs, start=1)}


def body_numbers(body: TrimmedBody, superelement: Superelement) -> Numbers:
    """Return mass and inertia of the trimmed body about its CoG, see `mass_numbers`, and the numbers of its modes."""
    rigid = rigid_body(body)
    return {"mass/body": np.array([rigid.mass, *rigid.full_inertia]), **mode_numbers(body, superelement)}


def mass_numbers(part: PlacedPart) -> Numbers:
    """Return mass and Ixx, Iyy, Izz, Ixy, Ixz, Iyz of a part in the convention of MuJoCo: negative products."""
    numbers, products = part.numbers, np.array([part.side, 1.0, part.side]) * part.numbers.products
    moments = numbers.inertia or (0.0, 0.0, 0.0)
    return {f"mass/{part.name}": np.array([numbers.mass, *moments, *-products])}


SLOWER_HOLD = 200.0 / 3.6
"""Speed above which the hold of the course becomes slower [m/s]: the sedan with 0.1 Hz is unstable from 280 km/h on."""


def hold_numbers(vehicle: Vehicle) -> Numbers:
    """Return the hold of the course: stiffness and damping along x, y [N/m, N s/m] and in yaw; empty at rest.

    k = m (2 pi f)^2 with the mass of the car, and in yaw its inertia about the centre of gravity of the trimmed body.
    The hold along y acts at the foremost wheels, where a driver steers; the last number is their x relative to the CoG
    [m]. At the centre of gravity the hold would let every oversteering car diverge. Above `SLOWER_HOLD` f falls as the
    yaw damping of a car does, with 1/V, so that the hold alone makes no car unstable.
    """
    driving, body = vehicle.driving, vehicle.body
    if not driving.rolling:
        return {}
    mass, yaw_inertia = body.mass, float(rigid_body(body).inertia[2, 2])
    for part in vehicle.composition.parts:
        x, y = part.cog[0] - body.cog[0], part.cog[1] - body.cog[1]
        inertia_of_part = 0.0 if part.numbers.inertia is None else part.numbers.inertia[2]
        mass, yaw_inertia = mass + part.numbers.mass, yaw_inertia + inertia_of_part + part.numbers.mass * (x**2 + y**2)
    omega = 2.0 * np.pi * driving.hold_frequency * min(1.0, SLOWER_HOLD / driving.speed)
    inertia = np.array([mass, mass, yaw_inertia])
    ahead = min(wheel.center[0] for wheel in vehicle.composition.wheels) - body.cog[0]
    return {"hold/body": np.concatenate([inertia * omega**2, 2.0 * driving.hold_damping * omega * inertia, [ahead]])}


def element_numbers(
    vehicle: Vehicle, body: Superelement, like: tuple[Vehicle, Sequence[Numbers]] | None = None
) -> list[Numbers]:
    """Return the numbers of every element: body, parts, springs on joints, connections, springs, dampers, hold.

    Args:
        vehicle: the car.
        body: superelement of the car, with the masses fixed to it.
        like: another car with the same elements and body, and its numbers, which are reused for equal elements.
    """
    makers: list[Callable[[Any], Numbers]] = []
    elements: list[list[Any]] = []
    for one in (vehicle, like[0] if like else vehicle):
        car, listed = one.composition, list[Any]([one.body])
        makers = [lambda part: body_numbers(part, body)]
        for chosen, make in (
            (car.parts, mass_numbers),
            (car.joint_springs, joint_numbers),
            (car.connections, lambda part: connection_numbers(part, vehicle.body, body)),
            (car.springs, spring_numbers),
            (car.dampers, damper_numbers),
            ((one,), hold_numbers),
        ):
            listed += chosen
            makers += [make] * len(chosen)
        elements.append(listed)
    if like is None:
        return [make(one) for make, one in zip(makers, elements[0], strict=True)]
    return [
        numbers if one is other or one == other else make(one)
        for make, one, other, numbers in zip(makers, *elements, like[1], strict=True)
    ]


def _table(name: str, table: ForceTable | None, local: float = np.inf) -> Numbers:
    """Return the points of a law over displacement in series with a local stiffness [N/m]: displacements add up."""
    if table is None:
        return {}
    gives = [x + force / local for x, force in zip(table.displacement, table.force, strict=True)]
    return {f"table/{name}": np.array([*gives, *table.force])}


def force_fields(force: PlacedForce) -> Numbers:
    """Return the custom field of a force in its model: directions of force and moment, 1 in part axes, and the mean."""
    if force.joint:
        return {f"{TORQUE}{force.name}/{force.joint}": np.array([0.0, force.mean])}
    # A drive torque does not act on the car at rest: its trim in steady acceleration sets the direction.
    moment = (0.0, 0.0, 0.0) if force.path == DRIVING else force.moment
    return {f"{FORCE}{force.name}": np.array([*force.force, *moment, float(force.follows), force.mean])}
