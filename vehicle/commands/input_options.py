"""Options of what moves the plates: a file and its channels, or a road; and what they ask for."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from vehicle.errors import ConfigurationError
from vehicle.names import CORNERS

if TYPE_CHECKING:
    from vehicle.records.choice import Choice


def signal_options(parser: argparse.ArgumentParser, *, several: bool = False) -> None:
    """Add --input, --wheel, --road and its numbers: which plates move, and how.

    Args:
        parser: of the command.
        several: --input, --road and --speed may be repeated; then their values are lists.
    """
    parser.add_argument(
        "--input",
        action="append" if several else "store",
        metavar="FILE",
        help="measurement file of any format of `inspect`, or the name of a shipped one: low.csv"
        + ("; may be repeated" if several else ""),
    )
    parser.add_argument(
        "--wheel",
        choices=sorted(CORNERS),
        help="wheel of a plain displacement column; front_right by default",
    )
    parser.add_argument(
        "--road",
        action="append" if several else "store",
        nargs="?",
        const="",
        metavar="C|FILE.csv",
        help="instead of --input, all wheels drive over a road: its class of ISO 8608, A to H, or a measured profile "
        "(columns distance, left, right [m]); beside --input, alone: accept levels beyond a shaker"
        + ("; may be repeated" if several else ""),
    )
    rate = "" if several else "; beside --input: in place of the times of the file"
    road_options(parser, several=several, rate_note=rate)
    parser.add_argument(
        "--tyre",
        choices=("rolling", "standing"),
        help="with a road: tyres that roll at its speed, as they do by default, or that stand on moving plates, as on "
        "a rig; the tyres of a car that stands on blocks too stand",
    )


def road_options(parser: argparse.ArgumentParser, *, several: bool = False, rate_note: str = "") -> None:
    """Add the numbers of a drive over a road; each is None where it is not given.

    Args:
        parser: of the command.
        several: --speed may be repeated, once for each road; then its value is a list.
        rate_note: what the help of --rate says beside.
    """
    group = parser.add_argument_group("a road")
    group.add_argument(
        "--speed",
        action="append" if several else "store",
        type=float,
        metavar="KM/H",
        help="speed of the car [km/h]" + ("; once for all roads, or once for each" if several else ""),
    )
    group.add_argument("--duration", type=float, metavar="S", help="length [s]; 60, or the whole profile, by default")
    group.add_argument("--rate", type=float, metavar="HZ", help=f"samples a second; 1000 by default{rate_note}")
    group.add_argument("--seed", type=int, metavar="N", help="one seed is one road; 1 by default")
    group.add_argument(
        "--coherence",
        type=float,
        metavar="G",
        help="of the tracks: 1 equal, 0 unrelated; isotropic plane by default",
    )
    group.add_argument(
        "--patch",
        type=float,
        metavar="M",
        help="length of the contact patch that averages the road [m], 0 for none; 0.1 by default",
    )


ROAD_NUMBERS = ("speed", "duration", "rate", "seed", "coherence", "patch")
"""Options of `road_options`."""

INPUT_CHOICES = {
    **{name: name for name in ("wheel", "interpolate", "resample", "detrend", "highpass")},
    "remove-mean": "remove_mean",
    "channel": "picks",
    "unit": "units",
    "from": "first",
    "to": "last",
}
"""Options of a file of signals, and where their values are."""


def drives_on_road(options: argparse.Namespace) -> bool:
    """Whether a road moves the plates and not a file.

    Args:
        options: as of `signal_options`.

    Raises:
        ConfigurationError: neither or both are given, or options that belong to the other.
    """
    roads = options.road if isinstance(options.road, list) else [options.road]
    words = " ".join(f"--road {one}" for one in roads)
    if any(roads):
        if options.input:
            raise ConfigurationError(
                f"{words} beside --input: give one of them; --road alone accepts levels beyond a shaker"
            )
        for name, place in INPUT_CHOICES.items():
            measured = name == "unit" and getattr(options, "measured", None) is not None
            if getattr(options, place, None) and not measured:
                raise ConfigurationError(f"--{name}: belongs to --input; {words} drives all wheels of the car")
        return True
    if getattr(options, "tyre", None) is not None:
        raise ConfigurationError(
            "--tyre: belongs to a road, as --road C --speed 80; on plates the tyres stand, unless --set driving.speed"
        )
    if not options.input:
        raise ConfigurationError("needed is either --input FILE, or a road: --road C --speed 80")
    for name in ROAD_NUMBERS:
        if getattr(options, name) is not None and not (name == "rate" and hasattr(options, "picks")):
            raise ConfigurationError(f"--{name}: belongs to a road, as --road C --speed 80, and not to --input")
    return False


def record_options(parser: argparse.ArgumentParser, roles: str, *, channel: bool = True, rate: bool = True) -> None:
    """Add the choice of channels, units and times in a measurement file.

    Args:
        parser: of the command.
        roles: what a channel is chosen for, in words, with an example.
        channel, rate: False where the command has such an option of its own.
    """
    if channel:
        parser.add_argument(
            "--channel",
            dest="picks",
            action="append",
            default=[],
            metavar="ROLE=NAME",
            help=f"channel of the file, by number, exact name, or pattern with *, for {roles}; time=NAME names the "
            "times; may be repeated; `python -m vehicle inspect FILE` lists them",
        )
    parser.add_argument(
        "--unit",
        dest="units",
        action="append",
        default=[],
        metavar="[ROLE=]UNIT",
        help="unit of the chosen channels, or of one, where the file tells none or a wrong one, as mm or g; may be "
        "repeated",
    )
    if rate:
        parser.add_argument("--rate", type=float, metavar="HZ", help="samples a second, in place of the file's times")
    parser.add_argument("--from", dest="first", type=float, metavar="S", help="begin at this time of the file [s]")
    parser.add_argument("--to", dest="last", type=float, metavar="S", help="end at this time of the file [s]")
    parser.add_argument("--detrend", action="store_true", help="subtract the straight line of least squares")
    parser.add_argument(
        "--highpass",
        type=float,
        metavar="HZ",
        help="corner of a high-pass without phase shift [Hz]; with it velocities and accelerations are integrated",
    )


def record_choice(options: argparse.Namespace, role: str) -> Choice | None:
    """What the options of `record_options` ask for; None for nothing.

    Args:
        options: of the command.
        role: of a channel or a unit that names none.

    Raises:
        ConfigurationError: a role twice, a unit that is not known, a number out of range.
    """
    from vehicle.records.choice import Choice, pairs

    channels = pairs("--channel", options.picks, role)
    asked = pairs("--unit", options.units, "")
    units = {name: unit for name, unit in asked.items() if not name or name in channels}
    unknown = next((name for name in asked if name not in units), None)
    if unknown is not None and getattr(options, "measured", None) is None:  # else of what was measured
        raise ConfigurationError(f"--unit {unknown}=...: no --channel {unknown}=NAME is given")
    found = Choice(
        channels=channels,
        units=units,
        rate=options.rate,
        first=options.first,
        last=options.last,
        detrend=options.detrend,
        highpass=options.highpass,
    )
    return None if found.empty else found
