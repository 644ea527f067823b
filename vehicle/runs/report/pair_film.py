"""Film of two saved runs side by side: the folder of a run has no poses, so both are simulated again for it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.digits import number
from vehicle.drawing.rendering.film import pair_film
from vehicle.drawing.rendering.pair_shot import require_one_input
from vehicle.drawing.rendering.shot import Take
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Run
from vehicle.runs.output.saved_run import recorded_signal
from vehicle.runs.report.answer import what_changed
from vehicle.runs.report.finished_run import FinishedRun, read_run
from vehicle.runs.report.page import told_apart

SIMULATED = 0.2
"""Share of the progress of a film for the simulations."""

ROUNDING = 1e-6
"""Relative difference of a curve that is round-off: saved time histories have at least seven digits."""


def film_of_two(
    folders: Sequence[Path],
    path: Path,
    take: Mapping[str, Any] | None = None,
    *,
    size: tuple[int, int] = (1280, 720),
    jobs: int = 1,
    progress: Callable[[float], None] | None = None,
) -> str:
    """Write a film of two saved runs of one input, side by side.

    Args:
        folders: folders of the runs, two; the first is the reference.
        path: MP4 file.
        take: settings of `Take` that are not chosen by the program: start, duration, slow, exaggeration.
        size, jobs, progress: see `pair_film`.

    Returns:
        Shown times, and the difference of the new simulations from the saved runs, as text.

    Raises:
        ConfigurationError: the inputs or lengths of the runs differ, or a setting is out of range.
        DataError: a run is damaged, or has not the displacement of a moving plate.
        MissingPartError, OutputError: see `film`.
    """
    report = progress or (lambda fraction: None)
    saved = told_apart([read_run(folder) for folder in folders])
    require_one_input({run.name: run for run in saved})
    again = []
    for count, run in enumerate(saved, 1):
        again.append(_simulated(run))
        report(SIMULATED * count / len(saved))
    speed = (again[0].road or {}).get("speed_kmh")
    off = max(deviation(run, new) for run, new in zip(saved, again, strict=True))
    near = "equal" if off < ROUNDING else f"differ by {number(100.0 * off, 2)} % (RMS) from"
    words = f"simulated again by the engine mujoco; its curves {near} the saved ones"
    settings = Take(**(take or {}), speed=float(speed) / 3.6 if isinstance(speed, int | float) else None)
    cut = pair_film(
        {run.name: new for run, new in zip(saved, again, strict=True)},
        what_changed(*saved) + ("" if off < ROUNDING else f"; {words}"),
        path,
        settings,
        size=size,
        jobs=jobs,
        progress=lambda share: report(SIMULATED + (1.0 - SIMULATED) * share),
    )
    return f"{cut.start:.2f} to {cut.end:.2f} s, both runs {words}"


def _simulated(run: FinishedRun) -> Run:
    """Return a saved run with poses.

    Raises:
        DataError: the run has not the displacement of a moving plate.
    """
    try:
        signal = recorded_signal(run.summary, run.recording)
    except ConfigurationError as error:
        raise DataError(
            f"{run.place}: cannot be simulated again for a video ({error}); run it with all default channels"
        ) from None
    return replace(run.car.run(signal, engine="mujoco"), road=run.summary.input.road)


def deviation(saved: FinishedRun, again: Run) -> float:
    """Return the RMS of the difference of a curve of the film from the saved one, over its RMS [-]; the largest.

    Args:
        saved: saved run.
        again: the same run, simulated again.
    """
    old, new = saved.recording, again.recording
    worst = 0.0
    for name in (f"plate_{saved.wheel}_displacement", "seat_rail_acc_z", f"damper_{saved.wheel}_velocity"):
        if name in old.channels and name in new.channels and np.any(old[name]):
            off = np.interp(old.time, new.time, new[name]) - old[name]
            worst = max(worst, float(np.sqrt(np.mean(off**2) / np.mean(old[name] ** 2))))
    return worst
