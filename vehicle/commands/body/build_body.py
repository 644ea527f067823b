"""`python -m vehicle body build`: the frame of a body design on the points of a car."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import output_options, require_output, write
from vehicle.commands.body.show_body import report
from vehicle.commands.options import message_options, vehicle_options

if TYPE_CHECKING:
    from vehicle.parameters.vehicle import Vehicle


def add(tasks: Any) -> None:
    """The options."""
    built = tasks.add_parser("build", help="compute the frame of a body design on the points of a car")
    built.add_argument("--design", type=Path, metavar="FILE.toml", help="body design; that of the vehicle by default")
    output_options(built)
    vehicle_options(built)
    message_options(built)


def run(options: argparse.Namespace, vehicle: Vehicle) -> None:
    """Compute the model, write it and print what it is."""
    from vehicle.flexbody.body_design import read_design
    from vehicle.flexbody.body_frame import design_superelement
    from vehicle.flexbody.library import body_file

    require_output(options)
    file = options.design or body_file(vehicle, options.vehicle.parent if options.vehicle else None)
    design = read_design(file)
    model = design_superelement(design, vehicle.points, vehicle.composition.attachments(), vehicle.body)
    write(options, model)
    print("\n".join(report(model, vehicle)))
