"""`python -m vehicle drive`: drive signals of the plates that reproduce measured accelerations."""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.clock_options import delay_option
from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.input_options import record_options
from vehicle.commands.options import (
    command_parser,
    figures_option,
    message_options,
    output_options,
    read,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.names import CORNERS
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting
from vehicle.signals.records.record_settings import RecordSettings
from vehicle.studies.replication.drive_settings import DriveSettings

if TYPE_CHECKING:
    from vehicle.signals.records.choice import Choice
    from vehicle.studies.replication.iteration import Step


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("drive", "Compute drive signals of the plates that reproduce measured accelerations.")
    setting_options(parser, DriveCommand, "target")
    channels = parser.add_argument_group("channels of the target measurement")
    record_options(
        channels,
        'an acceleration of the car and its channel in the file, for example knuckle_fr_acc_z="Dof 12 +Z". The '
        "name alone is sufficient if the file uses it or has only one channel. Give at least as many channels "
        "as plates",
    )
    delay_option(channels)
    setting_options(vehicle_options(parser), DriveSettings, "wheels")
    iteration = parser.add_argument_group("the iteration")
    setting_options(iteration, DriveSettings, "band", "iterations", "gain", "target_error")
    parser.former(
        "--tolerance",
        "--tolerance: no such option; set the error at which the iteration ends with --target-error PERCENT",
    )
    setting_options(iteration, DriveSettings, "engine", "stated_errors")
    output_options(parser, None, default="runs/drive_<name of the target>")
    figures_option(parser)
    message_options(parser, quiet=True)
    return parser


@dataclass(frozen=True, kw_only=True, slots=True)
class DriveCommand(Settings):
    """Settings of the command.

    Attributes:
        record: channels, units and times of the measurement.
        delay: delays of groups of channels, "GROUP=TIME".
        search: settings of the replication.
        destination: folder of the results.
        figures: write pictures (PNG).
    """

    target: Path = setting(
        "measured accelerations, in any format that `inspect` reads", type=Path, required=True, metavar="FILE"
    )
    record: RecordSettings = part(RecordSettings)
    delay: tuple[str, ...] = ()
    search: DriveSettings = part(DriveSettings)
    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    figures: bool = True


def settings_of(options: argparse.Namespace) -> DriveCommand:
    """Return the settings of the parsed options."""
    wheels = [CORNERS[word] for word in options.wheels or ()] or None
    search = read(options, DriveSettings, wheels=wheels, delay=None)
    return read(options, DriveCommand, search=search)


def _job(settings: DriveCommand, console: Console) -> None:
    from vehicle.runs.car import Car
    from vehicle.signals.records.delays import parsed_delays
    from vehicle.studies.replication.drive_files import save_drive
    from vehicle.studies.replication.drive_search import replicate_drive

    inputs = tuple(path for path in (settings.target, settings.car.vehicle) if path is not None)
    output = settings.destination.folder(Path("runs") / f"drive_{settings.target.stem}", protect=inputs)
    names, choice = _channels(settings)
    search = replace(
        settings.search,
        choice=choice,
        delay=parsed_delays(settings.delay),
        progress=lambda step: None if console.quiet else _say(step, settings.search.iterations),
    )
    car = Car.load(settings.car.vehicle, settings.car.overrides)
    drive = replicate_drive(car, settings.target, names, **search.given())
    console.accept(drive.notices)
    force, figures = settings.destination.force, settings.figures
    summary = save_drive(drive, output, force=force, figures=figures, protect=inputs)
    console.say(report(summary, output))


def _say(step: Step, iterations: int) -> None:
    """Print the error of a finished iteration."""
    back = "" if step.kept else ", worse than before: this step is undone and the gain halved"
    print(
        f"iteration {step.number} of at most {iterations}: error {100.0 * step.error:.3g} %{back}",
        file=sys.stderr,
        flush=True,
    )


def _channels(settings: DriveCommand) -> tuple[dict[str, str], Choice]:
    """Return the channels, name in the car to name in the file, and the further choice of the file."""
    from vehicle.signals.records.choice import Choice
    from vehicle.studies.replication.drive_search import named_channels

    picks = settings.record.picks
    unnamed = [text.strip() for text in picks if "=" not in text]
    named = tuple(f"{text}={text}" if "=" not in text else text for text in picks)
    choice = replace(settings.record, picks=named).choice("") or Choice()
    names = {role: name for role, name in choice.channels.items() if role != "time"}
    if not names:
        raise ConfigurationError(
            "--channel is missing; name a measured acceleration, for example --channel knuckle_fr_acc_z=NAME"
        )
    return (named_channels(settings.target, unnamed, choice) if unnamed == list(names) else names), choice


def report(summary: dict[str, Any], output: Path) -> str:
    """Return the printed summary."""
    target, drive = summary["target"], summary["drive"]
    low, high = target["band_hz"]
    errors = ", ".join(f"{name} {100.0 * value:.3g} %" for name, value in summary["errors"].items())
    plates = ", ".join(
        f"{wheel} RMS {1e3 * drive['rms_m'][wheel]:.4g} mm, largest {1e3 * drive['largest_m'][wheel]:.4g} mm"
        for wheel in drive["wheels"]
    )
    lines = [
        f"target      {target['file']}, {target['duration_s']:g} s, {low:g} to {high:g} Hz",
        f"drive       {plates}",
        f"error       {errors} (RMS of target minus response, divided by RMS of target, in this band)",
        f"iteration   {len(summary['iterations'])} runs ({summary['engine']}); {summary['outcome']}",
        *(f"note        {text}" for text in summary["notices"]),
        f"files       {output}: {', '.join(summary['files'].values())}",
    ]
    return "\n".join(lines)


main = command(parser, settings_of, _job)
