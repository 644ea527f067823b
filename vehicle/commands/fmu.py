"""`python -m vehicle fmu CAR`: a car as an FMU for co-simulation in other simulators."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import (
    car_argument,
    command_parser,
    message_options,
    output_options,
    setting_options,
)
from vehicle.commands.parser import Parser
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.names import FMI_VERSIONS
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.handover.fmu.fmu_file import WrittenFmu


@dataclass(frozen=True, kw_only=True, slots=True)
class FmuSettings(Settings):
    """Settings of the FMU of a car.

    Attributes:
        destination: the FMU; by default the name of the car.
    """

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    fmi: str = setting("version of the FMI standard; default: %(default)s", FMI_VERSIONS[0], choices=FMI_VERSIONS)
    channels: str | None = setting(
        "add outputs to the default channels: loads, all, or names separated by commas", metavar="NAME,..."
    )
    speed: float | None = setting(
        "speed at which the tyres roll over the plates, which then represent the road [km/h]; default: speed of "
        "the vehicle file",
        within="[0, 300]",
        type=float,
        metavar="KM/H",
    )
    step: float = setting(
        "internal time step [ms]; a communication step must be a multiple of it; default: %(default)s",
        0.1,
        within="[0.001, 0.5]",
        type=float,
        metavar="MS",
    )


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser("fmu", "Write a car as an FMU (FMI 2.0 or 3.0) for Simulink, OpenModelica and others.")
    car_argument(parser)
    setting_options(parser, FmuSettings, "speed", "fmi", "channels", "step")
    output_options(parser, None, default="NAME.fmu", metavar="FILE.fmu")
    message_options(parser, quiet=True)
    return parser


def _job(settings: FmuSettings, console: Console) -> None:
    from vehicle.handover.fmu.fmu_file import write_fmu
    from vehicle.model.parameters.recorded_channels import recorded_channels
    from vehicle.runs.car import Car
    from vehicle.runs.output.folder import write_whole

    choice = settings.car.rolling(settings.speed)
    car = Car.load(choice.vehicle, choice.overrides)
    inputs = () if choice.vehicle is None else (choice.vehicle,)
    path = settings.destination.file(Path(f"{car.vehicle.name}.fmu"), ending=".fmu", protect=inputs)
    channels = None if settings.channels is None else recorded_channels(settings.channels, car.vehicle)
    reports: list[WrittenFmu] = []
    write_whole(
        path,
        lambda file: reports.append(
            write_fmu(car, file, fmi=settings.fmi, channels=channels, step=1e-3 * settings.step)
        ),
    )
    if console.quiet:
        return
    (fmu,) = reports
    size = path.stat().st_size / 1000.0
    counts = ", ".join(f"{fmu.count(causality)} {causality}s" for causality in ("input", "parameter", "output"))
    print(f"{path}: FMI {settings.fmi}.0 co-simulation, {counts}; {size:.0f} kB; {', '.join(fmu.platforms)}")
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


main = command(parser, FmuSettings, _job)
