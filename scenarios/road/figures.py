"""Figures of the study of roads: class and speed, friction."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.charts import figure_file
from scenarios.road.findings import ratio
from scenarios.road.runs import Ride, RideRuns
from vehicle.drawing.rendering.figure import COLOURS

STYLES = ("-", "--", ":")
"""Of the cars, in their order."""


def draw_classes(path: Path, runs: RideRuns, roads: Sequence[str], speeds: Sequence[float]) -> None:
    """Draw comfort at rail and seat and tyre load over speed, a colour for each class, a style for each car."""
    axles = [axle for axle, _ in runs.measure.by_axle]
    panels = [("rail_weighted", "seat rail, ISO 2631-1 [m/s²]", 1.0), ("seat_weighted", "seat, ISO 2631-1 [m/s²]", 1.0)]
    panels += [(f"load_{axle}", f"dynamic over static tyre load, {axle} [%]", 100.0) for axle in axles]
    caption = (
        f"Weighted vibration (x and y by Wd, z by Wk, vector sum) and RMS of the dynamic tyre load over the speed, on "
        f"roads of ISO 8608; {_cars(runs)}; friction of the vehicle file; {runs.text()}; bars: two standard errors "
        "over the records."
    )
    with figure_file(path, (10.5, 7.0), "Class of the road and speed", caption) as figure:
        axes = figure.subplots(2, -(-len(panels) // 2), sharex=True, squeeze=False).ravel()
        for axis, (name, label, scale) in zip(axes, panels, strict=False):
            for colour, road in zip(COLOURS, roads, strict=False):
                for style, car in zip(STYLES, runs.cars, strict=False):
                    averages = [runs(Ride(car=car, road=road, speed=speed)) for speed in speeds]
                    values = [scale * average.mean[name] for average in averages]
                    errors = [scale * average.error[name] for average in averages]
                    _curve(axis, speeds, values, errors, colour, style, f"class {road}, {car}")
            axis.set(ylabel=label, ylim=(0.0, None))
            axis.set_xlabel("speed [km/h]")
            if name.startswith("load"):
                look = {"color": "#777777", "linewidth": 0.8, "linestyle": ":"}
                line = axis.axhline(100.0 / 3.0, **look, label="a Gaussian load touches 0 at three times its RMS")
                axis.legend(handles=[line], loc="upper left", fontsize=7)
        axes[0].set_ylim(0.0, 1.4 * axes[0].get_ylim()[1])
        axes[0].legend(loc="upper left", ncols=2, fontsize=7)
        figure.align_ylabels(axes)


def draw_friction(path: Path, runs: RideRuns, roads: Sequence[str], speed: float, frictions: Sequence[float]) -> None:
    """Draw comfort at rail and seat and tyre load over the friction of all dampers, relative to no friction."""
    load = f"load_{runs.measure.by_axle[0][0]}"
    panels = [
        ("rail", "seat rail, unweighted, 2 to 50 Hz [%]"),
        ("rail_weighted", "seat rail, ISO 2631-1 [%]"),
        ("seat_weighted", "seat, ISO 2631-1 [%]"),
        (load, f"dynamic tyre load, {load.removeprefix('load_')} [%]"),
    ]
    caption = (
        f"Over the Coulomb friction of every damper, relative to the same car without friction on the same records, at "
        f"{speed:g} km/h on roads of ISO 8608; {_cars(runs)}; {runs.text(speed)}; bars: two standard errors of the "
        "ratio over the records."
    )
    with figure_file(path, (10.5, 7.0), "Friction of the dampers", caption) as figure:
        axes = figure.subplots(2, 2, sharex=True).ravel()
        for axis, (name, label) in zip(axes, panels, strict=True):
            for colour, road in zip(COLOURS, roads, strict=False):
                for style, car in zip(STYLES, runs.cars, strict=False):
                    rides = [Ride(car=car, road=road, speed=speed, friction=value) for value in frictions]
                    values, errors = zip(*(ratio(runs, ride, name) for ride in rides), strict=True)
                    scaled = [[100.0 * value for value in shares] for shares in (values, errors)]
                    _curve(axis, frictions, scaled[0], scaled[1], colour, style, f"class {road}, {car}")
            axis.axhline(100.0, color="#777777", linewidth=0.8)
            axis.set_ylabel(label)
            axis.set_xlabel("Coulomb friction of every damper [N]")
        axes[0].legend(loc="upper left", fontsize=7)
        figure.align_ylabels(axes)


def _cars(runs: RideRuns) -> str:
    return ", ".join(f"{car} ({style})" for style, car in zip(("full", "dashed", "dotted"), runs.cars, strict=False))


def _curve(
    axis: Any, x: Sequence[float], y: Sequence[float], errors: Sequence[float], colour: str, style: str, label: str
) -> None:
    if np.isfinite(y).all():
        bars = [2.0 * float(np.nan_to_num(error)) for error in errors]
        axis.errorbar(
            x, y, yerr=bars, color=colour, linestyle=style, marker="o", markersize=3.5, capsize=2.5, label=label
        )
