"""Run of the car from which the car of a run was made, on the same plates: what the changes of the car do."""

import dataclasses
from pathlib import Path

from vehicle.errors import VehicleError
from vehicle.model.parameters.base_car import base_file
from vehicle.model.parameters.shipped import CARS
from vehicle.runs.car import Car
from vehicle.runs.output.run_files import summarise
from vehicle.runs.output.saved_run import recorded_signal
from vehicle.runs.report.differences import changed_parameters, shipped_origin
from vehicle.runs.report.finished_run import FinishedRun

LONGEST = 300.0
"""Maximum length of a record [s] that is simulated again for the report: the reduced engine needs some seconds."""

OF_THE_RUN = ("name", "driving.", "solver.")
"""Beginnings of paths that belong to a run, or name a car, and do not change it."""


def base_run(run: FinishedRun) -> FinishedRun | None:
    """Return a run of the unchanged car on the plates of a run of the reduced engine.

    The unchanged car is that of the vehicle file if the run sets parameters, else the base of the file, else the
    shipped car from which it was made (see `shipped_origin`).

    Returns:
        The run, without FRFs; None if the car is not changed, the engine is another one, the record is longer than
        `LONGEST`, or the unchanged car cannot stand on these plates.
    """
    excitation, solver = run.summary.input, run.summary.solver
    if solver.engine != "reduced" or excitation.duration_s > LONGEST:
        return None
    try:
        car = _unchanged(run)
        if car is None or not _same_plates(run, car):
            return None
        simulated = car.run(recorded_signal(run.summary, run.recording), engine="reduced", skip=run.skip)
    except VehicleError:
        return None
    simulated = dataclasses.replace(simulated, road=excitation.road)
    return FinishedRun(
        name=f"the unchanged {car.vehicle.name}",
        folder=run.folder,
        place=run.place,
        summary=summarise(simulated, (), {}),
        car=car,
        recording=simulated.recording,
        responses=(),
    )


def _unchanged(run: FinishedRun) -> Car | None:
    """Return the unchanged car with the driving state and the solver of the run; None if nothing is changed."""
    origin = run.summary.vehicle
    road = run.summary.input.road or {}
    # An obstacle sets tyres that lift off: they belong to the run.
    kept = [
        text
        for text in origin.overrides
        if text.startswith(OF_THE_RUN) or (road.get("obstacle") and ".one_sided=" in text)
    ]
    file = None if origin.file is None else Path(origin.file)
    if len(kept) < len(origin.overrides):
        car = Car.load(file, kept)
    elif file is not None and (base := base_file(file)) is not None:
        car = Car.load(base, kept)
    else:
        shipped = shipped_origin(run.car.vehicle)
        if shipped is None or shipped.name not in CARS:
            return None
        car = Car.load(shipped.name, kept)
    changes = changed_parameters([car.vehicle, run.car.vehicle])
    return car if any(not path.startswith(OF_THE_RUN) for path, _, _ in changes) else None


def _same_plates(run: FinishedRun, car: Car) -> bool:
    """Return True if the plates of the run are those of the unchanged car: on a road they depend on its wheels."""
    wheels, unchanged = ({wheel.name: wheel.center[:2] for wheel in each.vehicle.composition.wheels}
                         for each in (run.car, car))  # fmt: skip
    if set(wheels) != set(unchanged):
        return False
    moved = max(abs(a - b) for name in wheels for a, b in zip(wheels[name], unchanged[name], strict=True))
    return run.summary.input.road is None or moved < 1e-6
