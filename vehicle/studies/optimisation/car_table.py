"""`cars.csv`: every car that was tried, written generation by generation, read again when a search goes on."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehicle.errors import DataError, OutputError
from vehicle.runs.output.folder import write_text
from vehicle.runs.output.written_files import note
from vehicle.studies.optimisation.problem import Problem
from vehicle.studies.optimisation.search import Tried

CARS = "cars.csv"


def columns(problem: Problem) -> list[str]:
    """Heads of the parameters and of the numbers, with units."""
    parameters = [f"{one.path} [{unit}]" for one, unit in zip(problem.ranges, problem.units, strict=True)]
    return [*parameters, *(f"{wish.label} [{wish.unit}]" for wish in problem.wishes)]


def cells(numbers: Sequence[float]) -> list[str]:
    """Numbers with all their digits; empty where there is none."""
    return ["" if math.isnan(number) else repr(float(number)) for number in numbers]


class CarTable:
    """The file of the cars of a search; generation 0 is the car as it is.

    Args:
        path: the file. Generations that are there are kept, but for the last: a killed process may have left half of
            it.
        problem: what is wanted.

    Raises:
        DataError: the file is damaged.
        OutputError: it cannot be written.
    """

    def __init__(self, path: Path, problem: Problem) -> None:
        self.path, self.problem = path, problem
        self.generations: list[Tried] = []
        self._cars = 0
        self._head = ["car", "generation", *columns(problem), "failed because"]
        known = self._read() if path.exists() else []
        write_text(path, _text([self._head]))
        note(path)  # which grows from now on
        for tried in known:
            self.add(tried)

    def add(self, tried: Tried) -> None:
        """Keep a generation.

        Raises:
            OutputError: the disk refuses it.
        """
        rows = [
            [str(self._cars + i), str(len(self.generations)), *cells(point), *cells(values), reason.replace("\n", " ")]
            for i, (point, values, reason) in enumerate(zip(tried.points, tried.values, tried.reasons, strict=True))
        ]
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(_text(rows))
        except OSError as error:
            raise OutputError(f"{self.path}: cannot be written: {error.strerror}; --resume goes on") from None
        self._cars += len(rows)
        self.generations.append(tried)

    def _read(self) -> list[Tried]:
        """All generations of the file but the last."""
        size = len(self.problem.ranges)
        found: dict[str, list[list[str]]] = {}
        for row in list(csv.reader(self.path.read_text(encoding="utf-8").splitlines()))[1:]:
            if len(row) == len(self._head):  # else it was cut off
                found.setdefault(row[1], []).append(row)
        if found:
            found.popitem()
        try:
            return [
                Tried(
                    points=np.array([[_number(cell) for cell in row[2 : 2 + size]] for row in rows]),
                    values=np.array([[_number(cell) for cell in row[2 + size : -1]] for row in rows]),
                    reasons=tuple(row[-1] for row in rows),
                )
                for rows in found.values()
            ]
        except ValueError as error:
            raise DataError(f"{self.path}: no table of a search ({error}); start anew with --force") from None


def _number(cell: str) -> float:
    return float(cell) if cell else math.nan


def _text(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
