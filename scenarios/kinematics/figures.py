"""Figures of axles: curves over wheel travel, compliance as bars, toe and camber with a point moved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.charts import figure_file
from scenarios.kinematics.axles import Axle, Moved
from scenarios.kinematics.claims import COMPLIANCES
from vehicle.drawing.rendering.figure import COLOURS, LINES
from vehicle.engines.kinematics.axle_statics import WheelPose

PANELS = {
    "camber [deg], top outwards +": "camber_deg",
    "toe [deg], front inwards +": "toe_deg",
    "contact point, lateral [mm], outwards +": "patch_lateral_m",
    "wheel centre, longitudinal [mm], to the rear +": "longitudinal_m",
    "vertical load [kN]": "load_n",
    "spring length [mm]": "strut_length_m",
}
"""Label of a panel to its quantity."""

TRAVEL = "wheel travel [mm], upwards +"


def values(poses: Sequence[WheelPose], name: str) -> npt.NDArray[np.float64]:
    """Return a quantity of poses, lengths in mm, forces in kN."""
    scale = {"m": 1e3, "n": 1e-3}.get(name.rpartition("_")[2], 1.0)
    return scale * np.array([getattr(pose, name) for pose in poses])


def travel_figure(path: Path, axles: Sequence[Axle]) -> None:
    """Write the curves of all axles over equal and over opposite travel."""
    note = (
        "Right wheel, changes from its design position, body held, bushings as they are; solid: both wheels lifted "
        "alike, dashed: the left wheel goes down where the right one goes up"
    )
    with figure_file(path, (13.0, 8.6), "Axles over wheel travel", note) as figure:
        grid = figure.subplots(2, 3, sharey=True)
        for panel, (label, name) in zip(grid.ravel(), PANELS.items(), strict=True):
            for axle, colour in zip(axles, _colours(len(axles)), strict=True):
                for poses, style, text in ((axle.equal, "-", axle.label), (axle.opposite, "--", None)):
                    height = values(poses, "wheel_travel_m")
                    panel.plot(values(poses, name), height, style, color=colour, label=text)
            panel.axhline(0.0, color="#888888", linewidth=0.6)
            panel.set(xlabel=label)
        grid[0, 0].legend(loc="best")
        for panel in grid[:, 0]:
            panel.set(ylabel=TRAVEL)


def compliance_figure(path: Path, axles: Sequence[Axle]) -> None:
    """Draw the compliances of all axles as bars."""
    note = (
        "1 kN to the right (lateral) or to the rear (braking) on both wheels at the ground, design height; right wheel"
    )
    with figure_file(path, (11.0, 5.6), "Compliance of axles", note) as figure:
        for panel, (label, (way, name, scale)) in zip(figure.subplots(2, 2).ravel(), COMPLIANCES.items(), strict=True):
            values = [scale * getattr(getattr(axle, way), name) for axle in axles]
            panel.barh([axle.label for axle in axles], values, color=_colours(len(axles)))
            panel.axvline(0.0, color="#888888", linewidth=0.6)
            panel.invert_yaxis()
            panel.set(xlabel=label)


def moved_figure(path: Path, moved: Sequence[Moved], point: str) -> None:
    """Write toe and camber of axles with a point lower, as it is and higher."""
    note = f"{point} of each car changed as in the legend; equal travel, wheel on the right, bushings as they are"
    with figure_file(path, (11.0, 4.2 * len(moved)), f"One point moved: {point}", note) as figure:
        for row, moved_point in zip(figure.subplots(len(moved), 2, sharey=True, squeeze=False), moved, strict=True):
            for panel, label in zip(row, list(PANELS)[:2], strict=True):
                for poses, shift, colour, style in zip(
                    moved_point.curves, moved_point.shifts, COLOURS, LINES, strict=False
                ):
                    height = values(poses, "wheel_travel_m")
                    shift_label = f"{1e3 * shift:+g} mm" if shift else "as it is"
                    panel.plot(values(poses, PANELS[label]), height, color=colour, linestyle=style, label=shift_label)
                panel.axhline(0.0, color="#888888", linewidth=0.6)
                panel.set(xlabel=label, title=moved_point.label)
            row[0].set(ylabel=TRAVEL)
            row[1].legend(loc="best")


def _colours(count: int) -> list[str]:
    """Return a colour for each axle."""
    return [COLOURS[index % len(COLOURS)] for index in range(count)]
