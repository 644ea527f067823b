"""Picture of load spectra: number of cycles over the range, for the largest loads of each type."""

import re
from collections.abc import Sequence
from pathlib import Path

from vehicle.drawing.rendering.figure import COLOURS, LINES, saved_figure
from vehicle.signals.analysis.load_spectrum import LoadSpectrum

PANELS = {
    "wheels, springs and dampers: range [N]": (r"(tyre_|damper_\w+_force$|\w*spring\w*_force$)", "N", 1.0),
    "connections: range [N]": (r".*", "N", 1.0),
    "suspension travel: range [mm]": (r".*", "m", 1e3),
    "joint springs: range [N m]": (r".*", "N m", 1.0),
}
"""Label of each panel to the names, the unit and the scale of its loads; a load is in the first matching panel."""

FEWEST = 0.25
"""Cycles at which the pictures begin: half of the half cycle that a record may hold."""


def plot_loads(path: Path, loads: Sequence[LoadSpectrum], caption: str) -> None:
    """Write the picture of load spectra.

    Args:
        loads: loads with their cycles; each panel shows as many of the largest as there are colours.
    """
    left = [load for load in loads if load.counted.ranges.size]
    panels: dict[str, list[LoadSpectrum]] = {}
    for label, (form, unit, _) in PANELS.items():
        panel_loads = [load for load in left if load.unit == unit and re.match(form, load.name)]
        left = [load for load in left if load not in panel_loads]
        if panel_loads:
            panels[label] = sorted(panel_loads, key=lambda load: -load.equivalent_amplitude)[: len(COLOURS)]
    with saved_figure(path, (12.0, 8.0), "Load spectra: cycles with at least a range", caption) as figure:
        for number, (label, panel_loads) in enumerate(panels.items()):
            axis = figure.add_subplot(2 if len(panels) > 2 else 1, 2 if len(panels) > 1 else 1, number + 1)
            scale = PANELS[label][2]
            for colour, line, load in zip(COLOURS, LINES, panel_loads, strict=False):
                # Extend the largest range to smaller numbers of cycles.
                cycles, ranges = load.counted.exceeded(), scale * load.counted.ranges
                axis.step(
                    [*cycles, FEWEST],
                    [*ranges, ranges[-1]],
                    where="post",
                    color=colour,
                    linestyle=line,
                    label=load.name,
                )
            axis.set(xscale="log", xlabel="cycles", ylabel=label)
            axis.set_xlim(left=FEWEST)
            axis.xaxis.set_major_formatter("{x:,g}")
            axis.set_ylim(bottom=0.0)
            axis.legend()
