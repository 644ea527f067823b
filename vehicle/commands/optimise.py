"""`python -m vehicle optimise`: search for Pareto-optimal parameters within bounds and limits."""

from __future__ import annotations

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
from vehicle.studies.sweeps.sweep_settings import SweepSettings


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("optimise", "Search for the parameters with the best compromise of comfort, load, travel.")
    signal_options(parser, several=True)
    vehicle_options(parser)
    search = parser.add_argument_group("the search")
    search.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="PATH=LOW:HIGH",
        help="a parameter and its bounds, in its unit, as front.damper.viscous=800:4000; *.damper.viscous sets all "
        "that end so alike; may be repeated",
    )
    search.add_argument(
        "--minimise",
        action="append",
        default=[],
        metavar="NUMBER[@INPUT]",
        help="an objective: unweighted, weighted, seat_unweighted, seat_weighted [m/s2], seat_value, tyre_load, "
        "lowest_load, slip_share [-], travel [m]; one axis or wheel is weighted_z, travel_fr; after the @ an input, "
        "as road_A_120 or the stem of a file, or mean or worst of all; may be repeated",
    )
    search.add_argument(
        "--maximise", action="append", default=[], metavar="NUMBER[@INPUT]", help="an objective to maximise"
    )
    search.add_argument(
        "--limit",
        action="append",
        default=[],
        metavar="NUMBER[@INPUT]<=VALUE",
        help="constraint, as 'travel<=0.06' or 'lowest_load>=0.1', in the unit of the number; applies to "
        "every input by default; may be repeated",
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
        help="with --targets: a change of this parameter counts C times; 1 by default; may be repeated",
    )
    search.add_argument("--cars", type=int, default=2000, metavar="N", help="cars to try; %(default)s by default")
    search.add_argument(
        "--population",
        type=int,
        default=64,
        metavar="N",
        help="cars of a generation, at least 8; %(default)s by default",
    )
    search.add_argument(
        "--search-seed", type=int, default=1, metavar="N", help="one seed is one search; %(default)s by default"
    )
    parser.add_argument(
        "--tolerance",
        action="append",
        default=[],
        metavar="PATH=SIZE",
        help="half of the band of a parameter, varied or not: in its unit, or in percent: 15%%; may be repeated",
    )
    tolerances = parser.scoped_group(
        "cars as they are made",
        needs="--tolerance PATH=SIZE, and there is none",
        active=lambda options: bool(options.tolerance),
    )
    tolerances.add_argument(
        "--samples",
        type=int,
        metavar="K",
        help="cars within the tolerances for each car tried; 8 by default, more where the quantile needs them",
    )
    tolerances.add_argument(
        "--quantile",
        type=float,
        metavar="Q",
        help="of their numbers that counts, 0.5 to below 1; 1 is the worst of the K cars; their mean by default. A "
        "quantile Q needs 1/(1 - Q) cars; with it, 64 new cars around each named one show what share reaches its "
        "numbers",
    )
    setting_options(parser, SweepSettings, "engine", default="reduced")
    setting_options(parser, SweepSettings, "skip")
    setting_options(parser, SweepSettings, "jobs")
    setting_options(parser, SweepSettings, "executor")
    parser.add_argument(
        "--check", action="store_true", help="run the named cars with MuJoCo too and report the difference"
    )
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
    from vehicle.studies.optimisation.car_search import plan_search, require_counts
    from vehicle.studies.optimisation.car_table import CARS
    from vehicle.studies.optimisation.problem import parsed_tolerance
    from vehicle.studies.optimisation.search_files import read_other_front
    from vehicle.studies.optimisation.stored_search import SEARCH
    from vehicle.studies.sweeps.executors import executor_factory

    if options.targets is not None:
        _meet_targets(options)
        return
    require_counts(cars=options.cars, population=options.population, search_seed=options.search_seed)
    car = Car.load(options.vehicle, options.overrides)
    plan = plan_search(
        car,
        [parsed_variation("--vary", text).range() for text in options.vary],
        chosen_inputs(options, car.vehicle),
        options.minimise,
        maximise=options.maximise,
        limits=options.limit,
        tolerances=[parsed_tolerance(text) for text in options.tolerance],
        samples=options.samples,
        quantile=options.quantile,
        engine=options.engine,
        skip=options.skip,
        seed=options.search_seed,
    )
    beside = None if options.beside is None else read_other_front(options.beside, plan.trials.problem)
    make = executor_factory(options.executor, options.jobs)
    rows = (CARS, SEARCH)
    output = study_folder_of(options, options.output, rows=rows)
    with study_folder(output, force=options.force, resume=options.resume, rows=rows) as folder:
        cars = plan.run(
            folder,
            cars=options.cars,
            population=options.population,
            executor=make if options.executor or options.jobs > 1 else None,
            check=options.check,
            progress=ProgressLine("optimise  ", enabled=not options.quiet),
        )
        cars.write(folder, beside=beside, command=f"python -m vehicle optimise {shlex.join(options.words)}")
    if not options.quiet:
        print(cars.text(output, beside))


def _meet_targets(options: argparse.Namespace) -> None:
    """Search for the smallest change that meets the targets of a file, and write its result."""
    from vehicle.errors import ConfigurationError
    from vehicle.model.parameters.ranges import parsed_variation
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import study_folder, write_json, write_text
    from vehicle.runs.output.own_files import parameters_text, write_own_files
    from vehicle.runs.targets.verdict import read_targets
    from vehicle.studies.optimisation.target_search import meet_targets

    for name in ("minimise", "maximise", "limit", "tolerance", "check", "beside", "resume"):
        if getattr(options, name):
            raise ConfigurationError(f"--targets: searches by the limits of its file; leave out --{name}")
    if options.input or options.road:
        raise ConfigurationError("--targets: its file names the inputs; leave out --input and --road")
    car, figures = Car.load(options.vehicle, options.overrides), read_targets(options.targets)
    costs = dict(_cost(text) for text in options.cost)
    output = study_folder_of(options, options.output, rows=())
    with study_folder(output, force=options.force, resume=False, rows=()) as folder:
        found = meet_targets(
            car,
            figures,
            [parsed_variation("--vary", text).range() for text in options.vary],
            duration=options.duration,
            costs=costs,
            jobs=options.jobs,
            progress=ProgressLine("optimise  ", enabled=not options.quiet),
        )
        write_text(folder / "vehicle.toml", parameters_text(found.car, found.sentence))
        write_own_files(folder, found.car)
        command = f"python -m vehicle optimise {shlex.join(options.words)}"
        write_json(folder / "summary.json", {**found.summary(), "command": command})
    if not options.quiet:
        print(f"{output}: {found.change.runs} cars on {', '.join(found.inputs)}; vehicle.toml, summary.json")
        print(found)


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
