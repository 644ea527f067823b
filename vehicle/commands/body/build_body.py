"""`python -m vehicle body build`: compute the frame of a body design on the points of a car."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from vehicle.commands.body.model_file import output_options, require_output, write
from vehicle.commands.body.show_body import report
from vehicle.commands.console import Console
from vehicle.commands.options import message_options, setting_options, vehicle_options
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    built = tasks.add_parser(
        "build", help="compute a body model from a body design (a frame of beams through the points of the car)"
    )
    design = built.add_argument_group("the design")
    setting_options(design, BuildSettings, "design")
    output_options(built)
    vehicle_options(built)
    message_options(built, quiet=True)


@dataclass(frozen=True, kw_only=True, slots=True)
class BuildSettings(Settings):
    """Car, body design, and the new file."""

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    design: Path | None = setting(
        "file of the body design; default: the design named in the vehicle file", type=Path, metavar="FILE.toml"
    )


def run(settings: BuildSettings, console: Console) -> None:
    """Compute the body model from its design, write it, and print its properties."""
    from vehicle.model.flexbody.body_design import read_design
    from vehicle.model.flexbody.body_frame import design_superelement
    from vehicle.model.flexbody.body_model import body_file

    vehicle = settings.car.load()
    output = require_output(settings.destination, settings.design, settings.car.vehicle)
    file = settings.design or body_file(vehicle, settings.car.folder)
    design = read_design(file)
    model = design_superelement(design, vehicle.points, vehicle.composition.attachments(), vehicle.body)
    write(output, model)
    console.say("\n".join(report(model, vehicle)))


SETTINGS = BuildSettings
