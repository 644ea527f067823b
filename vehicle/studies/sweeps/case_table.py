"""Cases of a sweep by their number: variations on inputs, made when they are used."""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import product
from pathlib import Path

from vehicle.studies.sweeps.case import Case, Input, overrides_of
from vehicle.studies.sweeps.lazy_sequence import LazySequence


class Cases(LazySequence[Case]):
    """Cases of every variation on every input, the inputs varying slowest; a case is made when it is used.

    Args:
        changes: texts "path=value" of each variation.
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
        self._length = len(self.inputs) * len(changes)

    def __len__(self) -> int:
        """Return the number of cases."""
        return self._length

    def item(self, number: int) -> Case:
        """Make a case."""
        position, change = divmod(number, len(self.changes))
        return self._case(*self.inputs[position], self.changes[change])

    def __iter__(self) -> Iterator[Case]:
        """Return the cases in their order."""
        for source, shared in self.inputs:
            for change in self.changes:
                yield self._case(source, shared, change)

    def _case(self, source: Input, shared: tuple[str, ...], change: tuple[str, ...]) -> Case:
        return Case(
            source=source, overrides=shared + change, engine=self.engine, vehicle=self.vehicle, shared=len(shared)
        )


class RowChanges(LazySequence[tuple[str, ...]]):
    """Variations in the rows of a table; the texts "path=value" of a row are made when they are used.

    Args:
        paths: parameter paths, the columns.
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
    """Every combination of the texts of several columns, the last column varying fastest."""

    def __init__(self, columns: Sequence[Sequence[str]]) -> None:
        self.columns = columns
        # Number of combinations of the columns after each column: a text is repeated as often.
        repeated = [math.prod(map(len, columns[position + 1 :])) for position in range(len(columns))]
        self._repeated = list(zip(columns, repeated, strict=True))
        self._length = math.prod(map(len, columns))

    def __len__(self) -> int:
        """Return the number of combinations."""
        return self._length

    def item(self, number: int) -> tuple[str, ...]:
        """Return a combination."""
        return tuple([column[number // repeated % len(column)] for column, repeated in self._repeated])

    def __iter__(self) -> Iterator[tuple[str, ...]]:
        """Return the combinations in their order."""
        return product(*self.columns)


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
        inputs: the inputs, varying slowest.
        engine, vehicle, fixed: see `Cases`.
    """
    changes = RowChanges(paths, rows if isinstance(rows, Sequence) else list(rows))
    return Cases(changes, inputs, engine=engine, vehicle=vehicle, fixed=fixed)
