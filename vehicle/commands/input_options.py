"""Options of the input: a file of signals with its channels, or a road."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.accepted_advice import advice_option
from vehicle.commands.options import read, setting_options
from vehicle.commands.parser import Condition, Parser
from vehicle.names import CORNERS
from vehicle.signals.excitation.input_settings import DriveInput, PlateSettings, on_road
from vehicle.signals.excitation.road_settings import LEVEL, RoadSettings
from vehicle.signals.records.record_settings import RecordSettings

if TYPE_CHECKING:
    from vehicle.studies.sweeps.sweep_inputs import InputChoice

FILE_NEEDS = "--input (a road moves the plates of all wheels)"
RECORD_NEEDS = "--input or to a road recorded over time (--speed channel:NAME)"
ROAD_NEEDS = "a road, for example --road C --speed 80, not to --input"
CLASS_NEEDS = (
    "a road class of ISO 8608, for example --road C --speed 80; signal files and measured profiles are used unchanged"
)


def signal_options(parser: Parser, *, several: bool = False, precision: bool = True) -> argparse._ArgumentGroup:
    """Add --input, --road and the options of each; return the group of the options that act on a file of signals.

    Args:
        several: --input, --road and --speed may be repeated; then their values are lists.
        precision: False leaves out --precision.
    """
    action = "append" if several else "store"
    again = ". May be repeated" if several else ""
    parser.add_argument(
        "--input",
        action=action,
        metavar="FILE",
        help=f"measurement file in any format that `inspect` reads, or the name of a shipped file: low.csv{again}",
    )
    parser.add_argument(
        "--road",
        action=action,
        metavar="C|FILE|OBSTACLE",
        help="a road under all wheels instead of --input: a class of ISO 8608 (A to H), a measured profile "
        "(table distance, left, right [m]; OpenCRG .crg; ERD), heights over time (with --speed "
        "channel:NAME), or an obstacle on a level road, NAME[:SIZES in mm][:left|right][@METRES]: "
        f"cleat:20x50, half_round:50, speed_bump, ramp, pothole, cobbles{again}",
    )
    parser.former(
        r"--road (--.*)?$",
        "--road: the road is missing; give a class of ISO 8608 (A to H) or FILE.csv; for levels beyond a shaker use "
        "--any-level",
    )
    group = parser.scoped_group("a file of signals", needs=FILE_NEEDS, active=lambda options: bool(options.input))
    group.add_argument(
        "--wheel",
        choices=sorted(CORNERS),
        help="wheel that a displacement column without a wheel in its name moves; default: shaker_wheel of the "
        "vehicle file",
    )
    group.add_argument(
        "--any-level",
        action="store_true",
        help="accept levels and accelerations beyond a real shaker, and plate signals so similar that their FRFs "
        "cannot be separated",
    )

    def is_class(options: argparse.Namespace) -> bool:
        return any(len(road) == 1 for road in _listed(options.road))

    note = "" if several else "; with --input it replaces the time column of the file"

    def drives(options: argparse.Namespace) -> bool:
        # A file of targets names its roads; --rpm runs on a level one.
        return bool(options.road or getattr(options, "rpm", None) or getattr(options, "targets", None))

    road = road_options(parser, drives, is_class, several=several, rate_note=note, precision=precision)
    setting_options(
        road, RoadSettings, "tyre", note="; with --input the tyres stand, except with --set driving.speed=M/S"
    )
    return group


def road_options(
    parser: Parser,
    on_road: Condition,
    is_class: Condition,
    *,
    several: bool = False,
    rate_note: str = "",
    precision: bool = False,
) -> argparse._ArgumentGroup:
    """Add the numeric options of a road, each None by default; return the group of those that act on any road.

    Args:
        on_road: True if the options contain a road.
        is_class: True if a road is a class of ISO 8608.
        several: --speed may be repeated, once for each road, and --seed; then their values are lists.
        rate_note: addition to the help of --rate, for a command in which it acts on a file of signals too.
        precision: add --precision.
    """
    group = parser.scoped_group("a road", needs=ROAD_NEEDS, active=on_road)
    group.add_argument(
        "--speed",
        action="append" if several else "store",
        type=speed_value,
        metavar="KM/H|channel:NAME",
        help="speed of the car [km/h]; for a road recorded over time, channel:NAME names the channel with the speed"
        + ("; one for all roads, or one for each" if several else ""),
    )
    setting_options(group, RoadSettings, "duration", *(["precision"] if precision else []))
    setting_options(parser if rate_note else group, RoadSettings, "rate", note=rate_note)
    random = parser.scoped_group("a road of a class", needs=CLASS_NEEDS, active=is_class)
    each = "; repeat it to see the scatter: each road runs with each seed" if several else ""
    setting_options(random, RoadSettings, "seed", note=each, action="append" if several else "store")
    setting_options(random, RoadSettings, "period")
    setting_options(random, RoadSettings, "coherence")
    setting_options(group, RoadSettings, "patch")
    setting_options(group, RoadSettings, "contact")
    return group


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value] if value else []


def speed_value(text: str) -> float | str:
    """Return a speed [km/h], or the text channel:NAME."""
    if text.startswith("channel:") and len(text) > len("channel:"):
        return text
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: must be a speed [km/h] or channel:NAME") from None


def recorded_over_time(options: argparse.Namespace) -> bool:
    """Return True if a road was recorded over time, with its speed."""
    return any(isinstance(speed, str) for speed in _listed(options.speed))


def inputs_of(options: argparse.Namespace) -> InputChoice:
    """Return the inputs of parsed options, of which --input, --road, --speed and --seed may be repeated."""
    from vehicle.studies.sweeps.sweep_inputs import InputChoice

    return read(options, InputChoice, settings=read(options, RoadSettings, seed=None))


def input_of(options: argparse.Namespace) -> PlateSettings | DriveInput:
    """Return the input of parsed options; with --rpm alone it is a level road."""
    if not options.road and not options.input and vars(options).get("rpm"):
        # The engine alone shakes the car, which stands or drives on a level road.
        return read(options, DriveInput, road=LEVEL, speed=options.speed or 0.0)
    if on_road(_listed(options.road), _listed(options.input)):
        return read(options, DriveInput)
    return read(options, PlateSettings)


def record_options(
    parser: argparse._ActionsContainer, roles: str, *, channel: bool = True, rate: bool = True, unit: bool = True,
    highpass: bool = True,
) -> None:  # fmt: skip
    """Add the options that choose channels, units and times in a measurement file.

    Args:
        roles: purpose of a channel in words with an example, for the help.
        channel, rate, unit, highpass: False leaves out the option of this name.
    """
    if channel:
        parser.add_argument(
            "--channel",
            dest="picks",
            action="append",
            default=[],
            metavar="ROLE=NAME",
            help=f"channel of the file (number, exact name, or pattern with *) for {roles}; time=NAME for the time "
            "channel. May be repeated. `python -m vehicle inspect FILE` lists the channels",
        )
    if unit:
        unit_option(parser)
    if rate:
        setting_options(parser, RecordSettings, "rate")
    database_option(parser)
    setting_options(parser, RecordSettings, "first", "last", "resample")
    advice_option(parser)
    setting_options(parser, RecordSettings, "detrend", *(["highpass"] if highpass else []))


def unit_option(parser: argparse._ActionsContainer) -> None:
    """Add --unit, the units of the channels of a file."""
    parser.add_argument(
        "--unit",
        dest="units",
        action="append",
        default=[],
        metavar="[ROLE=]UNIT",
        help="unit of the chosen channels, or of one of them, for example mm or g, if the file states none or a "
        "wrong one. May be repeated",
    )


def database_option(parser: argparse._ActionsContainer) -> None:
    """Add --dbc, which decodes the log of a CAN bus."""
    parser.add_argument(
        "--dbc",
        dest="databases",
        type=Path,
        action="append",
        default=[],
        metavar="FILE",
        help="CAN database that decodes a bus log (MDF, .asc, .trc, candump). May be repeated",
    )
