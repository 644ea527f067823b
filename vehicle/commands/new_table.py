"""Report of a table of a car: what was understood, guessed and left out; its points over the template."""

import math
from pathlib import Path
from typing import Any

from vehicle.digits import aligned
from vehicle.drawing.rendering.point_plot import plot_points
from vehicle.studies.design.new_car import NewCar
from vehicle.studies.design.template_car import TemplateCar
from vehicle.studies.design.written_table import car_points
from vehicle.studies.tables.car_table import CarTable


def table_report(result: NewCar, template: TemplateCar, source: CarTable) -> list[str]:
    """Return the lines on a table: its rows behind each number and point, guesses, and what is left out."""
    units = {check.name: check.unit for check in result.checks}
    lines = [f"table {source.file}" + (f", axes {source.axes}" if source.axes else ""), ""]
    rows = [("understood", "in the file", "in the car")]
    values = {check.name: check.value for check in result.checks}
    for name in source.numbers:
        shown = f"{values[name]:.6g} {units[name]}".removesuffix(" -") if name in values else str(source.numbers[name])
        rows.append((name.replace("_", " "), source.origins.get(name, ""), shown))
    lines += aligned(rows, left=2)
    if source.points:
        points = [("point", "in the file", "x, y, z in the car [mm]", "from the template [mm]")]
        for word, (used, _, before) in _points(result, template, source).items():
            for name, at in used.items():
                millimetres = ", ".join(f"{1e3 * value:.1f}" for value in at)
                moved = f"{1e3 * math.dist(at, before[name]):.1f}"
                points.append((f"{word} {name}", source.origins.get((word, name), ""), millimetres, moved))
        lines += ["", *aligned(points, left=2)]
        for word, (_, kept, _) in _points(result, template, source).items():
            if kept:
                lines.append(
                    f"{word} points that are not in the file, moved with the template's axle: {', '.join(kept)}"
                )
    lines += [f"damper curve {word}: {len(rows)} points" for word, rows in source.curves.items()]
    for (word, path), (value, origin) in source.parameters.items():
        lines.append(f"{word} {path} = {value}: {origin}")
    for title, texts in (("guessed", source.guessed), ("left out", source.left_out)):
        if texts:
            lines += ["", f"{title}:", *(f"  {_placed(at)}{text}" for at, text in texts)]
    return [*lines, ""]


def table_json(source: CarTable) -> dict[str, Any]:
    """Return what was read of a table, for JSON."""
    return {
        "file": source.file,
        "axes": source.axes,
        "numbers": source.numbers,
        "points": {word: list(points) for word, points in source.points.items()},
        "guessed": [text for _, text in source.guessed],
        "left_out": [text for _, text in source.left_out],
    }


def plot_table(path: Path, result: NewCar, template: TemplateCar, source: CarTable) -> None:
    """Write the picture of the points of a table over the template."""
    title = f"Points of {source.file} over the points of {template.name}"
    caption = (
        "x to the rear, y to the right, z up, frame of the vehicle file; a line joins a point with its place before"
    )
    plot_points(path, _points(result, template, source), title, caption)


def _points(result: NewCar, template: TemplateCar, source: CarTable):  # type: ignore[no-untyped-def]
    """Return by axle the points of the car from the table, from the template, and all of the template."""
    axles = {}
    for word in template.wheels:
        placed = car_points(result, template, word)
        used = {name: placed[name] for name in source.points.get(word, {})}
        kept = {name: at for name, at in placed.items() if name not in used}
        before = {name: tuple(at) for name, at in template.table[template.axle(word)]["hardpoints"].items()}
        if used:
            axles[word] = (used, kept, before)
    return axles


def _placed(at: str) -> str:
    """Return the line of a place, for a list under the name of the file: "7: "."""
    return f"{at.rpartition(':')[2].strip()}: " if at else ""
