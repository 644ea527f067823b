"""Figures of a car on the four-post rig."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.charts import figure_file
from scenarios.four_post.runs import LINES, STATES, OneRun, channels_of, transmissibility
from scenarios.signals.four_post import MOTIONS
from vehicle.drawing.rendering.figure import COLOURS, FRF_TICKS
from vehicle.drawing.rendering.figure import LINES as STYLES
from vehicle.runs.car import Car

LINEAR = {"stuck": ("#222222", ":"), "sliding": ("#888888", "--")}
"""Colour and style of the curves from matrices."""

Exact = Mapping[tuple[str, str], npt.NDArray[np.complex128]]


def level_words(level: float) -> str:
    """Return a text for a level: displacements over those of a road of class A."""
    return "class A" if level == 1.0 else f"1/{1.0 / level:g} of class A"


def response_figure(path: Path, car: Car, runs: Sequence[OneRun], exact: Exact, caption: str) -> None:
    """Draw the transmissibility of body and wheel carriers to each motion of the plates, from runs and matrices."""
    title = f"{car.vehicle.name} on four posts: displacement over that of the plates"
    with figure_file(path, (15.0, 9.0), title, caption) as figure:
        rows = max(len(channels_of(car, motion)) for motion in MOTIONS)
        axes = figure.subplots(rows, len(MOTIONS), sharex=True, sharey="row", squeeze=False)
        for column, motion in zip(axes.T, MOTIONS, strict=True):
            for row, (axis, channel) in enumerate(zip(column, channels_of(car, motion), strict=False)):
                for state in STATES:
                    colour, style = LINEAR[state]
                    size = transmissibility(LINES, exact[motion, state][row])
                    axis.plot(LINES, size, color=colour, linestyle=style, label=f"matrices, dampers {state}")
                motion_runs = [run for run in runs if run.motion == motion]
                for level_run, colour, line in zip(motion_runs, COLOURS, STYLES, strict=False):
                    response = level_run.response
                    assert response is not None
                    size = transmissibility(response.frequency, response.response[row])
                    look = {"color": colour, "linestyle": line, "linewidth": 1.0}
                    axis.plot(response.frequency, size, label=level_words(level_run.level), **look)
                axis.set(xscale="log", yscale="log", xlim=(1.0, 40.0))
                axis.set_title(f"{motion}: {channel.replace('_acc_', ', ').replace('_', ' ')}")
        axes[0, 0].legend(loc="lower left")
        for axis in axes[-1]:
            axis.set_xlabel("frequency [Hz]")
            axis.set_xticks([tick for tick in FRF_TICKS if tick < 50], [str(t) for t in FRF_TICKS if t < 50])
            axis.set_xticks([], minor=True)
        for axis in axes[:, 0]:
            axis.set_ylabel("transmissibility [-]")


def slip_figure(path: Path, car: Car, runs: Sequence[OneRun], caption: str) -> None:
    """Draw slip shares of the dampers and comfort value over the level, a line for each motion."""
    with figure_file(path, (12.5, 4.6), f"{car.vehicle.name} on four posts: does it slide?", caption) as figure:
        front, rear, comfort = figure.subplots(1, 3)
        for motion, colour, mark in zip(MOTIONS, COLOURS, "os^D", strict=False):
            motion_runs = [run for run in runs if run.motion == motion]
            levels = [run.level for run in motion_runs]
            for axis, wheel in ((front, "fr"), (rear, "rr")):
                shares = [100.0 * run.slip.get(wheel, np.nan) for run in motion_runs]
                axis.plot(levels, shares, f"{mark}-", color=colour, label=motion, markersize=4)
            comfort.plot(
                levels, [run.comfort / run.level for run in motion_runs], f"{mark}-", color=colour, markersize=4
            )
        for axis, title in ((front, "front right damper"), (rear, "rear right damper")):
            axis.set(xscale="log", ylim=(-3.0, 100.0), title=title, ylabel="share of the time in slip [%]")
        comfort.set(
            xscale="log",
            yscale="log",
            title="seat rail: lower is better",
            ylabel="RMS 2 to 50 Hz over the level [m/s²]",
        )
        for axis in (front, rear, comfort):
            axis.set_xlabel("displacement over that of class A at 80 km/h [-]")
        front.legend(loc="upper left")
