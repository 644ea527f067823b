"""A sweep of a car: parameters to vary, inputs, and what is measured, checked before anything is computed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.paths import assignments
from vehicle.model.parameters.shipped import FOCUS_FILE, vehicle_file
from vehicle.model.parameters.vehicle import load_vehicle, overridden
from vehicle.model.parameters.whole_body import body_rules
from vehicle.runs.car import Car
from vehicle.studies.sweeps.case import Case, all_tyre_words, varied_cases
from vehicle.studies.sweeps.measure import ComfortMeasure, Measure
from vehicle.studies.sweeps.sweep import Progress, sweep
from vehicle.studies.sweeps.sweep_inputs import Source, common_start, file_of, inputs_of
from vehicle.studies.sweeps.sweep_table import SweepTable

Variations = Mapping[str, Sequence[Any]] | Sequence[Iterable[str] | Mapping[str, Any]]
"""Path to values, for every combination; or a list of variations, each path to value or texts "path=value"."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SweepPlan:
    """A sweep that can be run.

    Attributes:
        cases: the runs.
        measure: turns a run into values.
        skip: start of the evaluation [s].
        notes: messages on what the varied parameters imply.
    """

    cases: Sequence[Case]
    measure: Measure
    skip: float
    notes: tuple[str, ...]

    @property
    def tyres(self) -> str:
        """What the tyres do in all runs."""
        return all_tyre_words(self.cases)

    def run(
        self,
        *,
        executor: Executor | Callable[[], Executor] | None = None,
        jobs: int = 1,
        folder: Path | None = None,
        retry_failed: bool = False,
        progress: Progress | None = None,
    ) -> SweepTable:
        """Run the sweep; arguments, result and errors of `vehicle.studies.sweeps.sweep.sweep`."""
        return sweep(
            self.cases,
            self.measure,
            executor=executor,
            jobs=jobs,
            folder=folder,
            retry_failed=retry_failed,
            progress=progress,
        )


def plan_sweep(
    car: Car,
    vary: Variations,
    inputs: Source | Sequence[Source],
    *,
    engine: str = "auto",
    skip: float | None = None,
    measure: Measure | None = None,
) -> SweepPlan:
    """Check a sweep; arguments and errors of `run_sweep`."""
    changes = changes_of(vary)
    vehicle = file_of(car)
    require_paths(vehicle, car.overrides, changes[0])
    sources = inputs_of(car, inputs)
    start = common_start(sources, skip)
    cases = varied_cases(changes, sources, engine=engine, vehicle=vehicle, fixed=car.overrides)
    paths = [text.partition("=")[0] for text in changes[0]]
    return SweepPlan(
        cases=cases,
        measure=ComfortMeasure(skip=start, seat=car.vehicle.seated) if measure is None else measure,
        skip=start,
        notes=(*body_rules(car.vehicle, paths), *_idle_notes(vehicle, car.overrides, changes)),
    )


def run_sweep(
    car: Car,
    vary: Variations,
    inputs: Source | Sequence[Source],
    *,
    engine: str = "auto",
    skip: float | None = None,
    measure: Measure | None = None,
    jobs: int = 1,
    folder: Path | None = None,
    progress: Progress | None = None,
) -> SweepTable:
    """Run a car with varied parameters on one or several inputs, and tabulate comfort and slip.

    The runs go to processes, so a script calls this below `if __name__ == "__main__":`.

    Args:
        car: loaded by `Car.load`; its own overrides hold in every run.
        vary: path to values, as {"damper.coulomb_friction": [62.5, 125]}, for every combination; or a list of
            variations, each path to value.
        inputs: files or names of shipped ones, roads, signals; one or several.
        engine: as in `Car.run`.
        skip: start of the evaluation [s]; 2 by default, on a road see `Car.run`.
        measure: turns a run into values; comfort and slip shares by default.
        jobs: number of processes; the table does not depend on it.
        folder: existing folder in which finished rows are stored, and found again by the next call; None stores none.
        progress: called with the finished fraction.

    Returns:
        A row for each run, the inputs varying slowest; a failed run is a row with its reason.

    Raises:
        ConfigurationError: a path does not exist, an input is missing, or `skip` is out of range.
        DataError: an input cannot be read, or was sampled below 125 Hz.
    """
    plan = plan_sweep(car, vary, inputs, engine=engine, skip=skip, measure=measure)
    return plan.run(jobs=jobs, folder=folder, progress=progress)


def changes_of(vary: Variations) -> list[tuple[str, ...]]:
    """Return the texts "path=value" of each variation, the last path varying fastest.

    Raises:
        ConfigurationError: there is no variation, or a value of a type that no parameter has.
    """
    if isinstance(vary, Mapping):
        columns = [[text for value in each for text in assignments({path: value})] for path, each in vary.items()]
        changes = list(product(*columns))
    else:
        changes = [tuple(assignments(each)) for each in vary]
    if not changes or not changes[0]:
        raise ConfigurationError("vary: no variation; give {PATH: [VALUE, ...]}, as {'damper.viscous': [1500, 2000]}")
    return changes


def require_paths(vehicle: Path | None, overrides: Sequence[str], changes: Sequence[str]) -> None:
    """Refuse a misspelt parameter before anything is computed: it would fail in every row.

    An impossible value is left to its row: another row may be possible.

    Args:
        vehicle: vehicle file; that of the Focus by default.
        overrides: texts of every run.
        changes: texts of the first variation.

    Raises:
        ConfigurationError: a path does not exist, or its value is none.
    """
    file = FOCUS_FILE if vehicle is None else vehicle_file(vehicle)
    overridden(file, overrides)
    try:
        overridden(file, [*overrides, *changes])
    except ConfigurationError as error:
        raise ConfigurationError(str(error).replace("--set ", "varied parameter ", 1)) from None


def _idle_notes(file: Path | None, overrides: Sequence[str], changes: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """Return a message for each varied parameter without effect; none where laws vary, which may turn it on."""
    for column in zip(*changes, strict=True):
        values = {text.partition("=")[2].strip() for text in column}
        if len(values) > 1 and any(value[:1].isalpha() for value in values):
            return ()
    try:
        return idle_parameters(load_vehicle(file, [*overrides, *changes[0]]), changes[0])
    except ConfigurationError:
        return ()  # the row says why
