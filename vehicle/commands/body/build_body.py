"""`python -m vehicle body build`: compute the frame of a body design on the points of a car."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import output_options, require_output, write
from vehicle.commands.body.show_body import report
from vehicle.commands.options import message_options, vehicle_options

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    built = tasks.add_parser(
        "build", help="compute a body model from a body design (a frame of beams through the points of the car)"
    )
    design = built.add_argument_group("the design")
    design.add_argument(
        "--design",
        type=Path,
        metavar="FILE.toml",
        help="file of the body design; default: the design named in the vehicle file",
    )
    output_options(built)
    vehicle_options(built)
    message_options(built, quiet=True)


def run(options: argparse.Namespace, vehicle: Vehicle) -> None:
    """Compute the body model from its design, write it, and print its properties."""
    from vehicle.model.flexbody.body_design import read_design
    from vehicle.model.flexbody.body_frame import design_superelement
    from vehicle.model.flexbody.body_model import body_file

    require_output(options)
    file = options.design or body_file(vehicle, options.vehicle.parent if options.vehicle else None)
    design = read_design(file)
    model = design_superelement(design, vehicle.points, vehicle.composition.attachments(), vehicle.body)
    write(options, model)
    if options.quiet:
        return
    print("\n".join(report(model, vehicle)))
