"""`python -m vehicle body show`: properties of a body model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.commands.body.model_file import model_of
from vehicle.commands.console import Console
from vehicle.commands.options import extra_output_options, message_options, setting_options, vehicle_options
from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement
    from vehicle.model.parameters.vehicle import Vehicle

FILES = ("modes.csv", "attachments.csv", "residuals.csv", "shapes.png")
COLUMNS = 12
"""Maximum number of modes in the printed table of attachments."""


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    shown = tasks.add_parser(
        "show",
        help="print frequencies, mode shapes at the attachments, mass, inertia and residual flexibility of a body "
        "model",
    )
    setting_options(shown, BodySettings, "file")
    extra_output_options(shown, ", ".join(FILES))
    shown.add_argument("--json", action="store_true", help="print JSON")
    vehicle_options(shown)
    message_options(shown)


@dataclass(frozen=True, kw_only=True, slots=True)
class BodySettings(Settings):
    """Body model to show, by default the body of the car; files are written only to an `output`."""

    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)
    file: Path | None = setting(
        "file of the body model; default: the body of the vehicle", flag="file", type=Path, nargs="?", metavar="FILE"
    )


def run(settings: BodySettings, console: Console) -> None:
    """Print the properties of the body model; with --output write them as files."""
    vehicle, destination = settings.car.load(), settings.destination
    if destination.output is not None:
        destination.folder(destination.output)
    model = model_of(settings.file, settings.car, vehicle)
    if destination.output is not None:
        _write(destination.output, model, levels(model, vehicle), force=destination.force)
    try:
        content = _numbers(model, vehicle, levels(model, vehicle), _bare(model, vehicle))
    except DataError:
        content = _numbers(model, vehicle, {}, None)
    console.result(content, "\n".join(report(model, vehicle)))


def report(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Return the printed lines: mass properties against the vehicle, modes, participation, residual flexibility."""
    from vehicle.model.flexbody.body_loads import body_loads
    from vehicle.model.flexbody.mass_difference import mass_difference, vehicle_lines

    lines = [f"{model.name}: {len(model.nodes)} nodes, {len(model.frequencies)} modes", f"  {model.provenance}"]
    lines += mass_lines(model, vehicle)
    if not model.frequencies.size:
        return [*lines, "rigid"]
    if notices := mass_difference(model, vehicle.body, body_loads(vehicle)):
        lines += [
            *notices,
            "lines for the section [body] of a vehicle file:",
            *(f"  {line}" for line in vehicle_lines(model)),
        ]
    lines += mode_lines(model)
    try:
        at_points = [
            *attachment_lines(model, vehicle),
            *residual_lines(model, vehicle),
            *rotation_lines(model, vehicle),
        ]
    except DataError as error:  # a model of another car: only the properties at its points are missing
        return [*lines, f"does not fit this car: {error}"]
    return [*lines, *at_points]


