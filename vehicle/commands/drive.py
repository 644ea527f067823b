"""`python -m vehicle drive`: the plate signals that make the car answer with measured accelerations, as a file."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import command
from vehicle.commands.destination import output_folder_of
from vehicle.commands.input_options import record_choice, record_options
from vehicle.commands.options import command_parser, engine_option, message_options, output_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.names import CORNERS

if TYPE_CHECKING:
    from vehicle.parameters.vehicle import Vehicle
    from vehicle.records.choice import Choice
    from vehicle.replication.iteration import Step
    from vehicle.replication.target import Target


def parser() -> Parser:
    """The options of the command."""
    found = command_parser("drive", "A drive file from a response: the plates that make the car answer as measured.")
    found.add_argument(
        "--target", type=Path, required=True, metavar="FILE", help="measured accelerations, of any format of `inspect`"
    )
    record_options(
        found,
        'an acceleration of the car, as knuckle_fr_acc_z="Dof 12 +Z"; the name alone where the file has it, or has '
        "one channel; at least as many channels as plates",
    )
    vehicle_options(found)
    found.add_argument(
        "--wheel",
        dest="wheels",
        action="append",
        choices=sorted(CORNERS),
        help="wheel whose plate is driven; by default those that the names of the channels tell, else that of the "
        "vehicle file; may be repeated",
    )
    found.add_argument(
        "--band",
        default="1:50",
        metavar="A:B",
        help="frequencies in which the response is met [Hz]; %(default)s by default; begin it where the target holds "
        "more than the noise of its sensor",
    )
    found.add_argument("--iterations", type=int, default=15, metavar="N", help="runs at most; %(default)s by default")
    found.add_argument(
        "--gain",
        type=float,
        default=0.8,
        metavar="G",
        help="share of the correction that a step makes [-], above 0 and up to 1; %(default)s by default",
    )
    found.add_argument(
        "--target-error",
        type=float,
        default=0.1,
        metavar="PERCENT",
        help="end where the RMS of the error in the band falls below this share of the target's [%%]; %(default)s",
    )
    found.former("--tolerance", "--tolerance: the error at which the iteration ends is given by --target-error PERCENT")
    engine_option(found, "auto")
    output_options(found, None, default="runs/drive_<name of the target>")
    message_options(found, quiet=True)
    return found


def _job(options: argparse.Namespace) -> None:
    from vehicle.car import Car
    from vehicle.output.drive_files import write_drive
    from vehicle.output.folder import output_folder
    from vehicle.replication.driven_car import DrivenCar
    from vehicle.replication.iteration import replicate
    from vehicle.replication.target import read_target

    inputs = tuple(path for path in (options.target, options.vehicle) if path is not None)
    band = _checked_numbers(options)
    output = output_folder_of(options, Path("runs") / f"drive_{options.target.stem}", protect=inputs)
    names, choice = _channels(options)
    car = Car.load(options.vehicle, options.overrides)
    car.vehicle.require_channels(names, car.vehicle.acceleration_channels)
    target = read_target(options.target, names, choice, band, car.vehicle.solver.record_rate)
    plant = DrivenCar(car, _wheels(options, target, car.vehicle), target, options.engine)
    with output_folder(output, force=options.force, protect=inputs) as folder:
        found = replicate(
            plant,
            target.values,
            target.lines,
            iterations=options.iterations,
            gain=options.gain,
            tolerance=0.01 * options.target_error,
            possible=plant.possible,
            settled=plant.settled,
            said=lambda step: None if options.quiet else _say(step, options.iterations),
        )
        if not any(step.kept for step in found.steps):
            raise SimulationError(
                f"{options.target}: no drive found that answers better than plates at rest; {found.outcome}"
            )
        summary = write_drive(folder, found, plant)
    if not options.quiet:
        print(report(summary, output))


def _say(step: Step, iterations: int) -> None:
    """A line for each run, while the next one goes on."""
    back = "" if step.kept else ", worse: taken back, half the gain"
    print(
        f"iteration {step.number} of at most {iterations}: error {100.0 * step.error:.3g} %{back}",
        file=sys.stderr,
        flush=True,
    )


def _checked_numbers(options: argparse.Namespace) -> tuple[float, float]:
    """Edges of the band [Hz]; refuses numbers that nobody can mean."""
    found = re.fullmatch(r"([\d.]+):([\d.]+)", options.band)
    try:
        low, high = (float(text) for text in found.groups()) if found else (0.0, 0.0)
    except ValueError:
        low = high = 0.0
    if not 0.0 < low < high:
        raise ConfigurationError(f"--band {options.band}: needed are two frequencies [Hz], the lower one first: 1:50")
    if not 1 <= options.iterations <= 1000:
        raise ConfigurationError(f"--iterations {options.iterations}: must be 1 to 1000")
    if not 0.0 < options.gain <= 1.0:
        raise ConfigurationError(f"--gain {options.gain:g}: must be above 0 and up to 1")
    if not 0.0 < options.target_error < 100.0:
        raise ConfigurationError(f"--target-error {options.target_error:g} %: must be above 0 and below 100")
    return low, high


def _channels(options: argparse.Namespace) -> tuple[dict[str, str], Choice]:
    """Channel of the car to what names it in the file, and what else is asked of the file."""
    from vehicle.records.choice import Choice
    from vehicle.records.reader import read_record

    alone = [text.strip() for text in options.picks if "=" not in text]
    options.picks = [f"{text}={text}" if "=" not in text else text for text in options.picks]
    choice = record_choice(options, "") or Choice()
    names = {role: name for role, name in choice.channels.items() if role != "time"}
    if not names:
        raise ConfigurationError("needed is --channel: the acceleration of the car that was measured")
    if len(names) == 1 and alone:
        held = read_record(options.target, choice.databases).channels
        if len(held) == 1:
            names = {alone[0]: "1"}
    return names, choice


def _wheels(options: argparse.Namespace, target: Target, vehicle: Vehicle) -> tuple[str, ...]:
    """Wheels whose plates are driven."""
    from vehicle.names import in_order

    if options.wheels:
        found = in_order({CORNERS[word] for word in options.wheels})
    else:
        named = {part for name in target.channels for part in name.split("_") if part in CORNERS.values()}
        found = in_order(named or {vehicle.shaker_wheel})
    if len(found) > len(target.channels):
        raise ConfigurationError(
            f"{len(found)} plates ({', '.join(found)}) and {len(target.channels)} channel: give at least as many "
            "channels as plates"
        )
    return found


def report(summary: dict[str, Any], output: Path) -> str:
    """The summary as text."""
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
        f"error       {errors} (RMS of target minus response over RMS of target, in the band)",
        f"iteration   {len(summary['iterations'])} runs ({summary['engine']}); {summary['outcome']}",
        *(f"note        {text}" for text in summary["notices"]),
        f"files       {output}: {', '.join(summary['files'].values())}",
    ]
    return "\n".join(lines)


main = command(parser, _job)
