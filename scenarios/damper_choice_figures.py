"""Figures of the damper study: frequency responses, load fluctuation over damping, iteration."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from scenarios.chart import COLORS, chart, lines
from scenarios.damper_choice_runs import READ_OFF, START_REAR, RoadHolding
from vehicle.lumped.damper_optimum import Fluctuation

Array = npt.NDArray[np.float64]

STYLES = ("-", "--", "-.", ":")

FITTED = "Vehicle parameters fitted to the printed results."


def quarter_response_figure(folder: Path, frequency: Array, responses: dict[float, Array]) -> None:
    """Figures 2 and 3."""
    caption = f"Quarter car, displacement per road displacement. {FITTED}"
    with chart(folder / "figure_02_03_quarter_car.png", caption, columns=2, size=(11.0, 4.8)) as panels:
        for index, (panel, title) in enumerate(zip(panels, ("unsprung mass", "sprung mass"), strict=True)):
            _responses(panel, frequency, {c: found[index] for c, found in responses.items()}, title, "[m/m]")
            panel.set_xlim(0.0, 15.0)


def half_response_figure(folder: Path, frequency: Array, responses: dict[float, Array]) -> None:
    """Figures 5 to 8."""
    caption = f"Half car, equal dampers, both wheels on the same road in phase. {FITTED}"
    with chart(folder / "figure_05_to_08_half_car.png", caption, rows=2, columns=2, size=(11.0, 8.4)) as panels:
        titles = ("front unsprung mass", "rear unsprung mass", "heave", "pitch")
        for index, (panel, title) in enumerate(zip(panels, titles, strict=True)):
            unit = "[rad/m]" if title == "pitch" else "[m/m]"
            _responses(panel, frequency, {c: found[index] for c, found in responses.items()}, title, unit)
            panel.set_xlim(0.0, 30.0)


def optimum_figure(folder: Path, found: dict[str, RoadHolding], road: str) -> None:
    """Figures 9 and 10: load fluctuation over damping, as printed and physical."""
    caption = (
        f"Road: {road}. Left: R as printed, the sum of magnitudes of band amplitudes. Right: RMS of the tyre force "
        f"over the static load. Dots: optima. {FITTED}"
    )
    with chart(folder / f"figure_09_10_{road}.png", caption, columns=2, size=(11.0, 4.8)) as panels:
        for panel, (measure, one) in zip(panels, found.items(), strict=True):
            curves = [
                ("quarter car", one.quarter, COLORS[0], "-"),
                ("half car front, equal dampers", one.equal[0], COLORS[1], "--"),
                ("half car rear, equal dampers", one.equal[1], COLORS[2], "-."),
            ]
            label = "R as printed [-]" if measure == "printed" else "RMS tyre force / static load [-]"
            lines(panel, one.damping, curves, xlabel="damping [N s/m]", ylabel=label, title=f"{measure} measure")
            for best, color in zip((one.quarter_optimum, *one.equal_optima), COLORS, strict=False):
                panel.plot(best.damping, best.value, "o", color=color, markersize=5)
            panel.set_ylim(bottom=0.0)


def iteration_figure(folder: Path, found: RoadHolding, measure: Fluctuation) -> None:
    """Figures 11 to 13: one end over its own damping, the other held."""
    caption = (
        "Half car on the highway, R as printed. Each panel is one step: the damper of one end varied, the other held; "
        f"dots at the best multiple of 250 N s/m. {FITTED}"
    )
    with chart(folder / "figure_11_12_13_iteration.png", caption, columns=3, size=(14.0, 4.8)) as panels:
        rear, front = START_REAR, float("nan")
        for panel, step, number in zip(panels, found.read_off[:3], (11, 12, 13), strict=True):
            end = 0 if step.changed == "front" else 1
            held = rear if end == 0 else front
            pairs = [(c, held) if end == 0 else (held, c) for c in READ_OFF]
            values = [float(measure(float(a), float(b))[end]) for a, b in pairs]
            other = "rear" if end == 0 else "front"
            title = f"figure {number}: {other} held at {held:.0f} N s/m"
            curve = (step.changed, values, COLORS[1 + end], "-")
            lines(panel, READ_OFF, [curve], xlabel=f"{step.changed} damping [N s/m]", ylabel="R [-]", title=title)
            best = step.front if end == 0 else step.rear
            panel.plot(best, step.fluctuation[end], "o", color=COLORS[1 + end], markersize=5)
            panel.set_ylim(bottom=0.0)
            front, rear = step.front, step.rear


def _responses(panel: object, frequency: Array, curves: dict[float, Array], title: str, unit: str) -> None:
    drawn = [
        (f"{c:.0f} N s/m", values, color, style)
        for (c, values), color, style in zip(curves.items(), COLORS, STYLES, strict=False)
    ]
    lines(panel, frequency, drawn, xlabel="frequency [Hz]", ylabel=f"transmissibility {unit}", title=title)
    panel.set_ylim(bottom=0.0)  # type: ignore[attr-defined]
