"""Measurement files of the command `tune`: their options, and their settings."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Any

from vehicle.commands.clock_options import delay_option
from vehicle.commands.input_options import record_options, speed_value
from vehicle.commands.measured_options import mapping_options
from vehicle.commands.options import setting_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.road_settings import RoadSettings
from vehicle.studies.tuning.fit_settings import LevelSettings, MeasurementFile, ResponseSettings

OF_RECORD = ("road", "speed", "contact", "levels", "reference")
"""Names of the options that belong to the time histories of the preceding --record."""


class _Measurement(argparse.Action):
    """Action that adds measurement files to the list of all, in the order of the command line."""

    def __call__(self, parser: Any, namespace: argparse.Namespace, values: Any, option: str | None = None) -> None:
        content = str(option).removeprefix("--")
        added = [MeasurementFile(file=file, content=content) for file in values]
        namespace.measurements = [*namespace.measurements, *added]
        namespace.latest = len(added)


class _OfMeasurement(argparse.Action):
    """Action that sets an option of the measurement files of the preceding --frf or --record."""

    def __call__(self, parser: Any, namespace: argparse.Namespace, values: Any, option: str | None = None) -> None:
        latest = namespace.measurements[len(namespace.measurements) - namespace.latest :]
        if not latest:
            raise ConfigurationError(f"{option}: must follow the --frf or --record that it belongs to; move it there")
        for each in latest:
            if self.dest == "stuck" and each.content != "frf":
                raise ConfigurationError(f"--stuck: belongs to --frf, but {each.file} follows --record; remove --stuck")
            if self.dest in OF_RECORD and each.content != "record":
                raise ConfigurationError(
                    f"{option}: belongs to --record, but {each.file} follows --frf; name the file with --record"
                )
        value = {self.dest: values if self.nargs is None else True}
        namespace.measurements[-len(latest) :] = [replace(each, **value) for each in latest]


def measurement_options(parser: Parser) -> None:
    """Add the options that name measurement files, and the options that act on the preceding files."""
    parser.set_defaults(measurements=[], latest=0)
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
        help="speed on the preceding --road [km/h]; for a road recorded over time, channel:NAME names the channel "
        "with the speed",
    )
    help_text = "tyre contact model on the preceding --road; default: patch (on an obstacle: cams)"
    setting_options(files, RoadSettings, "contact", action=_OfMeasurement, help=help_text)
    setting_options(files, LevelSettings, "levels", "reference", action=_OfMeasurement)
    files.add_argument(
        "--any-level", action="store_true", help="accept plate levels and accelerations beyond a real shaker"
    )
    mapping_options(files)
    record_options(files, "", channel=False)
    delay_option(files, "; without this option the delay of each group of channels is fitted")
    files.add_argument("--channels", metavar="NAME,...", help="channels of the model to fit; default: all in the files")


def has_files(options: argparse.Namespace, content: str) -> bool:
    """Return True if a file was named by --frf ("frf") or --record ("record")."""
    return any(each.content == content for each in options.measurements)
