"""The FRF picture of a run: many channels to one motion of the plates, or few channels to each of several plates."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from vehicle.drawing.rendering.figure import (
    FADED,
    INK,
    UNDRIVEN,
    error_band,
    fading,
    frf_axes,
    looks,
    saved_figure,
    shade,
    wrapped,
    wrapped_phase,
)
from vehicle.drawing.rendering.plots import NO_LEVELS, REGION, plot_frf
from vehicle.drawing.rendering.recorded_run import RecordedRun, hub_channel
from vehicle.names import side_of
from vehicle.signals.analysis.dependence import motion_words
from vehicle.signals.analysis.motion_response import MotionResponse

OUTPUTS = {"seat_rail_acc_z": "Seat rail, vertical", "engine_acc_z": "Engine, vertical"}
"""Representative channels of a car, in addition to the part that carries its first driven wheel."""

DECADES = 1e4
"""Range of the magnitude axis: smaller values are errors of a plate without effect on the channel."""


def plot_frfs(
    path: Path,
    run: RecordedRun,
    responses: Sequence[MotionResponse],
    caption: str,
    size: tuple[float, float] = (13.0, 8.6),
) -> None:
    """Plot the FRFs of a run.

    Args:
        responses: responses to each motion of the plates, with rows of all acceleration channels.
    """
    if len(responses) > 1:
        _plot_separated(path, run, responses, caption, size)
        return
    motion, title = responses[0].motion, ""
    if len(motion) > 1:
        title = f"FRFs from the common motion of {_plates(motion, run.car.model.vehicle.wheels)}"
    plot_frf(path, run, responses[0].response, caption, title, size)


def _plates(motion: Mapping[str, float], wheels: Sequence[str]) -> str:
    """Describe the plates of a motion: the plate front right, or the plates with their factors."""
    names = {wheel: side_of(wheel, wheels) for wheel in motion}
    if len(motion) == 1:
        return f"plate {next(iter(names.values()))}"
    if motion_words(motion) == "alike":
        return f"plates {', '.join(names.values())}"
    return "plates " + ", ".join(f"{names[wheel]} ({factor:+.3g})" for wheel, factor in motion.items())


def _plot_separated(
    path: Path, run: RecordedRun, responses: Sequence[MotionResponse], caption: str, max_size: tuple[float, float]
) -> None:
    """Plot a column for each of a few channels, a line for each plate motion, and the multiple coherence."""
    vehicle = run.car.model.vehicle
    rows = {name: row for row, name in enumerate(vehicle.acceleration_channels)}
    hub = f"Wheel carrier {side_of(run.wheel, vehicle.wheels)}, vertical"
    shown = {name: title for name, title in OUTPUTS.items() if name in rows}
    shown |= {name: hub for name in [hub_channel(vehicle.composition, run.wheel)] if name in rows}
    shown = shown or {next(iter(rows)): next(iter(rows))}
    frequency = responses[0].response.frequency
    levels = np.abs([response.response.response[rows[name]] for response in responses for name in shown])
    inside = np.asarray(np.isfinite(levels).all(axis=0))
    single = all(len(response.motion) == 1 for response in responses)
    title = f"FRFs from each of {len(responses)} {'plates' if single else 'motions of the plates'}, which act at once"
    size = (min(max(7.2, 5.0 * len(shown)), max_size[0]), max_size[1])
    with saved_figure(path, size, title, wrapped(f"{caption}; {FADED}", size[0])) as figure:
        axes = figure.subplots(3, len(shown), sharex=True, sharey="row", height_ratios=(2.2, 1.0, 0.9), squeeze=False)
        for (magnitude, phase, coherence), (name, heading) in zip(axes.T, shown.items(), strict=True):
            coherent = responses[0].response.coherence[rows[name]]
            for style, response in zip(looks(), responses, strict=False):
                each = response.response
                values, error = each.response[rows[name]], each.random_error[rows[name]]
                error_band(magnitude, frequency, np.abs(values), REGION * error, coherent, style["color"])
                label = _plates(response.motion, vehicle.wheels)
                fading(magnitude, frequency, np.abs(values), coherent, label, **style)
                phase.plot(frequency, wrapped_phase(values), linewidth=0.8, **style)
            coherence.plot(frequency, coherent, color=INK)
            magnitude.set_title(heading)
            for axis in (magnitude, phase, coherence):
                shade(axis, frequency, ~inside, UNDRIVEN, None if inside.all() else "no FRF: no input")
        axes[0, 0].legend(loc="upper left")
        frf_axes(figure, axes, (0, 0.25, 0.5, 0.75, 1))
        axes[2, 0].set_ylabel("multiple coherence [-]")
        finite = levels[np.isfinite(levels) & (levels > 0.0)]
        lowest, highest = (finite.min(), finite.max()) if finite.size else NO_LEVELS
        axes[0, 0].set_ylim(max(0.5 * lowest, highest / DECADES), 2.0 * highest)
