"""Pictures of a replicated drive signal: target and response, the drive signal, and the convergence of the error."""

from collections.abc import Mapping
from itertools import cycle
from pathlib import Path

import numpy as np

from vehicle.arrays import Mask
from vehicle.drawing.rendering.figure import COLOURS, LINES, looks, saved_figure
from vehicle.drawing.rendering.recorded_run import liveliest
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.spectra import power_spectral_density

DETAIL, WINDOW = 2.0, 4.0
"""Length of the magnified time window and of a window of the spectra [s]."""

LEGEND_FACTOR = 200.0
"""Range of the axis with the legend above its curves: two rows, which no curve crosses."""

ERROR, OUTSIDE = "#555555", "#ececec"


def _between(values: Vector, low: float, high: float) -> Mask:
    return np.asarray((values >= low) & (values <= high))


def plot_replication(
    path: Path,
    time: Vector,
    responses: Mapping[str, tuple[Vector, Vector]],
    drive: Mapping[str, Vector],
    band: tuple[float, float],
    caption: str,
) -> None:
    """Plot target and response of each channel and the drive signal below: a time window, and the spectrum.

    Args:
        time: sample times [s], (n,).
        responses: channel to target and response [m/s2], (n,) each.
        drive: wheel to its plate displacement [m], (n,).
        band: edges of the frequency band [Hz].
    """
    step = float(time[1] - time[0])
    start = liveliest(time, np.sum([pair[0] for pair in responses.values()], axis=0), DETAIL)
    shown = (time >= start) & (time <= start + DETAIL)
    with saved_figure(
        path, (12.5, 2.4 * (len(responses) + 1) + 1.2), "Response to the final drive signal", caption
    ) as figure:
        axes = figure.subplots(len(responses) + 1, 2, sharex="col", width_ratios=(1.7, 1.0), squeeze=False)
        for (name, (target, response)), (left, right) in zip(responses.items(), axes[:-1], strict=True):
            looks = (
                ("target", target, {"color": COLOURS[0], "linewidth": 2.2, "alpha": 0.55}),
                ("response", response, {"color": COLOURS[1], "linestyle": "--", "linewidth": 1.0}),
                ("target minus response", target - response, {"color": ERROR, "linestyle": ":", "linewidth": 1.0}),
            )
            for label, values, look in looks:
                left.plot(time[shown], values[shown], label=label, **look)
                right.plot(*_amplitude(step, values), label=label, **look)
            left.set(ylabel="acceleration [m/s²]", title=name)
            right.set(ylabel="[(m/s²)/√Hz]", yscale="log")
        for wheel, line in zip(drive, cycle(LINES), strict=False):
            style = {"color": COLOURS[2], "linestyle": line}
            values = 1e3 * drive[wheel]
            axes[-1, 0].plot(time[shown], values[shown], label=f"plate {wheel}", **style)
            axes[-1, 1].plot(*_amplitude(step, values), **style)
        axes[-1, 0].set(ylabel="displacement [mm]", title="drive", xlabel="time [s]", xlim=(start, start + DETAIL))
        axes[-1, 1].set(ylabel="[mm/√Hz]", yscale="log", xscale="log", xlabel="frequency [Hz]", title="drive")
        axes[0, 1].set_title("amplitude spectral density")
        low, high = 0.5 * band[0], 1.5 * band[1]
        ticks = [tick for tick in (0.5, 1, 2, 5, 10, 20, 50, 100) if low <= tick <= high]
        axes[-1, 1].set(xlim=(low, high))
        axes[-1, 1].set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        for axis in axes[:, 1]:
            drawn = np.concatenate([line.get_ydata()[_between(line.get_xdata(), *band)] for line in axis.lines])
            axis.set_ylim(0.5 * drawn[drawn > 0.0].min(), (LEGEND_FACTOR if axis is axes[0, 1] else 2.0) * drawn.max())
            for ends in ((low, band[0]), (band[1], high)):
                axis.axvspan(*ends, color=OUTSIDE, zorder=0, label="outside the band" if ends[0] == low else None)
        axes[0, 1].legend(loc="upper left", ncols=2)
        if len(drive) > 1:
            axes[-1, 0].legend(loc="upper right", ncols=2)
        figure.align_ylabels(axes[:, 0])


def _amplitude(step: float, values: Vector) -> tuple[Vector, Vector]:
    """Return frequencies and the root of the power spectral density."""
    density = power_spectral_density(step, values, window_s=min(WINDOW, step * (values.size - 1)))
    return density.frequency[1:], np.sqrt(density.density[0, 1:])


def plot_convergence(path: Path, errors: Mapping[str, Vector], kept: Mask, caption: str) -> None:
    """Plot the error of each channel over the runs.

    Args:
        errors: channel to RMS of target minus response over RMS of target, in the band [-], (runs,).
        kept: True for runs better than all previous runs, (runs,).
    """
    runs = np.arange(1, kept.size + 1)
    with saved_figure(path, (8.0, 4.8), "Error against iteration", caption) as figure:
        axis = figure.subplots()
        for (name, values), look in zip(errors.items(), looks(), strict=False):
            axis.plot(runs, 100.0 * values, label=name, **look)
            axis.plot(runs[kept], 100.0 * values[kept], "o", color=look["color"])
            axis.plot(runs[~kept], 100.0 * values[~kept], "o", color=look["color"], markerfacecolor="white")
        if not kept.all():
            axis.plot([], [], "o", color=ERROR, markerfacecolor="white", label="taken back")
        axis.set(
            yscale="log", xlabel="run", ylabel="RMS error divided by RMS of target,\nin the band [%]; lower is better"
        )
        axis.set_xticks(runs[:: max(1, kept.size // 15)])
        axis.legend()
