"""`python -m vehicle body show`: what a body model is."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import model_of
from vehicle.commands.destination import output_folder_of
from vehicle.commands.options import extra_output_options, message_options, vehicle_options
from vehicle.errors import DataError

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement
    from vehicle.model.parameters.vehicle import Vehicle

FILES = ("modes.csv", "attachments.csv", "residuals.csv", "shapes.png")
COLUMNS = 12
"""Most modes side by side in the printed table of attachments."""


def add(tasks: Any) -> None:
    """The options."""
    shown = tasks.add_parser("show", help="frequencies, participation of attachments, mass properties, residuals")
    shown.add_argument("file", type=Path, nargs="?", metavar="FILE", help="body model; that of the vehicle by default")
    extra_output_options(shown, ", ".join(FILES))
    shown.add_argument("--json", action="store_true", help="print JSON")
    vehicle_options(shown)
    message_options(shown)


def run(options: argparse.Namespace, vehicle: Vehicle) -> None:
    """Print it, and write files where asked for."""
    if options.output is not None:
        output_folder_of(options, options.output)
    model = model_of(options.file, options, vehicle)
    if options.output is not None:
        from vehicle.commands.body.shown_files import write_files

        write_files(options.output, options.force, model, levels(model, vehicle))
    if not options.json:
        print("\n".join(report(model, vehicle)))
        return
    from vehicle.commands.body.shown_numbers import numbers

    try:
        found = numbers(model, vehicle, levels(model, vehicle), _bare(model, vehicle))
    except DataError:
        found = numbers(model, vehicle, {}, None)
    print(json.dumps(found, indent=2, allow_nan=False))


def report(model: Superelement, vehicle: Vehicle) -> list[str]:
    """What a model is: mass properties against the vehicle, modes, participation of attachments, residuals."""
    from vehicle.model.flexbody.body_loads import body_loads
    from vehicle.model.flexbody.mass_difference import mass_difference, vehicle_lines

    lines = [f"{model.name}: {len(model.nodes)} nodes, {len(model.frequencies)} modes", f"  {model.provenance}"]
    lines += mass_lines(model, vehicle)
    if not model.frequencies.size:
        return [*lines, "rigid"]
    if notices := mass_difference(model, vehicle.body, body_loads(vehicle)):
        lines += [*notices, "[body] of this model:", *(f"  {line}" for line in vehicle_lines(model))]
    lines += mode_lines(model)
    try:
        at_points = [
            *attachment_lines(model, vehicle),
            *residual_lines(model, vehicle),
            *rotation_lines(model, vehicle),
        ]
    except DataError as error:  # of another car: shown all the same, but for its points
        return [*lines, f"not on this car: {error}"]
    return [*lines, *at_points]


def mass_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Mass, CoG and inertia about it of the model against those of the vehicle."""
    from vehicle.model.flexbody.rigid_body import rigid_body

    own, lines = rigid_body(vehicle.body), [f"{'':<18} {'model':>10} {'vehicle':>10} {'difference':>11}"]

    def line(name: str, mine: float, theirs: float, digits: int) -> None:
        apart = f"{mine - theirs:>+z11.{digits}f}"
        lines.append(f"{name:<18} {mine:>z10.{digits}f} {theirs:>z10.{digits}f} {apart}")

    line("mass [kg]", model.mass, own.mass, 2)
    for axis, mine, theirs in zip("xyz", model.cog, own.cog, strict=True):
        line(f"CoG {axis} [m]", float(mine), float(theirs), 4)
    for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
        sign = 1.0 if i == j else -1.0  # products as integrals, as in the vehicle file
        name = f"I{'xyz'[i]}{'xyz'[j]} [kg m2]"
        line(name, sign * float(model.inertia[i, j]), sign * float(own.inertia[i, j]), 1)
    lines.append("  moments about the CoG, products as integrals; the car takes those of the vehicle")
    return lines


def mode_lines(model: Superelement) -> list[str]:
    """Frequency, damping and name of each mode."""
    lines = [f"{'mode':>4} {'Hz':>8} {'damping':>8}  name"]
    for i, (frequency, ratio) in enumerate(zip(model.frequencies, model.damping_ratio, strict=True)):
        lines.append(f"{i + 1:>4} {frequency:>8.3f} {100 * ratio:>6.2f} %  {model.mode_names[i]}")
    return lines


def levels(model: Superelement, vehicle: Vehicle) -> dict[str, Any]:
    """Shapes at the attachments and places of a car over the mean of the body, sqrt(m) Phi [-]: name to (modes, 3)."""
    import numpy as np

    from vehicle.model.flexbody.superelement import attached_nodes

    places = vehicle.composition.attachments()
    nodes = attached_nodes(model, places)
    scale = float(np.sqrt(model.mass))
    return {name: scale * model.shapes[:, model.node_index(nodes[at])] for name, at in places.items() if at in nodes}


def attachment_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """How strongly each attachment and place takes part in each mode."""
    import numpy as np

    count = min(len(model.frequencies), COLUMNS)
    cut = "" if count == len(model.frequencies) else f"; the first {count} modes, all with --output"
    found = {name: np.linalg.norm(one, axis=1) for name, one in levels(model, vehicle).items()}
    lines = [
        f"participation of attachments and places: |shape| over its mean in the body, sqrt(m) |Phi| [-]{cut}",
        f"  {'mode':<28}" + "".join(f"{number:>6}" for number in range(1, count + 1)),
    ]
    return lines + [f"  {name:<28}" + "".join(f"{one:>6.2f}" for one in own[:count]) for name, own in found.items()]


def residual_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Residual flexibility of each attachment, and where there is none."""
    import numpy as np

    if model.residual:
        lines = ["residual flexibility [m/N]: along x, y, z, and the largest value in any direction"]
        for name, own in model.residual.items():
            along = "".join(f"{value:>11.3g}" for value in np.diag(own))
            lines.append(f"  {name:<28}{along}{np.linalg.eigvalsh(own)[-1]:>11.3g}")
    else:
        lines = ["residual flexibility: none known"]
    bare = _bare(model, vehicle)
    if bare:
        lines.append(
            f"  none of {', '.join(bare)}: beyond the modes of the model the body is rigid there, as after a modal "
            "test; `body import --residual` takes measured values"
        )
    return lines


def _bare(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Points at which something acts on the body and whose node has no residual flexibility."""
    from vehicle.model.flexbody.superelement import attached_nodes

    own = vehicle.composition
    acting = {one.point: one.at for one in own.connections if "body" in (one.moving, one.carrier)}
    nodes = attached_nodes(model, acting)
    return [name for name, at in acting.items() if nodes.get(at) not in model.residual]


def rotation_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Whether the model knows how the nodes turn on which elements with a rotational stiffness act."""
    from vehicle.model.flexbody.superelement import attached_nodes

    turning = {
        one.point: one.at
        for one in vehicle.composition.connections
        if "body" in (one.moving, one.carrier) and one.law is not None and one.law.rotational_stiffness > 0.0
    }
    nodes = attached_nodes(model, turning)
    unknown = [name for name, at in turning.items() if nodes[at] not in model.rotations]
    known = [name for name in turning if name not in unknown]
    lines = [f"rotations of nodes under rotational stiffness: known of {', '.join(known)}"] if known else []
    if unknown:
        lines.append(
            f"rotations of nodes under rotational stiffness: not known of {', '.join(unknown)}; to a torque there the "
            "body is rigid"
        )
    return lines
