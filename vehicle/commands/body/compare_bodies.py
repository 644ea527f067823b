"""`python -m vehicle body compare`: compare the modes of two body models."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vehicle.arrays import Vector
from vehicle.commands.body.model_file import model_of
from vehicle.commands.console import Console
from vehicle.commands.options import extra_output_options, message_options, setting_options, vehicle_options
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.settings import Settings, part, setting

if TYPE_CHECKING:
    from vehicle.model.flexbody.superelement import Superelement

FILES = ("mac.csv", "mac.png")

MOST = 40
"""Maximum number of modes of each body in the picture; more labels would not be readable."""


def add(tasks: Any) -> None:
    """Add the parser of the task with its options."""
    compared = tasks.add_parser(
        "compare", help="compare frequencies and mode shapes (MAC) of two body models at the points of the car"
    )
    setting_options(compared, BodiesSettings, "file", "other")
    extra_output_options(compared, ", ".join(FILES))
    vehicle_options(compared)
    message_options(compared)


@dataclass(frozen=True, kw_only=True, slots=True)
class BodiesSettings(Settings):
    """Body models to compare at the points of a car; files are written only to an `output`."""

    file: Path = setting("body model, .toml or .npz", flag="file", type=Path, metavar="FILE")
    other: Path = setting("file of the other body model, .toml or .npz", flag="other", type=Path, metavar="OTHER")
    car: CarChoice = part(CarChoice)
    destination: Destination = part(Destination)


def run(settings: BodiesSettings, console: Console) -> None:
    """Print frequencies and MAC at the points of the car; with --output write them as files."""
    import numpy as np

    from vehicle.model.flexbody.superelement import attached_nodes
    from vehicle.signals.analysis.modal_assurance import mac

    vehicle, output = settings.car.load(), settings.destination.output
    if output is not None:
        settings.destination.folder(output)
    models = [model_of(file, settings.car, vehicle) for file in (settings.file, settings.other)]
    points = vehicle.composition.attachments()
    shapes = []
    for model in models:
        nodes = attached_nodes(model, points)
        shapes.append(np.array([model.shape_at(nodes[point]).T for point in points.values()]).transpose(1, 0, 2))
    likeness = mac(*shapes)
    if output is not None:
        title = f"similarity (MAC) of the mode shapes at {len(points)} points of the car"
        _write_files(output, settings, models, likeness, title)
    print(
        f"{'mode':>4} {'Hz':>8}   {'mode':>4} {'Hz':>8} {'change':>8} {'MAC':>6}   at {len(points)} points of the car"
    )
    for i, row in enumerate(likeness):
        j = int(row.argmax())
        frequency, other = models[0].frequencies[i], models[1].frequencies[j]
        change = 100.0 * (other / frequency - 1.0)
        print(f"{i + 1:>4} {frequency:>8.3f}   {j + 1:>4} {other:>8.3f} {change:>+7.2f}% {row[j]:>6.3f}")


def _write_files(
    output: Path, settings: BodiesSettings, models: list[Superelement], likeness: Vector, title: str
) -> None:
    """Write the MAC matrix as a table, and a picture of its first modes."""
    from vehicle.runs.comparison.pictures import plot_mac
    from vehicle.runs.output.folder import output_folder, write_files
    from vehicle.signals.formats.csv_table import table_text

    rows, columns = (model.frequencies for model in models)
    heads = ["mode", "frequency [Hz]", *(f"mode_{j + 1} {each:.9g} Hz [-]" for j, each in enumerate(columns))]
    table = [(i + 1, f"{each:.9g}", *row) for i, (each, row) in enumerate(zip(rows, likeness, strict=True))]
    text = table_text([heads, *table], [f"{title}; rows: {settings.file.name}, columns: {settings.other.name}"])
    axes_title = f"down: {settings.file.name}\nacross: {settings.other.name}"
    note = f"; the first {MOST} modes" if max(likeness.shape) > MOST else ""
    shown = [(axes_title, likeness[:MOST, :MOST], rows[:MOST].tolist(), columns[:MOST].tolist())]
    picture = partial(plot_mac, tables=shown, caption=f"{title}{note}")
    with output_folder(output, force=settings.destination.force) as folder:
        write_files(folder, dict(zip(FILES, (text, picture), strict=True)))


SETTINGS = BodiesSettings
