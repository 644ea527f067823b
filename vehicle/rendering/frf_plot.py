"""The FRF picture: magnitude, phase and coherence of the main vertical channels over one frequency axis."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from vehicle.analysis.frf import FrequencyResponse
from vehicle.names import SIDE_OF_WHEEL, acceleration_channels
from vehicle.rendering.figure import COLOURS, saved_figure
from vehicle.rendering.recorded_run import RecordedRun

Vector = npt.NDArray[np.float64]

BAND = (1.0, 50.0)
TICKS = (1, 2, 3, 5, 10, 20, 30, 50)

REGION = 1.96
"""Half width of the band around a magnitude, in standard errors: 95 % of all records lie within it."""

NO_LEVELS = (1.0, 1e5)
"""Range of the magnitude [m/s2 per m] of a picture without any."""

UNDRIVEN_COLOUR = "#ececec"


def columns(wheel: str) -> dict[str, dict[str, str]]:
    """Title of each column, and the label of each channel that it shows."""
    side = SIDE_OF_WHEEL[wheel]
    return {
        f"Suspension ({side}) and engine, vertical": {
            f"knuckle_{wheel}_acc_z": "knuckle at damper bottom",
            f"damper_top_{wheel}_acc_z": "damper top",
            f"suspension_mount_{wheel}_acc_z": "body at suspension mount",
            "engine_acc_z": "engine",
        },
        "Body, vertical": {
            "seat_rail_acc_z": "seat rail",
            "body_front_acc_z": "body front",
            "roof_left_rear_acc_z": "roof, left rear",
            f"suspension_mount_{wheel}_acc_z": "body at suspension mount",
        },
    }


def wrapped_phase(response: npt.NDArray[np.complex128]) -> Vector:
    """Phase [deg] between -180 and 180, with NaN after each jump so that no line crosses the picture.

    Args:
        response: complex values over frequency, (m,).

    Returns:
        Phase of a line to draw, (m,); NaN at the first point behind a jump.
    """
    phase = np.degrees(np.angle(response))
    jumps = np.flatnonzero(np.abs(np.diff(phase)) > 180.0) + 1
    phase[jumps] = np.nan
    return np.asarray(phase)


def plot_frf(
    path: Path,
    run: RecordedRun,
    response: FrequencyResponse,
    caption: str,
    channels: Sequence[str] | None = None,
) -> None:
    """Write the FRF picture: magnitudes with the 95 % band of their random error, grey where the input tells nothing.

    Args:
        path: PNG file.
        run: the run; tells the excited wheel.
        response: FRFs to the plate displacement [m/s2 per m].
        caption: line under the picture: input, level, estimator.
        channels: names of the rows of `response`; all acceleration channels by default.
    """
    rows = {name: row for row, name in enumerate(acceleration_channels() if channels is None else channels)}
    groups = columns(run.wheel)
    inside = np.isfinite(response.response).any(axis=0)
    shown = np.abs(response.response[[rows[name] for labels in groups.values() for name in labels if name in rows]])
    with saved_figure(path, (13.0, 8.6)) as figure:
        axes = figure.subplots(3, 2, sharex=True, sharey="row", height_ratios=(2.2, 1.0, 0.9))
        for column, (title, labels) in enumerate(groups.items()):
            magnitude, phase, coherence = axes[:, column]
            for number, (name, label) in enumerate(labels.items()):
                if name not in rows:
                    continue
                # The mount stands in both columns and looks the same in both.
                style = {"color": COLOURS[4] if name.startswith("suspension_mount") else COLOURS[number]}
                values, error = np.abs(response.response[rows[name]]), REGION * response.random_error[rows[name]]
                low = np.maximum(values - error, 0.01 * values)
                magnitude.fill_between(response.frequency, low, values + error, alpha=0.25, linewidth=0.0, **style)
                magnitude.plot(response.frequency, values, label=label, **style)
                phase.plot(response.frequency, wrapped_phase(response.response[rows[name]]), **style)
                coherence.plot(response.frequency, response.coherence[rows[name]], **style)
            magnitude.set_title(title)
            coherence.set_xlabel("frequency [Hz]")
            for axis in axes[:, column]:
                axis.fill_between(
                    response.frequency,
                    0.0,
                    1.0,
                    where=~inside,
                    transform=axis.get_xaxis_transform(),
                    color=UNDRIVEN_COLOUR,
                    zorder=0,
                    label="no FRF: no input",
                )
            magnitude.legend(loc="upper left")
        upper, middle, lower = axes[:, 0]
        upper.set(xscale="log", yscale="log", xlim=BAND, ylabel="acceleration / plate displacement [(m/s²)/m]")
        middle.set(ylim=(-180.0, 180.0), yticks=(-180, -90, 0, 90, 180), ylabel="phase [deg]")
        lower.set(ylim=(0.0, 1.05), yticks=(0, 0.25, 0.5, 0.75, 1), ylabel="coherence [-]")
        levels = shown[:, inside]
        levels = levels[np.isfinite(levels) & (levels > 0.0)]
        upper.set_ylim(*(0.5 * levels.min(), 2.0 * levels.max()) if levels.size else NO_LEVELS)
        for axis in axes[2]:
            axis.set_xticks(TICKS, [str(tick) for tick in TICKS])
            axis.set_xticks([], minor=True)
        figure.suptitle(f"FRFs to the plate under the {SIDE_OF_WHEEL[run.wheel]} front wheel", fontsize=12)
        figure.align_ylabels(axes[:, 0])
        figure.supxlabel(caption, fontsize=8.5, color="#444444")
