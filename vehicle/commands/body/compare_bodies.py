"""`python -m vehicle body compare`: two models of a body."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import model_of
from vehicle.commands.options import message_options, vehicle_options

if TYPE_CHECKING:
    from vehicle.parameters.vehicle import Vehicle


def add(tasks: Any) -> None:
    """The options."""
    compared = tasks.add_parser("compare", help="two models of a body: frequencies and MAC at the points of the car")
    compared.add_argument("file", type=Path, metavar="FILE", help="body model, .toml or .npz")
    compared.add_argument("other", type=Path, metavar="OTHER", help="the one that it is compared with")
    vehicle_options(compared)
    message_options(compared)


def run(options: argparse.Namespace, vehicle: Vehicle) -> None:
    """Print frequencies and MAC at the points of the car."""
    import numpy as np

    from vehicle.analysis.modal_assurance import mac
    from vehicle.flexbody.superelement import attached_nodes

    models = [model_of(file, options, vehicle) for file in (options.file, options.other)]
    places = vehicle.composition.attachments()
    shapes = []
    for model in models:
        nodes = attached_nodes(model, places)
        shapes.append(np.array([model.shape_at(nodes[place]).T for place in places.values()]).transpose(1, 0, 2))
    likeness = mac(*shapes)
    print(
        f"{'mode':>4} {'Hz':>8}   {'mode':>4} {'Hz':>8} {'change':>8} {'MAC':>6}   at {len(places)} points of the car"
    )
    for i, row in enumerate(likeness):
        j = int(row.argmax())
        one, other = models[0].frequencies[i], models[1].frequencies[j]
        change = 100.0 * (other / one - 1.0)
        print(f"{i + 1:>4} {one:>8.3f}   {j + 1:>4} {other:>8.3f} {change:>+7.2f}% {row[j]:>6.3f}")
