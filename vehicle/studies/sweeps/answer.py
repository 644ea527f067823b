"""Answer of a sweep: what its table says, in files beside the table, in printed lines and in parts of the report."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from vehicle.digits import number
from vehicle.studies.sweeps.case import parameter_cells
from vehicle.studies.sweeps.sweep_ranking import SweptCases

MOST_ROWS = 2000
"""Maximum number of runs in the report; `table.csv` has all."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Part of a report.

    Attributes:
        title, anchor: its heading, and the name of its link.
        template: name of its template.
        values: values of the template.
        draw: writes the picture of the part to a path; None without one.
        label: the picture in words.
    """

    title: str
    anchor: str
    template: str
    values: Mapping[str, Any]
    draw: Callable[[Path], object] | None = None
    label: str = ""


class Answer(Protocol):
    """What the table of a sweep says."""

    def write(self, folder: Path, caption: str) -> tuple[str, ...]:
        """Write the files of the answer beside the table and return their names.

        Args:
            folder: folder of the sweep.
            caption: tyres and evaluated span, for a picture.
        """

    def lines(self) -> list[str]:
        """Return the printed table, and the result in words."""

    def parts(self, table: SweptCases, caption: str, notes: Sequence[str]) -> list[Part]:
        """Return the parts of the report, with `REPEAT`; none for an answer without a report.

        Args:
            table: table of the sweep.
            caption: see `write`.
            notes: messages on side effects of the varied parameters and on the engine.
        """


REPEAT = Part("How to repeat the sweep", "repeat", "repeat_sweep", {"best": ""})
"""Last part of a report; `best` has the options --set of the best car, if the answer names one."""


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
