"""The picture of the main time histories: the whole record, its liveliest moment, and the damper characteristic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from vehicle.names import SIDE_OF_WHEEL, WHEELS
from vehicle.rendering.excerpt import liveliest
from vehicle.rendering.figure import COLOURS, saved_figure
from vehicle.rendering.recorded_run import RecordedRun
from vehicle.simulation.recording import Recording

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Vector = npt.NDArray[np.float64]

DETAIL = 2.0
"""Length of the magnified stretch [s]."""

LEGEND_ROOM = 0.22
"""Share of the height of a panel kept free for its legend."""

SLIP_COLOUR = "#f2b8b5"


@dataclass(frozen=True, kw_only=True, slots=True)
class Panel:
    """One row of the picture."""

    label: str
    """quantity and unit"""
    scale: float
    """from the unit of the channel to that of the label"""
    lines: Mapping[str, str]
    """channel to legend text"""


def panels(wheel: str, excited: tuple[str, ...]) -> list[Panel]:
    """Rows of the picture for a run with these excited wheels."""
    plates = {f"plate_{name}_displacement": f"plate {SIDE_OF_WHEEL[name]}" for name in excited or (wheel,)}
    side = SIDE_OF_WHEEL[wheel]
    corner = {f"knuckle_{wheel}_acc_z": f"knuckle {side}", f"damper_top_{wheel}_acc_z": f"damper top {side}"}
    velocities = {f"damper_{name}_velocity": f"damper {SIDE_OF_WHEEL[name]}" for name in WHEELS}
    tyres = {f"tyre_{name}_force_z": f"tyre {SIDE_OF_WHEEL[name]}" for name in WHEELS}
    return [
        Panel(label="plate\ndisplacement [mm]", scale=1e3, lines=plates),
        Panel(label="acceleration z\n[m/s²]", scale=1.0, lines={"seat_rail_acc_z": "seat rail"}),
        Panel(label="acceleration z\n[m/s²]", scale=1.0, lines=corner),
        Panel(label="damper velocity\n[mm/s]", scale=1e3, lines=velocities),
        Panel(label="tyre force z\n[kN]", scale=1e-3, lines=tyres),
    ]


def plot_time(path: Path, run: RecordedRun) -> None:
    """Write the picture of the main time histories.

    Args:
        path: PNG file.
        run: the run.
    """
    recording, wheel = run.recording, run.wheel
    time = recording.time
    slip = run.car.model.vehicle.damper.slip_velocity
    rows = panels(wheel, recording.excited)
    start = liveliest(time, recording[f"damper_{wheel}_velocity"], DETAIL)
    end = min(start + DETAIL, float(time[-1]))
    inside = (time >= start) & (time <= end)
    with saved_figure(path, (15.0, 9.2)) as figure:
        grid = figure.add_gridspec(1, 2, width_ratios=(3.3, 1.0))
        histories, characteristics = (figure.add_subfigure(grid[column]) for column in range(2))
        axes = histories.subplots(len(rows), 2, sharey="row", width_ratios=(2.0, 1.6))
        whole, detail = axes[:, 0], axes[:, 1]
        for row, panel in enumerate(rows):
            for number, (name, label) in enumerate(panel.lines.items()):
                style = {"color": COLOURS[number], "zorder": 2.5 - 0.1 * number}
                values = panel.scale * recording[name]
                whole[row].plot(time, values, linewidth=0.5, label=label, **style)
                detail[row].plot(time[inside], values[inside], **style)
            lowest, highest = whole[row].get_ylim()
            whole[row].set_ylim(lowest, highest + LEGEND_ROOM * (highest - lowest))
            whole[row].set_ylabel(panel.label)
            whole[row].legend(loc="upper right", ncols=2)
            whole[row].axvspan(start, end, color="#fff3c4", zorder=0)
            whole[row].set_xlim(time[0], time[-1])
            detail[row].set_xlim(start, end)
            if "velocity" in panel.label:
                for axis in (whole[row], detail[row]):
                    _slip_limits(axis, 1e3 * slip)
                _shade_slip(detail[row], time[inside], recording[f"damper_{wheel}_velocity"][inside], slip)
        for column in (whole, detail):
            for axis in column[:-1]:
                axis.tick_params(labelbottom=False)
            column[-1].set_xlabel("time [s]")
        whole[0].set_title("whole record")
        detail[0].set_title(f"liveliest {end - start:.3g} s of the {SIDE_OF_WHEEL[wheel]} damper")
        histories.align_ylabels(whole)
        for axis, name in zip(characteristics.subplots(2, 1), WHEELS, strict=True):
            _characteristic(axis, recording, name, slip)
        figure.suptitle("Main time histories", fontsize=12)
        figure.supxlabel(
            f"{Path(run.signal.source).name}, RMS {1e3 * run.signal.rms(wheel):.3g} mm at wheel {wheel}; "
            f"dashed: slip velocity ±{1e3 * slip:g} mm/s, red: {SIDE_OF_WHEEL[wheel]} damper in slip",
            fontsize=8.5,
            color="#444444",
        )


def _slip_limits(axis: Axes, limit: float) -> None:
    for sign in (-1.0, 1.0):
        axis.axhline(sign * limit, color="#8c2f39", linewidth=0.8, linestyle="--", zorder=4)


def _shade_slip(axis: Axes, time: Vector, velocity: Vector, limit: float) -> None:
    """Mark the times at which the damper slips."""
    axis.fill_between(
        time,
        0.0,
        1.0,
        where=np.abs(velocity) > limit,
        transform=axis.get_xaxis_transform(),
        color=SLIP_COLOUR,
        zorder=0,
    )


def _characteristic(axis: Axes, recording: Recording, wheel: str, slip: float) -> None:
    """Damper force over its velocity, every sample a point."""
    velocity, force = 1e3 * recording[f"damper_{wheel}_velocity"], recording[f"damper_{wheel}_force"]
    axis.plot(velocity, force, ".", markersize=1.5, color=COLOURS[0], zorder=3)
    for sign in (-1.0, 1.0):
        axis.axvline(sign * 1e3 * slip, color="#8c2f39", linewidth=0.8, linestyle="--")
    axis.set(xlabel="damper velocity [mm/s]", ylabel="damper force [N]", title=f"{SIDE_OF_WHEEL[wheel]} damper")
