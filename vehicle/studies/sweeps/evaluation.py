"""Evaluation of the table of a sweep: printed lines, further files, and parts of the report."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from vehicle.digits import number
from vehicle.studies.sweeps.case import parameter_cells
from vehicle.studies.sweeps.sweep_ranking import SweptCases

MOST_ROWS = 2000
"""Maximum number of runs in the report; `table.csv` has all."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Part of a report."""

    title: str  # title, anchor: its heading, and the name of its link
    anchor: str
    template: str  # name of its template
    values: Mapping[str, Any]  # values of the template
    draw: Callable[[Path], object] | None = None  # writes the picture of the part to a path; None without one
    label: str = ""  # the picture in words


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """Evaluation of the table of a sweep."""

    lines: Sequence[str]  # the printed table, and the result in words
    # name of a further file to the function that writes it to a path
    files: Mapping[str, Callable[[Path], object]] = field(default_factory=dict)
    # parts of the report, with `REPEAT`, for messages on side effects and on the engine
    parts: Callable[[Sequence[str]], list[Part]] = lambda notes: []


REPEAT = Part("How to repeat the sweep", "repeat", "repeat_sweep", {"best": ""})
"""Last part of a report; `best` has the options --set of the best car, which may be empty."""


def runs_part(table: SweptCases) -> Part:
    """Return the part of a report with the values of all runs."""
    paths = table.paths()
    heads = ["input", *paths, *(f"{name} [{unit}]" for name, unit in table.units.items()), "engine"]
    rows: list[list[str]] = []
    for case, row in zip(table.cases, table.rows(), strict=True):
        if len(rows) == MOST_ROWS:
            break
        values = [float(row["values"].get(name, math.nan)) for name in table.units]
        cells = [number(value if math.isfinite(value) else None, 4) for value in values]
        rows.append([case.source.name, *parameter_cells(case, paths), *cells, row["engine"]])
    counted = {"runs": len(table.cases), "parameters": len(paths), "failed": table.failed}
    return Part("All runs", "runs", "runs", {"heads": heads, "rows": rows, **counted})
