"""Figures of the half car with rider: base case, parameter studies, speed, lift-off."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from scenarios.charts import chart, lines
from scenarios.half_car_rider.claims import TRAVEL_DIRECTIONS, Study
from scenarios.half_car_rider.runs import SPEEDS, VARIED, Motion, Outcome
from scenarios.lumped.half_car_rider_model import linear_tyre_load
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters
from scenarios.lumped.history import History
from vehicle.drawing.rendering.figure import COLOURS

BUMP = "Half-sine bump 0.05 m high, 0.5 m long"

TIME_FIGURES: tuple[tuple[str, tuple[str, ...], Motion, float, str], ...] = (
    ("figure_05", ("upper_limb", "lower_limb"), "displacement", 1e3, "displacement [mm]"),
    ("figure_06", ("upper_limb", "lower_limb"), "acceleration", 1.0, "acceleration [m/s²]"),
    ("figure_07", ("front_body", "rear_body"), "displacement", 1e3, "displacement [mm]"),
    ("figure_08", ("pitch",), "displacement", 1e3, "pitch angle [mrad]"),
    ("figure_09", ("front_wheel", "rear_wheel"), "displacement", 1e3, "displacement [mm]"),
    ("figure_10", ("seat", "body"), "acceleration", 1.0, "acceleration [m/s²]"),
)
"""File, panels, quantity, factor, axis."""

LINEAR, ONE_SIDED = ("linear tyre", COLOURS[0], "-"), ("one-sided tyre", COLOURS[1], "--")

LINE_STYLES = {"passive": "-", "skyhook": "--", "hybrid": ":"}


def time_figures(folder: Path, histories: Mapping[str, History], speed: float) -> None:
    """Draw figures 5 to 10: time histories of the base case, passive and semi-active."""
    caption = (
        f"{BUMP}, {speed:.0f} km/h, met by the front wheel at t = 0. Passive: exact linear response. Skyhook "
        "(continuous) and hybrid: dampers between cmin and cmax, set each control period. Tyres glued to the road."
    )
    for name, shown, quantity, factor, label in TIME_FIGURES:
        with chart(folder / f"{name}.png", caption, rows=len(shown), size=(9.0, 3.0 + 2.2 * len(shown))) as panels:
            for panel, shown_history in zip(panels, shown, strict=True):
                for (law, history), color in zip(histories.items(), COLOURS, strict=False):
                    curve = (law, factor * history.motion(shown_history, quantity), color, LINE_STYLES[law])
                    lines(
                        panel,
                        history.time,
                        [curve],
                        xlabel="time [s]",
                        ylabel=label,
                        title=shown_history.replace("_", " "),
                    )
                panel.set_xlim(0.0, 4.0)


def study_figures(folder: Path, factors: Sequence[float], passive: Study, skyhook: Study | None) -> None:
    """Draw figures 11 to 22 in pairs and 23 to 25: dose values and travel over each parameter."""
    semi = "" if skyhook is None else "; dashed: continuous skyhook, whose limits do not follow the passive damper"

    def draw(panel: Any, parameter: str, measure: str, factor: float, ylabel: str) -> None:
        for study, style in ((passive, "-"), (skyhook, "--")):
            for speed, row, color in zip(SPEEDS, study[parameter] if study else (), COLOURS, strict=False):
                values = [factor * getattr(outcome, measure) for outcome in row]
                curve = (f"{speed:.0f} km/h" if style == "-" else None, values, color, style)
                xlabel = f"{VARIED[parameter]} [% of the base case]"
                lines(panel, 100.0 * np.asarray(factors), [curve], xlabel=xlabel, ylabel=ylabel)
        panel.set_ylim(bottom=0.0)

    for index, parameter in enumerate(VARIED):
        first = 11 + 2 * index
        caption = f"{BUMP}. Solid: passive, exact linear response{semi}. Unweighted acceleration, as in the source."
        path = folder / f"figure_{first}_{first + 1}_{parameter}.png"
        with chart(path, caption, columns=2, size=(11.0, 4.8)) as panels:
            for panel, limb in zip(panels, ("upper", "lower"), strict=True):
                draw(panel, parameter, f"{limb}_vdv", 1.0, f"VDV of the {limb} body [m/s$^{{1.75}}$]")
    caption = f"{BUMP}. Largest magnitude of the travel, front or rear. Solid: passive{semi}."
    with chart(folder / "figure_23_24_25_travel.png", caption, columns=3, size=(14.0, 4.8)) as panels:
        for panel, parameter in zip(panels, TRAVEL_DIRECTIONS, strict=True):
            draw(panel, parameter, "travel", 1e3, "suspension travel [mm]")


def speed_figure(
    folder: Path, scan: Mapping[str, Sequence[float]], laws: Mapping[str, Sequence[Outcome]], speeds: Sequence[float]
) -> None:
    """Draw the dose value of the upper body over speed: exact passive response, and every law at printed speeds."""
    caption = (
        f"{BUMP}. Left: exact passive response from 1 to 60 km/h; the grey band is the range of the source. Right: "
        "passive and semi-active dampers at the source's speeds, tyres glued to the road."
    )
    with chart(folder / "speed.png", caption, columns=2, size=(11.0, 4.8)) as (left, right):
        left.axvspan(SPEEDS[0], SPEEDS[-1], color="#eeeeee")
        curves = [("upper body", scan["upper"], COLOURS[0], "-"), ("lower body", scan["lower"], COLOURS[1], "--")]
        lines(left, scan["speed"], curves, xlabel="speed [km/h]", ylabel="VDV [m/s$^{1.75}$]", title="passive")
        for index, (law, outcomes) in enumerate(laws.items()):
            style = "--" if law.endswith("on_off") else "-"
            color = "black" if law == "passive" else COLOURS[((index - 1) // 2) % len(COLOURS)]
            curve = (law.replace("_", " "), [o.upper_vdv for o in outcomes], color, style)
            lines(right, speeds, [curve], xlabel="speed [km/h]", ylabel="VDV of the upper body [m/s$^{1.75}$]")
        right.set_ylim(bottom=0.0)


def lift_off_figure(folder: Path, car: HalfCarRiderParameters, glued: History, free: History, speed: float) -> None:
    """Draw the tyre loads of the base case: linear tyre that pulls, and one-sided tyre."""
    caption = (
        f"{BUMP}, {speed:.0f} km/h, passive dampers. The linear tyre pulls on the road where its load is below zero "
        "(shaded); the one-sided tyre leaves the road and lands again."
    )
    with chart(folder / "lift_off.png", caption, rows=2, size=(9.0, 7.0)) as panels:
        linear = linear_tyre_load(car, glued)
        one_sided = np.maximum(linear_tyre_load(car, free), 0.0)
        for panel, end, a, b in zip(panels, ("front", "rear"), linear, one_sided, strict=True):
            panel.fill_between(glued.time, a / 1e3, 0.0, where=a < 0.0, color="#f2c6bd")
            for time, load, look in ((glued.time, a, LINEAR), (free.time, b, ONE_SIDED)):
                curve = (look[0], load / 1e3, *look[1:])
                lines(panel, time, [curve], xlabel="time [s]", ylabel="tyre load [kN]", title=end)
            panel.set_xlim(0.0, 1.2)
