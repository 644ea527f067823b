"""Compiled model of a car in static equilibrium."""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco

from vehicle.arrays import Vector
from vehicle.engines.simulation.moved_car import MovedCar
from vehicle.engines.simulation.rows import Rows
from vehicle.engines.simulation.standing import require_body_modes, require_standing
from vehicle.engines.simulation.static_trim import StaticTrim, trim
from vehicle.engines.simulation.steady_trim import steady_trim
from vehicle.errors import SimulationError
from vehicle.model.assembly.spec import assemble
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.vehicle import Vehicle


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarModel:
    """Compiled model of a car with its preloads, as generated; `prepare_model` changes only models of runs.

    Attributes:
        vehicle: parameters.
        superelement: flexible body including the masses fixed to it.
        spec: MJCF specification of the model.
        origins: origin of each body frame in the design position [m], by body name.
        model: compiled model with the unstrained positions of its joint springs.
        static: preloads and static loads.
        moved: position of a car in steady acceleration, from which `spec` and `model` start; None at rest.
    """

    vehicle: Vehicle
    superelement: Superelement
    spec: mujoco.MjSpec
    origins: Mapping[str, Vector]
    model: mujoco.MjModel
    static: StaticTrim
    moved: MovedCar | None = None

    def __repr__(self) -> str:
        """One line."""
        return f"CarModel({self.vehicle.name}, {self.model.nbody} bodies, {self.model.nv} coordinates)"


def build_model(vehicle: Vehicle, trimmed_body: Superelement) -> CarModel:
    """Assemble and compile a car, and compute its static equilibrium.

    Raises:
        ConfigurationError: the car is physically impossible; the message names the parameter.
        SimulationError: MuJoCo rejects the model, or the car can move without resistance.
    """
    require_body_modes(vehicle, trimmed_body)
    assembly = assemble(vehicle, trimmed_body)
    try:
        model = assembly.spec.compile()
    except ValueError as error:
        raise SimulationError(
            f"MuJoCo refuses the generated car: {' '.join(str(error).split())}; check the parameters that "
            "you changed last"
        ) from None
    rows = Rows(model)
    static = trim(rows)
    require_standing(vehicle, rows, static)
    moved = None
    if vehicle.driving.accelerates:
        model, static, moved = steady_trim(vehicle, assembly.spec, rows.anew(static.preload), static)
    return CarModel(
        vehicle=vehicle,
        superelement=assembly.superelement,
        spec=assembly.spec,
        origins=assembly.origins,
        model=model,
        static=static,
        moved=moved,
    )
