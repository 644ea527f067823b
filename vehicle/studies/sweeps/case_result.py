"""Result of a case of a sweep, and its row: a line of JSON, which a worker writes and the sweep stores."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, TypedDict

from vehicle.studies.sweeps.case import Case


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """Values of a run, or the error message of a failed run."""

    values: dict[str, float] = field(default_factory=dict)  # name to value; empty for a failed run
    engine: str = ""  # engine of the run; empty for a failed run
    reason: str = ""  # error message of a failed run; else empty
    seconds: float = 0.0  # computing time including the building of the car [s]; runs of a batch share the time equally

    def row(self, case: Case, key: str) -> str:
        """Return the row of a case, a line of JSON; `key` is its digest, see `CaseKeys`."""
        # JSON writes floats with all digits, so values read again are identical; an undefined value (NaN) is null.
        row = {
            "key": key,
            "case": case.label,
            "values": {name: None if value != value else value for name, value in self.values.items()},
            "engine": self.engine,
            "reason": self.reason,
            "seconds": self.seconds,
        }
        return json.dumps(row, allow_nan=False) + "\n"

    @classmethod
    def read(cls, line: bytes) -> Result:
        """Return the result in a row.

        Raises:
            ValueError: the line is no row: not JSON, a key is missing or of another type, or a number is not finite.
        """
        try:
            row: dict[str, Any] = json.loads(line)
            values = {str(name): math.nan if value is None else number(value) for name, value in row["values"].items()}
            texts = {name: text(row[name]) for name in ("engine", "reason")}
            result = cls(values=values, **texts, seconds=number(row["seconds"]))
        except (KeyError, TypeError, AttributeError, RecursionError, OverflowError) as error:
            raise ValueError(f"{type(error).__name__}: {error}") from None
        if bool(result.values) == bool(result.reason):
            raise ValueError("must have values, or the message of an error")
        return result


@dataclass(frozen=True, kw_only=True, slots=True)
class Block:
    """Rows of the cases of a task as text, so that the process of the sweep stores them without reading them."""

    rows: bytes  # a line for each case, see `Result.row`
    seconds: float  # computing time of all cases [s]
    failed: tuple[int, ...] = ()  # positions of the failed cases
    reduced: bool = False  # True if the reduced engine ran all cases

    @classmethod
    def of(cls, cases: Sequence[Case], keys: Sequence[str], results: Sequence[Result]) -> Block:
        """Return the rows of cases.

        Args:
            cases: the cases.
            keys: digest of each case, see `CaseKeys`.
            results: result of each case.
        """
        rows = (result.row(case, key) for case, key, result in zip(cases, keys, results, strict=True))
        return cls(
            rows="".join(rows).encode(),
            seconds=sum(result.seconds for result in results),
            failed=tuple(position for position, result in enumerate(results) if result.reason),
            reduced=all(result.engine == "reduced" for result in results),
        )

    def results(self) -> list[Result]:
        """Return the results of the cases."""
        return [Result.read(line) for line in self.rows.splitlines()]


def number(value: Any) -> float:
    """Return a finite number of JSON; raise a ValueError for another value."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"found {value!r:.20}, must be a finite number")
    return float(value)


def text(value: Any) -> str:
    """Return a text of JSON; raise a ValueError for another value."""
    if not isinstance(value, str):
        raise ValueError(f"found {value!r:.20}, must be a text")
    return value


class Row(TypedDict):
    """Row of a case: its values as texts with all digits."""

    values: dict[str, str]
    engine: str
    reason: str
    seconds: str
