"""Data of a car as tables of text, for the console and for the report."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from vehicle.model.parameters.parameter_list import Parameter, value_text
from vehicle.names import point_words
from vehicle.runs.car.car_data import CarData
from vehicle.runs.car.motion_figures import MINIMUM_SHARE, MotionFigure
from vehicle.runs.car.steady_data import SteadyData
from vehicle.runs.car.usual_figures import axle_figures, car_figures, motion_values, usual_figures, usual_range

SOURCE_WIDTH = 60
"""Maximum number of letters of a source in the table of parameters."""


@dataclass(frozen=True, kw_only=True, slots=True)
class TextTable:
    """Table of text cells; `heads` may be empty."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Aligned columns: the first to the left, further ones to the right if there is a head."""
        lines = [row for row in (self.heads, *self.rows) if row]
        widths = [max(len(row[column]) for row in lines) for column in range(len(lines[0]))]
        aligned = []
        for row in lines:
            cells = [row[0].ljust(widths[0])]
            cells += [
                cell.rjust(width) if self.heads else cell for cell, width in zip(row[1:], widths[1:], strict=True)
            ]
            aligned.append("  ".join(cells).rstrip())
        return "\n".join([*aligned, *self.notes])


def number(value: float | None, decimals: int = 0) -> str:
    """Return a number with a number of decimals; a dash for a quantity that is not defined."""
    return "-" if value is None or not math.isfinite(value) else f"{value:z.{decimals}f}"


SUPPORT_NOTE = (
    "anti-dive, anti-lift and anti-squat: for an axle that takes the whole brake or drive force; with the "
    "shares of the axles: --acceleration -3"
)


FIGURES_NOTE = (
    "figure: simple estimate for this motion alone, from masses and rates, dampers at 0.1 m/s; modes with it: "
    f"modes of the whole car with at least {100.0 * MINIMUM_SHARE:.0f} % of their kinetic energy in this motion"
)


def car_tables(data: CarData) -> list[TextTable]:
    """Return the tables of a car: the whole car, its steady acceleration if it has one, its figures with their usual
    ranges, its axles, its headline figures.
    """
    steady = [] if data.steady is None else [_steady(data.steady)]
    return [_whole_car(data), *steady, _usual(data), _axles(data), figures_table(data.figures, data.mass_kg)]


def car_text(data: CarData) -> str:
    """Return all values of a car but its parameters as text."""
    changes = f"; {'; '.join(data.overrides)}" if data.overrides else ""
    first = f"{data.name}, tyres {data.tyres}{changes}"
    notes = [f"note: {note}" for note in data.notes]
    return "\n".join([first, *(f"\n{table}" for table in car_tables(data)), *(["", *notes] if notes else [])])


def _whole_car(data: CarData) -> TextTable:
    x, y, z = data.cog_m
    ixx, iyy, izz, izx = data.inertia_kg_m2
    loads = sum(sum(axle.load_n.values()) for axle in data.axles)
    rows = [
        (
            "mass",
            f"{data.mass_kg:.1f} kg: sprung {data.sprung_kg:.1f}, unsprung {data.unsprung_kg:.1f}; "
            f"trimmed body {data.trimmed_body_kg:g}",
        ),
        (
            "CoG",
            f"{1e3 * data.cog_behind_front_m:.0f} mm behind the {data.axles[0].name} wheels, {1e3 * y:z.0f} mm to the "
            f"right, {1e3 * data.cog_height_m:.0f} mm above the ground; x {x:.4f}, y {y:z.4f}, z {z:.4f} m",
        ),
        ("load", _load_words(data)),
        ("inertia", f"Ixx {ixx:.1f}, Iyy {iyy:.1f}, Izz {izz:.1f}, integral of z x {izx:.1f} kg m2, about the CoG"),
    ]
    if data.wheelbase_m is not None:
        rows.append(("wheelbase", f"{1e3 * data.wheelbase_m:.0f} mm"))
    if loads:
        parts = [f"{axle.name} {sum(axle.load_n.values()):.0f} N" for axle in data.axles]
        parts += [f"{point_words(name)} {load:.0f} N" for name, load in data.support_n.items()]
        rows.append(("static loads", f"{', '.join(parts)}; {100 * data.front_share:.1f} % on {data.axles[0].name}"))
    return TextTable(title="Car", heads=(), rows=tuple(rows))


def _load_words(data: CarData) -> str:
    """Return persons and luggage on board; for an empty car how to add a driver."""
    if data.loads_kg:
        return ", ".join(f"{name} {mass:g} kg" for name, mass in data.loads_kg.items())
    at = "seat" if any(parameter.path == "hardpoints.seat" for parameter in data.parameters) else "[X,Y,Z]"
    return f"none: no driver, passenger or luggage; --set load.driver.mass=75 --set load.driver.at={at} adds a driver"


