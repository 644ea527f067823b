"""First section of a report: targets with limits, values and verdict, on a page of A4."""

import re
from collections.abc import Mapping, Sequence

from markupsafe import Markup

from vehicle.digits import number
from vehicle.runs.report.differences import parameter_words
from vehicle.runs.report.figures_section import value_text
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates
from vehicle.runs.targets.target import Target
from vehicle.runs.targets.verdict import NOT_RUN, Rated, sentence, verdict

fill = templates(__file__)


def verdict_section(figures: Mapping[str, Target], runs: Sequence[FinishedRun]) -> Markup:
    """Return the verdict on each car in words, and the table of limits and values.

    Args:
        figures: figures with their limits, see `vehicle.runs.targets.verdict.read_targets`.
        runs: finished runs of one or several cars.
    """
    rated = verdict(figures, runs)
    words = [_car_words(car) for car in rated]
    cars = words if len(set(words)) == len(words) else list(rated)
    rows = [
        {
            "words": figure.words or name.replace("_", " "),
            "where": figure.where or "every run",
            "limit": f"{'≤' if figure.sense > 0 else '≥'} {number(figure.limit)}",
            "unit": figure.unit,
            "cells": [(_value(each[name]), each[name].state) for each in rated.values()],
            "source": figure.source,
        }
        for name, figure in figures.items()
    ]
    return fill(
        "verdict",
        sentences=[sentence(figures, car, each) for car, each in zip(cars, rated.values(), strict=True)],
        cars=cars,
        rows=rows,
        caption="value and its 95 % interval on a random road; undecided if the limit lies inside the interval; "
        "± ? if the interval is unknown; the worst of several runs",
    )


def _car_words(car: str) -> str:
    """Return the name of a car with its changed parameters in words."""
    return re.sub(r"(\w+(?:\.\w+)+)=", lambda match: f"{parameter_words(match[1])} ", car)


def _value(rated: Rated) -> str:
    """Return value and half of its interval as text, "?" for an unknown interval; a dash without a run."""
    if rated.state == NOT_RUN:
        return "–"
    return f"{value_text(rated.value, rated.error)}{' ± ?' if rated.unknown else ''}"
