"""Result of a case of a sweep."""

from __future__ import annotations

from dataclasses import dataclass, field


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
