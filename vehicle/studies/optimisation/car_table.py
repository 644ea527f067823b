"""Table `cars.csv` of all cars tried, written generation by generation and read when a search is continued."""

import csv
import io
import math
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.errors import OutputError
from vehicle.leftovers import say
from vehicle.runs.output.folder import write_text
from vehicle.runs.output.written_files import note
from vehicle.signals.formats.csv_table import RowWriter
from vehicle.studies.optimisation.problem import Problem
from vehicle.studies.optimisation.search import TriedCars

CARS = "cars.csv"


def columns(problem: Problem) -> list[str]:
    """Return the column heads of the parameters and of the objectives and limits, with units."""
    parameters = [f"{bounds.path} [{unit}]" for bounds, unit in zip(problem.ranges, problem.units, strict=True)]
    return [*parameters, *(f"{criterion.label} [{criterion.unit}]" for criterion in problem.criteria)]


def cells(numbers: Sequence[float]) -> list[str]:
    """Return numbers as text with all digits; empty for NaN."""
    return ["" if math.isnan(number) else repr(float(number)) for number in numbers]


class CarTable:
    """File of the cars of a search; generation 0 is the unmodified car.

    Args:
        path: the file. Existing generations are kept except the last, which may be incomplete after a killed process,
            and those from a damaged row on, with a notice.
        problem: parameters, objectives and limits.
    """

    def __init__(self, path: Path, problem: Problem) -> None:
        self.path, self.problem = path, problem
        self.generations: list[TriedCars] = []
        self._first = [0]  # number of the first car of each generation, and of the next one
        self._head = ["car", "generation", *columns(problem), "failed because"]
        for tried in self._read() if path.exists() else ():
            self._take(tried)
        rows = [row for number, tried in enumerate(self.generations) for row in self._rows(tried, number)]
        write_text(path, _text([self._head, *rows]))
        note(path)  # the file grows from now on

    def add(self, tried: TriedCars) -> None:
        """Append a generation to the file."""
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(_text(self._rows(tried, len(self.generations))))
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise OutputError(f"{self.path}: cannot be written: {error.strerror}; continue with --resume") from None
        self._take(tried)

    def _take(self, tried: TriedCars) -> None:
        self._first.append(self._first[-1] + len(tried.reasons))
        self.generations.append(tried)

    def _rows(self, tried: TriedCars, generation: int) -> list[list[str]]:
        """Return the rows of a generation."""
        each = enumerate(zip(tried.points, tried.values, tried.reasons, strict=True), start=self._first[generation])
        return [
            [str(car), str(generation), *cells(point), *cells(values), reason.replace("\n", " ")]
            for car, (point, values, reason) in each
        ]

    def _read(self) -> list[TriedCars]:
        """Read all generations of the file except the last, and those from a damaged row on."""
        size = len(self.problem.ranges)
        generations: list[list[list[str]]] = []
        lines = self.path.read_text(encoding="utf-8", errors="replace").split("\n")[:-1]  # the last may be incomplete
        for number, line in enumerate(lines[1:], start=2):
            try:
                (row,) = csv.reader([line])
                if len(row) != len(self._head) or int(row[0]) != number - 2:
                    raise ValueError(
                        f"found {len(row)} cells, must be {len(self._head)} beginning with the next number of a car"
                    )
                if int(row[1]) == len(generations):
                    generations.append([])
                elif int(row[1]) != len(generations) - 1:
                    raise ValueError(f"found generation {row[1]}")
                generations[-1].append([*row[2:-1], row[-1]])
                [_number(cell) for cell in row[2:-1]]
            except (ValueError, csv.Error) as error:
                kept = max(len(generations) - 1, 0)
                say(f"{self.path}, line {number}: damaged ({error}); the {kept} whole generations before it are kept")
                break
        return [
            TriedCars(
                points=np.array([[_number(cell) for cell in row[:size]] for row in rows]),
                values=np.array([[_number(cell) for cell in row[size:-1]] for row in rows]),
                reasons=tuple(row[-1] for row in rows),
            )
            for rows in generations[:-1]
        ]


def _number(cell: str) -> float:
    """Return the number of a cell, NaN for an empty one; raise a ValueError for an infinite number or NaN."""
    if cell and not math.isfinite(float(cell)):
        raise ValueError(f"must be a finite number, not {cell[:20]!r}")
    return float(cell) if cell else math.nan


def _text(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    RowWriter(text).writerows(rows)
    return text.getvalue()
