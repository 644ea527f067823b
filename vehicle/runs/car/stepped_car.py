"""A car with a time step that is small enough for it and for its forces."""

from dataclasses import replace
from typing import Any

from vehicle.engines.linear.step_error import accurate_step, require_accurate_step
from vehicle.engines.simulation.applied_forces import require_step_of_forces, step_for
from vehicle.model.parameters.shipped import sets_step


def stepped_car(car: Any) -> Any:
    """Return a car with a sufficiently small time step, or the car itself if its step is that; see `Car.stepped`."""
    forces, solver = car.vehicle.composition.forces, car.vehicle.solver
    if solver.timestep is not None and sets_step(car.origin["file"], car.overrides):
        require_accurate_step(car.model, car.matrices)
        require_step_of_forces(forces, solver.step)
        return car
    step = step_for(forces, accurate_step(car.model, car.matrices))
    while step * solver.record_rate > 1.0 + 1e-9:  # at least one step for each sample
        step *= 0.5
    if step == solver.timestep:
        return car
    table = {**car.vehicle.table, "solver": {**car.vehicle.table["solver"], "timestep": step}}
    vehicle = replace(car.vehicle, table=table, solver=replace(solver, timestep=step))
    stepped = type(car)(vehicle, folder=car.folder)
    stepped.origin, stepped.overrides = car.origin, car.overrides
    stepped._checked = {*car._checked, "mujoco"}
    return stepped
