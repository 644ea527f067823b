"""Modes that move: canvas, controls and gallery, which the script of the page fills, and tables of all of them."""

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
"""Frequency [Hz] up to which modes are shown."""

VIEWS = {"corner": "Corner", "side": "Side", "front": "Front", "top": "Top"}


def car_modes_of(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> list[dict[str, object]]:
    """Modes of each car; of equal cars once."""
    found: list[dict[str, object]] = []
    seen: list[tuple[FinishedRun, dict[str, object]]] = []
    for run, own in zip(runs, modes, strict=True):
        same = next((one for other, one in seen if other.car.vehicle == run.car.vehicle), None)
        if same is None:
            one = mode_set(run.name, run.wheel, car_wireframe(run.car.model), own)
            seen.append((run, one))
            found.append(one)
        else:
            same["name"] = f"{same['name']}, {run.name}"
    return found


def moving_modes(runs: Sequence[FinishedRun], modes: Sequence[Modes]) -> Markup:
    """Canvas, controls, gallery and tables of the modes."""

    def select(words: str, name: str) -> Markup:
        return tag("div", tag("label", words, for_=f"mode-{name}"), tag("select", id=f"mode-{name}"))

    def slider(words: str, name: str, least: float, most: float, step: float, value: float) -> Markup:
        control = (
            f'<input type="range" id="mode-{name}" min="{least:g}" max="{most:g}" step="{step:g}" value="{value:g}">'
        )
        return joined([tag("label", words, for_=f"mode-{name}", class_="only-screen"), Markup(control)])

    views = [tag("button", word, type="button", data_view=view) for view, word in VIEWS.items()]
    controls = tag(
        "div",
        select("Car", "car"),
        select("Dampers", "state"),
        select("Mode", "pick"),
        slider("Largest displacement drawn [mm]", "amplitude", 0, 500, 5, 160),
        slider("Periods a second on the screen", "speed", 0.1, 2.0, 0.1, 0.7),
        tag("button", "Pause", type="button", id="mode-play"),
        *views,
        tag("div", id="mode-words"),
        tag("div", class_="scale", id="mode-scale"),
        tag("div", tag("span", "at rest"), tag("span", "moves most"), class_="ends"),
        class_="controls",
    )
    label = "The chosen mode, moving. Drag or arrow keys turn it, the mouse wheel, plus and minus zoom."
    canvas = tag("canvas", id="mode-canvas", tabindex="0", role="img", aria_label=label)
    parts = [
        tag(
            "p",
            "Linear modes of the car in its design position, from the matrices of the simulated model. Drag to turn, "
            "wheel to zoom. Grey: at rest. Colour: how far a point moves. The decay is not shown.",
        ),
        tag("noscript", tag("p", "The moving picture needs scripts; the tables below do not.")),
        tag("div", canvas, controls, class_="modes"),
        tag("div", id="mode-gallery", class_="gallery"),
    ]
    heads = ("what moves", "frequency [Hz]", "damping ratio [%]")
    for run, own in zip(runs, modes, strict=True):
        for state, found in own.items():
            rows = [(one.description, f"{one.frequency:.3f}", f"{100 * one.damping_ratio:.2f}") for one in found]
            title = f"{len(rows)} modes up to {HIGHEST_MODE:g} Hz, dampers {state}" + (
                f": {run.name}" if len(runs) > 1 else ""
            )
            parts.append(folded(title, table(heads, rows)))
    return joined(parts)
