"""The tornado chart: comfort sensitivities on both roads, sorted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from scenarios.charts import figure_file
from scenarios.comfort_sensitivity_runs import ComfortRuns
from scenarios.road_signals import ROAD_RMS
from scenarios.tornado_bars import Bar
from vehicle.analysis.comfort import COMFORT_BAND
from vehicle.rendering.figure import COLOURS

LOW_COLOUR, HIGH_COLOUR = COLOURS[0], COLOURS[3]


def draw_tornado(path: Path, comfort: ComfortRuns, bars: Sequence[Bar]) -> None:
    """Write the chart: a row for each parameter, a column for each road, the largest swing on top.

    Args:
        path: PNG file.
        comfort: what made the bars.
        bars: sorted.
    """
    levels = " and ".join(f"{1e3 * rms:g} mm RMS ({road})" for road, rms in ROAD_RMS.items())
    caption = (
        f"Change of the comfort value (RMS of the seat rail, x, y and z, unfiltered, {COMFORT_BAND[0]:g} to "
        f"{COMFORT_BAND[1]:g} Hz) against the nominal car on the same records. Roads of {levels} under the right front "
        f"wheel, {comfort.records.text()}, engine {comfort.engine}. Whiskers: two standard errors of the ratio over "
        "the records. Numbers: values of the parameter, -20 and +20 % of the nominal one but for mount damping (from "
        "its nominal 0) and body stiffness (frequencies with its square root). Order: largest swing on either road"
    )
    height = np.arange(len(bars))[::-1]
    with figure_file(
        path, (11.0, 1.8 + 0.62 * len(bars)), "Comfort sensitivities of the car (beyond source 1)", caption
    ) as figure:
        axes = figure.subplots(1, len(ROAD_RMS), sharex=True, sharey=True)
        for axis, road in zip(axes, ROAD_RMS, strict=True):
            for label, colour, shift, found, values in (
                ("low end", LOW_COLOUR, 0.19, [bar.at_low[road] for bar in bars], [bar.low for bar in bars]),
                ("high end", HIGH_COLOUR, -0.19, [bar.at_high[road] for bar in bars], [bar.high for bar in bars]),
            ):
                change = np.array([100.0 * (one.relative - 1.0) for one in found])
                error = 200.0 * np.nan_to_num([one.relative_error for one in found])
                axis.barh(
                    height + shift, change, 0.36, xerr=error, color=colour, label=label, ecolor="#222222", capsize=2
                )
                for y, x, spread, value in zip(height + shift, change, error, values, strict=True):
                    away = 3 if x >= 0.0 else -3
                    axis.annotate(
                        f"{value:.4g}",
                        (x + np.sign(away) * spread, y),
                        xytext=(away, 0),
                        textcoords="offset points",
                        ha="left" if x >= 0.0 else "right",
                        va="center",
                        fontsize=7,
                    )
            axis.axvline(0.0, color="#222222", linewidth=0.8)
            axis.set(title=f"{road} road", xlabel="change of the comfort value [%]")
            axis.grid(visible=False, axis="y")
            axis.margins(x=0.16)
        axes[0].set_yticks(height, [bar.label for bar in bars])
        axes[1].legend(loc="lower right")
