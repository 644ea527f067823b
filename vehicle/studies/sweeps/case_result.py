"""Result of a case of a sweep, and its row: a line of JSON, which a worker writes and the sweep stores."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, TypedDict

from vehicle.studies.sweeps.case import Case


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """Values of a run, or the error message of a failed run.

    Attributes:
        values: name to value; empty for a failed run.
        engine: engine of the run; empty for a failed run.
        reason: error message of a failed run; else empty.
        seconds: computing time including the building of the car [s]; runs of a batch share the time equally.
    """

    values: dict[str, float] = field(default_factory=dict)
    engine: str = ""
    reason: str = ""
    seconds: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Block:
    """Rows of the cases of a task as text, so that the process of the sweep stores them without reading them.

    Attributes:
        rows: a line for each case, see `row_text`.
        seconds: computing time of all cases [s].
        failed: positions of the failed cases.
        reduced: True if the reduced engine ran all cases.
    """

    rows: bytes
    seconds: float
    failed: tuple[int, ...] = ()
    reduced: bool = False

    @classmethod
    def of(cls, cases: Sequence[Case], keys: Sequence[str], results: Sequence[Result]) -> Block:
        """Return the rows of cases.

        Args:
            cases: the cases.
            keys: digest of each case, see `CaseKeys`.
            results: result of each case.
        """
        rows = (row_text(*row) for row in zip(cases, keys, results, strict=True))
        return cls(
            rows="".join(rows).encode(),
            seconds=sum(result.seconds for result in results),
            failed=tuple(position for position, result in enumerate(results) if result.reason),
            reduced=all(result.engine == "reduced" for result in results),
        )

    def results(self) -> list[Result]:
        """Return the results of the cases."""
        return [result_of(line) for line in self.rows.splitlines()]


def row_text(case: Case, key: str, result: Result) -> str:
    """Return the row of a case, a line of JSON."""
    # JSON writes floats with all digits, so values read again are identical; NaN is written as NaN.
    row = {
        "key": key,
        "case": case.label,
        "values": result.values,
        "engine": result.engine,
        "reason": result.reason,
        "seconds": result.seconds,
    }
    return json.dumps(row) + "\n"


def result_of(line: bytes) -> Result:
    """Return the result in a row.

    Raises:
        ValueError, KeyError, TypeError, AttributeError: the line is no row.
    """
    row: dict[str, Any] = json.loads(line)
    return Result(
        values={name: float(value) for name, value in row["values"].items()},
        engine=str(row["engine"]),
        reason=str(row["reason"]),
        seconds=float(row["seconds"]),
    )


class Row(TypedDict):
    """Row of a case: its values as texts with all digits."""

    values: dict[str, str]
    engine: str
    reason: str
    seconds: str