def _usual(data: CarData) -> TextTable:
    """Return the figures of the whole car; below them a note on each figure of car or axle outside its usual range."""
    rows = tuple((figure.name, figure.value_text, figure.range_text) for figure in car_figures(data))
    notes = tuple(f"! {figure}" for figure in usual_figures(data) if figure.unusual)
    return TextTable(title="Figures", heads=("whole car", "value", "usual"), rows=rows, notes=notes)


def _axles(data: CarData) -> TextTable:
    loads = [" / ".join(number(load) for load in axle.load_n.values()) for axle in data.axles]
    rows = [
        ("template", *(axle.template for axle in data.axles), ""),
        ("static wheel load, right / left [N]", *loads, ""),
    ]
    for row in axle_figures(data):
        ranges = list(dict.fromkeys(figure.range_text for figure in row))
        rows.append((row[0].name, *(figure.value_text for figure in row), "; ".join(ranges)))
    heads = ("axle (values of a single wheel: right)", *(axle.name for axle in data.axles), "usual")
    notes = (SUPPORT_NOTE,) if data.wheelbase_m is not None else ()
    return TextTable(title="Axles", heads=heads, rows=tuple(rows), notes=notes)


def _steady(steady: SteadyData) -> TextTable:
    rows = tuple(
        (
            wheel.name,
            number(wheel.load_n),
            number(wheel.load_change_n),
            number(1e3 * wheel.travel_m, 1),
            number(wheel.along_n),
            number(wheel.across_n),
            number(wheel.friction, 2),
        )
        for wheel in steady.wheels
    )
    supports = [
        f"support by the linkage of {axle.name}: {number(axle.percent, 1)} % of the load transfer, "
        f"{number(1e3 * axle.travel_m, 1)} mm of travel"
        for axle in steady.supports
    ]
    heads = ("wheel", "load [N]", "change [N]", "travel [mm]", "along [N]", "across [N]", "friction [-]")
    pitch, roll = (number(angle, 2) for angle in (steady.pitch_deg, steady.roll_deg))
    notes = (
        f"in steady acceleration: {steady.acceleration:g} m/s2 forwards, {steady.lateral:g} m/s2 to the left; pitch "
        f"{pitch} deg (nose down +), roll {roll} deg (right side down +)",
        *supports,
        *([STEADY_NOTE] if supports else []),
    )
    return TextTable(title="Steady acceleration", heads=heads, rows=rows, notes=notes)


STEADY_NOTE = (
    "support: anti-dive in front and anti-lift in the rear while braking, anti-lift in front and anti-squat in the "
    "rear while driving; travel: compression +"
)


def figures_table(figures: Sequence[MotionFigure], mass: float) -> TextTable:
    """Return the table of headline figures of a car of a mass [kg], with the modes that share their motions."""
    by_state = {(figure.motion, figure.dampers): figure for figure in figures}
    motions, states = (tuple(dict.fromkeys(key)) for key in zip(*by_state, strict=True))
    rows = []
    for motion in motions:
        cells = []
        for state in states:
            figure = by_state[motion, state]
            frequency, ratio = motion_values(figure, mass)
            modes = [f"{number(mode.frequency_hz, 2)} ({number(100.0 * mode.share)} %)" for mode in figure.modes]
            cells += [frequency.value_text, ratio.value_text, ", ".join(modes) or "-"]
        rows.append((motion, *cells, usual_range(motion, mass)))
    heads = (
        ("sliding [Hz]", "damping at 0.1 m/s [%]") if state == "sliding" else ("stuck [Hz]", "damping [%]")
        for state in states
    )
    return TextTable(
        title=f"Key figures, dampers {' and '.join(states)}",
        heads=(
            "figure",
            *(word for head in heads for word in (*head, "modes with it [Hz] (share)")),
            "usual, sliding [Hz]; [%]",
        ),
        rows=tuple(rows),
        notes=(FIGURES_NOTE,),
    )


def parameter_table(parameters: Sequence[Parameter], *, shortened: bool = True) -> TextTable:
    """Return the table of parameters.

    Args:
        shortened: True to cut long values and sources to the width of a screen.
    """

    def cut(text: str, width: int) -> str:
        return text if not shortened or len(text) <= width else text[: width - 4] + " ..."

    rows = tuple(
        (
            entry.path,
            cut(value_text(entry.value), 28),
            entry.unit,
            cut(entry.range, 28),
            cut(entry.source, SOURCE_WIDTH),
        )
        for entry in parameters
    )
    return TextTable(title="Parameters", heads=("parameter", "value", "unit", "range", "source"), rows=rows)
