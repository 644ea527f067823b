"""Report of a sweep: best and base car, picture, cars in the order of comfort, all runs, and how to repeat it."""

import math
import shlex
from collections.abc import Sequence

import numpy as np
from markupsafe import Markup

from vehicle.digits import number
from vehicle.runs.car import Car
from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import document, head_line
from vehicle.runs.report.svg_figure import drawing
from vehicle.signals.analysis.ride_comfort import MEANING, SEAT_VALUE, UNWEIGHTED, WEIGHTED
from vehicle.studies.sweeps.case import parameter_cells
from vehicle.studies.sweeps.case_file import CaseResults
from vehicle.studies.sweeps.effects import Effects, effect_sentence
from vehicle.studies.sweeps.sweep_picture import can_be_drawn, draw_ranked
from vehicle.studies.sweeps.sweep_ranking import RankedCars, SweptCases, ranked_cars

fill = templates(__file__)

MOST_ROWS = 2000
"""Maximum number of runs in the table of all runs; `table.csv` has all."""


def sweep_page(
    table: SweptCases,
    name: str,
    *,
    caption: str,
    command: str = "",
    notes: Sequence[str] = (),
    effects: Effects | None = None,
    results: CaseResults | None = None,
    author: str = "",
    project: str = "",
) -> str:
    """Return the report of a sweep as one HTML document.

    Args:
        table: table of the sweep.
        name: name of the car.
        caption: tyres and evaluated span.
        command: command line that made the sweep; empty for a sweep in Python.
        notes: messages on side effects of the varied parameters and on the engine.
        results: results of the cases of a file; then no ranking of the cars.
        effects: effects of single parameters; then no ranking of the cars.
        author, project: names in the head of the page; may be empty.
    """
    cars = ranked_cars(table) if effects is None and results is None else None
    parts: list[tuple[str, str, Markup]] = []
    if cars is not None:
        parts += [("Result", "result", _result(cars, caption, notes)), ("Cars", "cars", _cars(cars))]
    if effects is not None:
        parts.append(("Result", "result", _effects(effects, caption, notes)))
    elif results is not None:
        parts.append(("Result", "result", fill("cases", results=results, notes=notes)))
    if effects is None:
        parts.append(("All runs", "runs", _runs(table)))
    parts.append(("How to repeat the sweep", "repeat", _repeating(cars, table, command)))
    inputs = ", ".join(str(source) for source in table.made.get("inputs", {}))
    counts = f"{len(table.cases)} runs, {len(table.failed)} failed"
    head = f"{name} on {inputs}; {counts}; {caption}"
    return document(f"Sweep of {name}", (head, head_line(author, project)), parts)


def best_sentences(cars: RankedCars) -> list[str]:
    """Return sentences that name the most comfortable car and the base car with their comfort."""
    names = f"{cars.prefix}{WEIGHTED}", f"{cars.prefix}{UNWEIGHTED}"

    def values(car: int) -> str:
        return f"{names[0]} {cars.weighted[car]:.4g} m/s², {names[1]} {cars.unweighted[car]:.4g} m/s²"

    def parameters(car: int) -> str:
        return ", ".join(f"{path} = {cell}" for path, cell in zip(cars.paths, cars.cells[car], strict=True))

    base = f"Base car, the first of the sweep: {parameters(0)}: {values(0)}."
    if states := cars.state_sentences():
        return [*(f"{text[0].upper()}{text[1:]}." for text in states), base]
    if cars.alike and len(cars.order) > 1:
        return [f"All {len(cars.order)} cars are equally comfortable: the varied parameters have no effect here.", base]
    if cars.best == 0:
        return [f"The base car is the most comfortable of {len(cars.order)} cars.", base]
    text = cars.change_text(cars.best).replace("+-", "±")
    against = f", {text} % against the base car{cars.doubt}" if math.isfinite(cars.change(cars.best)) else ""
    return [f"Most comfortable of {len(cars.order)} cars: {parameters(cars.best)}: {values(cars.best)}{against}.", base]


