"""Figures of a fit: FRFs and time histories before and after, correlation of the values, posterior."""

import textwrap
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.drawing.rendering.figure import COLOURS, FADED, FRF_TICKS, fading, frf_axes, saved_figure, wrapped_phase
from vehicle.model.parameters.ranges import Range
from vehicle.names import channel_units, channel_words
from vehicle.runs.car import Car
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.level_target import LevelTarget
from vehicle.studies.tuning.posterior import Posterior
from vehicle.studies.tuning.record_target import RecordTarget

LOOKS: dict[str, dict[str, Any]] = {
    "measured": {"color": "#9a9a9a", "linewidth": 2.2},
    "start": {"color": COLOURS[3], "linestyle": ":", "linewidth": 1.5},
    "fitted": {"color": COLOURS[0], "linestyle": "--", "linewidth": 1.3},
}
"""Wide and grey, dotted and dashed: visible where measurement and fit agree."""

SHOWN = 0.72
"""Maximum length of the shown part of a time history [s]: the part with the highest level."""

ACROSS = 4
"""Maximum number of channels in a row of a figure."""


def plot_responses(path: Path, target: FrfTarget | LevelTarget, start: Car, fitted: Car, source: str) -> None:
    """Draw measured FRFs, and those before and after the fit, four channels in a row."""
    models = {"start": target.model_response(start), "fitted": target.model_response(fitted)}
    data, frequency = target.data, target.data.frequency
    shown = data.labels[:ACROSS]
    estimator = "local rational model" if target.window is None else f"H1, Hann windows of {target.window:g} s"
    model = (
        "Linear car with stuck dampers"
        if target.signal is None
        else f"Reduced engine on the same signal, same estimator ({estimator})"
    )
    caption = (
        f"Measured: {source}. {model}: with the start values and with the fitted values. {frequency.size} "
        f"frequencies from {frequency[0]:.1f} to {frequency[-1]:.1f} Hz; {FADED}"
    )
    if len(data.names) > ACROSS:
        caption += f". First {ACROSS} of {len(data.names)} FRFs; the table has all of them"
    size = (max(7.2, 4.6 * len(shown)), 7.4)
    title = f"FRFs before and after the fit: {target.name}"
    with saved_figure(path, size, title, textwrap.fill(caption, int(13.5 * size[0]))) as figure:
        axes = figure.subplots(3, len(shown), sharex=True, sharey="row", height_ratios=(2.4, 1, 0.9), squeeze=False)
        for row, (name, (magnitude, phase, coherence)) in enumerate(zip(shown, axes.T, strict=True)):
            for label, response in {"measured": data.response, **models}.items():
                weight = data.coherence[row] if label == "measured" else np.ones(frequency.size)
                fading(magnitude, frequency, np.abs(response[row]), weight, label, **LOOKS[label])
                phase.plot(frequency, wrapped_phase(response[row].copy()), **LOOKS[label])
            coherence.plot(frequency, data.coherence[row], **LOOKS["measured"])
            magnitude.set_title(textwrap.fill(channel_words(name), 40))
            magnitude.legend(loc="best")
        frf_axes(figure, axes, (0, 0.5, 1))
        if isinstance(target, LevelTarget):
            axes[0, 0].set_ylabel(target.quantity)
        low, high = float(frequency[0]), float(frequency[-1])
        for axis in axes[2]:
            ticks = [tick for tick in FRF_TICKS if low <= tick <= high]
            axis.set_xticks(ticks, [str(tick) for tick in ticks])
            axis.set_xlim(low, high)


def plot_histories(path: Path, target: RecordTarget, start: Car, fitted: Car, source: str) -> None:
    """Draw measured time histories, and those before and after the fit, a row for each channel."""
    measured = target.measured()
    curves = {"measured": measured, "start": target.model_histories(start), "fitted": target.model_histories(fitted)}
    time = target.record.time[target.kept]
    inside = _highest_level(time, measured)
    channels = tuple(target.record.channels)
    units = channel_units(channels)
    size = (11.0, 2.3 * len(channels) + 1.4)
    caption = (
        f"Measured: {source}. Reduced engine on the same signal: with the start values and with the fitted "
        f"values. All curves through the low-pass filter of the fit ({target.lowpass:g} Hz); "
        f"{number(time[inside][-1] - time[inside][0], 2)} s with the highest level of {time[-1] - time[0]:.3g} s"
    )
    title = f"Time histories before and after the fit: {target.name}"
    with saved_figure(path, size, title, textwrap.fill(caption, int(13.5 * size[0]))) as figure:
        axes = figure.subplots(len(channels), 1, sharex=True, squeeze=False)[:, 0]
        for row, (axis, channel) in enumerate(zip(axes, channels, strict=True)):
            for label, values in curves.items():
                axis.plot(time[inside], values[row][inside], **LOOKS[label], label=label)
            axis.set_ylabel(f"{channel_words(channel)}\n[{units[channel].replace('2', '²')}]")
            axis.set_xlim(time[inside][0], time[inside][-1])
        axes[0].legend(loc="upper right", ncols=3)
        axes[-1].set_xlabel("time [s]")
        figure.align_ylabels(axes)