def mass_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Return lines with mass, CoG and inertia about the CoG, of the model and of the vehicle."""
    from vehicle.model.flexbody.rigid_body import rigid_body

    body = rigid_body(vehicle.body)
    lines = [
        f"compared with the car {vehicle.name}; --vehicle chooses another",
        f"{'':<18} {'model':>10} {'vehicle':>10} {'difference':>11}",
    ]

    def line(name: str, mine: float, theirs: float, digits: int) -> None:
        apart = f"{mine - theirs:>+z11.{digits}f}"
        lines.append(f"{name:<18} {mine:>z10.{digits}f} {theirs:>z10.{digits}f} {apart}")

    line("mass [kg]", model.mass, body.mass, 2)
    for axis, mine, theirs in zip("xyz", model.cog, body.cog, strict=True):
        line(f"CoG {axis} [m]", float(mine), float(theirs), 4)
    for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
        sign = 1.0 if i == j else -1.0  # products as integrals, as in the vehicle file
        name = f"I{'xyz'[i]}{'xyz'[j]} [kg m2]"
        line(name, sign * float(model.inertia[i, j]), sign * float(body.inertia[i, j]), 1)
    lines.append(
        "  moments about the centre of gravity, Ixy = integral of xy dm; a simulation uses the values of the "
        "vehicle file"
    )
    return lines


def mode_lines(model: Superelement) -> list[str]:
    """Return a line for each mode: frequency, damping ratio, name."""
    lines = [f"{'mode':>4} {'Hz':>8} {'damping':>8}  name"]
    for i, (frequency, ratio) in enumerate(zip(model.frequencies, model.damping_ratio, strict=True)):
        lines.append(f"{i + 1:>4} {frequency:>8.3f} {100 * ratio:>6.2f} %  {model.mode_names[i]}")
    return lines


def levels(model: Superelement, vehicle: Vehicle) -> dict[str, Any]:
    """Return normalised mode shapes sqrt(m) Phi [-] at attachments and output points: name to (modes, 3)."""
    import numpy as np

    from vehicle.model.flexbody.superelement import attached_nodes

    points = vehicle.composition.attachments()
    nodes = attached_nodes(model, points)
    scale = float(np.sqrt(model.mass))
    return {name: scale * model.shapes[:, model.node_index(nodes[at])] for name, at in points.items() if at in nodes}


def attachment_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Return the table of participation of attachments and output points in each mode."""
    import numpy as np

    count = min(len(model.frequencies), COLUMNS)
    cut = "" if count == len(model.frequencies) else f"; first {count} modes only, --output DIR writes all"
    amplitudes = {name: np.linalg.norm(shape, axis=1) for name, shape in levels(model, vehicle).items()}
    lines = [
        f"mode shapes at attachments and output points, relative to the mean of the body: sqrt(m) |Phi| [-]{cut}",
        f"  {'mode':<28}" + "".join(f"{number:>6}" for number in range(1, count + 1)),
    ]
    return lines + [
        f"  {name:<28}" + "".join(f"{value:>6.2f}" for value in values[:count]) for name, values in amplitudes.items()
    ]


def residual_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Return lines with the residual flexibility of each attachment, and the attachments without it."""
    import numpy as np

    if model.residual:
        lines = ["residual flexibility [m/N]: along x, y, z, and the largest value in any direction"]
        for name, flexibility in model.residual.items():
            along = "".join(f"{value:>11.3g}" for value in np.diag(flexibility))
            lines.append(f"  {name:<28}{along}{np.linalg.eigvalsh(flexibility)[-1]:>11.3g}")
    else:
        lines = ["residual flexibility: the model contains none"]
    bare = _bare(model, vehicle)
    if bare:
        lines.append(
            f"  no residual flexibility at {', '.join(bare)}: only the modes of the model make the body flexible "
            "there; add measured values with `body import --residual FILE`"
        )
    return lines


def _bare(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Return the points of connections to the body whose node has no residual flexibility."""
    from vehicle.model.flexbody.superelement import attached_nodes

    car = vehicle.composition
    acting = {
        connection.point: connection.at
        for connection in car.connections
        if "body" in (connection.moving, connection.carrier)
    }
    nodes = attached_nodes(model, acting)
    return [name for name, at in acting.items() if nodes.get(at) not in model.residual]


def rotation_lines(model: Superelement, vehicle: Vehicle) -> list[str]:
    """Return lines with the points of rotational stiffness with and without nodal rotations in the model."""
    from vehicle.model.flexbody.superelement import attached_nodes

    stiff = {
        connection.point: connection.at
        for connection in vehicle.composition.connections
        if "body" in (connection.moving, connection.carrier)
        and connection.law is not None
        and connection.law.rotational_stiffness > 0.0
    }
    nodes = attached_nodes(model, stiff)
    unknown = [name for name, at in stiff.items() if nodes[at] not in model.rotations]
    present = [name for name in stiff if name not in unknown]
    lines = (
        [f"the body model contains the rotations at these points with rotational stiffness: {', '.join(present)}"]
        if present
        else []
    )
    if unknown:
        lines.append(
            f"rotation of the body at points with rotational stiffness: missing at {', '.join(unknown)}, so the "
            "body is rigid against torques there"
        )
    return lines


