"""`python -m vehicle drive`: drive signals of the plates that reproduce measured accelerations."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.accepted_advice import accept
from vehicle.commands.clock_options import delay_option
from vehicle.commands.command_line import command
from vehicle.commands.destination import output_folder_of
from vehicle.commands.input_options import record_choice, record_options
from vehicle.commands.options import (
    command_parser,
    figures_option,
    message_options,
    output_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.names import CORNERS
from vehicle.studies.replication.drive_settings import DriveSettings

if TYPE_CHECKING:
    from vehicle.signals.records.choice import Choice
    from vehicle.studies.replication.iteration import Step


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("drive", "Compute drive signals of the plates that reproduce measured accelerations.")
    parser.add_argument(
        "--target",
        type=Path,
        required=True,
        metavar="FILE",
        help="measured accelerations, in any format that `inspect` reads",
    )
    channels = parser.add_argument_group("channels of the target measurement")
    record_options(
        channels,
        'acceleration of the car and its channel in the file, for example knuckle_fr_acc_z="Dof 12 +Z". The '
        "name alone is sufficient if the file uses it or has only one channel. Give at least as many channels "
        "as plates",
    )
    delay_option(channels)
    setting_options(vehicle_options(parser), DriveSettings, "wheels")
    iteration = parser.add_argument_group("the iteration")
    setting_options(iteration, DriveSettings, "band", "iterations", "gain", "target_error")
    parser.former(
        "--tolerance",
        "--tolerance is not an option here; set the error at which the iteration ends with --target-error PERCENT",
    )
    setting_options(iteration, DriveSettings, "engine")
    output_options(parser, None, default="runs/drive_<name of the target>")
    figures_option(parser)
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.runs.car import Car
    from vehicle.signals.records.delays import parsed_delays
    from vehicle.studies.replication.drive_files import save_drive
    from vehicle.studies.replication.drive_search import replicate_drive

    inputs = tuple(path for path in (options.target, options.vehicle) if path is not None)
    settings = DriveSettings.of_options(
        options,
        wheels=[CORNERS[word] for word in options.wheels or ()] or None,
        delay=parsed_delays(options.delay),
        progress=lambda step: None if options.quiet else _say(step, options.iterations),
    )
    output = output_folder_of(options, Path("runs") / f"drive_{options.target.stem}", protect=inputs)
    names, choice = _channels(options)
    car = Car.load(options.vehicle, options.overrides)
    drive = replicate_drive(car, options.target, names, **replace(settings, choice=choice).given())
    accept(options, drive.notices)
    summary = save_drive(drive, output, force=options.force, figures=options.figures, protect=inputs)
    if not options.quiet:
        print(report(summary, output))


def _say(step: Step, iterations: int) -> None:
    """Print the error of a finished iteration."""
    back = "" if step.kept else ", worse than before: step undone, next step with half the gain"
    print(
        f"iteration {step.number} of at most {iterations}: error {100.0 * step.error:.3g} %{back}",
        file=sys.stderr,
        flush=True,
    )


def _channels(options: argparse.Namespace) -> tuple[dict[str, str], Choice]:
    """Return the channels, name in the car to name in the file, and the further choice of the file."""
    from vehicle.signals.records.choice import Choice
    from vehicle.studies.replication.drive_search import named_channels

    unnamed = [text.strip() for text in options.picks if "=" not in text]
    options.picks = [f"{text}={text}" if "=" not in text else text for text in options.picks]
    choice = record_choice(options, "") or Choice()
    names = {role: name for role, name in choice.channels.items() if role != "time"}
    if not names:
        raise ConfigurationError(
            "--channel is missing; name a measured acceleration, for example --channel knuckle_fr_acc_z=NAME"
        )
    return (named_channels(options.target, unnamed, choice) if unnamed == list(names) else names), choice


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


main = command(parser, _job)
