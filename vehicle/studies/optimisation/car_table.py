"""Table `cars.csv` of all cars tried, written generation by generation and read when a search is continued."""

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.errors import DataError, OutputError
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
        path: the file. Existing generations are kept except the last, which may be incomplete after a killed process.
        problem: parameters, objectives and limits.

    Raises:
        DataError: the file is damaged.
        OutputError: the file cannot be written.
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
        """Append a generation to the file.

        Raises:
            OutputError: the file cannot be written.
        """
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(_text(self._rows(tried, len(self.generations))))
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
        """Read all generations of the file except the last."""
        size = len(self.problem.ranges)
        generations: dict[str, list[list[str]]] = {}
        for row in list(csv.reader(self.path.read_text(encoding="utf-8").splitlines()))[1:]:
            if len(row) == len(self._head):  # a shorter row is incomplete
                generations.setdefault(row[1], []).append(row)
        if generations:
            generations.popitem()
        try:
            return [
                TriedCars(
                    points=np.array([[_number(cell) for cell in row[2 : 2 + size]] for row in rows]),
                    values=np.array([[_number(cell) for cell in row[2 + size : -1]] for row in rows]),
                    reasons=tuple(row[-1] for row in rows),
                )
                for rows in generations.values()
            ]
        except ValueError as error:
            raise DataError(f"{self.path}: not a table of a search ({error}); start again with --force") from None


def _number(cell: str) -> float:
    return float(cell) if cell else math.nan


def _text(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    RowWriter(text).writerows(rows)
    return text.getvalue()
