"""Automatic fit of parameters to FRFs and bump records, which Bommer (2006) tuned by hand (section 3.2).

python -m scenarios.tuning [--output DIR] [--quick] [--jobs N] [--vehicle FILE.toml] [--force]

Data of a hidden car with 3 % noise, from the authors' starting values. `python -m vehicle tune` fits measured files.
"""

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from scenarios.car_runs import CarRuns
from scenarios.claims import Findings
from scenarios.study import car_study
from scenarios.tuning.claims import (
    data_note,
    demonstration_claims,
    fit_notes,
    fit_numbers,
    frozen_note,
)
from scenarios.tuning.data import (
    AUTHORS,
    CHANNELS,
    HIDDEN,
    QUICK,
    SLIDING,
    make_measurements,
)
from scenarios.tuning.figures import parameter_figure
from vehicle.commands.console import ProgressLine
from vehicle.model.parameters.paths import overrides_of
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car, Run
from vehicle.runs.output.folder import write_files
from vehicle.studies.tuning.car_fit import tune
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.fit_settings import SPACING
from vehicle.studies.tuning.full_steps import FullSteps, full_steps
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget
from vehicle.studies.tuning.tuned_car import TunedCar
from vehicle.studies.tuning.tuning_files import figures_of
from vehicle.studies.tuning.tuning_text import value_lines


def fitted(name: str, car: Car, parameters: Sequence[Range], measurements: Sequence[MeasuredTarget]) -> TuningResult:
    """Fit parameters of a car with the fast models; show the progress."""
    line = ProgressLine(name)
    result = tune(car, parameters, measurements, progress=lambda count, _: line(count / (count + 40.0)))
    line(1.0)
    return result


def finished(
    runs: CarRuns, result: TuningResult, measurements: Sequence[MeasuredTarget], engine: str | None
) -> FullSteps:
    """Continue a fit with full simulations, also of the low level, whose fast model is that of stuck dampers."""

    def simulate(values: Mapping[str, float]) -> list[Run]:
        changes = overrides_of(runs.car().vehicle, values)
        # Runs of its own: the cache of `runs` would keep the records of every step.
        again = CarRuns(vehicle=runs.vehicle, overrides=runs.overrides, engine=engine or runs.engine, jobs=runs.jobs)
        signals = [measurement.signal for measurement in measurements if measurement.signal is not None]
        return again([again.case(signal, changes) for signal in signals])

    return full_steps(result, [measurement.target for measurement in measurements], simulate)


def study(runs: CarRuns, folder: Path, *, quick: bool) -> Findings:
    """Find the hidden car from its data, draw the figures into the folder, and compare."""
    car = runs.car()
    engine = "reduced" if quick else None
    parameters = [entry for entry in AUTHORS if not quick or entry.path in QUICK]
    true = {entry.path: HIDDEN[entry.path] for entry in parameters}
    measurements = make_measurements(
        runs,
        folder,
        fitted=list(true),
        levels=("high",) if quick else ("low", "mid", "high"),
        channels=CHANNELS[::3] if quick else CHANNELS,
        bumps=("bump_7p5mm",) if quick else ("bump_1p5mm", "bump_7p5mm"),
        spacing=1.0 if quick else SPACING,
        engine=engine,
    )
    result = fitted("all in one", car, parameters, measurements)
    final = finished(runs, result, measurements, engine)
    begin = car.with_(overrides_of(car.vehicle, {entry.path: entry.start for entry in parameters}))
    tuned = TunedCar(
        start=begin,
        result=final.result,
        measurements=tuple(measurements),
        engine=engine or runs.engine,
        final=final,
    )
    write_files(folder, {f"{name}.png": draw for name, draw in figures_of(tuned).items()})
    results, from_records = {"all levels in one fit": final.result}, None
    notes = [
        data_note(measurements, engine or runs.engine, quick),
        *fit_notes("All levels and bumps in one fit", final.result, final, car.vehicle),
    ]
    data: dict[str, Any] = {"true": true, "all": fit_numbers(final.result), "all_fast": fit_numbers(result)}
    if not quick:
        # The authors' order: the low level, which comes first, then the damper from the bumps, the rest frozen.
        bumps = [entry for entry in measurements if isinstance(entry.target, RecordTarget)]
        others, damper_only = (
            [entry for entry in parameters if (entry.path in SLIDING) is slides] for slides in (False, True)
        )
        stuck = fitted("low level", car, others, measurements[:1])
        damper = fitted("damper", car.with_(overrides_of(car.vehicle, stuck.values)), damper_only, bumps)
        from_records = finished(runs, fitted("bump records", car, parameters, bumps), bumps, None)
        results["bump records alone"] = from_records.result
        notes += [
            *fit_notes("Bump records alone (time-domain step)", from_records.result, from_records, car.vehicle),
            *fit_notes("As the authors: low level alone, dampers stuck", stuck, None, car.vehicle),
            *fit_notes("Then the damper alone from the bump records, the rest frozen", damper, None, car.vehicle),
            frozen_note(damper, true),
        ]
        data |= {
            "bumps": fit_numbers(from_records.result),
            "low": fit_numbers(stuck),
            "damper_frozen": fit_numbers(damper),
        }
    parameter_figure(folder / "parameters.png", results, true)
    return Findings(
        title="Parameters fitted to FRFs and bump records (Bommer 2006, section 3.2, automatic)",
        claims=demonstration_claims(final, from_records, true),
        tyres=car.vehicle.driving.words,
        unjudged={"bump records alone, and the authors' own order": "left out with --quick"} if quick else {},
        notes=notes,
        data=data,
        values=value_lines(final.result, car.vehicle),
    )


LONGEST_STEP = 5e-4
"""Largest step of MuJoCo [s]: every stiffness within the bounds is stable with it. The fast models do not use it."""


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    step = f"solver.timestep={min(LONGEST_STEP, runs.car().vehicle.solver.step)!r}"
    runs = CarRuns(vehicle=runs.vehicle, overrides=(*runs.overrides, step), engine=runs.engine, jobs=runs.jobs)
    return study(runs, folder, quick=options.quick)


main = car_study("tuning", _study)


if __name__ == "__main__":
    sys.exit(main())
