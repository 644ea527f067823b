"""`python -m vehicle body build`: compute the frame of a body design on the points of a car."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import output_options, require_output, write
from vehicle.commands.body.show_body import report
from vehicle.commands.console import Console
from vehicle.commands.options import message_options, setting_options, vehicle_options
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.model.flexbody.body_design import BodyDesign
    from vehicle.model.parameters.vehicle import Vehicle


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    built = tasks.add_parser(
        "build", help="compute a body model from a body design (a frame of beams through the points of the car)"
    )
    design = built.add_argument_group("the design")
    setting_options(design, BuildSettings, "design", "fit")
    output_options(built)
    vehicle_options(built)
    message_options(built, quiet=True)


def _fitted(design: BodyDesign, vehicle: Vehicle, *, quiet: bool) -> BodyDesign:
    """Return the design with section factors fitted on this car; print the factors unless quiet."""
    from vehicle.model.flexbody.body_frame import body_frame
    from vehicle.model.flexbody.node_masses import NodeProperties
    from vehicle.model.flexbody.section_fit import STAGES, fit_factors

    frame = body_frame(design, vehicle.points, NodeProperties.of_body(vehicle.body, design.least_ixx))
    factors = fit_factors(frame, dict.fromkeys(design.factors, 1.0), STAGES)
    for group in design.fitted_groups if not quiet else ():
        print(f"members.{group}.factor = {factors[group]:.5g}")
    members = {
        name: replace(group, factor=factors[name]) if name in design.fitted_groups else group
        for name, group in design.members.items()
    }
    return replace(design, members=members)


@dataclass(frozen=True, kw_only=True, slots=True)
class BuildSettings(Settings):
    """Car, its body design (None for that of the vehicle file), whether its sections are fitted, and the new file."""

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    design: Path | None = setting(
        "file of the body design; default: the design named in the vehicle file", type=Path, metavar="FILE.toml"
    )
    fit: bool = setting(
        "fit the factors of the beam sections to the published body modes of Bommer 2006 (first 19 Hz, "
        "torsion 25.5 Hz, ninth 43 Hz), and print them as lines of a design. Takes minutes",
        False,
        action="store_true",
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
    if settings.fit:
        design = _fitted(design, vehicle, quiet=console.quiet)
    model = design_superelement(design, vehicle.points, vehicle.composition.attachments(), vehicle.body)
    write(output, model)
    console.say("\n".join(report(model, vehicle)))


SETTINGS = BuildSettings
