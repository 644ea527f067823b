"""`python -m vehicle body show`: what a body model is."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import model_of
from vehicle.commands.options import message_options, vehicle_options

if TYPE_CHECKING:
    from vehicle.flexbody.superelement import Superelement
    from vehicle.parameters.vehicle import Vehicle


def add(tasks: Any) -> None:
    """The options."""
    shown = tasks.add_parser("show", help="frequencies, participation of attachments, mass properties, residuals")
    shown.add_argument("file", type=Path, nargs="?", metavar="FILE", help="body model; that of the vehicle by default")
    vehicle_options(shown)
    message_options(shown)


def run(options: argparse.Namespace, vehicle: Vehicle) -> None:
    """Print it."""
    print("\n".join(report(model_of(options.file, options, vehicle), vehicle)))


def report(model: Superelement, vehicle: Vehicle) -> list[str]:
    """What a model is: mass properties against the vehicle, modes, where they are loud, residuals."""
    import numpy as np

    own, lines = vehicle.body, [f"{model.name}: {len(model.nodes)} nodes, {len(model.frequencies)} modes"]
    lines.append(f"  {model.provenance}")
    lines.append(f"{'':<12} {'model':>10} {'vehicle':>10}")
    lines.append(f"{'mass [kg]':<12} {model.mass:>10.2f} {own.mass:>10.2f}")
    for axis, mine, theirs in zip("xyz", model.cog, own.cog, strict=True):
        lines.append(f"{f'CoG {axis} [m]':<12} {mine:>10.4f} {theirs:>10.4f}")
    if not model.frequencies.size:
        return [*lines, "rigid"]
    places = [name for name in vehicle.composition.attachments() if name in model.nodes]
    lines.append(f"{'mode':>4} {'Hz':>8} {'damping':>8}  loudest places [kg^-1/2], name")
    for i, (frequency, ratio) in enumerate(zip(model.frequencies, model.damping_ratio, strict=True)):
        level = {name: float(np.linalg.norm(model.shapes[i, model.node_index(name)])) for name in places}
        loud = sorted(level, key=lambda name: -level[name])[:3]
        text = ", ".join(f"{name} {level[name]:.4f}" for name in loud)
        lines.append(f"{i + 1:>4} {frequency:>8.3f} {100 * ratio:>6.2f} %  {text}; {model.mode_names[i]}")
    if model.residual:
        lines.append("residual flexibility [m/N], principal values")
        for name, flexibility in model.residual.items():
            values = ", ".join(f"{value:.3g}" for value in np.linalg.eigvalsh(flexibility))
            lines.append(f"  {name:<28} {values}")
    return [*lines, *rotation_lines(model, vehicle)]


def rotation_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Whether the model knows how the nodes turn on which elements with a rotational stiffness act."""
    from vehicle.flexbody.superelement import attached_nodes

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
