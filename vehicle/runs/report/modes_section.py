"""Animated modes: canvas, controls and gallery with the numbers of their script, and tables of all modes."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from markupsafe import Markup

from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.wireframe import GROUPS, CarWireframe, car_wireframe, unit_factor
from vehicle.engines.linear.car_modes import Mode
from vehicle.runs.report.findings import damper_state
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates

Modes = Mapping[str, Sequence[Mode]]
STATES = ("stuck", "sliding")
HIGHEST_MODE = 60.0
"""Maximum frequency of the modes [Hz]."""

FULL = 999
"""Maximum displacement of a mode in the data of the page: a step of 1/999 is finer than a pixel."""

SHADES = 24
"""Number of colours from rest to the maximum displacement."""

fill = templates(__file__)


def modes_of(run: FinishedRun) -> Modes:
    """Return the modes of the car of a run for each of `STATES`, that of its dampers first."""
    states = sorted(STATES, key=lambda state: state != damper_state(run))
    return {state: run.car.modes(state, HIGHEST_MODE) for state in states}


def car_modes_of(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> list[dict[str, Any]]:
    """Return the modes of each car; cars with equal modes appear once."""
    sets: list[dict[str, Any]] = []
    for run, car_modes in zip(runs, modes, strict=True):
        entry = mode_set(run.name, car_wireframe(run.car.model), car_modes)
        same = next((other for other in sets if {**other, "name": ""} == {**entry, "name": ""}), None)
        if same is None:
            sets.append(entry)
        else:
            same["name"] += f", {run.name}"
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


def mode_set(name: str, wire: CarWireframe, modes: Modes) -> dict[str, Any]:
    """Return the modes of one car for the script of the page.

    Args:
        modes: modes for dampers "stuck" and "sliding".

    Returns:
        Content for JSON; coordinates in millimetres.
    """
    return {
        "name": name,
        "points": np.rint(1e3 * wire.points).astype(int).ravel().tolist(),
        "lines": wire.lines.ravel().tolist(),
        "groups": wire.groups.tolist(),
        "states": {state: [_mode(wire, mode) for mode in state_modes] for state, state_modes in modes.items()},
    }


def _mode(wire: CarWireframe, mode: Mode) -> dict[str, Any]:
    """Return a mode, scaled and rotated in phase so that its maximum displacement is real and equal to `FULL`."""
    moved = wire.displacement(mode.shape)
    moved = unit_factor(moved) * moved
    return {
        "hz": round(mode.frequency, 4),
        "zeta": round(mode.damping_ratio, 5),
        "text": mode.description,
        "ride": round(100 * ride_share(mode)),
        "energy": [[name, round(100 * share)] for name, share in _largest(mode.energy)],
        "re": np.rint(FULL * moved.real).astype(int).ravel().tolist(),
        "im": np.rint(FULL * moved.imag).astype(int).ravel().tolist(),
    }


def ride_share(mode: Mode) -> float:
    """Return the share of body heave and pitch in the kinetic energy of a mode; the mode with most is shown first."""
    return sum(mode.motions.get(name, 0.0) for name in ("body heave (z)", "body pitch (Ry)"))


def _largest(energy: Mapping[str, float]) -> list[tuple[str, float]]:
    shares = sorted(energy.items(), key=lambda item: -item[1])
    return [(name.replace("_", " "), share) for name, share in shares if share >= 0.03]


def as_json(sets: Sequence[Mapping[str, Any]]) -> str:
    """Return the mode sets as JSON text that is safe inside a script element."""
    table = colours(np.linspace(0.0, 1.0, SHADES), 1.0)[:, :3]
    shades = ["#" + "".join(f"{round(255 * float(part)):02x}" for part in colour) for colour in table]
    text = json.dumps({"full": FULL, "groups": GROUPS, "shades": shades, "cars": list(sets)}, separators=(",", ":"))
    return text.replace("<", "\\u003c")
