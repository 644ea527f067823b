"""`python -m vehicle optimise`: search for Pareto-optimal parameters within bounds and limits."""

import argparse
import shlex
from pathlib import Path

from vehicle.commands.chosen_inputs import chosen_inputs
from vehicle.commands.command_line import ProgressLine, command
from vehicle.commands.destination import study_folder_of
from vehicle.commands.input_options import signal_options
from vehicle.commands.options import (
    command_parser,
    message_options,
    output_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.studies.optimisation.search_settings import SearchSettings


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "optimise", "Search for parameters with the best compromise of comfort, tyre load and travel."
    )
    signal_options(parser, several=True)
    vehicle_options(parser)
    search = parser.add_argument_group("the search")
    search.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="PATH=LOW:HIGH",
        help="a parameter and its bounds, in its unit, as front.damper.viscous=800:4000; *.damper.viscous sets all "
        "that end so alike. May be repeated",
    )
    search.add_argument(
        "--minimise",
        action="append",
        default=[],
        metavar="NUMBER[@INPUT]",
        help="an objective: a figure of a ride, as unweighted, weighted, seat_weighted, tyre_load, travel, "
        "peak:seat_rail_acc_z; of an axis or wheel weighted_z, travel_fr; after the @ an input, as road_A_120 or the "
        "stem of a file, or mean or worst of all. May be repeated",
    )
    search.add_argument(
        "--targets",
        metavar="FILE.toml",
        help="in place of objectives: the smallest change of at most 8 parameters with which all figures of the file "
        "meet their limits, on the inputs of the file, which is that of `report --targets`",
    )
    search.add_argument(
        "--cost",
        action="append",
        default=[],
        metavar="PATH=C",
        help="with --targets: a change of this parameter counts C times. By default 1. May be repeated",
    )
    setting_options(search, SearchSettings, "maximise", "limits", "cars", "population", "seed")
    setting_options(parser, SearchSettings, "tolerances")
    tolerances = parser.scoped_group(
        "cars as they are made",
        needs="--tolerance PATH=SIZE, and there is none",
        active=lambda options: bool(options.tolerances),
    )
    setting_options(tolerances, SearchSettings, "samples", "quantile")
    setting_options(parser, SearchSettings, "engine", "skip", "jobs", "executor", "check")
    parser.add_argument(
        "--beside", type=Path, metavar="DIR", help="another search with these objectives: drawn with its distance"
    )
    output_options(parser, Path("runs/optimise"))
    parser.add_argument("--resume", action="store_true", help="go on in that folder, also with more --cars")
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.model.parameters.ranges import parsed_variation
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import study_folder
    from vehicle.studies.optimisation.car_search import plan_search
    from vehicle.studies.optimisation.car_table import CARS
    from vehicle.studies.optimisation.problem import parsed_tolerance
    from vehicle.studies.optimisation.search_files import read_other_front
    from vehicle.studies.optimisation.stored_search import SEARCH
    from vehicle.studies.sweeps.executors import executor_factory

    if options.targets is not None:
        _meet_targets(options)
        return
    settings = SearchSettings.of_options(
        options,
        executor=None if options.executor is None else executor_factory(options.executor),
        tolerances=[parsed_tolerance(text) for text in options.tolerances or ()],
    )
    car = Car.load(options.vehicle, options.overrides)
    vary = [parsed_variation("--vary", text).range() for text in options.vary]
    plan = plan_search(car, vary, chosen_inputs(options, car.vehicle), options.minimise, settings)
    beside = None if options.beside is None else read_other_front(options.beside, plan.trials.problem)
    rows = (CARS, SEARCH)
    output = study_folder_of(options, options.output, rows=rows)
    with study_folder(output, force=options.force, resume=options.resume, rows=rows) as folder:
        cars = plan.run(folder, progress=ProgressLine("optimise  ", enabled=not options.quiet))
        cars.write(folder, beside=beside, command=f"python -m vehicle optimise {shlex.join(options.words)}")
    if not options.quiet:
        print(cars.text(output, beside))


def _meet_targets(options: argparse.Namespace) -> None:
    """Search for the smallest change that meets the targets in a file, and write its result."""
    from vehicle.errors import ConfigurationError
    from vehicle.model.parameters.ranges import parsed_variation
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import study_folder, write_json, write_text
    from vehicle.runs.output.own_files import parameters_text, write_own_files
    from vehicle.runs.targets.verdict import read_targets
    from vehicle.signals.excitation.road_drive import USUAL_DURATION
    from vehicle.studies.optimisation.target_search import meet_targets, outlook

    for name in ("minimise", "maximise", "limits", "tolerances", "check", "beside", "resume"):
        if getattr(options, name):
            option = f"--{name.removesuffix('s')}"
            raise ConfigurationError(f"--targets: searches by the limits of its file; leave out {option}")
    if options.input or options.road:
        raise ConfigurationError("--targets: its file names the inputs; leave out --input and --road")
    car, figures = Car.load(options.vehicle, options.overrides), read_targets(options.targets)
    costs = dict(_cost(text) for text in options.cost)
    output = study_folder_of(options, options.output, rows=())
    if not options.quiet:
        length = USUAL_DURATION if options.duration is None else options.duration
        print(f"note        {outlook(len(options.vary), figures, length)}", flush=True)
    with study_folder(output, force=options.force, resume=False, rows=()) as folder:
        result = meet_targets(
            car,
            figures,
            [parsed_variation("--vary", text).range() for text in options.vary],
            duration=options.duration,
            costs=costs,
            jobs=options.jobs,
            progress=ProgressLine("optimise  ", enabled=not options.quiet),
        )
        write_text(folder / "vehicle.toml", parameters_text(result.car, result.sentence))
        write_own_files(folder, result.car)
        command = f"python -m vehicle optimise {shlex.join(options.words)}"
        write_json(folder / "summary.json", {**result.summary(), "command": command})
    if not options.quiet:
        print(f"{output}: {result.change.runs} cars on {', '.join(result.inputs)}; vehicle.toml, summary.json")
        print(result)


def _cost(text: str) -> tuple[str, float]:
    """Return path and cost of a text as "front.damper.viscous=2".

    Raises:
        ConfigurationError: another form, or a cost that is not positive.
    """
    from vehicle.errors import ConfigurationError

    path, _, value = text.partition("=")
    try:
        cost = float(value)
    except ValueError:
        cost = 0.0
    if not 0.0 < cost < float("inf"):
        raise ConfigurationError(f"--cost {text}: must be PATH=C with a number above 0, as front.damper.viscous=2")
    return path, cost


main = command(parser, _job)
