"""Picture of a road: its heights, and height and slope as a tyre takes them, over the distance."""

import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from vehicle.drawing.rendering.figure import COLOURS, saved_figure
from vehicle.signals.analysis.samples import Vector


class RoadTrack(NamedTuple):
    """Road below a wheel.

    Attributes:
        road: height of the road itself [m]; (n,).
        height, slope: height [m] and slope [-] as the tyre takes them; (n,).
    """

    road: Vector
    height: Vector
    slope: Vector


def plot_road(path: Path, distance: Vector, tracks: Mapping[str, RoadTrack], title: str, caption: str) -> None:
    """Plot a road, a column for each track.

    Args:
        distance: distance of the wheels [m]; (n,).
        tracks: title of the column to the road.
    """
    width = 3.0 + 4.5 * len(tracks)
    with saved_figure(path, (width, 6.0), title, textwrap.fill(caption, round(12.0 * width))) as figure:
        axes = figure.subplots(2, len(tracks), sharex=True, sharey="row", height_ratios=(2.0, 1.0), squeeze=False)
        for column, (heading, track) in zip(axes.T, tracks.items(), strict=True):
            for label, height, colour in zip(("road", "after averaging by the tyre"), track[:2], COLOURS, strict=False):
                column[0].plot(distance, 1e3 * height, color=colour, label=label)
            column[1].plot(distance, 1e2 * track.slope, color=COLOURS[1])
            column[0].set_title(heading)
            column[1].set_xlabel("distance of the foremost wheels [m]")
        axes[0, 0].set_ylabel("height [mm]")
        axes[1, 0].set_ylabel("slope [%]")
        axes[0, 0].legend()
        figure.align_ylabels(axes[:, 0])
