"""`python -m vehicle optimise`: search for Pareto-optimal parameters within bounds and limits."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import inputs_of, signal_options
from vehicle.commands.options import (
    car_of,
    command_parser,
    destination_of,
    message_options,
    output_options,
    read,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.studies.optimisation.search_settings import SearchSettings

if TYPE_CHECKING:
    from vehicle.model.parameters.ranges import Range
    from vehicle.studies.optimisation.search_study import SearchStudy, TargetStudy


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
        type=_range,
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
        help="an objective: a figure of a ride, as weighted, seat_weighted [m/s2], tyre_load [-], travel [m], "
        "peak:seat_rail_acc_z; of an axis or wheel weighted_z, travel_fr; after the @ an input, as road_A_120 or the "
        "stem of a file, or mean or worst of all. May be repeated",
    )
    search.add_argument(
        "--targets",
        type=Path,
        metavar="FILE.toml",
        help="in place of objectives: the smallest change of at most 8 parameters with which all figures of the file "
        "meet their limits, on the inputs of the file, which is that of `report --targets`",
    )
    search.add_argument(
        "--cost",
        action="append",
        type=_cost,
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


def _range(text: str) -> Range:
    """Return the range of a text as "front.damper.viscous=800:4000"."""
    from vehicle.model.parameters.ranges import parsed_variation

    return parsed_variation("--vary", text).range()


def _cost(text: str) -> tuple[str, float]:
    """Return path and cost of a text as "front.damper.viscous=2".

    Raises:
        ConfigurationError: another form, or a cost that is not positive.
    """
    path, _, value = text.partition("=")
    try:
        cost = float(value)
    except ValueError:
        cost = 0.0
    if not 0.0 < cost < float("inf"):
        raise ConfigurationError(f"--cost {text}: must be PATH=C with a number above 0, as front.damper.viscous=2")
    return path, cost


def settings_of(options: argparse.Namespace) -> SearchStudy | TargetStudy:
    """Return the study of parsed options.

    Raises:
        ConfigurationError: options without effect with --targets.
    """
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.studies.optimisation.search_study import SearchStudy, TargetStudy

    chosen = {"car": car_of(options), "destination": destination_of(options)}
    if options.targets is None:
        return read(options, SearchStudy, inputs=inputs_of(options), **chosen)
    for name in ("minimise", "maximise", "limits", "tolerances", "check", "beside", "resume"):
        if getattr(options, name):
            option = f"--{name.removesuffix('s')}"
            raise ConfigurationError(f"--targets: searches by the limits of its file; leave out {option}")
    if options.input or options.road:
        raise ConfigurationError("--targets: its file names the inputs; leave out --input and --road")
    return read(options, TargetStudy, **chosen)


def _job(study: SearchStudy | TargetStudy, console: Console) -> None:
    text = study.run(
        command=console.command("vehicle optimise"),
        begin=console.progress,
        note=lambda text: console.say(f"note        {text}"),
    )
    console.say(text)


main = command(parser, settings_of, _job)
