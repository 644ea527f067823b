"""`python -m vehicle road`: the plate signals of a car that drives over a road, as a file."""

from __future__ import annotations

import argparse
import math
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.destination import output_file_of
from vehicle.commands.input_options import record_choice, road_options
from vehicle.commands.options import command_parser, message_options, output_options, vehicle_options
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError

if TYPE_CHECKING:
    from vehicle.excitation.iso_road import Side
    from vehicle.excitation.recorded_road import RecordedDrive
    from vehicle.excitation.road_drive import RoadDrive
    from vehicle.parameters.vehicle import Vehicle


def parser() -> Parser:
    """The options of the command."""
    found = command_parser("road", "Plate signals of a car on a road: class and speed, or a measured profile.")
    vehicle_options(found)
    found.add_argument("--class", dest="road_class", metavar="C", help="class of ISO 8608, A to H")
    found.add_argument("--profile", type=Path, metavar="FILE.csv", help="or a measured road: distance, left, right [m]")
    road_options(found, lambda _: True, lambda options: options.profile is None)
    output_options(found, Path("road.csv"), metavar="FILE.csv")
    message_options(found, quiet=True)
    return found


def _job(options: argparse.Namespace) -> None:
    from vehicle.excitation.signal_file import write_signal
    from vehicle.output.folder import write_whole
    from vehicle.parameters.vehicle import load_vehicle

    if (options.road_class is None) == (options.profile is None):
        raise ConfigurationError("road: needed is either --class or --profile, one of them")
    inputs = tuple(file for file in (options.profile, options.vehicle) if file is not None)
    path = output_file_of(options, options.output, ending=".csv", protect=inputs)
    vehicle = load_vehicle(options.vehicle, options.overrides)
    road = options.road_class.upper() if options.profile is None else options.profile
    signal = road_drive(road, options, vehicle).signal()
    write_whole(path, lambda file: write_signal(file, signal, [signal.source, f"wheels of {vehicle.name}"]))
    if not options.quiet:
        sizes = ", ".join(f"{wheel} {1e3 * float(z.std()):.3g}" for wheel, z in signal.displacement.items())
        print(f"{path}: {signal.source}; {signal.duration:g} s; RMS [mm] {sizes}")


def class_or_profile(text: str) -> str | Path:
    """What --road of other commands names: a class, or the file of a profile.

    Raises:
        ConfigurationError: it is neither.
    """
    if len(text) > 1 and not Path(text).is_file():
        raise ConfigurationError(f"--road {text}: no class of ISO 8608 (A to H), and no file of a measured profile")
    return text.upper() if len(text) == 1 else Path(text)


def road_drive(road: str | Path, options: argparse.Namespace, vehicle: Vehicle) -> RoadDrive | RecordedDrive:
    """The drive that the options ask for, with the wheels where the car has them.

    Args:
        road: class of ISO 8608, or the file of a profile.
        options: as of `road_options`, or of `signal_options`.
        vehicle: the car.

    Raises:
        ConfigurationError: no speed, a car that cannot roll, or as of `RoadDrive`.
    """
    from vehicle.excitation.road_drive import RoadDrive

    if options.speed is None:
        raise ConfigurationError("a road needs --speed KM/H, as --speed 80")
    if isinstance(options.speed, str):
        return _recorded_drive(road, options, vehicle)
    wheels = vehicle.composition.wheels
    # Every option that is named as a number of a drive, where it is given.
    names = {field.name for field in fields(RoadDrive)} & vars(options).keys() - {"road"}
    numbers = {name: value for name in names if (value := getattr(options, name)) is not None}
    return RoadDrive(
        road=road,
        wheels=_places(vehicle),
        track=2.0 * sum(abs(wheel.patch[1]) for wheel in wheels) / len(wheels),
        driving=_driving(options, vehicle),
        **numbers,
    )


def _recorded_drive(road: str | Path, options: argparse.Namespace, vehicle: Vehicle) -> RecordedDrive:
    """The drive over a road that was recorded over time."""
    from vehicle.excitation.recorded_road import PREFIX, RecordedDrive
    from vehicle.records.choice import Choice

    if not isinstance(road, Path):
        raise ConfigurationError(f"--speed {options.speed}: belongs to a recorded road, --road FILE; {road} is a class")
    for name in ("seed", "coherence", "patch"):
        if getattr(options, name) is not None:
            raise ConfigurationError(f"--{name}: belongs to a class or a profile; a recorded road is taken as it is")
    choice = Choice()
    if hasattr(options, "picks"):
        # --rate is that of the run; the times are those of the file.
        own = {**vars(options), "rate": None}
        choice = record_choice(argparse.Namespace(**own), "height", known=("speed",)) or Choice()
    numbers = {name: value for name in ("duration", "rate") if (value := getattr(options, name)) is not None}
    return RecordedDrive(
        road=road,
        channel=options.speed.removeprefix(PREFIX),
        wheels=_places(vehicle),
        choice=choice,
        driving=_driving(options, vehicle),
        **numbers,
    )


def _places(vehicle: Vehicle) -> tuple[tuple[str, float, Side], ...]:
    """Name of each wheel, its distance behind the foremost one [m], and its track."""
    wheels = vehicle.composition.wheels
    foremost = min(wheel.center[0] for wheel in wheels)
    side: dict[bool, Side] = {True: "right", False: "left"}
    return tuple((wheel.name, wheel.center[0] - foremost, side[wheel.side > 0.0]) for wheel in wheels)


def _driving(options: argparse.Namespace, vehicle: Vehicle) -> float | None:
    """Speed at which the tyres roll on a road [m/s], 0 to let them stand; None where the car itself says it.

    A car that stands on blocks too is on a rig, and its tyres stand where nothing is said. NaN stands for the mean
    speed of a recorded drive.
    """
    from vehicle.parameters.elements import Tyre

    asked, overrides = getattr(options, "tyre", None), getattr(options, "overrides", None) or ()
    if any(text.partition("=")[0].strip() in ("driving.speed", "speed") for text in overrides):
        if asked is not None:
            raise ConfigurationError(f"--tyre {asked} beside --set driving.speed: give one of them")
        return None
    on_blocks = any(one.ground for one in vehicle.composition.connections if not isinstance(one.law, Tyre))
    if asked == "standing" or (asked is None and on_blocks):
        return 0.0 if vehicle.driving.rolling else None
    return math.nan if isinstance(options.speed, str) else float(options.speed) / 3.6


main = command(parser, _job)
