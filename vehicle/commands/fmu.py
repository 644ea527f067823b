"""`python -m vehicle fmu CAR`: a car as an FMU for co-simulation in other simulators."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.destination import output_file_of
from vehicle.commands.options import VEHICLE_HELP, command_parser, message_options, output_options, set_once, set_option
from vehicle.commands.parser import Parser
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.names import FMI_VERSIONS

if TYPE_CHECKING:
    from vehicle.handover.fmu.fmu_file import WrittenFmu

HIGHEST_SPEED = 300.0
"""Maximum speed [km/h]."""


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("fmu", "Write a car as an FMU (FMI 2.0 or 3.0) for Simulink, OpenModelica and others.")
    parser.add_argument("car", nargs="?", type=vehicle_file, metavar="CAR", help=VEHICLE_HELP)
    set_option(parser)
    parser.add_argument(
        "--speed",
        type=float,
        metavar="KM/H",
        help="speed at which the tyres roll over the plates, which then are the road [km/h]; default: speed of "
        "the vehicle file",
    )
    parser.add_argument(
        "--fmi", choices=FMI_VERSIONS, default=FMI_VERSIONS[0], help="version of the FMI standard; default: %(default)s"
    )
    parser.add_argument(
        "--channels",
        metavar="NAME,...",
        help="add outputs to the default channels: loads, all, or names separated by commas",
    )
    parser.add_argument(
        "--step",
        type=float,
        default=0.1,
        metavar="MS",
        help="internal time step [ms]; a communication step must be a multiple of it; default: %(default)s",
    )
    output_options(parser, None, default="NAME.fmu", metavar="FILE.fmu")
    message_options(parser, quiet=True)
    return parser


def _job(options: argparse.Namespace) -> None:
    from vehicle.commands.loads import recorded_channels
    from vehicle.handover.fmu.fmu_file import LONGEST_STEP, SHORTEST_STEP, write_fmu
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import write_whole

    shortest, longest = 1e3 * SHORTEST_STEP, 1e3 * LONGEST_STEP
    if not shortest <= options.step <= longest:
        raise ConfigurationError(f"--step {options.step:g}: must be {shortest:g} to {longest:g} ms")
    if options.speed is not None and not 0.0 <= options.speed <= HIGHEST_SPEED:
        raise ConfigurationError(f"--speed {options.speed:g}: must be 0 to {HIGHEST_SPEED:g} km/h")
    rolling = (
        []
        if options.speed is None
        else set_once(options.overrides, "--speed", [f"driving.speed={options.speed / 3.6!r}"])
    )
    car = Car.load(options.car, [*options.overrides, *rolling])
    inputs = () if options.car is None else (options.car,)
    path = output_file_of(options, Path(f"{car.vehicle.name}.fmu"), ending=".fmu", protect=inputs)
    channels = None if options.channels is None else recorded_channels(options.channels, car.vehicle)
    reports: list[WrittenFmu] = []
    write_whole(
        path,
        lambda file: reports.append(write_fmu(car, file, fmi=options.fmi, channels=channels, step=1e-3 * options.step)),
    )
    if options.quiet:
        return
    (fmu,) = reports
    size = path.stat().st_size / 1000.0
    counts = ", ".join(f"{fmu.count(causality)} {causality}s" for causality in ("input", "parameter", "output"))
    print(f"{path}: FMI {options.fmi}.0 co-simulation, {counts}; {size:.0f} kB; {', '.join(fmu.platforms)}")
    print(
        f"internal step {1e3 * fmu.step:g} ms; set displacement and velocity of each plate, with their values at "
        "the end of the communication step"
    )
    forces = [force for force in car.vehicle.composition.forces if force.harmonics or force.recorded]
    if pushed := [force.channel for force in forces if force.path.startswith("force.")]:
        print(f"note: {', '.join(pushed)}: is an input; the FMU keeps its mean value only, without harmonics and files")
    if others := [force.name for force in forces if not force.path.startswith("force.")]:
        print(
            f"note: {', '.join(others)}: left out of the FMU; to get an input for it, write it as a section "
            "[force.NAME] of the vehicle file"
        )


main = command(parser, _job)
