"""`python -m vehicle optimise`: search for Pareto-optimal parameters within bounds and limits."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import inputs_of, signal_options
from vehicle.commands.options import (
    acceleration_options,
    command_parser,
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
    acceleration_options(vehicle_options(parser))
    search = parser.add_argument_group("the search")
    search.add_argument(
        "--vary",
        action="append",
        type=_range,
        default=[],
        metavar="PATH=LOW:HIGH",
        help="parameter and its bounds in its unit, for example front.damper.viscous=800:4000; *.damper.viscous sets "
        "all parameters with this ending to one value. May be repeated",
    )
    search.add_argument(
        "--minimise",
        action="append",
        default=[],
        metavar="NUMBER[@INPUT]",
        help="figure of the ride to minimise, for example weighted, seat_weighted [m/s2], tyre_load [-], travel [m] or "
        "peak:seat_rail_acc_z; of one axis or wheel: weighted_z, travel_fr. @ adds the input: road_A_120, the stem of "
        "a file, mean or worst. May be repeated",
    )
    search.add_argument(
        "--targets",
        type=Path,
        metavar="FILE.toml",
        help="instead of objectives: find the smallest change of at most 8 parameters that meets all limits of this "
        "file on its inputs; `report --targets` reads the same file",
    )
    search.add_argument(
        "--cost",
        action="append",
        type=_cost,
        default=[],
        metavar="PATH=C",
        help="with --targets: count a change of this parameter C times; default: 1. May be repeated",
    )
    setting_options(search, SearchSettings, "maximise", "limits", "cars", "population", "seed")
    setting_options(parser, SearchSettings, "tolerances")
    tolerances = parser.scoped_group(
        "cars as they are made", needs="--tolerance PATH=SIZE", active=lambda options: bool(options.tolerances)
    )
    setting_options(tolerances, SearchSettings, "samples", "quantile")
    setting_options(parser, SearchSettings, "screen", "engine", "skip", "jobs", "executor", "check")
    parser.add_argument(
        "--beside",
        type=Path,
        metavar="DIR",
        help="also draw the front of another search with the same objectives, "
        "and print the distance between both fronts",
    )
    output_options(parser, Path("runs/optimise"))
    parser.add_argument("--resume", action="store_true", help="continue the search in this folder; --cars may grow")
    message_options(parser, quiet=True)
    return parser


def _range(text: str) -> Range:
    """Return the range of a text, for example "front.damper.viscous=800:4000"."""
    from vehicle.model.parameters.ranges import parsed_variation

    return parsed_variation("--vary", text).range()


def _cost(text: str) -> tuple[str, float]:
    """Return path and cost of a text, for example "front.damper.viscous=2"."""
    path, _, value = text.partition("=")
    try:
        cost = float(value)
    except ValueError:
        cost = 0.0
    if not 0.0 < cost < float("inf"):
        raise ConfigurationError(f"--cost {text}: must be PATH=C with C above 0, for example front.damper.viscous=2")
    return path, cost


def settings_of(options: argparse.Namespace) -> SearchStudy | TargetStudy:
    """Return the study of parsed options."""
    # Heavy packages are imported after the arguments are known to be good.
    from vehicle.studies.optimisation.search_study import SearchStudy, TargetStudy

    if options.targets is None:
        return read(options, SearchStudy, inputs=inputs_of(options))
    for name in ("minimise", "maximise", "limits", "tolerances", "screen", "check", "beside", "resume"):
        if getattr(options, name):
            option = f"--{name.removesuffix('s')}"
            raise ConfigurationError(f"--targets already sets the limits; remove {option}")
    if options.input or options.road:
        raise ConfigurationError("--targets already sets the inputs; remove --input and --road")
    return read(options, TargetStudy)


def _job(study: SearchStudy | TargetStudy, console: Console) -> None:
    text = study.run(
        command=console.command("vehicle optimise"),
        begin=console.progress,
        note=lambda text: console.say(f"note        {text}"),
    )
    console.say(text)


main = command(parser, settings_of, _job)
