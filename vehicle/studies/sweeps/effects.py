"""Effects of single parameters on comfort, ranked: table, text, chart and file."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import aligned, decimals, number
from vehicle.drawing.rendering.tornado_plot import draw_tornado, plot_tornado
from vehicle.runs.report.differences import parameter_words
from vehicle.signals.formats.csv_table import RowWriter
from vehicle.studies.sweeps.change_error import MEANING_OF_ERROR, NO_ERROR, UNKNOWN_ERROR
from vehicle.studies.sweeps.evaluation import REPEAT, Evaluation, Part
from vehicle.studies.sweeps.sweep_ranking import RANKED_BY

EFFECTS, TORNADO = "effects.csv", "effects.png"
"""Names of the files in the folder of a sweep."""

MOST_SHOWN = 12
"""Maximum number of parameters on the console and in the picture."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Effect:
    """Effect of a parameter on comfort.

    Attributes:
        path: path of the parameter.
        unit: its unit.
        value: value of the car.
        low, high: changed values.
        step: size of the change as text, "20 %", or "10 mm" for a coordinate.
        change_low, change_high: change of the weighted comfort value at them [%]; NaN for a failed run or no value.
        half_width: half width of the 95 % interval of a change on roads of the class [%], the larger of both; NaN
            without one.
    """

    path: str
    unit: str
    value: float
    low: float
    high: float
    step: str
    change_low: float
    change_high: float
    half_width: float

    @property
    def ends(self) -> tuple[str, str]:
        """Names of the low and of the high value, for example "-20 %" and "+20 %"."""
        return f"-{self.step}", f"+{self.step}"

    @property
    def mark(self) -> str:
        """Words for an effect without a clear direction: within its error, or equal signs at both ends; or empty."""
        if self.largest <= self.half_width:
            return "within +-"
        return "same sign" if self.change_low * self.change_high > 0.0 else ""

    def is_apart(self, other: Effect) -> bool:
        """Return True if the ranks of two effects are decided: they differ by more than sqrt(half_width^2 of both).

        Without half widths, on one event, every difference decides.
        """
        widths = np.nan_to_num([self.half_width, other.half_width])
        return abs(self.largest - other.largest) > math.hypot(*widths)

    @property
    def largest(self) -> float:
        """Larger change of comfort [%]; 0 if both runs failed."""
        return max(
            (abs(change) for change in (self.change_low, self.change_high) if math.isfinite(change)), default=0.0
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Effects:
    """Effects of all varied parameters, the largest first.

    Attributes:
        effects: effects, sorted.
        name: figure, for example "weighted".
        base: value of the unchanged car, mean over the inputs.
        without: parameters without effect.
        unit: unit of the figure.
        inputs: number of inputs.
        event: True if all inputs are single events.
    """

    effects: tuple[Effect, ...]
    name: str
    base: float
    without: tuple[str, ...]
    unit: str = "m/s2"
    inputs: int = 1
    event: bool = False

    @property
    def of_comfort(self) -> bool:
        """Return True if the figure is comfort."""
        return self.name in RANKED_BY

    def __str__(self) -> str:
        """Return the printed table and the result in words."""
        return "\n".join(effect_lines(self))

    def __repr__(self) -> str:
        """Return the parameters with the largest effects in a line."""
        first = ", ".join(f"{each.path} {number(each.largest, 2)} %" for each in self.effects[:3])
        return f"Effects({len(self.effects)} parameters, {self.name} {self.base:.4g} {self.unit}: {first})"

    def plot(self, ax: Any = None) -> Any:
        """Draw the tornado chart and return its axes.

        Args:
            ax: axes; a new figure by default.
        """
        from vehicle.drawing.rendering.open_axes import open_axes

        axes = open_axes(ax, (8.0, 1.2 + 0.36 * len(self.shown))).item()
        draw_tornado(axes, *self.bars)
        return axes

    def write_picture(self, path: Path, caption: str = "") -> None:
        """Write the tornado chart.

        Args:
            path: PNG or SVG file.
            caption: tyres and evaluated span.
        """
        value = (
            f"Comfort, {self.base:.3g} m/s2 weighted"
            if self.of_comfort
            else f"{self.name}, {self.base:.3g} {self.unit}"
        )
        title = f"{value}: changes by single parameters"
        plot_tornado(path, *self.bars, title=title, caption=caption)

    @property
    def error_words(self) -> str:
        """Meaning of the half widths, or the reason why an event has no error."""
        if any(math.isfinite(each.half_width) for each in self.effects):
            return MEANING_OF_ERROR
        return NO_ERROR if self.event or self.of_comfort else UNKNOWN_ERROR

    @property
    def shown(self) -> tuple[Effect, ...]:
        """Effects in table and picture."""
        return self.effects[:MOST_SHOWN]

    @property
    def bars(self) -> tuple[list[str], Vector, Vector, list[tuple[str, str]]]:
        """Labels, changes at low and high value [%], (bars, 2), half widths [%], (bars,), and names of their ends."""
        labels = [f"{parameter_words(each.path)}  {number(each.value)} {each.unit}" for each in self.shown]
        changes = np.array([(each.change_low, each.change_high) for each in self.shown])
        widths = np.array([each.half_width for each in self.shown])
        return labels, changes, widths, [each.ends for each in self.shown]


def effect_lines(effects: Effects) -> list[str]:
    """Return the lines of the table of the largest effects, and the result in words."""
    marked = any(each.mark for each in effects.shown)
    steps = {each.step for each in effects.shown}
    # Where coordinates are among the parameters, each row has its own step.
    ends = effects.shown[0].ends if len(steps) == 1 else ("step", "down", "up")
    heads = ["parameter", "value", *ends, "+-", *([""] if marked else [])]
    rows = [
        [
            each.path,
            f"{number(each.value, 4)} {each.unit}",
            *([each.step] if len(steps) > 1 else []),
            *(
                f"{change:+.{decimals(each.half_width)}f} %" if math.isfinite(change) else "no value"
                for change in (each.change_low, each.change_high)
            ),
            f"{each.half_width:.{decimals(each.half_width)}f}" if math.isfinite(each.half_width) else "-",
            *([each.mark] if marked else []),
        ]
        for each in effects.shown
    ]
    lines = aligned([heads, *rows])
    if len(effects.effects) > len(rows):
        lines.append(f"{len(effects.effects) - len(rows)} more parameters with smaller effects: see {EFFECTS}")
    over = f", mean of {effects.inputs} inputs" if effects.inputs > 1 else ""
    base = f"(unchanged car: {effects.base:.4g} {effects.unit.strip('-')}".rstrip() + ")"
    lines.append(f"change in {effects.name!r} {base}{over}; {effects.error_words}")
    if count := len(effects.without):
        shown = ", ".join(effects.without[:3]) + (" ..." if count > 3 else "")
        lines.append(f"no effect here: {count} parameter{'s' if count > 1 else ''} ({shown})")
    return [*lines, effect_sentence(effects)]


def effect_sentence(effects: Effects) -> str:
    """Return text with the parameters of largest effect."""
    if not effects.effects:
        return f"No varied parameter changes {'the comfort' if effects.of_comfort else effects.name} here."
    first, *others = effects.effects
    if math.isfinite(first.half_width) and first.largest <= first.half_width:
        return "No effect exceeds its error: use a longer road or a larger change."
    turns = [
        f"{end} makes the ride {number(abs(change), 2)} % {'rougher' if change > 0.0 else 'smoother'}"
        if effects.of_comfort
        else f"{end} {'raises' if change > 0.0 else 'lowers'} {effects.name} by {number(abs(change), 2)} %"
        for end, change in zip(first.ends, (first.change_low, first.change_high), strict=True)
        if math.isfinite(change)
    ]
    if not turns:
        return f"No changed car has a value of {effects.name}: see the reasons in table.csv."
    following = [each for each in others[:2] if not each.largest <= each.half_width]
    text = f"{first.path} matters most: {', '.join(turns)}"
    if following:
        text += f"; next come{'s' if len(following) == 1 else ''} {' and '.join(each.path for each in following)}"
    named = (first, *following)
    # A parameter that is not named counts too: it may be before a named one.
    unsure = [each.path for each in named if not all(each.is_apart(o) for o in effects.effects if o is not each)]
    if unsure:
        plural = "s" if len(unsure) > 1 else ""
        text += f"; the rank{plural} of {' and '.join(unsure)} may change: other effects differ by less than the errors"
    return f"{text}."


def write_effects(path: Path, effects: Effects) -> None:
    """Write a row for each parameter, the largest effect first, then those without effect."""
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = RowWriter(file)
        heads = ("value", "low", "high", "change_low [%]", "change_high [%]", "half_width_95 [%]")
        rows.writerow(["parameter", "unit", *heads])
        for each in effects.effects:
            numbers = (each.value, each.low, each.high, each.change_low, each.change_high, each.half_width)
            rows.writerow(
                [each.path, each.unit, *(f"{value:.6g}" if math.isfinite(value) else "" for value in numbers)]
            )
        for each_path in effects.without:
            rows.writerow([each_path, *[""] * 4, "0", "0", ""])


def effects_evaluation(effects: Effects, caption: str) -> Evaluation:
    """Return the evaluation of a sweep over single changes; `caption` names tyres and evaluated span."""
    draw = partial(effects.write_picture, caption=caption)
    files = {EFFECTS: partial(write_effects, effects=effects), TORNADO: draw}
    return Evaluation(effect_lines(effects), files, partial(_parts, effects, draw))


def _parts(effects: Effects, draw: Callable[[Path], object], notes: Sequence[str]) -> list[Part]:
    """Return the part of the report with the chart and all effects."""
    heads = ["parameter", "path", "unit", "value", "low", "high"]
    heads += ["change at low [%]", "change at high [%]", "± 95 % [%]"]
    rows = []
    for each in effects.effects:
        changes = (
            f"{change:+.2f}" if math.isfinite(change) else "no value" for change in (each.change_low, each.change_high)
        )
        width = number(each.half_width if math.isfinite(each.half_width) else None, 2)
        width = ", ".join(filter(None, (width, each.mark.replace("+-", "±"))))
        values = (number(value, 4) for value in (each.value, each.low, each.high))
        rows.append((parameter_words(each.path), each.path, each.unit, *values, *changes, width))
    contents = {"sentence": effect_sentence(effects), "notes": notes, "heads": heads, "rows": rows, "effects": effects}
    return [Part("Result", "result", "effects", contents, draw, "Changes by single parameters"), REPEAT]
