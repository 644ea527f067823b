"""`python -m vehicle sweep`: table of comfort and slip for variations of parameters and inputs."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.chosen_inputs import chosen_inputs
from vehicle.commands.command_line import ProgressLine, command
from vehicle.commands.destination import report_path, study_folder_of
from vehicle.commands.input_options import signal_options
from vehicle.commands.options import (
    command_parser,
    message_options,
    output_options,
    report_option,
    resume_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.studies.sweeps.sweep_settings import SweepSettings

if TYPE_CHECKING:
    from vehicle.model.parameters.ranges import Range
    from vehicle.studies.sweeps.case_table import Combinations
    from vehicle.studies.sweeps.plan import Variations


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("sweep", "Run the car with varied parameters on one or several inputs.")
    signal_options(parser, several=True)
    parser.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="PATH=VALUES",
        help="values of a parameter, as damper.coulomb_friction=62.5,125, or 62.5:125:6 for six equally spaced values; "
        "of a component of a vector, as bushings.tyre.stiffness.z=2e5,2.5e5; a whole vector is [x,y,z]; repeated: "
        "every combination",
    )
    parser.add_argument(
        "--table",
        type=Path,
        metavar="FILE.csv",
        help="columns are parameter paths, rows are variations; or the table.csv of another sweep",
    )
    parser.add_argument(
        "--sobol",
        type=int,
        metavar="N",
        help="Sobol indices of comfort, or of --measure, with N base points, a power of two, at least 64; each "
        "parameter is uniform between the bounds of --vary PATH=LOW:HIGH; N times (parameters + 2) runs on each input",
    )
    parser.add_argument(
        "--cases",
        type=Path,
        metavar="FILE.toml",
        help="roads, speeds, laden states and variants of a file, every car on every input, in one table",
    )
    parser.add_argument(
        "--each",
        metavar="P%[,Dmm]",
        help="change each parameter alone by P percent, down and up, and rank them by their effect on comfort or "
        "--measure; --vary PATH, as front.damper or viscous, chooses them; by default all stiffnesses, dampings, "
        "friction forces, masses; a coordinate, which has no percentage, is moved by D mm, 10 by default: 20%%,5mm",
    )
    vehicle_options(parser)
    setting_options(parser, SweepSettings, "measure", "engine", "skip", "jobs", "executor", "time_limit")
    output_options(parser, Path("runs/sweep"))
    resume_options(parser)
    parser.add_argument("--allow-failed", action="store_true", help="exit with 0, not 4, although runs failed")
    report_option(parser, "best and base car, picture, tables, how to repeat the sweep", "the sweep")
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.errors import ConfigurationError, SimulationError
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import study_folder, write_text, write_whole
    from vehicle.studies.sweeps.case_file import CASES, case_results, read_cases, write_cases
    from vehicle.studies.sweeps.case_table import RowChanges
    from vehicle.studies.sweeps.differences import DIFFERENCES
    from vehicle.studies.sweeps.effects import EFFECTS, TORNADO, effect_lines, write_effects
    from vehicle.studies.sweeps.executors import executor_factory
    from vehicle.studies.sweeps.parameter_effects import effects_of, single_changes, varied_parameters
    from vehicle.studies.sweeps.plan import plan_sweep
    from vehicle.studies.sweeps.sobol_sweep import SOBOL, comfort_indices, index_lines, sobol_changes, write_indices
    from vehicle.studies.sweeps.store import ROWS
    from vehicle.studies.sweeps.sweep_page import sweep_page
    from vehicle.studies.sweeps.sweep_picture import PICTURE, can_be_drawn, draw_ranked
    from vehicle.studies.sweeps.sweep_ranking import measure_lines, ranked_cars, ranking_lines
    from vehicle.studies.sweeps.sweep_table import read_variations

    if options.cases is not None and any(
        (options.vary, options.table, options.sobol, options.each, options.input, options.road)
    ):
        raise ConfigurationError(
            "--cases: its file has inputs and variants; leave out --vary, --input, --road and so on"
        )
    if options.each is not None and (options.table or options.sobol is not None):
        raise ConfigurationError("--each: takes --vary PATH, or no parameters; leave out --table and --sobol")
    if options.cases is None and options.each is None and bool(options.vary) == bool(options.table):
        raise ConfigurationError("give either --vary PATH=A,B,C (once or more) or --table FILE.csv")
    if options.measure is not None and (options.report is not None or options.cases is not None):
        raise ConfigurationError("--measure: these are of comfort: leave out --report and --cases")
    if options.sobol is not None and (options.table or options.report is not None):
        raise ConfigurationError(
            "--sobol: needs --vary PATH=LOW:HIGH, and has no report; leave out --table and --report"
        )
    ranges = [] if options.sobol is None else ranges_of(options.vary)
    changes: Variations
    listed = None if options.cases is None else read_cases(options.cases)
    car = Car.load((listed and listed.vehicle) or options.vehicle, options.overrides)
    parameters: dict[str, tuple[float, str]] = {}
    without: tuple[str, ...] = ()
    share = shift = 0.0
    if listed is not None:
        changes = list(listed.cars.values())
    elif options.each is not None:
        share, shift = steps_of(options.each)
        parameters = varied_parameters(car.vehicle, options.vary)
        changes, without = single_changes(car.vehicle, parameters, share, shift)
    elif ranges:
        changes = sobol_changes(ranges, options.sobol)
    else:
        changes = RowChanges(*read_variations(options.table)) if options.table else every_combination(options.vary)
    make = None if options.executor is None else executor_factory(options.executor)
    settings = SweepSettings.of_options(options, executor=make)
    inputs = listed.inputs if listed is not None else chosen_inputs(options, car.vehicle)
    plan = plan_sweep(car, changes, inputs, settings)
    output = study_folder_of(options, options.output, rows=(ROWS,))
    report = None if options.report is None else report_path(options, output)
    notes = (*plan.notes, *plan.engine_notes(), *plan.range_notes())
    for text in () if options.quiet else notes:
        print(f"note        {text}")
    with study_folder(output, force=options.force, resume=options.resume, rows=(ROWS,)) as folder:
        table = plan.run(
            folder=folder,
            progress=ProgressLine("sweep     ", enabled=not options.quiet, runs=len(plan.cases)),
            notice=lambda text: print(f"note: {text}", file=sys.stderr, flush=True),
        )
        indices = comfort_indices(table, ranges) if ranges else None
        if indices is not None:
            write_whole(folder / SOBOL, lambda path: write_indices(path, indices))
        effects = effects_of(table, parameters, share, without, shift) if parameters else None
        # Read before the folder of the rows gets its name.
        other = ranges or parameters or listed
        measured = [] if options.measure is None or other else measure_lines(table)
        cars, failed = None if other or measured else ranked_cars(table), table.failed
        results = None if listed is None else case_results(table, listed)
        if results is not None:
            write_whole(folder / CASES, lambda path: write_cases(path, results))
        drawn = cars is not None and can_be_drawn(cars)
        caption = f"tyres {plan.tyres}, evaluated from {plan.skip:g} s on"
        if cars is not None and drawn:
            write_whole(folder / PICTURE, lambda path: draw_ranked(path, cars, caption))
        if effects is not None:
            write_whole(folder / EFFECTS, lambda path: write_effects(path, effects))
            write_whole(folder / TORNADO, lambda path: effects.write_picture(path, caption))
        if report is not None:
            command = f"python -m vehicle sweep {shlex.join(options.words)}"
            head = {"author": options.author, "project": options.project}
            page = sweep_page(
                table,
                car.vehicle.name,
                caption=caption,
                command=command,
                notes=notes,
                effects=effects,
                results=results,
                **head,
            )
            write_text(folder / report if report.parent == Path() else report, page)
    if not options.quiet:
        more = "" if report is None else f"{report}, "
        more += f"{PICTURE}, " if drawn else ""
        more += f"{SOBOL}, " if ranges else ""
        more += f"{CASES}, " if results is not None else ""
        more += f"{EFFECTS}, {TORNADO}, " if effects is not None else ""
        more += f"{DIFFERENCES} (comfort against the first car), " if (output / DIFFERENCES).exists() else ""
        print(
            f"{output}: {len(plan.cases)} runs, {len(failed)} failed, tyres {plan.tyres}, evaluated from "
            f"{plan.skip:g} s on; table.csv, {more}sweep.json, rows.jsonl, timing.csv"
        )
        if cars is not None or measured:
            print("\n".join(measured if cars is None else ranking_lines(cars)))
        if indices is not None:
            print("\n".join(index_lines(indices)))
        if results is not None:
            print("\n".join(results.lines()))
        if effects is not None:
            print("\n".join(effect_lines(effects)))
        for case, reason in failed[:5]:
            print(f"failed      {case.label}: {reason}")
    if failed and not options.allow_failed:
        raise SimulationError(
            f"{len(failed)} of {len(plan.cases)} runs failed; the table is written, with the reason in their "
            "rows; --allow-failed takes that as success"
        )


def steps_of(text: str) -> tuple[float, float]:
    """Return the share [-] and the shift of coordinates [m] of a text as "20%", "20" or "20%,5mm".

    Raises:
        ConfigurationError: no number.
    """
    from vehicle.errors import ConfigurationError
    from vehicle.studies.sweeps.sweep_settings import SHIFT

    percent, comma, length = text.strip().removeprefix("+-").partition(",")
    try:
        share = 0.01 * float(percent.removesuffix("%"))
        return share, 1e-3 * float(length.removesuffix("mm")) if comma else SHIFT
    except ValueError:
        raise ConfigurationError(
            f"--each {text!r}: must be a percentage, as --each 20%, or that and the shift of coordinates in mm, as "
            "--each 20%,5mm"
        ) from None


def every_combination(texts: Sequence[str]) -> Combinations:
    """Return all combinations of `--vary`; the last path varies fastest.

    Raises:
        ConfigurationError: an option is not PATH=A,B,C or PATH=A:B:N, or a path occurs twice.
    """
    from vehicle.errors import ConfigurationError
    from vehicle.model.parameters.ranges import parsed_variation
    from vehicle.studies.sweeps.case_table import Combinations

    columns: dict[str, list[str]] = {}
    for text in texts:
        variation = parsed_variation("--vary", text)
        if variation.path in columns:
            raise ConfigurationError(f"--vary {variation.path}: given twice; list all its values in one option")
        columns[variation.path] = [f"{variation.path}={value}" for value in variation.listed()]
    return Combinations(list(columns.values()))


def ranges_of(texts: Sequence[str]) -> list[Range]:
    """Return the ranges of `--vary PATH=LOW:HIGH`.

    Raises:
        ConfigurationError: an option has no bounds, or a path occurs twice.
    """
    from vehicle.errors import ConfigurationError
    from vehicle.model.parameters.ranges import parsed_variation

    ranges = [parsed_variation("--vary", text).range() for text in texts]
    paths = [each.path for each in ranges]
    if twice := next((path for path in paths if paths.count(path) > 1), ""):
        raise ConfigurationError(f"--vary {twice}: given twice; give its bounds once")
    return ranges


main = command(parser, _job)
