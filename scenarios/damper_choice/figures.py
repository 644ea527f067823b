"""Figures of the damper study: frequency responses, load fluctuation over damping, iteration."""

from pathlib import Path

import numpy as np

from scenarios.charts import chart, lines
from scenarios.damper_choice.optimum import Fluctuation
from scenarios.damper_choice.runs import READ_OFF, SPEED, START_REAR, RoadHolding, TradeOff
from scenarios.lumped.half_car_rider_model import ENDS
from vehicle.arrays import Vector
from vehicle.drawing.rendering.figure import COLOURS

Responses = dict[float, Vector]

STYLES = ("-", "--", "-.", ":")

FITTED = "Vehicle parameters fitted to the printed results."


def response_figures(folder: Path, narrow: Vector, quarter: Responses, wide: Vector, half: Responses) -> None:
    """Draw figures 2, 3 and 5 to 8: responses over frequency [Hz]; damping to |response|, (coordinates, lines)."""
    for name, caption, titles, frequency, responses in (
        (
            "02_03_quarter_car",
            "Quarter car, displacement per road displacement.",
            ("unsprung mass", "sprung mass"),
            narrow,
            quarter,
        ),
        (
            "05_to_08_half_car",
            "Half car, equal dampers, both wheels on the same road in phase.",
            ("front unsprung mass", "rear unsprung mass", "heave", "pitch"),
            wide,
            half,
        ),
    ):
        rows = len(titles) // 2
        size = (11.0, 4.8 if rows == 1 else 8.4)
        with chart(folder / f"figure_{name}.png", f"{caption} {FITTED}", rows=rows, columns=2, size=size) as panels:
            for index, (panel, title) in enumerate(zip(panels, titles, strict=True)):
                curves = [
                    (f"{c:.0f} N s/m", responses_of_road[index], color, style)
                    for (c, responses_of_road), color, style in zip(responses.items(), COLOURS, STYLES, strict=False)
                ]
                label = f"transmissibility {'[rad/m]' if title == 'pitch' else '[m/m]'}"
                lines(panel, frequency, curves, xlabel="frequency [Hz]", ylabel=label, title=title)
                panel.set_ylim(bottom=0.0)
                panel.set_xlim(0.0, 15.0 * rows)


def optimum_figure(folder: Path, road_holding: dict[str, RoadHolding], road: str) -> None:
    """Draw figures 9 and 10: load fluctuation over damping, by the printed and the physical measure."""
    caption = (
        f"Road: {road}. Left: R as printed, the sum of magnitudes of band amplitudes. Right: RMS of the tyre force "
        f"over the static load. Dots: optima. {FITTED}"
    )
    with chart(folder / f"figure_09_10_{road}.png", caption, columns=2, size=(11.0, 4.8)) as panels:
        for panel, (measure, result) in zip(panels, road_holding.items(), strict=True):
            curves = [
                ("quarter car", result.quarter, COLOURS[0], "-"),
                ("half car front, equal dampers", result.equal[0], COLOURS[1], "--"),
                ("half car rear, equal dampers", result.equal[1], COLOURS[2], "-."),
            ]
            label = "R as printed [-]" if measure == "printed" else "RMS tyre force / static load [-]"
            lines(panel, result.damping, curves, xlabel="damping [N s/m]", ylabel=label, title=f"{measure} measure")
            for best, color in zip((result.quarter_optimum, *result.equal_optima), COLOURS, strict=False):
                panel.plot(best.damping, best.value, "o", color=color, markersize=5)
            panel.set_ylim(bottom=0.0)


