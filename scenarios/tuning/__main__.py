"""Automatic fit of parameters to FRFs and bump records, which Bommer (2006) tuned by hand (section 3.2).

python -m scenarios.tuning [--output DIR] [--quick] [--jobs N] [--vehicle FILE.toml] [--force]
python -m scenarios.tuning --frf measured_low.uff --level low --frf measured_high.csv --level my_signal.csv
    [--record my_bump.mf4 --signal my_bump.csv]... [--map knuckle_fr_acc_z="Dof 12 +Z"]...
    [--fit damper.viscous=500:5000:1500]... [--channel NAME]... [--band 3:45] [--spacing 0.3] [--window 4]

Without --frf and --record: data of a hidden car with 3 % noise, from the authors' starting values.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
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
    own_claims,
    value_lines,
)
from scenarios.tuning.data import (
    AUTHORS,
    CHANNELS,
    HIDDEN,
    NOISE,
    QUICK,
    SLIDING,
    TEXT,
    make_measurements,
    parse_parameters,
)
from scenarios.tuning.figures import correlation_figure, level_figure, parameter_figure, record_figure
from scenarios.tuning.own_data import own_measurements
from vehicle.commands.command_line import ProgressLine
from vehicle.commands.compare import drift_option, mapping_options
from vehicle.commands.input_options import record_options
from vehicle.commands.parser import Parser
from vehicle.model.parameters.paths import overrides_of
from vehicle.model.parameters.ranges import Range
from vehicle.runs.car import Car, Run
from vehicle.studies.tuning.car_fit import require_fittable
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.full_steps import FullSteps, full_steps
from vehicle.studies.tuning.least_squares import Target, fit
from vehicle.studies.tuning.measured_targets import BAND, SPACING, MeasuredTarget
from vehicle.studies.tuning.record_target import RecordTarget


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
        return self.runs.car().varied(overrides_of(self.vehicle, values))

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
            return again([again.case(measurement.signal, changes) for measurement in measurements])

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
        *fit_notes("All levels and bumps in one fit", final.result, final),
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
            *fit_notes("Bump records alone (time-domain step)", from_records.result, from_records),
            *fit_notes("As the authors: low level alone, dampers stuck", stuck, None),
            *fit_notes("Then the damper alone from the bump records, the rest frozen", damper, None),
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


def own_study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    """Fit parameters to FRFs and time histories of files."""
    tuning = Tuning(runs)
    parameters: Sequence[Range] = parse_parameters(options.fit, tuning.vehicle)
    require_fittable(parameters, tuning.vehicle)
    measurements = own_measurements(options, runs.car())
    notices = [f"- {text}" for entry in measurements for text in entry.notices]
    for text in notices:
        print(f"notice: {text.removeprefix('- ')}", file=sys.stderr, flush=True)
    if not options.fit:
        stuck = all(isinstance(entry.target, FrfTarget) and entry.target.signal is None for entry in measurements)
        parameters = [entry for entry in AUTHORS if not stuck or entry.path not in SLIDING]
    result = tuning.fit("fit", parameters, [entry.target for entry in measurements])
    final = None if options.quick else tuning.finish(result, measurements, None)
    result = result if final is None else final.result
    files = [path.name for path in (*options.frf, *options.record)]
    _draw(folder, tuning, result, measurements, ", ".join(files))
    parameter_figure(folder / "parameters.png", {"fit": result}, {})
    return Findings(
        title=f"Parameters fitted to {', '.join(files)}",
        claims=own_claims(result, final),
        tyres=tuning.vehicle.driving.words,
        notes=[*fit_notes("The fit", result, final), *(["The files:\n\n" + "\n".join(notices)] if notices else [])],
        data={"all": fit_numbers(result)},
        values=value_lines(result, tuning.vehicle),
        own_data=True,
    )


def _draw(
    folder: Path, tuning: Tuning, result: TuningResult, measurements: Sequence[MeasuredTarget], source: str
) -> None:
    """Draw data, start and fit of every target, and the correlations."""
    start = tuning.build({measurement.path: measurement.start for measurement in result.parameters})
    end = tuning.build(result.values)
    for index, measurement in enumerate(measurements):
        if isinstance(measurement.target, FrfTarget):
            level_figure(
                folder / f"frf_{index + 1}_{measurement.target.name}.png", measurement.target, start, end, source
            )
    records = [measurement.target for measurement in measurements if isinstance(measurement.target, RecordTarget)]
    if records:
        record_figure(folder / "records.png", records, start, end, source)
    correlation_figure(folder / "correlation.png", result)


def add_options(study_options: Parser) -> None:
    """Add the options of this study."""
    study_options.add_argument(
        "--frf",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="measured FRFs, or accelerations with the plate, in any format of `inspect`; repeatable",
    )
    study_options.add_argument(
        "--record",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="own time histories, of a bump or of anything else, in any format of `inspect`; repeatable",
    )
    own_group = study_options.scoped_group(
        "own data", needs="--frf or --record", active=lambda options: bool(options.frf or options.record)
    )
    responses = study_options.scoped_group("own FRFs", needs="--frf", active=lambda options: bool(options.frf))
    records = study_options.scoped_group(
        "own time histories", needs="--record", active=lambda options: bool(options.record)
    )
    responses.add_argument(
        "--level",
        action="append",
        default=[],
        metavar="low|FILE.csv",
        help="one for each --frf: low takes the linear car with stuck dampers; else the displacement signal that the "
        "FRFs were measured with",
    )
    records.add_argument(
        "--signal",
        action="append",
        default=[],
        metavar="FILE",
        help="one for each --record: the displacement of the plate, which begins with the record",
    )
    records.add_argument(
        "--delay", type=float, default=0.0, metavar="S", help="the records began this long after it [s]"
    )
    drift_option(records)
    records.add_argument("--stretch", metavar="FROM:TO", help="part of the signals that counts for --record [s]")
    records.add_argument(
        "--lowpass", type=float, default=100.0, metavar="HZ", help="records are compared below it; %(default)g Hz"
    )
    mapping_options(own_group)
    record_options(own_group, "", channel=False)
    own_group.add_argument(
        "--fit",
        action="append",
        default=[],
        metavar=TEXT,
        help="parameter, its bounds and where the fit begins; those of Bommer 2006 by default; may be repeated",
    )
    own_group.add_argument(
        "--channel",
        action="append",
        default=[],
        metavar="NAME",
        help=f"channel that counts; by default {', '.join(CHANNELS)} of FRFs, all but the plates of records; may be "
        "repeated",
    )
    responses.add_argument(
        "--band", default=f"{BAND[0]:g}:{BAND[1]:g}", metavar="LOW:HIGH", help="fitted frequencies [Hz]; %(default)s"
    )
    responses.add_argument(
        "--spacing", type=float, default=SPACING, metavar="HZ", help="distance of the frequencies [Hz]; %(default)g"
    )
    responses.add_argument(
        "--window", type=float, metavar="S", help="the FRFs were averaged over Hann windows this long"
    )


LONGEST_STEP = 5e-4
"""Largest step of MuJoCo [s]: every stiffness within the bounds is stable with it. The fast models do not use it."""


def _study(runs: CarRuns, folder: Path, options: argparse.Namespace) -> Findings:
    step = f"solver.timestep={min(LONGEST_STEP, runs.car().vehicle.solver.step)!r}"
    runs = CarRuns(vehicle=runs.vehicle, overrides=(*runs.overrides, step), engine=runs.engine, jobs=runs.jobs)
    if options.frf or options.record:
        return own_study(runs, folder, options)
    return study(runs, folder, quick=options.quick)


main = car_study("tuning", _study, add_options)


if __name__ == "__main__":
    sys.exit(main())
