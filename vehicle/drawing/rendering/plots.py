"""The two pictures of a run: FRFs of the main vertical channels, and the main time histories."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.drawing.rendering.figure import (
    COLOURS,
    FADED,
    FULL_LABEL,
    INK,
    LINES,
    PAGE_WIDTH,
    UNDRIVEN,
    error_band,
    fading,
    frf_axes,
    saved_figure,
    shade,
    wrapped,
    wrapped_phase,
)
from vehicle.drawing.rendering.placed_axes import Margins, placed_axes
from vehicle.drawing.rendering.recorded_run import RecordedRun, dampers_of, level_words, liveliest, wheels_of
from vehicle.names import side_of, slip_words, wheel_words
from vehicle.signals.analysis.frf import FrequencyResponse
from vehicle.signals.analysis.samples import Vector

REGION = 1.96
"""Half width of the band around a magnitude, in standard errors: 95 % of all records lie within it."""

NO_LEVELS = (1.0, 1e5)
"""Range of the magnitude [m/s2 per m] of a picture without any."""

DETAIL = 2.0
"""Length of the magnified stretch [s]."""

SEGMENTS = 1200
"""Segments of the envelope of a whole record: two to the millimetre of a page, finer than the line."""

CELLS = 2000
"""Of a characteristic, across its width and its height: finer than a dot of a page."""

DOTS_AT_ONCE = 2**18
"""Dots of a long record that are looked at together."""

LEGEND_FACTOR = 30.0
"""Range of a low magnitude axis above the curves, for the legend."""

ENVELOPE_OPACITY = 0.6
"""Opacity of the envelopes: equal envelopes of several channels stay visible through each other."""

LEGEND_COLUMNS = 2
LEGEND_ROOM = 0.22
"""Share of the height of a panel kept free for each row of its legend."""

FRF_MARGINS = Margins(left=0.74, right=0.14, bottom=0.68, top=0.52, across=0.26, down=0.2)
HISTORY_MARGINS = Margins(left=0.92, right=3.65, bottom=0.68, top=0.5, across=0.28, down=0.18)
DAMPER_MARGINS = Margins(left=12.25, right=0.2, bottom=0.68, top=0.5, down=0.72)
PAGE_HEIGHT = 6.0
PAGE_HISTORY = Margins(left=0.92, right=0.2, bottom=2.25, top=0.25, across=0.28, down=0.08)
PAGE_DAMPERS = Margins(left=0.92, right=0.2, bottom=0.68, top=4.5, across=0.28)
"""Height and margins on a page [inch]: the characteristics of the dampers are below the histories, not beside them."""

SHORT = {"plate\ndisplacement": "plate z\n", "acceleration z\n": "accel. z\n", "damper velocity\n": "damper\n"}
SHORT |= {"tyre force z\n": "tyre z\n"}
"""Labels of the vertical axes on a page, where the panels are low."""

SLIPPING, SLIP_LIMIT, MAGNIFIED = "#f2b8b5", INK, "#fff3c4"


def plot_frf(
    path: Path,
    run: RecordedRun,
    response: FrequencyResponse,
    caption: str,
    title: str = "",
    size: tuple[float, float] = (13.0, 8.6),
) -> None:
    """Write the FRF picture: magnitudes with the 95 % band of their random error, grey outside the band of the input.

    Args:
        response: FRFs to the plate displacement [m/s2 per m], one row for each acceleration channel.
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
    title = title or f"FRFs from the plate under the {run.car.model.vehicle.wheel_text(wheel)}"
    caption = wrapped(f"{caption}; {FADED}", size[0])
    with saved_figure(path, size, title, caption, placed=True) as figure:
        axes = placed_axes(
            figure, FRF_MARGINS.above(caption), widths=(1.0, 1.0), heights=(2.2, 1.0, 0.9), sharex=True, sharey="row"
        )
        for column, (title, labels) in enumerate(groups.items()):
            magnitude, phase, coherence = axes[:, column]
            for number, (name, label) in enumerate(labels.items()):
                # The mount is in both columns, with the same style.
                colour = 4 if name in mount else number
                style = {"color": COLOURS[colour], "linestyle": LINES[colour]}
                row = rows[name]
                values, error = np.abs(response.response[row]), REGION * response.random_error[row]
                error_band(magnitude, frequency, values, error, response.coherence[row], COLOURS[colour])
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
        above = LEGEND_FACTOR if size[1] < FULL_LABEL else 2.0
        axes[0, 0].set_ylim(*(0.5 * levels.min(), above * levels.max()) if levels.size else NO_LEVELS)


