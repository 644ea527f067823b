"""Measurement files of the command `tune`: their options, their roads, and the targets of the fit."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.clock_options import delay_option
from vehicle.commands.input_options import record_options, speed_value
from vehicle.commands.measured_options import mapping_options
from vehicle.commands.options import read, setting_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.road_settings import RoadSettings
from vehicle.signals.records.measured_settings import MeasuredSettings
from vehicle.signals.records.record_settings import RecordSettings
from vehicle.studies.tuning.fit_settings import HistorySettings, LevelSettings, ResponseSettings

if TYPE_CHECKING:
    from vehicle.runs.car import Car
    from vehicle.runs.car.road import Road
    from vehicle.signals.records.choice import Choice
    from vehicle.studies.tuning.measured_targets import MeasuredTarget

OF_FILE = ("signal", "stuck", "road", "speed", "contact", "levels", "reference")
"""Names of the options that belong to the files of the preceding --frf or --record."""

OF_RECORD = ("road", "speed", "contact", "levels", "reference")
"""Names of those that belong to time histories."""

ROAD_ROLES = ("left", "right", "height")
"""Roles of --map and --unit that name the heights of a road over time; --unit speed=UNIT belongs to its speed."""


class _Measurement(argparse.Action):
    """Action that adds measurement files to the list of all, in the order of the command line."""

    def __call__(self, parser: Any, namespace: argparse.Namespace, values: Any, option: str | None = None) -> None:
        listed = getattr(namespace, "measurements", None) or []
        content = str(option).removeprefix("--")
        added = [argparse.Namespace(content=content, file=file, **dict.fromkeys(OF_FILE)) for file in values]
        namespace.measurements = [*listed, *added]
        namespace.latest = added


class _OfMeasurement(argparse.Action):
    """Action that sets an option of the measurement files of the preceding --frf or --record."""

    def __call__(self, parser: Any, namespace: argparse.Namespace, values: Any, option: str | None = None) -> None:
        latest = getattr(namespace, "latest", None)
        if not latest:
            raise ConfigurationError(
                f"{option}: must follow the --frf or --record that it belongs to; move it behind this option"
            )
        for each in latest:
            if self.dest == "stuck" and each.content != "frf":
                raise ConfigurationError(
                    f"--stuck: belongs to --frf, but {each.file} follows --record; leave --stuck out"
                )
            if self.dest in OF_RECORD and each.content != "record":
                raise ConfigurationError(
                    f"{option}: belongs to --record, but {each.file} follows --frf; give the file with --record"
                )
            setattr(each, self.dest, values if self.nargs is None else True)


def measurement_options(parser: Parser) -> None:
    """Add the options that name measurement files, and the options that act on the preceding files."""
    parser.set_defaults(measurements=[], latest=[])
    files = parser.add_argument_group("measurements")
    files.add_argument(
        "--frf",
        nargs="+",
        type=Path,
        action=_Measurement,
        metavar="FILE",
        help="file of measured FRFs, or of time histories of accelerations and plate, in any format that "
        "`inspect` reads. May be repeated",
    )
    files.add_argument(
        "--record",
        nargs="+",
        type=Path,
        action=_Measurement,
        metavar="FILE",
        help="file of measured time histories of a bump or another input, in any format that `inspect` reads. "
        "May be repeated",
    )
    files.add_argument(
        "--signal",
        action=_OfMeasurement,
        metavar="FILE",
        help="file of the plate displacement for the preceding --frf or --record (channels: --map "
        "plate_fl_displacement=NAME). Default: the plate in each measurement file",
    )
    setting_options(files, ResponseSettings, "stuck", action=_OfMeasurement)
    files.add_argument(
        "--road",
        action=_OfMeasurement,
        metavar="C|FILE|OBSTACLE",
        help="road of the preceding --record, in the forms of `shaker`: a measured profile, heights over time "
        "(with --speed channel:NAME; may be the same file), a class of ISO 8608, or an obstacle. The tyres "
        "roll",
    )
    files.add_argument(
        "--speed",
        type=speed_value,
        action=_OfMeasurement,
        metavar="KM/H|channel:NAME",
        help="speed on the preceding --road [km/h]; for a road recorded over time also channel:NAME, the channel with "
        "the speed",
    )
    help_text = "tyre contact on the preceding --road; default: patch, on an obstacle cams"
    setting_options(files, RoadSettings, "contact", action=_OfMeasurement, help=help_text)
    setting_options(files, LevelSettings, "levels", "reference", action=_OfMeasurement)
    files.add_argument(
        "--any-level", action="store_true", help="accept plate levels and accelerations beyond a real shaker"
    )
    mapping_options(files)
    record_options(files, "", channel=False)
    delay_option(files, "; without this option the delay of each group of channels is fitted")
    files.add_argument(
        "--channels",
        metavar="NAME,...",
        help="channels of the model to fit; default: all in the files",
    )


def has_files(options: argparse.Namespace, content: str) -> bool:
    """Return True if a file was named by --frf ("frf") or --record ("record")."""
    return any(each.content == content for each in options.measurements)


def _road_of(each: argparse.Namespace, choice: Choice) -> Road | None:
    """Return the road of a measurement file, and None without --road."""
    from vehicle.runs.car.road import Road, named_road

    if each.road is None:
        for name in ("speed", "contact"):
            if getattr(each, name) is not None:
                raise ConfigurationError(f"--{name}: belongs to --road; add --road FILE after --record {each.file}")
        return None
    if each.signal is not None:
        raise ConfigurationError(
            f"--road {each.road} and --signal {each.signal} exclude each other; leave one of them out"
        )
    if each.speed is None:
        raise ConfigurationError(
            f"--road {each.road}: the speed is missing; add --speed KM/H, for example --speed 80, or --speed "
            "channel:NAME"
        )
    return Road(named_road(each.road), speed=each.speed, contact=each.contact, choice=choice)


def measured_targets(options: argparse.Namespace, car: Car) -> list[MeasuredTarget]:
    """Return the targets of all measurement files."""
    from vehicle.studies.tuning.measured_targets import measured_histories, measured_levels, measured_responses

    choice = replace(read(options, MeasuredSettings).choice(read(options, RecordSettings)), any_level=options.any_level)
    road_choice = replace(
        choice,
        channels={role: name for role, name in choice.channels.items() if role in (*ROAD_ROLES, "time")},
        units={role: unit for role, unit in choice.units.items() if role in (*ROAD_ROLES, "speed", "time")},
        resample=None,
    )
    choice = replace(
        choice,
        channels={role: name for role, name in choice.channels.items() if role not in ROAD_ROLES},
        units={role: unit for role, unit in choice.units.items() if role not in (*ROAD_ROLES, "speed")},
    )
    shared: dict[str, Any] = {
        "choice": choice,
        "inverted": options.turned,
        "fitted": options.channels.split(",") if options.channels else (),
    }
    delay, drift = read(options, MeasuredSettings).clock()
    targets = []
    for each in options.measurements:
        if each.content == "frf":
            frf = read(options, ResponseSettings, signal=each.signal, stuck=bool(each.stuck), **shared)
            targets.append(measured_responses(car, each.file, **frf.given()))
            continue
        source = _road_of(each, road_choice) or each.signal
        if each.levels is None and each.reference is not None:
            raise ConfigurationError(f"--reference {each.reference}: belongs to --levels N")
        times = {"signal": source, "delay": delay, "drift": drift, **shared}
        if each.levels is None:
            targets.append(measured_histories(car, each.file, **read(options, HistorySettings, **times).given()))
        else:
            times |= {"levels": each.levels, "reference": each.reference}
            targets.append(measured_levels(car, each.file, **read(options, LevelSettings, **times).given()))
    return targets
