"""The iteration of time waveform replication, for anything that answers a drive.

    U_(k+1) = U_k + G H_k^+ (Y_target - Y_k)

on the lines of the whole record. H_k belongs to the state of the last run: where the system is nonlinear, it is taken
anew, which makes of the fixed compensation of a test rig a quasi-Newton method. A step that makes the error larger is
taken back and tried again with half the gain.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from vehicle.studies.replication.inverse import Complex, Lines, Vector, regularised_inverse

HALVINGS = 3
"""Steps that are taken back one after the other, each with half the gain of the one before, until it is called
divergence."""

STALLED = 0.02
"""Relative gain of a step below which no further one is taken."""


class Plant(Protocol):
    """What is driven."""

    def run(self, drive: Vector) -> Vector:
        """Responses (k, n) to drives (p, n)."""

    def frf(self, frequency: Vector) -> Complex:
        """FRFs about the state of the last run, at rest before the first: (k, p, m) at lines (m,) [Hz]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Step:
    """One run of the iteration.

    Attributes:
        number: 1 for the first.
        gain: G of the step that led to it.
        error: of all responses, root of the mean square of those below [-].
        errors: RMS of target minus response over that of the target, in the band, (k,) [-].
        kept: whether it was better than all before.
    """

    number: int
    gain: float
    error: float
    errors: npt.NDArray[np.float64]
    kept: bool


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Replication:
    """The best drive and how it was found.

    Attributes:
        drive: (p, n).
        response: what answers it, (k, n).
        steps: all runs.
        reached: whether the error fell below the tolerance.
        outcome: why it ended.
    """

    drive: Vector
    response: Vector
    steps: tuple[Step, ...]
    reached: bool
    outcome: str

    @property
    def error(self) -> float:
        """Of the best run [-]."""
        return min((step.error for step in self.steps), default=1.0)


def replicate(
    plant: Plant,
    target: Vector,
    lines: Lines,
    *,
    iterations: int,
    gain: float,
    tolerance: float,
    possible: Callable[[Vector], tuple[Vector, str]] = lambda drive: (drive, ""),
    said: Callable[[Step], None] = lambda step: None,
    settled: int = 0,
) -> Replication:
    """Find the drive that answers with a target.

    Args:
        plant: at rest before its first run.
        target: responses (k, n).
        lines: of the record, with the band.
        iterations: runs at most.
        gain: G, above 0 and up to 1.
        tolerance: relative error that is good enough [-].
        possible: makes of a drive the one that can be run, and says why it cannot, if so.
        said: told every run.
        settled: first sample whose error counts.

    Returns:
        The best drive; at rest with an error of 1 where nothing was better.
    """
    wanted = lines.in_band(target)[:, settled:]
    sizes = np.sqrt(np.mean(wanted**2, axis=1))
    drive, response = np.zeros((plant.frf(lines.frequency[:1]).shape[1], target.shape[1])), np.zeros_like(target)
    inverse = regularised_inverse(plant.frf(lines.frequency), lines.frequency, sizes)
    best, now, failures, steps = 1.0, gain, 0, list[Step]()
    outcome = f"the {iterations} iterations asked for are done"
    for number in range(1, iterations + 1):
        tried, why = possible(drive + now * lines.correction(inverse, target - response))
        if why:
            outcome = why
            break
        answer = plant.run(tried)
        left = lines.in_band(target - answer)[:, settled:]
        errors = np.sqrt(np.mean(left**2, axis=1)) / sizes
        error = float(np.sqrt(np.mean(errors**2)))
        kept = error < best
        steps.append(Step(number=number, gain=now, error=error, errors=errors, kept=kept))
        said(steps[-1])
        if not kept:
            failures, now = failures + 1, 0.5 * now
            if failures == HALVINGS:
                outcome = f"diverging: {failures} steps in a row, each of half the gain, made the error larger"
                break
            continue
        before, best, failures = best, error, 0
        drive, response = tried, answer
        if best <= tolerance:
            outcome = f"the error fell below {100.0 * tolerance:g} %"
            break
        if before - best < STALLED * before * now:
            outcome = f"no further progress: the last step made the error smaller by less than {100 * STALLED:g} %"
            break
        inverse = regularised_inverse(plant.frf(lines.frequency), lines.frequency, sizes)
    return Replication(drive=drive, response=response, steps=tuple(steps), reached=best <= tolerance, outcome=outcome)
