"""The two pictures of a run: FRFs of the main vertical channels, and the main time histories."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from vehicle.drawing.rendering.figure import (
    COLOURS,
    FADED,
    INK,
    LINES,
    UNDRIVEN,
    fading,
    frf_axes,
    saved_figure,
    shade,
    wrapped_phase,
)
from vehicle.drawing.rendering.placed_axes import Margins, placed_axes
from vehicle.drawing.rendering.recorded_run import RecordedRun, dampers_of, level_words, liveliest, wheels_of
from vehicle.names import side_of
from vehicle.signals.analysis.frf import FrequencyResponse

REGION = 1.96
"""Half width of the band around a magnitude, in standard errors: 95 % of all records lie within it."""

NO_LEVELS = (1.0, 1e5)
"""Range of the magnitude [m/s2 per m] of a picture without any."""

DETAIL = 2.0
"""Length of the magnified stretch [s]."""

MOST_POINTS = 250_000
"""Points of a line: a record of four minutes is drawn as it is, of a longer one the outline."""

CELLS = 2000
"""Of a characteristic, across its width and its height: finer than a dot of a page."""

DOTS_AT_ONCE = 2**18
"""Dots of a long record that are looked at together."""

LEGEND_COLUMNS = 2
LEGEND_ROOM = 0.22
"""Share of the height of a panel kept free for each row of its legend."""

FRF_MARGINS = Margins(left=0.74, right=0.14, bottom=0.68, top=0.52, across=0.26, down=0.2)
HISTORY_MARGINS = Margins(left=0.92, right=3.65, bottom=0.68, top=0.5, across=0.28, down=0.18)
DAMPER_MARGINS = Margins(left=12.25, right=0.2, bottom=0.68, top=0.5, down=0.72)

SLIPPING, SLIP_LIMIT, MAGNIFIED = "#f2b8b5", INK, "#fff3c4"


def plot_frf(path: Path, run: RecordedRun, response: FrequencyResponse, caption: str, title: str = "") -> None:
    """Write the FRF picture: magnitudes with the 95 % band of their random error, grey outside the band of the input.

    Args:
        path: PNG file.
        run: the run, with its excited wheel.
        response: FRFs to the plate displacement [m/s2 per m], one row for each acceleration channel.
        caption: line under the picture: input, level, estimator.
        title: what the FRFs are to, where that is not one plate.
    """
    rows = {name: row for row, name in enumerate(run.car.model.vehicle.acceleration_channels)}
    wheel, wheels = run.wheel, run.car.model.vehicle.wheels
    side = side_of(wheel, wheels)
    mount = {f"suspension_mount_{wheel}_acc_z": "body at suspension mount"}
    corner = {f"knuckle_{wheel}_acc_z": "knuckle at damper bottom", f"damper_top_{wheel}_acc_z": "damper top"}
    body = {"seat_rail_acc_z": "seat rail", "body_front_acc_z": "body front", "roof_left_rear_acc_z": "roof, left rear"}
    groups = {
        f"Suspension ({side}) and engine, vertical": corner | mount | {"engine_acc_z": "engine"},
        "Body, vertical": body | mount,
    }
    groups = {
        title: {name: label for name, label in labels.items() if name in rows} for title, labels in groups.items()
    }
    frequency = response.frequency
    inside = np.asarray(np.isfinite(response.response).any(axis=0))
    shown = np.abs(response.response[[rows[name] for labels in groups.values() for name in labels]])
    with saved_figure(
        path,
        (13.0, 8.6),
        title or f"FRFs to the plate under the {run.car.model.vehicle.wheel_text(wheel)}",
        f"{caption}; {FADED}",
        placed=True,
    ) as figure:
        axes = placed_axes(figure, FRF_MARGINS, widths=(1.0, 1.0), heights=(2.2, 1.0, 0.9), sharex=True, sharey="row")
        for column, (title, labels) in enumerate(groups.items()):
            magnitude, phase, coherence = axes[:, column]
            for number, (name, label) in enumerate(labels.items()):
                # The mount is in both columns, with the same style.
                colour = 4 if name in mount else number
                style = {"color": COLOURS[colour], "linestyle": LINES[colour]}
                row = rows[name]
                values, error = np.abs(response.response[row]), REGION * response.random_error[row]
                low = np.maximum(values - error, 0.01 * values)
                magnitude.fill_between(frequency, low, values + error, alpha=0.25, linewidth=0.0, color=COLOURS[colour])
                fading(magnitude, frequency, values, response.coherence[row], label, **style)
                phase.plot(frequency, wrapped_phase(response.response[row]), **style)
                coherence.plot(frequency, response.coherence[row], **style)
            magnitude.set_title(title)
            for axis in axes[:, column]:
                shade(axis, frequency, ~inside, UNDRIVEN, None if inside.all() else "no FRF: no input")
            if labels:
                magnitude.legend(loc="upper left")
        frf_axes(figure, axes, (0, 0.25, 0.5, 0.75, 1))
        levels = shown[:, inside]
        levels = levels[np.isfinite(levels) & (levels > 0.0)]
        axes[0, 0].set_ylim(*(0.5 * levels.min(), 2.0 * levels.max()) if levels.size else NO_LEVELS)


def plot_time(path: Path, run: RecordedRun) -> None:
    """Write the main time histories: the whole record, its liveliest moment, and the characteristic of each damper.

    Args:
        path: PNG file.
        run: the run.
    """
    recording, wheel, wheels = run.recording, run.wheel, wheels_of(run.recording)
    dampers = dampers_of(recording)
    time, velocity = recording.time, recording[f"damper_{wheel if wheel in dampers else dampers[0]}_velocity"]
    slip, side = run.car.model.vehicle.damper.slip_velocity, side_of(wheel, wheels)
    corner = {f"knuckle_{wheel}_acc_z": f"knuckle {side}", f"damper_top_{wheel}_acc_z": f"damper top {side}"}
    # label, scale from the unit of the channels to that of the label, legend text of each channel
    panels: tuple[tuple[str, float, dict[str, str]], ...] = (
        (
            "plate\ndisplacement [mm]",
            1e3,
            _each("plate_{}_displacement", "plate", recording.excited or (wheel,), wheels),
        ),
        ("acceleration z\n[m/s²]", 1.0, {"seat_rail_acc_z": "seat rail"}),
        ("acceleration z\n[m/s²]", 1.0, corner),
        ("damper velocity\n[mm/s]", 1e3, _each("damper_{}_velocity", "damper", dampers, wheels)),
        ("tyre force z\n[kN]", 1e-3, _each("tyre_{}_force_z", "tyre", wheels, wheels)),
    )
    panels = tuple(
        (unit, scale, {name: label for name, label in lines.items() if name in recording.channels})
        for unit, scale, lines in panels
    )
    start = liveliest(time, velocity, DETAIL)
    end = min(start + DETAIL, float(time[-1]))
    inside = (time >= start) & (time <= end)
    caption = (
        f"{Path(run.signal.source).name}, {level_words(recording, wheel, run.signal.rms(wheel))} at wheel {wheel}; "
        f"tyres {run.car.model.vehicle.driving.words}; dashed: slip velocity ±{1e3 * slip:g} mm/s, "
        f"red: {side} damper in slip"
    )
    with saved_figure(path, (15.0, 9.2), "Main time histories", caption, placed=True) as figure:
        rows = len(panels) * (1.0,)
        axes = placed_axes(figure, HISTORY_MARGINS, widths=(2.0, 1.6), heights=rows, sharey="row")
        characteristics = placed_axes(figure, DAMPER_MARGINS, heights=len(dampers) * (1.0,))[:, 0]
        for (whole, detail), (unit, scale, lines) in zip(axes, panels, strict=True):
            for number, (name, label) in enumerate(lines.items()):
                style = {"color": COLOURS[number], "linestyle": LINES[number], "zorder": 2.5 - 0.1 * number}
                values = scale * recording[name]
                whole.plot(*outline(time, values), linewidth=0.5, label=label, **style)
                detail.plot(time[inside], values[inside], **style)
            lowest, highest = whole.get_ylim()
            room = LEGEND_ROOM * -(-len(lines) // LEGEND_COLUMNS)
            whole.set(ylim=(lowest, highest + room * (highest - lowest)), ylabel=unit)
            if len(lines) > 1 or "acceleration" in unit:
                whole.legend(loc="upper right", ncols=LEGEND_COLUMNS)
            whole.axvspan(start, end, color=MAGNIFIED, zorder=0)
            whole.set_xlim(time[0], time[-1])
            detail.set_xlim(start, end)
            if "velocity" in unit:
                for axis in (whole, detail):
                    for limit in (-1e3 * slip, 1e3 * slip):
                        axis.axhline(limit, color=SLIP_LIMIT, linewidth=0.8, linestyle="--", zorder=4)
                shade(detail, time[inside], np.abs(velocity[inside]) > slip, SLIPPING)
        for axis in axes[:-1].flat:
            axis.tick_params(labelbottom=False)
        for axis in axes[-1]:
            axis.set_xlabel("time [s]")
        axes[0, 0].set_title("whole record")
        axes[0, 1].set_title(f"liveliest {end - start:.3g} s of the {side} damper")
        for axis, name in zip(characteristics, dampers, strict=True):
            dots = distinct(1e3 * recording[f"damper_{name}_velocity"], recording[f"damper_{name}_force"])
            axis.plot(*dots, ".", markersize=1.5, color=COLOURS[0], zorder=3, rasterized=True)
            for limit in (-1e3 * slip, 1e3 * slip):
                axis.axvline(limit, color=SLIP_LIMIT, linewidth=0.8, linestyle="--")
            axis.set(
                xlabel="damper velocity [mm/s]", ylabel="damper force [N]", title=f"{side_of(name, wheels)} damper"
            )


def outline(time: npt.NDArray[np.float64], values: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.float64], ...]:
    """Reduce a long history to minimum and maximum of short segments, which looks the same at any width of a page.

    Args:
        time: sample times [s], (n,).
        values: samples, (n,).

    Returns:
        Time and values, unchanged up to `MOST_POINTS`; otherwise both extremes at the first time of each segment.
    """
    if time.size <= MOST_POINTS:
        return time, values
    starts = np.arange(0, time.size, -(-2 * time.size // MOST_POINTS))
    ends = np.stack([np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)], axis=1)
    return np.repeat(time[starts], 2), ends.ravel()


def distinct(x: npt.NDArray[np.float64], y: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.float64], ...]:
    """Remove dots of a scatter plot that lie on others, so that rare dots of a long record remain.

    Args:
        x: horizontal values, (n,).
        y: vertical values, (n,).

    Returns:
        One point of each occupied cell of the range, both (m,).
    """
    spans = [(float(values.min()), float(np.ptp(values)) or 1.0) for values in (x, y)]
    cells = selected = np.zeros(0, dtype=np.int64)
    for first in range(0, x.size, DOTS_AT_ONCE):
        column, row = (
            np.rint((values[first : first + DOTS_AT_ONCE] - low) / span * CELLS).astype(np.int64)
            for values, (low, span) in zip((x, y), spans, strict=True)
        )
        cells, index = np.unique(np.concatenate([cells, column * (CELLS + 1) + row]), return_index=True)
        selected = np.concatenate([selected, np.arange(first, first + column.size)])[index]
    return x[selected], y[selected]


def _each(channel: str, label: str, selected: Sequence[str], wheels: Sequence[str]) -> dict[str, str]:
    """Return the channel of each selected wheel with its legend text; `wheels` are all wheels of the car."""
    return {channel.format(wheel): f"{label} {side_of(wheel, wheels)}" for wheel in selected}
