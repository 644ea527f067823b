"""What is kept of a case: its numbers, or why there are none."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """Numbers of a run, or why there are none.

    Attributes:
        values: name to number; empty where the run failed.
        engine: engine that answered; empty where the run failed.
        reason: why it failed; empty where it did not.
        seconds: computing time, building the car included; of runs that are computed together an equal share each [s].
    """

    values: dict[str, float] = field(default_factory=dict)
    engine: str = ""
    reason: str = ""
    seconds: float = 0.0
