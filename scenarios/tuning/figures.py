"""Figure of fitted against hidden values."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from scenarios.charts import figure_file
from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS, INK
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.tuning_figures import short_name


def parameter_figure(path: Path, results: Mapping[str, TuningResult], true: Mapping[str, float]) -> None:
    """Draw fitted values with three standard errors over the hidden values."""
    first = next(iter(results.values()))
    paths = [
        parameter.path
        for parameter in first.parameters
        if any(parameter.path in result.free for result in results.values())
    ]
    starts = {parameter.path: parameter.start for parameter in first.parameters}
    held = [short_name(parameter.path) for parameter in first.unidentified]
    note = (
        "Bars: three standard errors; value over hidden value. Right: on a finer scale; what lies beyond it is cut "
        "off. Crosses: start. " + (f"Not told by the data and held at its start: {', '.join(held)}." if held else "")
    )
    with figure_file(path, (12.0, 1.6 + 0.55 * len(paths)), "Fitted values over hidden values", note) as figure:
        wide, fine = figure.subplots(1, 2, sharey=True)
        positions = np.arange(len(paths), dtype=float)
        for axis, percent in ((wide, None), (fine, 3.0)):
            axis.axvline(0.0, color=INK, linewidth=0.8)
            for index, ((name, result), colour) in enumerate(zip(results.items(), COLOURS, strict=False)):
                x, error, y = _relative(result, paths, true, positions + 0.22 * (index - 0.5 * (len(results) - 1)))
                axis.errorbar(x, y, xerr=error, fmt="o", markersize=4, capsize=3, color=colour, label=name)
            away = [100.0 * (starts[parameter] / true[parameter] - 1.0) for parameter in paths]
            axis.plot(away, positions, "x", color=COLOURS[3], label="start")
            if percent is not None:
                axis.set_xlim(-percent, percent)
            axis.set_xlabel("(fitted - hidden) / hidden [%]")
        wide.set_yticks(positions, [short_name(parameter) for parameter in paths])
        wide.invert_yaxis()
        wide.legend(loc="best")


def _relative(
    result: TuningResult, paths: Sequence[str], reference: Mapping[str, float], positions: Vector
) -> tuple[list[float], list[float], list[float]]:
    """Return deviation, three standard errors [%] and positions on the axis of the parameters of a fit."""
    columns: tuple[list[float], list[float], list[float]] = ([], [], [])
    for path, position in zip(paths, positions, strict=True):
        if path in result.free:
            columns[0].append(100.0 * (result.values[path] / reference[path] - 1.0))
            columns[1].append(300.0 * result.standard_errors[path] / reference[path])
            columns[2].append(float(position))
    return columns
