"""Animated modes: canvas, controls and gallery, which the script of the page fills, and tables of all modes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from vehicle.drawing.rendering.wireframe import car_wireframe
from vehicle.engines.linear.car_modes import Mode
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import Markup, folded, joined, table, tag
from vehicle.runs.report.moving_modes import mode_set

Modes = Mapping[str, Sequence[Mode]]
STATES = ("stuck", "sliding")
HIGHEST_MODE = 60.0
"""Maximum frequency of the modes [Hz]."""

VIEWS = {"corner": "Corner", "side": "Side", "front": "Front", "top": "Top"}


def modes_of(run: FinishedRun) -> Modes:
    """Return the modes of the car of a run for each of `STATES`."""
    return {state: run.car.modes(state, HIGHEST_MODE) for state in STATES}


def car_modes_of(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> list[dict[str, object]]:
    """Return the modes of each car; equal cars appear once."""
    sets: list[dict[str, object]] = []
    seen: list[tuple[FinishedRun, dict[str, object]]] = []
    for run, car_modes in zip(runs, modes, strict=True):
        same = next((entry for other, entry in seen if other.car.vehicle == run.car.vehicle), None)
        if same is None:
            entry = mode_set(run.name, run.wheel, car_wireframe(run.car.model), car_modes)
            seen.append((run, entry))
            sets.append(entry)
        else:
            same["name"] = f"{same['name']}, {run.name}"
    return sets


def moving_modes(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> Markup:
    """Return canvas, controls, gallery and tables of the modes."""

    def select(label: str, name: str) -> Markup:
        return tag("div", tag("label", label, for_=f"mode-{name}"), tag("select", id=f"mode-{name}"))

    def slider(label: str, name: str, minimum: float, maximum: float, step: float, value: float) -> Markup:
        limits = f'min="{minimum:g}" max="{maximum:g}" step="{step:g}"'
        control = f'<input type="range" id="mode-{name}" {limits} value="{value:g}">'
        return joined([tag("label", label, for_=f"mode-{name}", class_="only-screen"), Markup(control)])

    views = [tag("button", word, type="button", data_view=view) for view, word in VIEWS.items()]
    controls = tag(
        "div",
        select("Car", "car"),
        select("Dampers", "state"),
        select("Mode", "pick"),
        slider("Maximum displacement on the screen [mm]", "amplitude", 0, 500, 5, 160),
        slider("Periods per second on the screen", "speed", 0.1, 2.0, 0.1, 0.7),
        tag("button", "Pause", type="button", id="mode-play"),
        *views,
        tag("div", id="mode-words"),
        tag("div", class_="scale", id="mode-scale"),
        tag("div", tag("span", "at rest"), tag("span", "maximum"), class_="ends"),
        class_="controls",
    )
    label = "Animation of the selected mode. Rotate by mouse or arrow keys, zoom by mouse wheel, plus and minus."
    canvas = tag("canvas", id="mode-canvas", tabindex="0", role="img", aria_label=label)
    parts = [
        tag(
            "p",
            "Linear modes of the car in its design position, from the matrices of the simulated model. Drag to rotate, "
            "mouse wheel to zoom. Grey: at rest. Colour: displacement. The decay is not shown.",
        ),
        tag("noscript", tag("p", "The animation needs JavaScript; the tables below do not.")),
        tag("div", canvas, controls, class_="modes"),
        tag("div", id="mode-gallery", class_="gallery"),
    ]
    heads = ("mode shape", "frequency [Hz]", "damping ratio [%]")
    for run, car_modes in zip(runs, modes, strict=True):
        for state, state_modes in car_modes.items():
            rows = [
                (mode.description, f"{mode.frequency:.3f}", f"{100 * mode.damping_ratio:.2f}") for mode in state_modes
            ]
            title = f"{len(rows)} modes up to {HIGHEST_MODE:g} Hz, dampers {state}" + (
                f": {run.name}" if len(runs) > 1 else ""
            )
            parts.append(folded(title, table(heads, rows)))
    return joined(parts)
