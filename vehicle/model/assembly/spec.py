"""MuJoCo specification of the car on its rig, built from parameters and superelement."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco

from vehicle.arrays import Vector
from vehicle.model.assembly.element_builder import ElementBuilder
from vehicle.model.flexbody.attached_mass import with_attached_masses
from vehicle.model.flexbody.superelement import Superelement, attached_nodes
from vehicle.model.parameters.placed_force import on_parts
from vehicle.model.parameters.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True, slots=True)
class Assembly:
    """Generated specification of a car.

    Attributes:
        spec: the specification; `spec.compile()` gives the model.
        vehicle: parameters of the car.
        superelement: flexible body with the masses of the parts fixed to it.
        origins: origin of each body frame in the design position [m], by body name.
    """

    spec: mujoco.MjSpec
    vehicle: Vehicle
    superelement: Superelement
    origins: Mapping[str, Vector]


def assemble(vehicle: Vehicle, trimmed_body: Superelement) -> Assembly:
    """Build the car: trimmed body, then everything of its composition, in that order.

    Every body frame is parallel to the vehicle frame in the design position, with its origin at the centre of gravity.

    Raises:
        DataError: the superelement lacks a node at a point where a force acts.
    """
    masses = fixed_masses(vehicle, trimmed_body)
    return assemble_on(vehicle, with_attached_masses(trimmed_body, masses) if masses else trimmed_body)


def fixed_masses(vehicle: Vehicle, trimmed_body: Superelement) -> dict[str, float]:
    """Return the masses [kg] of the parts fixed to a flexible body, by node; arguments and errors: see `assemble`."""
    nodes = attached_nodes(trimmed_body, vehicle.composition.attachments())
    masses = dict[str, float]()
    for part in vehicle.composition.parts if vehicle.body.flexible else ():
        if part.seat is not None:
            masses[nodes[part.seat]] = masses.get(nodes[part.seat], 0.0) + part.numbers.mass
    return masses


def assemble_on(vehicle: Vehicle, superelement: Superelement) -> Assembly:
    """Build the car on a body model that includes the masses of the parts fixed to it; see `assemble`."""
    car = vehicle.composition
    spec = _empty_spec(vehicle)
    builder = ElementBuilder(spec, vehicle, superelement, attached_nodes(superelement, car.attachments()))
    builder.add_body()
    for part in car.parts:
        builder.add_part(part)
    for on_joint in car.joint_springs:
        builder.add_joint_spring(on_joint)
    for wheel in car.wheels:
        builder.add_plate(wheel)
    for connection in car.connections:
        builder.connect(connection)
    for spring in car.springs:
        builder.add_spring(spring)
    for damper in car.dampers:
        builder.add_damper(damper)
    builder.add_hold()
    builder.add_steady_forces()
    for force in on_parts(car.forces):
        builder.add_force(force)
    for output in car.outputs:
        builder.add_output(output)
    return Assembly(spec=spec, vehicle=vehicle, superelement=superelement, origins=builder.origins)


def _empty_spec(vehicle: Vehicle) -> mujoco.MjSpec:
    """Return a specification with the options that the element laws need."""
    spec = mujoco.MjSpec()
    spec.modelname = vehicle.name
    spec.compiler.degree = False
    spec.compiler.autolimits = True
    # Compiled callbacks access their arrays through the user data of a state.
    spec.nuserdata = 4
    option = spec.option
    option.timestep = vehicle.solver.step
    option.gravity = [0.0, 0.0, -vehicle.gravity]
    option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    # Modal columns are written into the rows, and a sparse pattern would not contain them.
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    option.iterations = 50
    option.tolerance = 1e-12
    disable = mujoco.mjtDisableBit
    option.disableflags |= int(
        disable.mjDSBL_ISLAND | disable.mjDSBL_CONTACT | disable.mjDSBL_EULERDAMP | disable.mjDSBL_AUTORESET
    )
    return spec
