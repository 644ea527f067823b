"""Runs of the complete car shared by studies: each case runs once, independent cases in parallel processes."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from vehicle.engines.simulation.recording import Recording
from vehicle.errors import SimulationError
from vehicle.runs.car import Car, Run
from vehicle.studies.sweeps.case import Case, Input, digest, signal_of
from vehicle.studies.sweeps.case_evaluation import run_of
from vehicle.studies.sweeps.executors import process_pool
from vehicle.studies.sweeps.measure import Measure
from vehicle.studies.sweeps.store import ROWS
from vehicle.studies.sweeps.sweep import sweep


class CarRuns:
    """Cars and finished runs behind one or several scenarios.

    Args:
        vehicle: TOML file; default: the car of Bommer 2006.
        overrides: changes of every car, before the changes of a case.
        engine: "mujoco", "reduced" or "auto".
        jobs: worker processes.
    """

    def __init__(
        self, *, vehicle: Path | None = None, overrides: Sequence[str] = (), engine: str = "mujoco", jobs: int = 1
    ) -> None:
        self.vehicle, self.overrides, self.engine, self.jobs = vehicle, tuple(overrides), engine, jobs
        self._cars: dict[tuple[str, ...], Car] = {}
        self._done: dict[str, Run] = {}

    def case(self, source: Input, overrides: Sequence[str] = (), *, engine: str | None = None) -> Case:
        """Return the case of a signal on the car with modified parameters.

        Args:
            source: the signal, or another input.
            overrides: texts like "damper.coulomb_friction=75"; applied after the overrides of all cars.
            engine: engine of this case, by default the engine of the other runs; a film needs "mujoco".
        """
        changes = (*self.overrides, *overrides)
        return Case(
            source=source,
            overrides=changes,
            engine=engine or self.engine,
            vehicle=self.vehicle,
            shared=len(self.overrides),
        )

    @property
    def wheel(self) -> str:
        """Return the wheel on the shaker."""
        return self.car().vehicle.shaker_wheel

    def car(self, overrides: Sequence[str] = ()) -> Car:
        """Return the car with modified parameters, cached."""
        changes = tuple(overrides)
        if not changes:
            return self._car_of(self.overrides)
        return self._car_of(self.car().with_(changes).overrides)

    def _car_of(self, changes: tuple[str, ...]) -> Car:
        """Return the car with all changes, cached."""
        if changes not in self._cars:
            self._cars[changes] = Car.load(self.vehicle, changes)
        return self._cars[changes]

    def __call__(self, cases: Sequence[Case]) -> list[Run]:
        """Return the runs of cases in their order; finished cases are not run again."""
        keys = [digest([case.overrides, case.engine, case.source.identity()]) for case in cases]
        missing = {key: case for key, case in zip(keys, cases, strict=True) if key not in self._done}
        recordings: list[Recording | None] = [None] * len(missing)
        if self.jobs > 1 and len(missing) > 1:
            with process_pool(min(self.jobs, len(missing))) as pool:
                recordings = list(pool.map(recording_of, missing.values()))
        for (key, case), recording in zip(missing.items(), recordings, strict=True):
            car, signal = self.car(case.overrides[case.shared :]), signal_of(case.source)
            if recording is None:
                self._done[key] = car.run(signal, engine=case.engine)
            else:
                self._done[key] = Run(car=car, signal=signal, recording=recording)
        return [self._done[key] for key in keys]


def recording_of(case: Case) -> Recording:
    """Run a case in a worker process and return its recording."""
    return run_of(case).recording


def swept(
    cases: Sequence[Case], measure: Measure, *, jobs: int = 1, folder: Path | None = None
) -> list[Mapping[str, float]]:
    """Return the values of cases in their order, run as a batch.

    Args:
        cases: the cases, sorted by car: building one costs more than most runs.
        measure: the values of a run.
        jobs: worker processes.
        folder: for the rows of an unfinished study and the table of a finished one; made if missing.

    Raises:
        SimulationError: a run failed.
    """
    if not cases:
        return []
    if folder is not None:
        folder.mkdir(exist_ok=True)
    table = sweep(cases, measure, jobs=jobs, folder=folder)
    for case, reason in table.failed[:1]:
        raise SimulationError(f"{case.label}: {reason}; {len(table.failed)} of {len(cases)} runs failed")
    values: list[Mapping[str, float]] = [result.values for result in table.results]
    if folder is not None:
        # They served an interrupted study; a finished one must not read them when the program has changed.
        (folder / ROWS).unlink()
    return values
