"""Picture of axle kinematics: camber, toe, paths and load over the wheel travel."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.drawing.rendering.figure import COLOURS, saved_figure
from vehicle.engines.kinematics.axle_statics import WheelPose
from vehicle.engines.kinematics.wheel_geometry import WheelGeometry

PANELS: dict[str, dict[str, str]] = {
    "camber [deg], top outwards positive": {"camber_deg": ""},
    "toe [deg], toe-in positive": {"toe_deg": ""},
    "lateral [mm], outwards positive": {"lateral_m": "wheel centre", "patch_lateral_m": "contact point"},
    "longitudinal [mm], rearwards positive": {
        "longitudinal_m": "wheel centre",
        "patch_longitudinal_m": "contact point",
    },
    "vertical load [N]": {"load_n": ""},
    "change of spring length [mm]": {"strut_length_m": ""},
    "roll centre above the ground [mm]": {"roll_centre_height_m": ""},
    "anti-dive / anti-squat angle [deg]": {"brake_support_deg": "brake force", "drive_support_deg": "drive force"},
    "steering axis [deg]": {"caster_deg": "caster", "kingpin_inclination_deg": "kingpin inclination"},
}
"""Label of each panel to its quantities and their names."""


def plot_kinematics(
    path: Path, poses: Sequence[WheelPose], geometry: Sequence[WheelGeometry], title: str, caption: str
) -> None:
    """Write the picture of axle kinematics.

    Args:
        poses: poses of the right wheel in the order of travel.
        geometry: geometry of the axle at these positions.
    """

    def values(name: str) -> np.ndarray:
        scale = 1e3 if name.endswith("_m") else 1.0
        entries: Sequence[object] = poses if hasattr(poses[0], name) else geometry
        return scale * np.array([getattr(entry, name) for entry in entries])

    panels = {label: lines for label, lines in PANELS.items() if np.isfinite(values(next(iter(lines)))).any()}
    with saved_figure(path, (11.0, 10.0), title, caption) as figure:
        grid = figure.subplots(3, 3, sharey=True)
        for axis, (label, lines) in zip(grid.ravel(), panels.items(), strict=False):
            for number, (name, line) in enumerate(lines.items()):
                style = ("-", "--")[number]
                axis.plot(values(name), values("wheel_travel_m"), style, color=COLOURS[number], label=line)
            axis.set(xlabel=label)
            axis.axhline(0.0, color="#888888", linewidth=0.6)
            if len(lines) > 1:
                axis.legend()
        for axis in grid[:, 0]:
            axis.set(ylabel="wheel travel [mm], upwards positive")
        for axis in grid.ravel()[len(panels) :]:
            axis.set_visible(False)
