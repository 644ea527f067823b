"""Evaluation of a sweep over chosen cars: the cars in the order of comfort, their picture and their report."""

import math
import shlex
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from vehicle.digits import number
from vehicle.runs.car import Car
from vehicle.runs.report.differences import parameter_words
from vehicle.signals.analysis.ride_comfort import MEANING, SEAT_VALUE, UNWEIGHTED, WEIGHTED
from vehicle.studies.sweeps.evaluation import REPEAT, Evaluation, Part, runs_part
from vehicle.studies.sweeps.sweep_picture import PICTURE, can_be_drawn, draw_ranked
from vehicle.studies.sweeps.sweep_ranking import RankedCars, SweptCases, measure_lines, ranked_cars, ranking_lines


def ranking_evaluation(table: SweptCases, caption: str) -> Evaluation:
    """Return the evaluation of a sweep over chosen cars.

    Args:
        table: the table; without ranked cars there are no lines.
        caption: tyres and evaluated span.
    """
    cars = ranked_cars(table)
    if cars is None:
        return Evaluation([], parts=lambda notes: [runs_part(table), REPEAT])
    drawn = partial(draw_ranked, cars=cars, caption=caption) if can_be_drawn(cars) else None

    def parts(notes: Sequence[str]) -> list[Part]:
        definitions = [f"{cars.prefix}{name}: {MEANING[name]}" for name in (WEIGHTED, UNWEIGHTED)]
        values = {"sentences": best_sentences(cars), "notes": notes, "definitions": definitions, "cars": cars}
        result = Part("Result", "result", "result", values, drawn, "Comfort over the varied parameters")
        return [result, _cars_part(cars), runs_part(table), replace(REPEAT, values={"best": _best(cars, table)})]

    return Evaluation(ranking_lines(cars), {} if drawn is None else {PICTURE: drawn}, parts)


def measured_evaluation(table: SweptCases, caption: str) -> Evaluation:
    """Return the evaluation of a sweep over chosen cars with another measure than comfort: the values of the runs."""
    return Evaluation(measure_lines(table), parts=lambda notes: [runs_part(table), REPEAT])


def _best(cars: RankedCars, table: SweptCases) -> str:
    """Return the options of the most comfortable car; empty if states of the car vary, which are no design choice."""
    if not cars.paths or cars.state_sentences():
        return ""
    first, cells = table.cases[0], cars.cells[cars.best]
    settings = [f"{path}={cell}" for path, cell in zip(cars.paths, cells, strict=True)]
    base = Car.load(first.vehicle, first.overrides[: first.shared])
    return " ".join(f"--set {shlex.quote(text)}" for text in base.with_(settings).overrides[first.shared :])


def best_sentences(cars: RankedCars) -> list[str]:
    """Return sentences that name the most comfortable car and the base car with their comfort."""
    names = f"{cars.prefix}{WEIGHTED}", f"{cars.prefix}{UNWEIGHTED}"

    def values(car: int) -> str:
        return f"{names[0]} {cars.weighted[car]:.4g} m/s², {names[1]} {cars.unweighted[car]:.4g} m/s²"

    def parameters(car: int) -> str:
        names = map(parameter_words, cars.paths)
        return ", ".join(f"{name} = {cell}" for name, cell in zip(names, cars.cells[car], strict=True))

    base = f"Base car (first of the sweep): {parameters(0)}; {values(0)}."
    if states := cars.state_sentences():
        return [*(f"{text[0].upper()}{text[1:]}." for text in states), base]
    if cars.alike and len(cars.order) > 1:
        return [f"All {len(cars.order)} cars are equally comfortable: the varied parameters have no effect here.", base]
    if cars.best == 0:
        return [f"The base car is the most comfortable of {len(cars.order)} cars.", base]
    text = cars.change_text(cars.best).replace("+-", "±")
    against = f", {text} % from the base car{cars.doubt}" if math.isfinite(cars.change(cars.best)) else ""
    return [f"Most comfortable of {len(cars.order)} cars: {parameters(cars.best)}; {values(cars.best)}{against}.", base]


def _cars_part(cars: RankedCars) -> Part:
    heads = cars.headings(lambda path: f"{parameter_words(path)} ({path})")
    count = len(heads)
    with_errors = bool(np.any(cars.half_width > 0.0))
    heads += [f"{cars.prefix}{WEIGHTED} [m/s²]", "change [%]", *(["± 95 % [%]"] if with_errors else [])]
    heads += [f"{cars.prefix}{UNWEIGHTED} [m/s²]"]
    heads += [] if cars.seat_value is None else [f"{SEAT_VALUE} [-]"]
    rows = []
    for car in cars.order:
        rows.append(
            [
                *cars.cells[car],
                number(cars.weighted[car], 4),
                "base" if car == 0 else cars.change_cell(car) if math.isfinite(cars.change(car)) else "–",
                *([number(cars.half_width[car] or None, 2).replace("nan", "–")] if with_errors else []),
                number(cars.unweighted[car], 4),
                *([] if cars.seat_value is None else [number(cars.seat_value[car], 4)]),
            ]
        )
    return Part("Cars", "cars", "cars", {"heads": heads, "rows": rows, "parameters": count})
