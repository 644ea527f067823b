"""Cases of a sweep by their number: variations on inputs, made when they are used."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from vehicle.studies.sweeps.case import Case, Input, overrides_of
from vehicle.studies.sweeps.lazy_sequence import LazySequence


class Cases(LazySequence[Case]):
    """Cases of every variation on every input, the inputs varying slowest; a case is made when it is used.

    Args:
        changes: texts "path=value" of each variation.
        inputs: the inputs.
        engine, vehicle: see `Case`.
        fixed: overrides of every case, before those of the input and of the variation.
    """

    def __init__(
        self,
        changes: Sequence[tuple[str, ...]],
        inputs: Sequence[Input],
        *,
        engine: str = "auto",
        vehicle: Path | None = None,
        fixed: Sequence[str] = (),
    ) -> None:
        self.changes = changes
        self.inputs = [(source, (*fixed, *overrides_of(source))) for source in inputs]
        self.engine, self.vehicle = engine, vehicle

    def __len__(self) -> int:
        """Return the number of cases."""
        return len(self.inputs) * len(self.changes)

    def item(self, number: int) -> Case:
        """Make a case."""
        position, change = divmod(number, len(self.changes))
        source, shared = self.inputs[position]
        return Case(
            source=source,
            overrides=shared + self.changes[change],
            engine=self.engine,
            vehicle=self.vehicle,
            shared=len(shared),
        )


class RowChanges(LazySequence[tuple[str, ...]]):
    """Variations in the rows of a table; the texts "path=value" of a row are made when they are used.

    Args:
        paths: parameter paths, the columns.
        rows: values.
    """

    def __init__(self, paths: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        self.paths, self.rows = paths, rows

    def __len__(self) -> int:
        """Return the number of variations."""
        return len(self.rows)

    def item(self, number: int) -> tuple[str, ...]:
        """Return the texts of a variation."""
        return tuple(f"{path}={value}" for path, value in zip(self.paths, self.rows[number], strict=True))


class Combinations(LazySequence[tuple[str, ...]]):
    """Every combination of the texts of several columns, the last column varying fastest.

    Args:
        columns: texts of each column.
    """

    def __init__(self, columns: Sequence[Sequence[str]]) -> None:
        self.columns = columns

    def __len__(self) -> int:
        """Return the number of combinations."""
        return math.prod(map(len, self.columns))

    def item(self, number: int) -> tuple[str, ...]:
        """Return a combination."""
        rest, texts = number, []
        for column in reversed(self.columns):
            rest, position = divmod(rest, len(column))
            texts.append(column[position])
        return tuple(reversed(texts))


def table_cases(
    paths: Sequence[str],
    rows: Iterable[Sequence[object]],
    inputs: Sequence[Input],
    *,
    engine: str = "auto",
    vehicle: Path | None = None,
    fixed: Sequence[str] = (),
) -> Cases:
    """Return a case for every row of parameter values on every input.

    Args:
        paths: parameter paths, the columns.
        rows: values.
        inputs: the inputs, varying slowest.
        engine, vehicle, fixed: see `Cases`.
    """
    changes = RowChanges(paths, rows if isinstance(rows, Sequence) else list(rows))
    return Cases(changes, inputs, engine=engine, vehicle=vehicle, fixed=fixed)