def _numbers(
    model: Superelement, vehicle: Vehicle, levels: Mapping[str, Any], bare: list[str] | None
) -> dict[str, Any]:
    """Return the content of the printed tables, unrounded, SI units; `bare` is None if the model does not fit the car.

    Inertia is the tensor about the CoG, its elements off the diagonal minus the products; participation |shape| over
    its mean in the body, (modes,) for each attachment and place; residual flexibility [m/N], (3, 3).
    """
    import numpy as np

    from vehicle.model.flexbody.body_loads import body_loads
    from vehicle.model.flexbody.mass_difference import mass_difference
    from vehicle.model.flexbody.rigid_body import rigid_body

    def mass_of(body: Any) -> dict[str, Any]:
        tensor = np.asarray(body.inertia).tolist()
        return {"mass_kg": float(body.mass), "cog_m": np.asarray(body.cog).tolist(), "inertia_kgm2": tensor}

    modes = zip(model.frequencies, model.damping_ratio, model.mode_names, strict=True)
    return {
        "name": model.name,
        "provenance": model.provenance,
        "nodes": len(model.nodes),
        **mass_of(model),
        "vehicle": mass_of(rigid_body(vehicle.body)),
        "notices": list(mass_difference(model, vehicle.body, body_loads(vehicle))),
        "modes": [
            {"frequency_hz": float(frequency), "damping_ratio": float(ratio), "name": name}
            for frequency, ratio, name in modes
        ],
        "on_this_car": bare is not None,
        "participation": {name: np.linalg.norm(shape, axis=1).tolist() for name, shape in levels.items()},
        "residual_m_per_n": {name: np.asarray(flexibility).tolist() for name, flexibility in model.residual.items()},
        "without_residual": bare,
    }


def _write(output: Path, model: Superelement, levels: Mapping[str, Any], *, force: bool) -> None:
    """Write tables of modes, attachments and residuals, and a picture of the shapes."""
    import numpy as np

    from vehicle.drawing.rendering.body_plot import MOST, plot_body
    from vehicle.runs.output.folder import Content, output_folder, write_files
    from vehicle.signals.formats.csv_table import table_text

    count = len(model.frequencies)
    modes = ["mode,frequency [Hz],damping ratio [-],name"]
    for i, (frequency, ratio) in enumerate(zip(model.frequencies, model.damping_ratio, strict=True)):
        modes.append(f'{i + 1},{frequency:.9g},{ratio:.6g},"{model.mode_names[i]}"')
    taking = [["attachment", "axis", *(f"mode_{n + 1} [-]" for n in range(count))]]
    for name, values in levels.items():
        taking += [[name, axis, *values[:, i]] for i, axis in enumerate("xyz")]
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    residuals = [["attachment", *(f"{'xyz'[i]}{'xyz'[j]} [m/N]" for i, j in pairs)]]
    residuals += [[name, *(values[pair] for pair in pairs)] for name, values in model.residual.items()]
    note = "mode shape at each attachment and point, relative to the mean of the body: sqrt(m) Phi"
    # A place is a node of the picture where it is one of the model.
    shown = [index for index, node in enumerate(model.nodes) if node in levels]
    titles = [
        f"mode {i + 1}: {frequency:.2f} Hz, {number(100 * ratio, 2)} %"
        + ("" if model.mode_names[i] == f"mode {i + 1}" else f"\n{model.mode_names[i]}")
        for i, (frequency, ratio) in enumerate(zip(model.frequencies, model.damping_ratio, strict=True))
    ]
    more = f"; the first {MOST} of {count} modes" if count > MOST else ""
    caption = (
        f"grey: at rest; colour: displacement, each mode at its own scale; dots: attachments and output points{more}"
    )
    texts = ("\n".join(modes) + "\n", table_text(taking, [note]), table_text(residuals))
    contents: dict[str, Content] = dict(zip(FILES, texts, strict=False))
    if count:
        contents[FILES[3]] = partial(
            plot_body,
            positions=model.positions,
            edges=np.asarray(model.edges, dtype=int),
            shapes=model.shapes,
            titles=titles,
            attachments=np.array(shown, dtype=int),
            title=f"Modes of the free body {model.name}",
            caption=caption,
        )
    with output_folder(output, force=force) as folder:
        write_files(folder, contents)


SETTINGS = BodySettings
