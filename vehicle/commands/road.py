"""`python -m vehicle road`: the plate signals of a car that drives over a road, as a file."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.command_line import Parser, parse_and_run
from vehicle.commands.options import FORCE_HELP, command_parser, message_options, vehicle_options
from vehicle.errors import ConfigurationError

if TYPE_CHECKING:
    from vehicle.excitation.iso_road import Side
    from vehicle.excitation.signal import Signal


def parser() -> Parser:
    """The options of the command."""
    found = command_parser("road", "Plate signals of a car on a road: class and speed, or a measured profile.")
    vehicle_options(found)
    road_options(found)
    found.add_argument("--output", type=Path, metavar="FILE.csv", help="file of the signals; road.csv by default")
    found.add_argument("--force", action="store_true", help=FORCE_HELP)
    message_options(found, quiet=True)
    return found


def road_options(parser: argparse.ArgumentParser) -> None:
    """Add what a road is made of."""
    parser.add_argument("--class", dest="road_class", metavar="C", help="class of ISO 8608, A to H")
    parser.add_argument(
        "--profile", type=Path, metavar="FILE.csv", help="or a measured road: distance, left, right [m]"
    )
    parser.add_argument("--speed", type=float, required=True, metavar="KM/H", help="speed [km/h]")
    parser.add_argument("--duration", type=float, metavar="S", help="length [s]; 60, or the whole profile, by default")
    parser.add_argument("--rate", type=float, default=1000.0, metavar="HZ", help="samples a second; 1000 by default")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="one seed is one road; 1 by default")
    parser.add_argument(
        "--coherence",
        type=float,
        metavar="G",
        help="of the tracks: 1 equal, 0 unrelated; isotropic plane by default",
    )
    parser.add_argument(
        "--patch", type=float, metavar="M", help="length of the contact patch that averages the road [m]; 0 by default"
    )


def main(arguments: list[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return parse_and_run(parser(), _job, arguments)


def _job(options: argparse.Namespace) -> None:
    from vehicle.excitation.signal_file import write_signal
    from vehicle.parameters.vehicle import load_vehicle

    path = options.output or Path("road.csv")
    if path.exists() and not options.force:
        raise ConfigurationError(f"--output {path}: exists; give --force to replace it, or another name")
    vehicle = load_vehicle(options.vehicle, options.overrides)
    signal = road_signal(options, vehicle)
    write_signal(path, signal, [signal.source, f"wheels of {vehicle.name}"])
    if not options.quiet:
        sizes = ", ".join(f"{wheel} {1e3 * float(z.std()):.3g}" for wheel, z in signal.displacement.items())
        print(f"{path}: {signal.source}; {signal.duration:g} s; RMS [mm] {sizes}")


def road_signal(options: argparse.Namespace, vehicle: Any) -> Signal:
    """The plate signals that the options ask for.

    Args:
        options: as of `road_options`.
        vehicle: the car; tells where its wheels are.

    Raises:
        ConfigurationError: options that do not go together, or out of range.
        DataError: as of `read_road`.
    """
    from vehicle.excitation.iso_road import CLASSES as LEVELS
    from vehicle.excitation.iso_road import IsoRoad, drive
    from vehicle.excitation.measured_road import read_road

    if (options.road_class is None) == (options.profile is None):
        raise ConfigurationError("road: needed is either --class or --profile, one of them")
    if not (math.isfinite(options.speed) and 0.0 < options.speed <= 400.0):
        raise ConfigurationError(f"--speed {options.speed:g} km/h: allowed above 0 to 400")
    wheels = vehicle.composition.wheels
    foremost = min(wheel.center[0] for wheel in wheels)
    side: dict[bool, Side] = {True: "right", False: "left"}
    places = {wheel.name: (wheel.center[0] - foremost, side[wheel.side > 0.0]) for wheel in wheels}
    speed, duration = options.speed / 3.6, options.duration
    if options.profile is not None:
        for name in ("coherence", "patch"):
            if getattr(options, name) is not None:
                raise ConfigurationError(f"--{name}: belongs to --class; a measured profile is taken as it is")
        profile = read_road(options.profile)
        if duration is None:
            duration = math.floor(profile.length / speed * options.rate) / options.rate
        return drive(profile, speed=speed, wheels=places, duration=duration, rate=options.rate)
    letter = options.road_class.upper()
    if letter not in LEVELS:
        raise ConfigurationError(f"--class {options.road_class!r}: allowed are {', '.join(LEVELS)}, from good to poor")
    track = 2.0 * sum(abs(wheel.patch[1]) for wheel in wheels) / len(wheels)
    road = IsoRoad(
        level=LEVELS[letter],
        seed=options.seed,
        track=track,
        coherence=options.coherence,
        patch=options.patch or 0.0,
    )
    return drive(road, speed=speed, wheels=places, duration=60.0 if duration is None else duration, rate=options.rate)