def iteration_figure(folder: Path, road_holding: RoadHolding, measure: Fluctuation) -> None:
    """Draw figures 11 to 13: fluctuation at one end over the damping at this end, with the other damping constant."""
    caption = (
        "Half car on the highway, R as printed. Each panel is one step: the damper of one end varied, the other held; "
        f"dots at the best multiple of 250 N s/m. {FITTED}"
    )
    with chart(folder / "figure_11_12_13_iteration.png", caption, columns=3, size=(14.0, 4.8)) as panels:
        held = {"front": float("nan"), "rear": START_REAR}
        for panel, step, number in zip(panels, road_holding.read_off[:3], (11, 12, 13), strict=True):
            end = ENDS.index(step.changed)
            other = ENDS[1 - end]
            pairs = ({**held, step.changed: float(c)} for c in READ_OFF)
            values = [float(measure(pair["front"], pair["rear"])[end]) for pair in pairs]
            title = f"figure {number}: {other} held at {held[other]:.0f} N s/m"
            curve = (step.changed, values, COLOURS[1 + end], "-")
            lines(panel, READ_OFF, [curve], xlabel=f"{step.changed} damping [N s/m]", ylabel="R [-]", title=title)
            panel.plot(step.damping, step.fluctuation[end], "o", color=COLOURS[1 + end], markersize=5)
            panel.set_ylim(bottom=0.0)
            held[step.changed] = step.damping


def trade_off_figure(path: Path, trade_off: TradeOff, name: str) -> None:
    """Draw the three measures over damping, and comfort against road holding."""
    from matplotlib import colormaps

    caption = (
        f"{name} on roads of ISO 8608, classes A to H, {3.6 * SPEED:.0f} km/h, linear model: every class doubles all "
        "values. Ring: the car's own damper; square: least tyre load; triangle: best comfort. Above the dashed line "
        "(1/3 of the static load) the tyre leaves the road now and then and the linear values no longer hold."
    )
    colors = colormaps["viridis"](np.linspace(0.0, 0.9, len(trade_off.measures)))
    quantities = (
        ("tyre_load", 1.0, "RMS tyre force / static load [-]"),
        ("acceleration", 1.0, "RMS body acceleration, Wk [m/s$^2$]"),
        ("travel", 1e3, "RMS suspension travel [mm]"),
    )
    with chart(path, caption, rows=2, columns=2, size=(12.0, 9.0)) as panels:
        for (road, row), color in zip(trade_off.measures.items(), colors, strict=True):
            values = {
                key: factor * np.array([getattr(measure, key) for measure in row]) for key, factor, _ in quantities
            }
            for panel, (key, _, label) in zip(panels, quantities, strict=False):
                panel.semilogy(trade_off.damping, values[key], color=color, linewidth=1.4)
                panel.set_xlabel("damping [N s/m]")
                panel.set_ylabel(label)
                panel.annotate(road, (trade_off.damping[-1], values[key][-1]), fontsize=9, color=color)
            last = panels[3]
            last.loglog(values["acceleration"], values["tyre_load"], color=color, linewidth=1.4)
            for damping, marker in (
                (trade_off.own, "o"),
                (trade_off.best("tyre_load"), "s"),
                (trade_off.best("acceleration"), "^"),
            ):
                x = np.interp(damping, trade_off.damping, values["acceleration"])
                y = np.interp(damping, trade_off.damping, values["tyre_load"])
                ring = marker == "o"  # stays visible where it coincides with a best one
                size, fill = (9, "none") if ring else (4, "full")
                last.plot(x, y, marker, color=color, markersize=size, fillstyle=fill)
            last.annotate(road, (values["acceleration"][-1], values["tyre_load"][-1]), fontsize=9, color=color)
        for panel in (panels[0], panels[3]):
            panel.axhline(1.0 / 3.0, color="#888888", linestyle="--", linewidth=0.9)
        for panel in panels[:3]:
            panel.axvline(trade_off.own, color="#888888", linestyle=":", linewidth=0.9)
        panels[3].set_xlabel("RMS body acceleration, Wk [m/s$^2$]")
        panels[3].set_ylabel("RMS tyre force / static load [-]")
        panels[3].set_title("comfort against road holding, damping along each curve", fontsize=10)