def plot_time(path: Path, run: RecordedRun, *, page: bool = False, others: Sequence[RecordedRun] = ()) -> None:
    """Write the main time histories: the whole record, its liveliest moment, and the characteristic of each damper.

    Args:
        page: draw for the width of a page.
        others: runs with which this one is compared; their figures have equal scales.
    """
    recording, wheel, wheels = run.recording, run.wheel, wheels_of(run.recording)
    dampers = dampers_of(recording)
    time, side = recording.time, side_of(wheel, wheels)
    limits = {name: run.car.model.vehicle.slip_velocities[name] for name in dampers}
    # Without a damper the motion of the plate determines the excerpt.
    shown = wheel if wheel in dampers or not dampers else dampers[0]
    velocity = recording[f"damper_{shown}_velocity" if dampers else f"plate_{wheel}_displacement"]
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
        if dampers or "damper" not in unit
    )
    start = liveliest(time, velocity, DETAIL)
    end = min(start + DETAIL, float(time[-1]))
    inside = (time >= start) & (time <= end)
    caption = (
        f"{Path(run.signal.source).name}, {level_words(recording, wheel, run.signal.rms(wheel))} at the "
        f"{wheel_words(wheel, wheels)}; "
        f"tyres {run.car.model.vehicle.driving.words}"
    )
    if dampers:
        laws = {damper.name: damper.law for damper in run.car.model.vehicle.composition.dampers}
        dashed, red = f"±{slip_words(limits, wheels)} mm/s", side_of(shown, wheels)
        caption += (
            f"; dashed: slip velocity {dashed}, red: {red} damper in slip"
            if laws[f"damper_{shown}"].static_friction > 0.0
            else f"; dashed: {dashed}, red: {red} damper faster than this"
        )
    size = (PAGE_WIDTH, PAGE_HEIGHT) if page else (15.0, 9.2)
    title = "" if page else "Main time histories"
    caption = wrapped(caption, size[0])
    with saved_figure(path, size, title, caption, placed=True) as figure:
        rows, each = len(panels) * (1.0,), len(dampers) * (1.0,)
        margins = (PAGE_HISTORY if page else HISTORY_MARGINS).above(caption)
        axes = placed_axes(figure, margins, widths=(2.0, 1.6), heights=rows, sharey="row")
        if not dampers:
            characteristics = np.zeros(0, dtype=object)
        elif page:
            characteristics = placed_axes(figure, PAGE_DAMPERS.above(caption), widths=each)[0]
        else:
            characteristics = placed_axes(figure, DAMPER_MARGINS.above(caption), heights=each)[:, 0]
        for (whole, detail), (unit, scale, lines) in zip(axes, panels, strict=True):
            for number, (name, label) in enumerate(lines.items()):
                style = {"color": COLOURS[number], "linestyle": LINES[number], "zorder": 2.5 - 0.1 * number}
                detail.plot(time[inside], scale * recording[name][inside], label=label, **style)
            # A wide envelope would hide a narrow one.
            spread = {name: float(np.std(recording[name])) for name in lines}
            for number, name in enumerate(sorted(lines, key=lambda name: -spread[name])):
                at, low, high = envelope(time, scale * recording[name])
                colour = COLOURS[list(lines).index(name)]
                whole.fill_between(
                    at, low, high, color=colour, linewidth=0.4, alpha=ENVELOPE_OPACITY, zorder=2.0 + 0.1 * number
                )
            lowest, highest = _range([run, *others], list(lines), scale)
            columns = len(lines) if page else LEGEND_COLUMNS
            room = LEGEND_ROOM * (1.6 if page else 1.0) * -(-len(lines) // columns)
            label = next((unit.replace(word, short) for word, short in SHORT.items() if page and word in unit), unit)
            whole.set(ylim=(lowest, highest + room * (highest - lowest)), ylabel=label.replace("\n ", "\n"))
            if len(lines) > 1 or "acceleration" in unit:
                handles, labels = detail.get_legend_handles_labels()
                # On a page the label of the axis names the quantity, so that four wheels fit in a row.
                labels = [text.removeprefix(f"{label.split()[0]} ") for text in labels] if page else labels
                whole.legend(handles, labels, loc="upper right", ncols=columns, columnspacing=1.0)
            whole.axvspan(start, end, color=MAGNIFIED, zorder=0)
            whole.set_xlim(time[0], time[-1])
            detail.set_xlim(start, end)
            if "velocity" in unit:
                for axis in (whole, detail):
                    for limit in (sign * slip for slip in dict.fromkeys(limits.values()) for sign in (-1e3, 1e3)):
                        axis.axhline(limit, color=SLIP_LIMIT, linewidth=0.8, linestyle="--", zorder=4)
                shade(detail, time[inside], np.abs(velocity[inside]) > limits[shown], SLIPPING)
        for axis in axes[:-1].flat:
            axis.tick_params(labelbottom=False)
        for axis in axes[-1]:
            axis.set_xlabel("time [s]")
        axes[0, 0].set_title("whole record: minimum to maximum")
        lively = f"{side_of(shown, wheels)} {'damper' if dampers else 'plate'}"
        axes[0, 1].set_title(f"{end - start:.3g} s with the largest motion of the {lively}")
        fast, strong = (
            _range([run, *others], [f"damper_{name}_{quantity}" for name in dampers], scale)
            for quantity, scale in (("velocity", 1e3), ("force", 1.0))
        )
        slip = max(limits.values(), default=0.0)
        fast = (min(fast[0], -1.1e3 * slip), max(fast[1], 1.1e3 * slip))
        for axis, name in zip(characteristics, dampers, strict=True):
            dots = distinct(1e3 * recording[f"damper_{name}_velocity"], recording[f"damper_{name}_force"])
            axis.plot(*dots, ".", markersize=1.5, color=COLOURS[0], zorder=3, rasterized=True)
            for limit in (-1e3 * limits[name], 1e3 * limits[name]):
                axis.axvline(limit, color=SLIP_LIMIT, linewidth=0.8, linestyle="--")
            axis.set(xlabel="damper velocity [mm/s]", title=f"{side_of(name, wheels)} damper", xlim=fast, ylim=strong)
            if axis is characteristics[0] or not page:
                axis.set_ylabel("damper force [N]")
            else:
                axis.tick_params(labelleft=False)


def _range(runs: Sequence[RecordedRun], channels: Sequence[str], scale: float) -> tuple[float, float]:
    """Return the limits of an axis that shows channels of several runs: their extremes and a margin of 5 %."""
    recordings = [(run.recording, name) for run in runs for name in channels if name in run.recording.channels]
    if not recordings:
        return -1.0, 1.0
    extremes = [(float(values.min()), float(values.max())) for values in (each[name] for each, name in recordings)]
    low, high = scale * min(low for low, _ in extremes), scale * max(high for _, high in extremes)
    margin = 0.05 * (high - low) or 1.0
    return low - margin, high + margin


def envelope(time: Vector, values: Vector) -> tuple[Vector, ...]:
    """Reduce a history (n,) at times [s] to the minimum and maximum of `SEGMENTS` segments of equal length.

    Neighbours share a sample, so that the area between minimum and maximum has no gaps.

    Returns:
        Middle of each segment [s], minimum, maximum; each sample is a segment where there are fewer.
    """
    if time.size <= SEGMENTS:
        return time, values, values
    edges = np.linspace(0, time.size - 1, SEGMENTS + 1).astype(int)
    low, high = (extreme.reduceat(values, edges[:-1]) for extreme in (np.minimum, np.maximum))
    ends = values[edges[1:]]
    return 0.5 * (time[edges[:-1]] + time[edges[1:]]), np.minimum(low, ends), np.maximum(high, ends)


def distinct(x: Vector, y: Vector) -> tuple[Vector, ...]:
    """Remove dots (n,) of a scatter plot that lie on others, so that rare dots of a long record remain.

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
