"""Figures of the bumps (3.12 to 3.20 of the source), and the film of both side by side, in step."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from scenarios.bump.runs import (
    FIRST_SLIP,
    FIRST_SLIP_TOLERANCE,
    PUBLISHED_FRICTION,
    RUNG_DOWN,
    SIZES,
    Bumps,
    fastest,
    relative_acceleration,
    ring_down_time,
    saturated_time,
)
from scenarios.bump.seeds import BumpSeeds, row_key
from scenarios.charts import figure_file, rows_of
from scenarios.evidence import evidence_of
from scenarios.signals.bump import BUMP_START_S
from scenarios.study import computed_by
from vehicle.arrays import Vector
from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.figure import COLOURS, LINES
from vehicle.drawing.rendering.film import write_film
from vehicle.drawing.rendering.layout import Layout, font
from vehicle.drawing.rendering.shot import Shot, Take
from vehicle.runs.car import SATURATED_VELOCITY, Run
from vehicle.runs.output.folder import write_whole

VERTICAL = {
    "seat rail (3.13)": ("seat_rail_acc_z", "seat_rail_z"),
    "seat (3.14)": ("seat_acc_z", "seat_z"),
    "knuckle (3.15)": ("knuckle_{wheel}_acc_z", "knuckle_z"),
    "damper top": ("damper_top_{wheel}_acc_z", ""),
    "engine (3.17)": ("engine_acc_z", "engine_z"),
    "roof left rear (3.18)": ("roof_right_rear_acc_z", "roof_z"),
    "body front": ("body_front_acc_z", ""),
}
"""Label to channel, and the key of the point where the source shows it."""

HORIZONTAL = {
    "seat rail x (3.19)": ("seat_rail_acc_x", "seat_rail_x"),
    "seat rail y (3.20)": ("seat_rail_acc_y", "seat_rail_y"),
}

RINGING = {"seat rail": "seat_rail", "engine": "engine", "roof left rear": "roof_right_rear"}

NOISY, QUIET = COLOURS[3], COLOURS[4]
"""Colours of the run with noise and of the same bump alone."""

SHOWN = (-0.25, 3.25)
"""Ends of the time histories after the start of the bump [s]; the source shows 3 s."""


def excerpt(run: Run, start: float, shown: tuple[float, float], values: Vector) -> tuple[Vector, Vector]:
    """Return times, shifted to a bump that begins at 5 s, and values, (n,), of a window after its start [s]."""
    keep = (run.time >= start + shown[0]) & (run.time <= start + shown[1])
    return run.time[keep] + BUMP_START_S - start, values[keep]


def history_figures(folder: Path, bumps: Bumps, seeds: BumpSeeds) -> None:
    """Write the figures of the time histories of all points, the low bump on the left, the high bump on the right."""
    start = bumps.record.start
    for name, title, channels in (
        ("histories_vertical", "Vertical accelerations", VERTICAL),
        ("histories_horizontal", "Horizontal accelerations of the seat rail", HORIZONTAL),
    ):
        note = _caption(
            bumps,
            "light: with the random noise of 0.05 mm RMS, dark: the bump alone; grey: the last interval of the "
            f"published axis, in which the extreme lies; bar: mean and standard deviation of ours over {seeds.count} "
            "seeds of the noise",
        )
        with figure_file(folder / f"{name}.png", (13.0, 1.0 + 1.45 * len(channels)), title, note) as figure:
            axes = rows_of(figure, len(channels), 2)
            for column, size, *pair in zip(axes.T, SIZES, bumps.noisy, bumps.quiet, strict=True):
                column[0].set_title(f"A = {1e3 * size:g} mm")
                for axis, (name, point) in zip(column, channels.values(), strict=True):
                    for run, colour, width in zip(pair, (NOISY, QUIET), (0.7, 1.1), strict=True):
                        values = run[name.format(wheel=run.wheel)]
                        axis.plot(*excerpt(run, start, SHOWN, values), color=colour, linewidth=width)
                    _published_ends(axis, size, point, seeds)
            for axis, label in zip(axes[:, 0], channels, strict=True):
                axis.set_ylabel(f"{label}\n[m/s²]")
    note = _caption(
        bumps,
        "relative acceleration along the strut axis; near zero while the damper sticks. The pictured low bump breaks "
        f"away: largest velocity {1e3 * fastest(bumps.noisy[0]):.2f} mm/s, above 1 mm/s for "
        f"{1e3 * saturated_time(bumps.noisy[0]):.0f} ms",
    )
    title = "Acceleration of the damper top relative to the knuckle (figure 3.16)"
    with figure_file(folder / "relative_acceleration.png", (11.0, 5.6), title, note) as figure:
        axes = rows_of(figure, 2, 1)[:, 0]
        for axis, run, size in zip(axes, bumps.noisy, SIZES, strict=True):
            axis.plot(*excerpt(run, start, (-0.05, 0.8), relative_acceleration(run)), color=COLOURS[0])
            axis.set(ylabel="relative acceleration\n[m/s²]", title=f"A = {1e3 * size:g} mm")
            # The automatic number of ticks depends on the height, which changes with their labels during the layout.
            axis.locator_params(axis="y", nbins=6)


def _published_ends(axis: Any, size: float, point: str, seeds: BumpSeeds) -> None:
    """Draw the published intervals of the extremes of a panel and our extremes over the seeds, if published."""
    for column, word in enumerate(("lowest", "highest")):
        try:
            low, high = evidence_of(row_key(size, point, word)).interval
        except KeyError:
            continue
        axis.axhspan(low, high, color="#d8d8d8", zorder=0)
        ours = seeds.extremes[size, point][:, column]
        look = {"fmt": "_", "color": COLOURS[1], "capsize": 3.0, "zorder": 4}
        axis.errorbar([BUMP_START_S + BAR_AT], [np.mean(ours)], yerr=[np.std(ours, ddof=1)], **look)


BAR_AT = -0.12
"""Time of the bar of the extremes after the start of the bump [s]."""


def friction_figure(path: Path, bumps: Bumps) -> None:
    """Write the relative acceleration for every friction limit, and the time of the first slip over it."""
    from matplotlib import colormaps

    shades = colormaps["viridis"](np.linspace(0.0, 0.85, len(bumps.by_friction)))
    note = _caption(
        bumps,
        "A = 7.5 mm; left: relative acceleration along the strut axis; right: first sample of the damper above "
        f"{1e3 * bumps.slip_velocity:g} mm/s, which is slip, and above 1 mm/s, where stick has ended",
    )
    with figure_file(
        path, (12.5, 4.6), "First slip after the 7.5 mm bump against friction (figure 3.12)", note
    ) as figure:
        history, times = figure.subplots(1, 2, width_ratios=(2.2, 1.0))
        for (friction, run), shade in zip(bumps.by_friction.items(), shades, strict=True):
            history.plot(
                *excerpt(run, bumps.record.start, (0.0, 0.15), relative_acceleration(run)),
                color=shade,
                linewidth=2.0 if friction == PUBLISHED_FRICTION else 1.1,
                label=f"Fd {friction:g} N",
            )
        history.axvline(FIRST_SLIP, color="#555555", linewidth=0.9, linestyle="--", label="published, 125 N")
        history.set(xlabel="time [s]", ylabel="relative acceleration [m/s²]")
        history.legend(loc="best")
        for velocity, style, label in (
            (bumps.slip_velocity, "o-", "first slip"),
            (SATURATED_VELOCITY, "o:", "end of stick"),
        ):
            slips = [(friction, time) for friction, time in bumps.first_slip(velocity).items() if time is not None]
            times.plot(*zip(*slips, strict=True), style, color=COLOURS[0], label=label)
        read_off = {"yerr": [FIRST_SLIP_TOLERANCE], "fmt": "s", "label": "published, ±10 ms"}
        times.errorbar([PUBLISHED_FRICTION], [FIRST_SLIP], color=COLOURS[1], **read_off)
        times.set(xlabel="friction limit Fd [N]", ylabel="time [s]")
        times.ticklabel_format(axis="y", useOffset=False)
        times.legend(loc="upper left")


def ring_down_figure(path: Path, bumps: Bumps) -> None:
    """Write how seat rail, engine and roof ring down after both bumps, relative to their largest value after it."""
    end = bumps.record.end
    note = _caption(
        bumps,
        "vertical acceleration without noise over its largest value after the bump; band: 20 %; dotted: the last time "
        "outside it",
    )
    with figure_file(path, (12.5, 6.6), "Ring-down after the bump", note) as figure:
        axes = rows_of(figure, len(RINGING), 1, sharey=True)[:, 0]
        for axis, (label, point) in zip(axes, RINGING.items(), strict=True):
            for run, size, colour, line in zip(bumps.quiet, SIZES, COLOURS, LINES, strict=False):
                motion = run[f"{point}_acc_z"]
                relative = motion / np.max(np.abs(motion[run.time >= end]))
                time, shown = excerpt(run, end, (0.0, 4.0), relative)
                size_label = f"A = {1e3 * size:g} mm"
                axis.plot(time - BUMP_START_S, shown, color=colour, linestyle=line, label=size_label)
                axis.axvline(ring_down_time(run.time, motion, end), color=colour, linestyle=":", linewidth=1.3)
            axis.axhspan(-RUNG_DOWN, RUNG_DOWN, color="#e2e2e2", zorder=0)
            axis.set(ylim=(-1.1, 1.1), ylabel=f"{label}\n[-]")
        axes[0].legend(loc="upper right")
        axes[-1].set_xlabel("time after the bump [s]")


def _caption(bumps: Bumps, subject: str) -> str:
    run = bumps.noisy[0]
    wheel = run.car.vehicle.wheel_text(run.wheel)
    return (
        f"{subject}. Bump under the {wheel} from t = {BUMP_START_S:g} s; time histories, no averages; "
        f"{computed_by(run)}"
    )


Picture = npt.NDArray[np.uint8]

HALF = (960, 600)
"""Width and height of one half [pixel]: wide enough for the captions that its height gives."""

BANNER = 48
"""Height of the captions above the halves [pixel]."""

SLOW = 3.0

SHOWN_BUMP = 0.06
"""Height [m] to which every bump is exaggerated: a linear car would look alike in both halves."""


def side_by_side(path: Path, runs: Sequence[Run], *, start: float, duration: float) -> None:
    """Write the film as H.264 in MP4.

    Raises:
        MissingPartError: no off-screen OpenGL library or no ffmpeg.
        OutputError: the file cannot be written.
    """
    backend, layout = choose_backend(), Layout(width=HALF[0], height=HALF[1])
    shots = [
        Shot(run, layout, Take(start=start, duration=duration, slow=SLOW, exaggeration=SHOWN_BUMP / size))
        for run, size in zip(runs, SIZES, strict=True)
    ]
    captions = [f"bump of {1e3 * size:g} mm, motion {SHOWN_BUMP / size:g} times" for size in SIZES]
    banner = np.concatenate([_banner(text) for text in captions], axis=1)
    pairs = zip(*(shot.frames(backend) for shot in shots), strict=True)
    frames = (np.concatenate([banner, np.concatenate(halves, axis=1)], axis=0) for halves in pairs)
    shape = (banner.shape[0] + HALF[1], banner.shape[1])
    write_whole(path, lambda file: write_film(file, frames, shape))


def _banner(text: str) -> Picture:
    """Return an image of a text centred in a strip, (height, width, 3)."""
    from PIL import Image, ImageDraw

    image = Image.new("RGB", (HALF[0], BANNER), (28, 37, 48))
    position = (HALF[0] / 2, BANNER / 2)
    ImageDraw.Draw(image).text(position, text, fill=(255, 255, 255), font=font(24, bold=True), anchor="mm")
    return np.asarray(image)
