"""Sweep of a car: check of parameters, inputs and measure before the first run."""

import contextlib
import math
import time as clock
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

from vehicle.digits import duration
from vehicle.engines.reduced.validity import ERROR_IN_RANGE, ERROR_ON_CLASS_C
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.body_notices import body_rules
from vehicle.model.parameters.force_elements import LIFTS
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.paths import assignments, meant
from vehicle.model.parameters.shipped import FOCUS_FILE, vehicle_file
from vehicle.model.parameters.vehicle import load_vehicle, overridden
from vehicle.runs.car import Car
from vehicle.runs.car.fast_run import fast_run
from vehicle.runs.car.outside_tests import RAIL, outside_tests
from vehicle.settings import with_settings
from vehicle.signals.excitation.road_drive import RoadDrive, evaluated_from
from vehicle.studies.sweeps.case import all_tyre_words, overrides_of, signal_of
from vehicle.studies.sweeps.case_evaluation import OF_A_RUN, loaded_car, reason_for_mujoco
from vehicle.studies.sweeps.case_table import Cases, Combinations, RowChanges
from vehicle.studies.sweeps.comfort_ranking import measured_evaluation, ranking_evaluation
from vehicle.studies.sweeps.dispatcher import FILL
from vehicle.studies.sweeps.estimate_measure import ESTIMATE, NOTE, estimate_measure
from vehicle.studies.sweeps.evaluation import Evaluation
from vehicle.studies.sweeps.figure_inputs import require_on_inputs
from vehicle.studies.sweeps.measure import BatchMeasure, Measure, chosen_measure
from vehicle.studies.sweeps.sweep import sweep_cases
from vehicle.studies.sweeps.sweep_inputs import Inputs, common_start, file_of, inputs_of, require_speed_of_roads
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.sweeps.sweep_table import SweepTable

Variations = Mapping[str, Sequence[Any]] | Combinations | RowChanges | Sequence[Iterable[str] | Mapping[str, Any]]
"""Path to values, run in every combination; or a list of variations, each path to value or texts "path=value"; an empty
variation is the unchanged car."""

