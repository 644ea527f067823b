"""Effects of single parameters on comfort: each is changed alone, down and up, and ranked by its effect.

All cars drive on the same road, so a change has a far smaller error than the comfort values themselves
(`vehicle.signals.analysis.comfort_error`); it is that of the unweighted RMS, relative to it.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.special import stdtrit

from vehicle.digits import number
from vehicle.drawing.rendering.tornado_plot import draw_tornado
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.parameter_list import parameter_list
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.comfort_error import WAVES, difference_error
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WAVE_NAMES
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sweep import Progress
from vehicle.studies.sweeps.sweep_inputs import Source
from vehicle.studies.sweeps.sweep_ranking import RANKED_BY, ROUNDING
from vehicle.studies.sweeps.sweep_table import SweepTable

EFFECTS, TORNADO = "effects.csv", "effects.png"
"""Names of the files in the folder of a sweep."""

UNITS = ("N/m", "N s/m", "N", "N m/rad", "N/rad", "kg")
"""Units of the parameters that are varied by default: stiffness, damping, friction and mass of a law or a part."""

LEFT_OUT = ("gravity", "smoothing")
"""Last keys of parameters that are never varied by default: they belong to the computation."""

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
        change_low, change_high: change of the weighted comfort value at them [%]; NaN for a failed run.
        half_width: half width of the 95 % interval of a change on roads of the class [%], the larger of both; NaN
            without one.
    """

    path: str
    unit: str
    value: float
    low: float
    high: float
    change_low: float
    change_high: float
    half_width: float

    @property
    def largest(self) -> float:
        """Largest change of both [%]; 0 if both runs failed."""
        return max(
            (abs(change) for change in (self.change_low, self.change_high) if math.isfinite(change)), default=0.0
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Effects:
    """Effects of all varied parameters, the largest first.

    Attributes:
        effects: effects, sorted.
        name: comfort value, as "weighted".
        base: comfort value of the unchanged car, mean over the inputs [m/s2].
        share: relative change of each parameter [-].
        without: parameters without effect.
    """

    effects: tuple[Effect, ...]
    name: str
    base: float
    share: float
    without: tuple[str, ...]

    def __str__(self) -> str:
        """Return table and sentence, as the console shows them."""
        return "\n".join(effect_lines(self))

    def __repr__(self) -> str:
        """Return the parameters with the largest effects in a line."""
        first = ", ".join(f"{each.path} {each.largest:.2g} %" for each in self.effects[:3])
        return f"Effects({len(self.effects)} parameters, {self.name} {self.base:.4g} m/s2: {first})"

    def plot(self, ax: Any = None) -> Any:
        """Draw the tornado chart and return its axes.

        Args:
            ax: axes; a new figure by default.
        """
        from vehicle.drawing.rendering.open_axes import open_axes

        axes = open_axes(ax, (8.0, 1.2 + 0.36 * len(self.shown))).item()
        draw_tornado(axes, *self.bars)
        return axes

    @property
    def shown(self) -> tuple[Effect, ...]:
        """Effects in table and picture."""
        return self.effects[:MOST_SHOWN]

    @property
    def bars(self) -> tuple[list[str], npt.NDArray[np.float64], npt.NDArray[np.float64], tuple[str, str]]:
        """Labels, changes at low and high value [%], (bars, 2), half widths [%], (bars,), and names of both ends."""
        labels = [f"{each.path}  {number(each.value)} {each.unit}" for each in self.shown]
        changes = np.array([(each.change_low, each.change_high) for each in self.shown])
        percent = number(100.0 * self.share)
        ends = f"parameter -{percent} %", f"parameter +{percent} %"
        return labels, changes, np.array([each.half_width for each in self.shown]), ends


def varied_parameters(vehicle: Vehicle, groups: Sequence[str] = ()) -> dict[str, tuple[float, str]]:
    """Return path to value and unit of the parameters of groups; by default all with a unit of `UNITS`.

    Args:
        vehicle: the car.
        groups: paths, or beginnings of paths, as "front.damper"; or a last key, as "viscous".

    Raises:
        ConfigurationError: a group has no parameter that is a number other than 0.
    """
    numbers: dict[str, tuple[float, str]] = {}
    for each in parameter_list(vehicle, None):
        if isinstance(each.value, int | float) and not isinstance(each.value, bool):
            numbers[each.path] = float(each.value), each.unit
        elif isinstance(each.value, list | tuple) and len(each.value) == len(AXES):
            components = {f"{each.path}.{axis}": part for axis, part in zip(AXES, each.value, strict=True)}
            numbers |= {
                path: (float(part), each.unit) for path, part in components.items() if isinstance(part, int | float)
            }
    nonzero = {path: pair for path, pair in numbers.items() if pair[0] != 0.0}
    if not groups:
        return {
            path: pair for path, pair in nonzero.items() if pair[1] in UNITS and path.rpartition(".")[2] not in LEFT_OUT
        }
    chosen: dict[str, tuple[float, str]] = {}
    for group in groups:
        members = {
            path: pair
            for path, pair in nonzero.items()
            if f"{path}.".startswith(f"{group}.") or path.endswith(f".{group}")
        }
        if not members:
            raise ConfigurationError(
                f"--vary {group}: no parameter that is a number other than 0; `vehicle show --search {group}` lists "
                "the parameters"
            )
        chosen |= members
    return chosen


def single_changes(
    vehicle: Vehicle, parameters: dict[str, tuple[float, str]], share: float
) -> tuple[list[tuple[str, ...]], tuple[str, ...]]:
    """Return the unchanged car and two cars for each parameter with effect, and the parameters without effect.

    Args:
        vehicle: the car.
        parameters: see `varied_parameters`.
        share: relative change of each parameter [-].

    Raises:
        ConfigurationError: a share that is not between 0 and 1, or no parameter has an effect.
    """
    if not 0.0 < share < 1.0:
        raise ConfigurationError(f"--each {100.0 * share:g} %: must be above 0 and below 100 %")
    texts = {path: f"{path}={value!r}" for path, (value, _) in parameters.items()}
    without = tuple(path for path, text in texts.items() if idle_parameters(vehicle, (text,)))
    changes: list[tuple[str, ...]] = [()]
    for path, (value, _) in parameters.items():
        if path not in without:
            changes += [(f"{path}={value * factor!r}",) for factor in (1.0 - share, 1.0 + share)]
    if len(changes) == 1:
        raise ConfigurationError(f"--vary: no parameter has an effect on this car: {', '.join(without)}")
    return changes, without


def parameter_effects(
    car: Car,
    inputs: Source | Sequence[Source],
    *,
    share: float = 0.2,
    groups: Sequence[str] = (),
    engine: str = "auto",
    skip: float | None = None,
    jobs: int = 1,
    folder: Path | None = None,
    progress: Progress | None = None,
) -> Effects:
    """Change each parameter of a car alone, down and up, and rank the parameters by their effect on comfort.

    As `sweep`, a script must call this function below `if __name__ == "__main__":`.

    Args:
        car: car loaded by `Car.load`.
        inputs: files or names of shipped ones, roads, signals; one or several.
        share: relative change of each parameter [-].
        groups: parameters, as "front.damper" or "viscous"; by default all stiffnesses, dampings, friction forces and
            masses.
        engine: as in `Car.run`.
        skip: start of the evaluation [s], as in `sweep`.
        jobs: number of processes; the effects do not depend on it.
        folder: existing folder in which finished rows are stored, for the next call to reuse; None stores no rows.
        progress: called with the finished fraction.

    Returns:
        The effects, largest first; `print` shows a table and a sentence.

    Raises:
        ConfigurationError: a group without parameters, a share out of range, and as in `sweep`.
    """
    parameters = varied_parameters(car.vehicle, groups)
    changes, without = single_changes(car.vehicle, parameters, share)
    plan = plan_sweep(car, changes, inputs, engine=engine, skip=skip)
    table = plan.run(jobs=jobs, folder=folder, progress=progress)
    return effects_of(table, parameters, share, without)


def effects_of(
    table: SweepTable, parameters: dict[str, tuple[float, str]], share: float, without: Sequence[str] = ()
) -> Effects:
    """Return the effects of the parameters of a sweep over `single_changes`, the mean over all inputs.

    Args:
        table: the table.
        parameters: see `varied_parameters`.
        share: relative change of each parameter [-].
        without: parameters without effect, which have no run.
    """
    inputs = len({id(case.source) for case in table.cases})
    name = next(each for each in RANKED_BY if each in table.units)

    def over_inputs(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        # The inputs vary slowest.
        return values.reshape(inputs, -1, *values.shape[1:])

    means = over_inputs(table.column(name)).mean(axis=0)
    rows = np.array(
        [[result.values.get(each, math.nan) for each in (UNWEIGHTED, *WAVE_NAMES)] for result in table.results]
    )
    unweighted, waves = over_inputs(rows[:, 0]), over_inputs(rows[:, 1::2] + 1j * rows[:, 2::2])
    errors = np.sqrt(np.sum(difference_error(waves, waves[:, :1]) ** 2, axis=0)) / inputs
    widths = 100.0 * stdtrit(2 * WAVES * inputs, 0.975) * errors / unweighted[:, 0].mean()
    changes = 100.0 * (means / means[0] - 1.0)
    varied = [path for path in parameters if path not in without]
    effects = []
    for index, path in enumerate(varied):
        value, unit = parameters[path]
        low, high = 1 + 2 * index, 2 + 2 * index
        effects.append(
            Effect(
                path=path, unit=unit, value=value, low=value * (1.0 - share), high=value * (1.0 + share),
                change_low=float(changes[low]), change_high=float(changes[high]),
                half_width=float(max(widths[low], widths[high])),
            )
        )  # fmt: skip
    idle = [each.path for each in effects if each.largest <= 100.0 * ROUNDING]
    ranked = sorted((each for each in effects if each.path not in idle), key=lambda each: -each.largest)
    return Effects(effects=tuple(ranked), name=name, base=float(means[0]), share=share, without=(*without, *idle))


def effect_lines(effects: Effects) -> list[str]:
    """Return the table of the largest effects and the sentence on them."""
    percent = number(100.0 * effects.share)
    heads = ["parameter", "value", f"-{percent} %", f"+{percent} %", "+-"]
    rows = [
        [
            each.path,
            f"{number(each.value, 4)} {each.unit}",
            *(
                f"{change:+.2f} %" if math.isfinite(change) else "failed"
                for change in (each.change_low, each.change_high)
            ),
            f"{each.half_width:.2f}" if math.isfinite(each.half_width) else "-",
        ]
        for each in effects.shown
    ]
    widths = [max(len(row[column]) for row in (heads, *rows)) for column in range(len(heads))]
    lines = [
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in (heads, *rows)
    ]
    if len(effects.effects) > len(rows):
        lines.append(f"and {len(effects.effects) - len(rows)} parameters with smaller effects in {EFFECTS}")
    lines.append(
        f"change of {effects.name!r}, {effects.base:.4g} m/s2 of the unchanged car; +-: half width of the 95 % "
        "interval on roads of this class"
    )
    if effects.without:
        shown = ", ".join(effects.without[:3]) + (" ..." if len(effects.without) > 3 else "")
        lines.append(f"without effect here: {len(effects.without)} parameters ({shown})")
    return [*lines, effect_sentence(effects)]


def effect_sentence(effects: Effects) -> str:
    """Return in one sentence which parameter changes comfort most."""
    if not effects.effects:
        return "No varied parameter changes the comfort here."
    first, *others = effects.effects
    percent = number(100.0 * effects.share)
    if math.isfinite(first.half_width) and first.largest <= first.half_width:
        return "No effect is larger than its error: take a longer road, or a larger change."
    turns = [
        f"{sign}{percent} % makes the ride {abs(change):.2g} % {'rougher' if change > 0.0 else 'smoother'}"
        for sign, change in (("-", first.change_low), ("+", first.change_high))
        if math.isfinite(change)
    ]
    text = f"{first.path} matters most: {', '.join(turns)}"
    return text + (f"; then come {' and '.join(each.path for each in others[:2])}." if others else ".")


def write_effects(path: Path, effects: Effects) -> None:
    """Write a row for each parameter, the largest effect first, then those without effect.

    Args:
        path: CSV file.
        effects: the effects.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        heads = ("value", "low", "high", "change_low [%]", "change_high [%]", "half_width_95 [%]")
        rows.writerow(["parameter", "unit", *heads])
        for each in effects.effects:
            numbers = (each.value, each.low, each.high, each.change_low, each.change_high, each.half_width)
            rows.writerow(
                [each.path, each.unit, *(f"{value:.6g}" if math.isfinite(value) else "" for value in numbers)]
            )
        for each_path in effects.without:
            rows.writerow([each_path, *[""] * 4, "0", "0", ""])