def _result(cars: RankedCars, caption: str, notes: Sequence[str]) -> Markup:
    figure = Markup()
    if can_be_drawn(cars):
        figure = drawing(lambda path: draw_ranked(path, cars, caption), "Comfort over the varied parameters")
    definitions = [f"{cars.prefix}{name}: {MEANING[name]}" for name in (WEIGHTED, UNWEIGHTED)]
    sentences = best_sentences(cars)
    return fill("result", sentences=sentences, notes=notes, figure=figure, definitions=definitions, cars=cars)


def _effects(effects: Effects, caption: str, notes: Sequence[str]) -> Markup:
    figure = drawing(lambda path: effects.write_picture(path, caption), "Changes of comfort by single parameters")
    heads = ["parameter", "unit", "value", "low", "high", "change at low [%]", "change at high [%]", "± 95 % [%]"]
    rows = []
    for each in effects.effects:
        changes = (
            f"{change:+.2f}" if math.isfinite(change) else "failed" for change in (each.change_low, each.change_high)
        )
        width = number(each.half_width if math.isfinite(each.half_width) else None, 2)
        width = ", ".join(filter(None, (width, each.mark.replace("+-", "±"))))
        rows.append(
            (each.path, each.unit, *(number(value, 4) for value in (each.value, each.low, each.high)), *changes, width)
        )
    sentence = effect_sentence(effects)
    return fill("effects", sentence=sentence, notes=notes, figure=figure, heads=heads, rows=rows, effects=effects)


def _cars(cars: RankedCars) -> Markup:
    heads = cars.headings()
    count = len(heads)
    with_errors = bool(np.any(cars.half_width > 0.0))
    heads += [f"{cars.prefix}{WEIGHTED} [m/s²]", "change [%]", *(["± 95 % [%]"] if with_errors else [])]
    heads += [f"{cars.prefix}{UNWEIGHTED} [m/s²]"]
    heads += [] if cars.seat_value is None else [f"{SEAT_VALUE} [-]"]
    rows = []
    for car in cars.order:
        change = cars.change(car)
        rows.append(
            [
                *cars.cells[car],
                number(cars.weighted[car], 4),
                "base" if car == 0 else f"{change:+.2f}" if math.isfinite(change) else "–",
                *([number(cars.half_width[car] or None, 2).replace("nan", "–")] if with_errors else []),
                number(cars.unweighted[car], 4),
                *([] if cars.seat_value is None else [number(cars.seat_value[car], 4)]),
            ]
        )
    return fill("cars", heads=heads, rows=rows, parameters=count)


def _runs(results: SweptCases) -> Markup:
    paths = results.paths()
    heads = ["input", *paths, *(f"{name} [{unit}]" for name, unit in results.units.items()), "engine"]
    rows: list[list[str]] = []
    for case, row in zip(results.cases, results.rows(), strict=True):
        if len(rows) == MOST_ROWS:
            break
        values = [float(row["values"].get(name, math.nan)) for name in results.units]
        cells = [number(value if math.isfinite(value) else None, 4) for value in values]
        rows.append([case.source.name, *parameter_cells(case, paths), *cells, row["engine"]])
    return fill("runs", heads=heads, rows=rows, runs=len(results.cases), parameters=len(paths), failed=results.failed)


def _repeating(cars: RankedCars | None, results: SweptCases, command: str) -> Markup:
    best = ""
    if cars is not None and cars.paths and not cars.state_sentences():
        first, cells = results.cases[0], cars.cells[cars.best]
        settings = [f"{path}={cell}" for path, cell in zip(cars.paths, cells, strict=True)]
        base = Car.load(first.vehicle, first.overrides[: first.shared])
        best = " ".join(f"--set {shlex.quote(text)}" for text in base.with_(settings).overrides[first.shared :])
    engines = ", ".join(results.made.get("engines_asked", ()))
    program = results.made.get("program", "")
    return fill("repeat_sweep", command=command, best=best, engines=engines, program=program)