def _highest_level(time: Vector, measured: Vector) -> slice:
    """Return the excerpt of `SHOWN` seconds with the largest normalised mean square of all channels."""
    count = min(max(int(SHOWN / (time[1] - time[0])), 2), time.size)
    power = np.mean(measured**2 / np.mean(measured**2, axis=1, keepdims=True), axis=0)
    total = np.concatenate([[0.0], np.cumsum(power)])
    first = int(np.argmax(total[count:] - total[:-count]))
    return slice(first, first + count)


def plot_correlation(path: Path, result: TuningResult) -> None:
    """Draw the correlation matrix of the fitted values."""
    names = [short_name(free_path) for free_path in result.free]
    size = (11.0, 2.0 + 0.45 * len(names))
    caption = "Near 1 or -1 the data determine a combination of two values much better than each value alone."
    with saved_figure(path, size, "Correlation of the fitted values", caption) as figure:
        axis = figure.subplots()
        picture = axis.imshow(result.correlation, cmap="RdBu_r", vmin=-1.0, vmax=1.0, aspect="auto")
        axis.grid(False)
        axis.set_xticks(range(len(names)), names, rotation=15, ha="right")
        axis.set_yticks(range(len(names)), names)
        for row, line in enumerate(result.correlation):
            for column, value in enumerate(line):
                colour = "white" if abs(value) > 0.6 else "black"
                axis.text(column, row, f"{value:.2f}", ha="center", va="center", fontsize=8, color=colour)
        figure.colorbar(picture, ax=axis, label="correlation [-]", shrink=0.8)


def short_name(path: str) -> str:
    """Return the path of a parameter without the table of its element, for an axis."""
    return path.replace("bushings.", "").replace("stiffness", "K")


def plot_corner(path: Path, posterior: Posterior) -> None:
    """Draw the distribution of each parameter, and of each pair with its 50 and 90 % regions."""
    parameters, samples = posterior.car.parameters, posterior.values()
    size = len(parameters)
    interval = posterior.interval()
    caption = (
        "Diagonal: median and 90 % interval of each parameter. Below: 50 and 90 % regions of each pair. Axes: "
        "the bounds of the parameters."
    )
    width = max(1.75 * size, 5.0)
    with saved_figure(path, (width, width + 0.8), "Posterior", textwrap.fill(caption, int(13.0 * width))) as figure:
        axes: Any = figure.subplots(size, size, squeeze=False)
        scales = ["linear" if parameter.is_linear else "log" for parameter in parameters]
        edges = [
            (np.linspace if parameter.is_linear else np.geomspace)(parameter.low, parameter.high, 41)
            for parameter in parameters
        ]
        for row, column in np.ndindex(size, size):
            axis = axes[row, column]
            if column > row:
                axis.set_visible(False)
                continue
            bounds = parameters[column]
            if row == column:
                axis.hist(samples[:, row], bins=edges[row], color="#c9d8ea")
                axis.axvline(interval[1, row], color=COLOURS[0])
                for end in (interval[0, row], interval[2, row]):
                    axis.axvline(end, color=COLOURS[0], linestyle="--", linewidth=0.9)
                axis.set_yticks([])
            else:
                density, _, _ = np.histogram2d(samples[:, column], samples[:, row], bins=(edges[column], edges[row]))
                ordered = np.sort(density.ravel())[::-1]
                total = np.cumsum(ordered) / ordered.sum()
                levels = sorted({float(ordered[int(np.searchsorted(total, share))]) for share in (0.9, 0.5)})
                centres = [0.5 * (each[1:] + each[:-1]) for each in (edges[column], edges[row])]
                axis.contourf(*centres, density.T, levels=[*levels, float(ordered[0]) + 1.0],
                              colors=["#c9d8ea", COLOURS[0]][-len(levels):])  # fmt: skip
                axis.set(yscale=scales[row], ylim=(parameters[row].low, parameters[row].high))
            axis.set(xscale=scales[column], xlim=(bounds.low, bounds.high))
            _few_ticks(axis.xaxis, bounds if row == size - 1 else None)
            if column != row:
                _few_ticks(axis.yaxis, parameters[row] if column == 0 else None)
            if row == size - 1:
                axis.set_xlabel(short_name(bounds.path).replace(".", "\n"), fontsize=8)
            if column == 0 and row:
                axis.set_ylabel(short_name(parameters[row].path).replace(".", "\n"), fontsize=8)


def _few_ticks(axis: Any, bounds: Range | None) -> None:
    """Set ticks at a fifth and four fifths of an axis, without labels for None."""
    axis.set_ticks([], minor=True)
    if bounds is None:
        axis.set_ticks([])
        return
    ticks = [bounds.low + (bounds.high - bounds.low) * share for share in (0.2, 0.8)]
    if not bounds.is_linear:
        ticks = [float(f"{bounds.low * (bounds.high / bounds.low) ** share:.2g}") for share in (0.2, 0.8)]
    axis.set_ticks(ticks, [f"{tick:.5g}" for tick in ticks], fontsize=7)
