"""Animated modes: canvas, controls and gallery, which the script of the page fills, and tables of all modes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from markupsafe import Markup

from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.engines.linear.car_modes import Mode
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates
from vehicle.runs.report.moving_modes import mode_set

Modes = Mapping[str, Sequence[Mode]]
STATES = ("stuck", "sliding")
HIGHEST_MODE = 60.0
"""Maximum frequency of the modes [Hz]."""

fill = templates(__file__)


def modes_of(run: FinishedRun) -> Modes:
    """Return the modes of the car of a run for each of `STATES`."""
    return {state: run.car.modes(state, HIGHEST_MODE) for state in STATES}


def car_modes_of(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> list[dict[str, object]]:
    """Return the modes of each car; cars with equal modes appear once."""
    sets: list[dict[str, object]] = []
    for run, car_modes in zip(runs, modes, strict=True):
        entry = mode_set(run.name, run.wheel, car_wireframe(run.car.model), car_modes)
        same = next((other for other in sets if {**other, "name": ""} == {**entry, "name": ""}), None)
        if same is None:
            sets.append(entry)
        else:
            same["name"] = f"{same['name']}, {run.name}"
    return sets


def moving_modes(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> Markup:
    """Return canvas, controls, gallery and tables of the modes."""
    tables = [
        (
            run.name,
            state,
            [(mode.description, f"{mode.frequency:.3f}", f"{100 * mode.damping_ratio:.2f}") for mode in state_modes],
        )
        for run, car_modes in zip(runs, modes, strict=True)
        for state, state_modes in car_modes.items()
    ]
    return fill("modes", tables=tables, highest=HIGHEST_MODE, several=len(runs) > 1)
