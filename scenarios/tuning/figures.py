"""Figures of a fit: FRFs and records before and after, values with their errors, correlations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.charts import FrfCurve, draw_frf, figure_file, rows_of
from vehicle.drawing.rendering.figure import COLOURS, INK
from vehicle.names import channel_units
from vehicle.runs.car import Car
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.record_target import RecordTarget

DATA, START, FITTED = "#9a9a9a", COLOURS[3], COLOURS[0]
"""Light, dotted and dashed: where data and fit agree, both are still seen."""

SHOWN = 0.72
"""Longest stretch of a record that is drawn, around its liveliest moment [s]."""

SHORT = {"stiffness": "K", "suspension_mount": "mount", "torque_arm_engine": "bottom mount, engine"}


def level_figure(path: Path, target: FrfTarget, start: Car, fitted: Car, source: str) -> None:
    """Draw data, start and fit of the FRFs of one level, a column for each channel; `source` describes the data."""
    before, after = target.model_response(start), target.model_response(fitted)
    frequency = target.data.frequency
    columns = []
    for row, channel in enumerate(target.data.channels):
        curves = [
            FrfCurve(
                label="data",
                frequency=frequency,
                response=target.data.response[row],
                coherence=target.data.coherence[row],
                colour=DATA,
            ),
            FrfCurve(label="start", frequency=frequency, response=before[row], colour=START, style=":"),
            FrfCurve(label="fitted", frequency=frequency, response=after[row], colour=FITTED, style="--"),
        ]
        columns.append((channel, curves))
    estimator = "local rational model, whole record" if target.window is None else f"H1, Hann, {target.window:g} s"
    model = (
        "linear car from its matrices, dampers stuck"
        if target.signal is None
        else "reduced engine on the same signal, FRF by the estimator of the data"
    )
    note = (
        f"Data: {source}; {estimator}, {target.averages:.3g} averages (degrees of freedom); coherence of the data. "
        f"Start and fitted: {model}. {frequency.size} frequencies from {frequency[0]:.1f} to {frequency[-1]:.1f} Hz."
    )
    draw_frf(path, f"FRFs before and after the fit: {target.name}", note, columns)


def record_figure(path: Path, targets: Sequence[RecordTarget], start: Car, fitted: Car, source: str) -> None:
    """Draw data, start and fit of the records, a column for each record; `source` describes the data."""
    count = max(len(target.record.channels) for target in targets)
    note = (
        f"Data: {source}; no averages. Start and fitted: reduced engine on the same signal. All through the low-pass "
        f"filter of the fit ({targets[0].lowpass:g} Hz); the liveliest stretch of what counts."
    )
    size = (6.5 * len(targets) + 1.0, 2.4 * count + 1.2)
    with figure_file(path, size, "Records before and after", note) as figure:
        axes = rows_of(figure, count, len(targets))
        for target, column in zip(targets, axes.T, strict=True):
            time = target.record.time[target.kept]
            measured, before, after = target.measured(), target.model_histories(start), target.model_histories(fitted)
            for row, channel in enumerate(target.record.channels):
                axis = column[row]
                axis.plot(time, measured[row], color=DATA, linewidth=2.0, label="data")
                axis.plot(time, before[row], color=START, linestyle=":", linewidth=1.4, label="start")
                axis.plot(time, after[row], color=FITTED, linestyle="--", label="fitted")
                axis.set(xlim=_shown(time, measured), ylabel=f"{channel}\n[{channel_units([channel])[channel]}]")
            column[0].set_title(target.name)
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper right", ncols=3)


def _shown(time: npt.NDArray[np.float64], measured: npt.NDArray[np.float64]) -> tuple[float, float]:
    """Return the window of `SHOWN` seconds with the largest normalised mean square of all channels; all if shorter."""
    count = int(SHOWN / (time[1] - time[0]))
    if count >= time.size:
        return float(time[0]), float(time[-1])
    power = np.mean(measured**2 / np.mean(measured**2, axis=1, keepdims=True), axis=0)
    total = np.concatenate([[0.0], np.cumsum(power)])
    first = int(np.argmax(total[count:] - total[:-count]))
    return float(time[first]), float(time[first + count - 1])


def short_name(path: str) -> str:
    """Return a short name of a path for an axis."""
    return ".".join(SHORT.get(part, part) for part in path.removeprefix("bushings.").split("."))


def parameter_figure(path: Path, results: Mapping[str, TuningResult], true: Mapping[str, float]) -> None:
    """Draw fitted values with three standard errors, and hidden values if there are any.

    Args:
        path: PNG file.
        results: name of a fit to its result; the first fit has all parameters.
        true: path to hidden value; empty for user data, whose values are drawn relative to their start.
    """
    first = next(iter(results.values()))
    paths = [
        parameter.path
        for parameter in first.parameters
        if any(parameter.path in result.free for result in results.values())
    ]
    starts = {parameter.path: parameter.start for parameter in first.parameters}
    held = [short_name(parameter.path) for parameter in first.unidentified]
    against = "hidden" if true else "start"
    note = (
        f"Bars: three standard errors; value over {against} value. "
        + ("Right: on a finer scale; what lies beyond it is cut off. Crosses: start. " if true else "")
        + (f"Not told by the data and held at its start: {', '.join(held)}." if held else "")
    )
    with figure_file(path, (12.0, 1.6 + 0.55 * len(paths)), f"Fitted values over {against} values", note) as figure:
        wide, fine = figure.subplots(1, 2, sharey=True)
        positions = np.arange(len(paths), dtype=float)
        for axis, percent in ((wide, None), (fine, 3.0)):
            axis.axvline(0.0, color=INK, linewidth=0.8)
            for index, ((name, result), colour) in enumerate(zip(results.items(), COLOURS, strict=False)):
                x, error, y = _relative(
                    result, paths, true or starts, positions + 0.22 * (index - 0.5 * (len(results) - 1))
                )
                axis.errorbar(x, y, xerr=error, fmt="o", markersize=4, capsize=3, color=colour, label=name)
            if true:
                away = [100.0 * (starts[parameter] / true[parameter] - 1.0) for parameter in paths]
                axis.plot(away, positions, "x", color=START, label="start")
            if percent is not None:
                axis.set_xlim(-percent, percent)
            axis.set_xlabel(f"(fitted - {against}) / {against} [%]")
        wide.set_yticks(positions, [short_name(parameter) for parameter in paths])
        wide.invert_yaxis()
        wide.legend(loc="best")


def _relative(
    result: TuningResult, paths: Sequence[str], reference: Mapping[str, float], positions: npt.NDArray[np.float64]
) -> tuple[list[float], list[float], list[float]]:
    """Return deviation, three standard errors [%] and positions on the axis of the parameters of a fit."""
    columns: tuple[list[float], list[float], list[float]] = ([], [], [])
    for path, position in zip(paths, positions, strict=True):
        if path in result.free:
            columns[0].append(100.0 * (result.values[path] / reference[path] - 1.0))
            columns[1].append(300.0 * result.standard_errors[path] / reference[path])
            columns[2].append(float(position))
    return columns


def correlation_figure(path: Path, result: TuningResult) -> None:
    """Write the correlation matrix of the free parameters."""
    names = [short_name(free_path) for free_path in result.free]
    size = 3.2 + 0.75 * len(names)
    note = "All free parameters of the fit; near 1 or -1 the data tell a combination much better than each alone."
    with figure_file(path, (size + 1.5, size), "Correlation of the fitted values", note) as figure:
        axis = figure.subplots()
        picture = axis.imshow(result.correlation, cmap="RdBu_r", vmin=-1.0, vmax=1.0)
        axis.grid(False)
        axis.set_xticks(range(len(names)), names, rotation=40, ha="right")
        axis.set_yticks(range(len(names)), names)
        for row, line in enumerate(result.correlation):
            for column, value in enumerate(line):
                colour = "white" if abs(value) > 0.6 else "black"
                axis.text(column, row, f"{value:.2f}", ha="center", va="center", fontsize=8, color=colour)
        figure.colorbar(picture, ax=axis, label="correlation [-]", shrink=0.8)
