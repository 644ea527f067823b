"""`python -m vehicle tune CAR`: fit parameters of a car to measured FRFs and time histories."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.clock_options import drift_option
from vehicle.commands.command_line import command
from vehicle.commands.console import Console, ProgressLine
from vehicle.commands.options import (
    CAR_HELP,
    command_parser,
    destination_of,
    head_options,
    message_options,
    output_options,
    read,
    set_option,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.commands.tune_measurements import has_files, measured_targets, measurement_options
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.tuning.fit_settings import HistorySettings, PosteriorSettings, ResponseSettings

if TYPE_CHECKING:
    from vehicle.model.parameters.ranges import Range
    from vehicle.runs.car import Car
    from vehicle.studies.tuning.frf_target import FrfTarget
    from vehicle.studies.tuning.posterior_text import NamedPosterior

OUTPUT = Path("runs/tune")


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("tune", "Fit parameters of a car to measured FRFs and time histories.")
    parser.add_argument("car", type=vehicle_file, metavar="CAR", help=CAR_HELP)
    set_option(parser)
    parser.add_argument(
        "--parameters",
        nargs="+",
        action="extend",
        default=[],
        metavar="PATH=LOW:HIGH",
        help="parameter to fit and its bounds (in its unit, above 0 except for a coordinate), for example "
        "front.damper.viscous=800:4000. The fit starts at the value of the car, or of --set",
    )
    measurement_options(parser)
    responses = parser.scoped_group(
        "FRFs",
        needs="--frf, or to --levels",
        active=lambda options: has_files(options, "frf") or any(each.levels for each in options.measurements),
    )
    setting_options(responses, ResponseSettings, "band", "spacing", "window", "averages")
    records = parser.scoped_group(
        "time histories", needs="--record", active=lambda options: has_files(options, "record")
    )
    drift_option(records)
    setting_options(records, HistorySettings, "stretch", "lowpass")
    parser.add_argument(
        "--posterior",
        action="store_true",
        help="also compute the uncertainty of the parameters from the FRFs: their probability distribution "
        "(posterior) by random sampling with emcee",
    )
    posterior = parser.scoped_group("posterior", needs="--posterior", active=lambda options: options.posterior)
    setting_options(posterior, PosteriorSettings)
    setting_options(parser, SweepSettings, "engine", default="mujoco")
    output_options(parser, OUTPUT)
    head_options(parser)
    parser.add_argument("--json", action="store_true", help="print the results as JSON, as in tune.json")
    parser.former("--measured", "--measured: FRFs are given by --frf FILE, time histories by --record FILE")
    parser.former("--(vary|fit) ", "the parameters to fit are given by --parameters PATH=LOW:HIGH")
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace, console: Console) -> None:
    from vehicle.model.parameters.ranges import parsed_variation
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import output_folder
    from vehicle.studies.tuning.car_fit import ranges_of, require_fittable
    from vehicle.studies.tuning.frf_target import FrfTarget
    from vehicle.studies.tuning.posterior import require_posterior
    from vehicle.studies.tuning.posterior_text import posterior_lines
    from vehicle.studies.tuning.tuned_car import tuned_car
    from vehicle.studies.tuning.tuning_files import NUMBERS, write_tuning
    from vehicle.studies.tuning.tuning_text import tuning_text

    if not options.measurements:
        raise ConfigurationError("the measurement is missing; add --frf FILE or --record FILE")
    if not options.parameters:
        raise ConfigurationError(
            "the parameters to fit are missing; add --parameters PATH=LOW:HIGH, for example damper.viscous=800:4000"
        )
    car = Car.load(options.car, options.overrides)
    bounds = [parsed_variation("--parameters", text).range() for text in options.parameters]
    parameters = ranges_of(car.vehicle, {entry.path: (entry.low, entry.high) for entry in bounds})
    require_fittable(parameters, car.vehicle)
    files = tuple(each.file for each in options.measurements)
    if len(files) > 1:
        console.require_one_file()
    inputs = [name for each in options.measurements for name in (each.signal, each.road) if name is not None]
    protect = tuple(Path(name) for name in inputs)
    folder = destination_of(options).folder(OUTPUT, protect=(*files, *protect))
    targets = measured_targets(options, car)
    console.accept(text for target in targets for text in target.notices)
    if not (options.quiet or options.json):
        for text in dict.fromkeys(text for target in targets for text in target.notices):
            print(f"notice: {text}", file=sys.stderr, flush=True)
    responses = [each.target for each in targets if isinstance(each.target, FrfTarget)]
    if options.posterior:
        require_posterior(responses)
    line = ProgressLine("fit       ", enabled=not options.quiet)
    tuned = tuned_car(
        car,
        parameters,
        targets,
        engine=options.engine,
        # The number of cars is not known before: 12 for each parameter is usual.
        progress=lambda count, _: line(0.7 * count / (count + 6.0 * len(parameters))),
        simulated=lambda count: line(0.7 + 0.3 * count / (count + 2.0)),
    )
    posteriors = _posteriors(options, car, parameters, responses) if options.posterior else []
    line(1.0)
    with output_folder(folder, force=options.force, protect=(*files, *protect)) as work:
        names = write_tuning(
            work,
            tuned,
            f"python -m vehicle tune {shlex.join(console.words)}",
            posteriors,
            author=options.author,
            project=options.project,
        )
    if options.json:
        print((folder / NUMBERS).read_text(encoding="utf-8"), end="")
    elif not options.quiet:
        print(tuning_text(tuned))
        if posteriors:
            print("\n".join(posterior_lines(posteriors, car.vehicle)))
        print(f"{folder}: {', '.join(names)}")


def _posteriors(
    options: argparse.Namespace, car: Car, parameters: Sequence[Range], targets: Sequence[FrfTarget]
) -> list[NamedPosterior]:
    """Return the posteriors of the fitted law and of its rival."""
    from vehicle.model.parameters.ranges import parsed_variation
    from vehicle.runs.car import Car
    from vehicle.studies.tuning.car_fit import ranges_of
    from vehicle.studies.tuning.posterior import emulated_car, posterior_of

    laws: list[tuple[str, Car, Sequence[Range]]] = [("fitted law", car, parameters)]
    chosen = read(options, PosteriorSettings)
    if chosen.rival:
        rival = [parsed_variation("--rival", text) for text in chosen.rival]
        settings = [f"{each.path}={each.values[0]}" for each in rival if each.bounds is None]
        fixed = {each.path for each in rival if each.bounds is None}
        other = Car.load(options.car, [*options.overrides, *settings])
        bounds = {each.path: each.bounds for each in rival if each.bounds is not None}
        middles = {
            path: (low, high, (low * high) ** 0.5 if low > 0.0 else 0.5 * (low + high))
            for path, (low, high) in bounds.items()
        }
        shared = [entry for entry in parameters if entry.path not in {*fixed, *bounds}]
        laws.append(("rival law", other, [*shared, *ranges_of(other.vehicle, middles)]))
    posteriors = []
    for name, law_car, law_parameters in laws:
        progress = ProgressLine(f"{name:<10}", enabled=not options.quiet)
        emulated = emulated_car(law_car, law_parameters, targets, cars=chosen.samples, progress=progress)
        posteriors.append((name, posterior_of(emulated, discrepancy=chosen.discrepancy)))
    return posteriors


main = command(parser, lambda options: options, _job)
