"""Section of a report: figures of the catalogue that were asked for, of all its runs."""

import math
from collections.abc import Sequence

from markupsafe import Markup

from vehicle.digits import number
from vehicle.runs.figures.value import shown_figures
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates

fill = templates(__file__)

STANDARD_ERRORS = 2.0
"""Standard errors in half of a 95 % interval."""


def figures_section(names: Sequence[str], runs: Sequence[FinishedRun]) -> Markup:
    """Return the table of figures: a row for each, with a value for each run.

    Args:
        names: names of figures, see `Run.figure`.
        runs: finished runs.

    Raises:
        ConfigurationError: no such figure, or a run lacks what it needs.
        DataError: a record is too short for a band.
    """
    columns = [shown_figures(names, run.runs) for run in runs]
    rows = [
        (each[0].title, each[0].unit, *(value_text(shown.value, shown.error) for shown in each))
        for each in zip(*columns, strict=True)
    ]
    return fill("figures", heads=["figure", "unit", *(run.name for run in runs)], rows=rows)


def value_text(value: float, error: float | None) -> str:
    """Return a value and half of its 95 % interval as text."""
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "not settled"
    return number(value) + (f" ± {number(STANDARD_ERRORS * error, 2)}" if error else "")
