"""Automatic fit of parameters to FRFs and bump records, which Bommer (2006) tuned by hand (section 3.2).

python -m scenarios.tuning [--output DIR] [--quick] [--jobs N] [--vehicle FILE.toml] [--force]

Data of a hidden car with 3 % noise, from the authors' starting values. `python -m vehicle tune` fits measured files.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
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
    NOISE,
    QUICK,
    SLIDING,
    make_measurements,
)
from scenarios.tuning.figures import parameter_figure
from vehicle.commands.command_line import ProgressLine
from vehicle.model.parameters.paths import overrides_of
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car, Run
from vehicle.runs.output.folder import write_whole
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.fit_settings import SPACING
from vehicle.studies.tuning.full_steps import FullSteps, full_steps
from vehicle.studies.tuning.least_squares import fit
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget
from vehicle.studies.tuning.target import Target
from vehicle.studies.tuning.tuning_figures import plot_correlation, plot_histories, plot_responses
from vehicle.studies.tuning.tuning_text import value_lines


class Tuning:
    """Fits of one car.

    Args:
        runs: makes its cars and its full simulations.
    """

    def __init__(self, runs: CarRuns) -> None:
        self.runs = runs
        self.vehicle = runs.car().vehicle

    def build(self, values: Mapping[str, float]) -> Car:
        """Return the car with given values; not cached."""
        return self.runs.car().with_(overrides_of(self.vehicle, values))

    def fit(
        self,
        name: str,
        parameters: Sequence[Range],
        targets: Sequence[Target],
        frozen: Mapping[str, float] = MappingProxyType({}),
    ) -> TuningResult:
        """Fit parameters with the fast models, with frozen values of others; show the progress."""
        line = ProgressLine(name)
        result = fit(
            parameters,
            targets,
            lambda values: self.build({**frozen, **values}),
            progress=lambda count, _: line(count / (count + 40.0)),
        )
        line(1.0)
        return result

    def finish(self, result: TuningResult, measurements: Sequence[MeasuredTarget], engine: str | None) -> FullSteps:
        """Continue a fit with the full simulation."""

        def simulate(values: Mapping[str, float]) -> list[Run]:
            changes = overrides_of(self.vehicle, values)
            again = CarRuns(
                vehicle=self.runs.vehicle,
                overrides=self.runs.overrides,
                engine=engine or self.runs.engine,
                jobs=self.runs.jobs,
            )
            signals = [measurement.signal for measurement in measurements if measurement.signal is not None]
            return again([again.case(signal, changes) for signal in signals])

        return full_steps(result, [measurement.target for measurement in measurements], simulate)


def study(runs: CarRuns, folder: Path, *, quick: bool) -> Findings:
    """Find the hidden car from its data, draw the figures into the folder, and compare."""
    tuning = Tuning(runs)
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
    result = tuning.fit("all in one", parameters, [entry.target for entry in measurements])
    final = tuning.finish(result, measurements, engine)
    source = f"hidden car, engine {engine or runs.engine}, {100 * NOISE:g} % noise"
    _draw(folder, tuning, final.result, measurements, source)
    results, from_records = {"all levels in one fit": final.result}, None
    notes = [
        data_note(measurements, engine or runs.engine, quick),
        *fit_notes("All levels and bumps in one fit", final.result, final, tuning.vehicle),
    ]
    data: dict[str, Any] = {"true": true, "all": fit_numbers(final.result), "all_fast": fit_numbers(result)}
    if not quick:
        # The authors' order: the low level, which comes first, then the damper from the bumps, the rest frozen.
        bumps = [entry for entry in measurements if isinstance(entry.target, RecordTarget)]
        records = [entry.target for entry in bumps]
        others, damper_only = (
            [entry for entry in parameters if (entry.path in SLIDING) is slides] for slides in (False, True)
        )
        stuck = tuning.fit("low level", others, [measurements[0].target])
        damper = tuning.fit("damper", damper_only, records, stuck.values)
        from_records = tuning.finish(tuning.fit("bump records", parameters, records), bumps, None)
        results["bump records alone"] = from_records.result
        notes += [
            *fit_notes("Bump records alone (time-domain step)", from_records.result, from_records, tuning.vehicle),
            *fit_notes("As the authors: low level alone, dampers stuck", stuck, None, tuning.vehicle),
            *fit_notes("Then the damper alone from the bump records, the rest frozen", damper, None, tuning.vehicle),
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
        tyres=tuning.vehicle.driving.words,
        unjudged={"bump records alone, and the authors' own order": "left out with --quick"} if quick else {},
        notes=notes,
        data=data,
        values=value_lines(final.result, tuning.vehicle),
    )


def _draw(
    folder: Path, tuning: Tuning, result: TuningResult, measurements: Sequence[MeasuredTarget], source: str
) -> None:
    """Draw data, start and fit of every target, and the correlations."""
    start = tuning.build({measurement.path: measurement.start for measurement in result.parameters})
    end = tuning.build(result.values)
    for index, measurement in enumerate(measurements, 1):
        target = measurement.target
        if not isinstance(target, RecordTarget):
            file = folder / f"frf_{index}_{target.name}.png"
            write_whole(file, partial(plot_responses, target=target, start=start, fitted=end, source=source))
        else:
            file = folder / f"time_{index}_{target.name}.png"
            write_whole(file, partial(plot_histories, target=target, start=start, fitted=end, source=source))
    write_whole(folder / "correlation.png", partial(plot_correlation, result=result))


LONGEST_STEP = 5e-4
"""Largest step of MuJoCo [s]: every stiffness within the bounds is stable with it. The fast models do not use it."""


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    step = f"solver.timestep={min(LONGEST_STEP, runs.car().vehicle.solver.step)!r}"
    runs = CarRuns(vehicle=runs.vehicle, overrides=(*runs.overrides, step), engine=runs.engine, jobs=runs.jobs)
    return study(runs, folder, quick=options.quick)


main = car_study("tuning", _study)


if __name__ == "__main__":
    sys.exit(main())