MOST_NAMED = 3
"""Maximum number of inputs named in a message."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SweepPlan:
    """Checked sweep, ready to run."""

    name: str  # name of the car
    cases: Cases  # the runs
    measure: Measure  # measure of each run
    skip: float  # start of the evaluation [s]
    settings: SweepSettings  # settings of the runs
    notes: tuple[str, ...]  # messages on side effects of the varied parameters, and on short roads
    # returns the evaluation of the table, for a caption with tyres and evaluated span
    evaluation_of: Callable[[SweepTable, str], Evaluation]

    @property
    def tyres(self) -> str:
        """Return a description of the state of the tyres in all runs: standing or rolling at a speed."""
        return all_tyre_words(self.cases)

    def engine_notes(self) -> tuple[str, ...]:
        """Return a message on the inputs on which MuJoCo runs the first or the last car, with the reason.

        For this both cars, in which the varied values have their first and their last value, are run on each input with
        the reduced engine; from their computing time the message says how long that engine takes for all runs. With
        the reduced engine the message names the first input on which the first car leaves its valid range.
        """
        engine = self.cases[0].engine
        if self.settings.estimate:
            return (NOTE,)
        if not isinstance(self.measure, BatchMeasure):
            return ()
        if engine == "reduced":
            return self._outside_range(self.measure)
        count, reasons, states, seconds = len(self.cases.changes), {}, [], 0.0
        for number, (source, _) in enumerate(self.cases.inputs):
            for car, which in {count - 1: "last", 0: "first"}.items():
                began = clock.perf_counter()
                states.append(reason := reason_for_mujoco(self.cases[number * count + car], self.measure))
                duration_s = clock.perf_counter() - began
                if reason:
                    reasons[source.name] = which, reason
            # A vector of cars takes as long as one car; the last run found the program compiled.
            seconds += duration_s * math.ceil(count / FILL)
        reduced = f"--engine reduced would take about {duration(max(seconds, 1.0))} for all {len(self.cases)} runs"
        asked = f"engine mujoco, as requested; {reduced}"
        if not reasons:
            inside = engine == "mujoco" and None not in states
            return (f"{asked}, within the valid range of the reduced engine ({ERROR_IN_RANGE})",) if inside else ()
        names = ", ".join(list(reasons)[:MOST_NAMED]) + (" ..." if len(reasons) > MOST_NAMED else "")
        which, reason = next(iter(reasons.values()))
        where = (
            f"on {names} ({len(reasons)} of {len(self.cases.inputs)} inputs), at least for the {which} car: {reason}"
        )
        if engine == "mujoco":
            return (f"{asked}{_difference(reason)}, outside the valid range of the reduced engine {where}",)
        return (f"engine mujoco {where}; {reduced}{_difference(reason)}",)

    def _outside_range(self, measure: BatchMeasure) -> tuple[str, ...]:
        """Return a message on the first input on which the first car leaves the valid range of the reduced engine."""
        count, roads = len(self.cases.changes), dict[str, int]()
        for number, (source, _) in enumerate(self.cases.inputs):
            # Other seeds of a road hardly differ in the largest rotation.
            one_seed = replace(source, tagged=False) if isinstance(source, RoadDrive) else source
            roads.setdefault(one_seed.name, number)
        for name, number in roads.items():
            if reason := reason_for_mujoco(self.cases[number * count], measure):
                where = f"outside the valid range of the reduced engine on {name}, at least for the first car"
                return (f"{where}: {reason}{_difference(reason)}; --engine mujoco runs the complete model",)
        return ()

    def range_notes(self) -> tuple[str, ...]:
        """Return messages on the first car and the first input on which its dampers leave the range of their tests."""
        count = len(self.cases.changes)
        with contextlib.suppress(*OF_A_RUN):  # the row of the case has the error message
            for number, (source, _) in enumerate(self.cases.inputs):
                car = loaded_car(self.cases[number * count])
                tested = [each.name for each in car.vehicle.composition.dampers if each.law.tested]
                if not tested:
                    return ()
                # `outside_tests` reads only these velocities; it runs the comfort of its laws again.
                run = fast_run(car, signal_of(source), [*(f"{name}_velocity" for name in tested), *RAIL])
                if texts := outside_tests(replace(run, skip=self.skip)):
                    return tuple(f"first car on {source.name}: {text}" for text in texts)
        return ()

    def run(self, **changed: Any) -> SweepTable:
        """Run the sweep, see `vehicle.studies.sweeps.sweep.sweep_cases`; `changed` replaces settings."""
        return sweep_cases(self.cases, self.measure, replace(self.settings, **changed))


def _difference(reason: str) -> str:
    """Return the difference of the reduced engine from MuJoCo as text; empty where a tyre pulls."""
    return "" if LIFTS in reason else f" (on class C {ERROR_ON_CLASS_C})"


class Design(Protocol):
    """Design of a sweep: the varied parameters, and the evaluation of their table."""

    @property
    def vehicle(self) -> str:
        """Return the name or file of the car; empty for that of the study."""

    def plan(self, car: Car, inputs: Inputs, settings: SweepSettings) -> SweepPlan:
        """Check cars and inputs before the first run and return the sweep; arguments and errors as in `sweep`."""


def plan_sweep(
    car: Car,
    vary: Variations,
    inputs: Inputs,
    settings: SweepSettings | None = None,
    evaluation_of: Callable[[SweepTable, str], Evaluation] | None = None,
) -> SweepPlan:
    """Check the arguments of a sweep and return the sweep; arguments and errors as in `sweep`.

    Args:
        evaluation_of: returns the evaluation of a table; by default its cars in the order of comfort, or the values of
            another measure.
    """
    settings, changes = settings or SweepSettings(), changes_of(vary)
    vehicle = file_of(car)
    each = _one_of_each_path(changes)
    require_paths(vehicle, car.overrides, each)
    sources = inputs_of(car, inputs, settings.skip)
    if settings.estimate and any(getattr(source, "chosen", "") for source in sources):
        raise ConfigurationError(
            "--precision: chooses the length of runs, and --estimate runs nothing; leave one of them out"
        )
    if any(text.partition("=")[0].strip().endswith("speed") for text in each):
        require_speed_of_roads(sources, changes)
    start = common_start(sources, settings.skip)
    sources = [evaluated_from(source, start) for source in sources]
    engine = ESTIMATE if settings.estimate else settings.engine
    cases = Cases(changes, sources, engine=engine, vehicle=vehicle, fixed=car.overrides)
    states = {(*car.overrides, *overrides_of(source)) for source in sources}
    run = [source for source in sources if isinstance(source, RoadDrive) and not settings.estimate]
    short = dict.fromkeys(text for source in run for text in source.notices)
    idle = tuple(set.intersection(*(set(_idle_notes(vehicle, state, changes, engine)) for state in states)))
    if idle and all(_all_idle(vehicle, state, each, engine) for state in states):
        raise ConfigurationError(f"vary: every run would be the same car: {'; '.join(idle)}")
    measure = chosen_measure(settings.measure, car.vehicle, start)
    if settings.estimate:
        alike = len(changes) if isinstance(changes, Combinations | RowChanges) else 0
        measure = estimate_measure(measure, car.vehicle, sources, alike=alike)
    require_on_inputs(measure, car, [changes[0], changes[-1]], sources)
    return SweepPlan(
        name=car.vehicle.name,
        cases=cases,
        measure=measure,
        skip=start,
        settings=settings,
        notes=(*body_rules(car.vehicle, [text.partition("=")[0] for text in each]), *idle, *short),
        evaluation_of=evaluation_of or (ranking_evaluation if settings.measure is None else measured_evaluation),
    )


@with_settings(SweepSettings)
def sweep(car: Car, vary: Variations, inputs: Inputs, settings: SweepSettings) -> SweepTable:
    """Run a car with varied parameters on one or several inputs, and tabulate comfort and slip.

    The runs are distributed to processes, so a script must call this function below `if __name__ == "__main__":`.

    Args:
        car: car loaded by `Car.load`; its overrides apply to every run.
        vary: path to values, for example {"damper.coulomb_friction": [62.5, 125]}, for every combination; or a list of
            variations, each path to value, in which {} is the car itself. If the variations of a list change different
            parameters, the car itself is the first row without being named, so that each is compared with it.
        inputs: files, names of shipped files, roads, signals; one or several.

    Returns:
        A row for each run with its engine, the inputs varying slowest; a failed run is a row with an error message.

    Raises:
        ConfigurationError: a path does not exist, no varied parameter has an effect, an input is missing, or a setting
            is out of range.
        DataError: an input cannot be read, or was sampled below 125 Hz.
    """
    return plan_sweep(car, vary, inputs, settings).run()


def changes_of(vary: Variations) -> Sequence[tuple[str, ...]]:
    """Return the texts "path=value" of each variation, the last path varying fastest."""
    changes: Sequence[tuple[str, ...]]
    if isinstance(vary, Mapping):
        columns = [[text for value in each for text in assignments({path: value})] for path, each in vary.items()]
        changes = Combinations(columns)
    elif isinstance(vary, Combinations | RowChanges):
        changes = vary
    else:
        changes = [tuple(assignments(each)) for each in vary]
        # The first variation is the base if all others change its parameters too.
        if changes and not all(_values(changes[0]).keys() <= _values(each).keys() for each in changes):
            changes = [(), *changes] if () not in changes else changes
    if not any(changes):
        raise ConfigurationError("vary: no variation; pass {PATH: [VALUE, ...]}, e.g. {'damper.viscous': [1500, 2000]}")
    return changes


def require_paths(vehicle: Path | None, overrides: Sequence[str], changes: Sequence[str]) -> None:
    """Check before the first run that all parameters exist: a misspelt parameter would fail in every row.

    An invalid value fails only in its row.

    Args:
        vehicle: vehicle file; by default that of the Focus.
        overrides: texts "path=value" of every run.
        changes: texts "path=value".
    """
    file = FOCUS_FILE if vehicle is None else vehicle_file(vehicle)
    overridden(file, overrides)
    try:
        overridden(file, [*overrides, *changes])
    except ConfigurationError as error:
        raise ConfigurationError(error.args[0].replace("--set ", "varied parameter ", 1)) from None


def _idle_notes(
    file: Path | None, overrides: Sequence[str], changes: Sequence[Sequence[str]], engine: str
) -> tuple[str, ...]:
    """Return a message for each varied parameter without effect; empty if laws vary, which may switch it on."""
    each = _one_of_each_path(changes)
    first = _values(each)
    for change in changes:
        different = [(first[path], value) for path, value in _values(change).items()]
        if any(old != new and (old[:1].isalpha() or new[:1].isalpha()) for old, new in different):
            return ()
    try:
        return idle_parameters(load_vehicle(file, [*overrides, *each]), each, engine)
    except ConfigurationError:
        return ()  # the row contains the reason


def _all_idle(file: Path | None, overrides: Sequence[str], change: Sequence[str], engine: str) -> bool:
    """Return True if no parameter that a variation sets has an effect, on none of the axles that a path means."""
    vehicle = load_vehicle(file, [*overrides, *change])
    return all(
        idle_parameters(vehicle, [f"{whole}={text.partition('=')[2]}"], engine)
        for text in change
        for whole in meant(vehicle.table, text.partition("=")[0].strip())
    )


def _one_of_each_path(changes: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """Return the first text "path=value" of each varied parameter."""
    if isinstance(changes, Combinations | RowChanges):
        return tuple(changes[0])
    first: dict[str, str] = {}
    for change in changes:
        for text in change:
            first.setdefault(text.partition("=")[0].strip(), text)
    return tuple(first.values())


def _values(change: Sequence[str]) -> dict[str, str]:
    """Return the text of the value of each path of a variation."""
    return {path.strip(): value.strip(" \"'") for path, _, value in (text.partition("=") for text in change)}
