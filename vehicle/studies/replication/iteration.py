"""Iteration of time waveform replication for any plant with responses and FRFs.

    U_(k+1) = U_k + G H_k^+ (Y_target - Y_k)

on the spectral lines of the whole record. H_k is the FRF linearised about the last run, updated after each step. For a
nonlinear plant this is a quasi-Newton method; a test rig uses a fixed H. A step that increases the error is undone and
repeated with half the gain.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.studies.replication.drive_settings import DriveSettings
from vehicle.studies.replication.inverse import Lines, regularised_inverse

HALVINGS = 3
"""Number of consecutive undone steps, each with half the gain, after which the iteration counts as diverging."""

STALLED = 0.02
"""Minimum relative reduction of the error by a step with gain 1; the iteration ends below it."""


class Plant(ABC):
    """Driven system: a car on plates, or a test system.

    Attributes:
        settled: index of the first sample whose error is included.
    """

    settled: int = 0

    @abstractmethod
    def run(self, drive: Vector) -> Vector:
        """Return responses (k, n) to drives (p, n)."""

    @abstractmethod
    def frf(self, frequency: Vector) -> Complex:
        """Return FRFs (k, p, m) at frequencies (m,) [Hz], linearised about the last run; before it about rest."""

    def possible(self, drive: Vector) -> tuple[Vector, str]:
        """Return a feasible drive for a drive, and "", or a message if no drive is feasible."""
        return drive, ""


@dataclass(frozen=True, kw_only=True, slots=True)
class Step:
    """Run of the iteration with its error."""

    number: int  # number of the run, from 1
    gain: float  # gain G of the step before the run [-]
    error: float  # root of the mean square of `errors` [-]
    errors: Vector  # RMS of target minus response over RMS of the target, in the band, (k,) [-]
    kept: bool  # True if the error is smaller than in all runs before


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Replication:
    """Result of the iteration: the best drive with its response, and all steps."""

    drive: Vector  # best drive, (p, n)
    response: Vector  # response to the best drive, (k, n)
    steps: tuple[Step, ...]  # all runs
    reached: bool  # True if the error fell below the tolerance
    outcome: str  # reason for the end of the iteration

    @property
    def error(self) -> float:
        """Return the error of the best run [-]."""
        return min((step.error for step in self.steps), default=1.0)


def replicate(plant: Plant, target: Vector, lines: Lines, settings: DriveSettings) -> Replication:
    """Find the drive whose response is nearest to a target.

    Args:
        plant: driven system, at rest before its first run.
        target: target responses (k, n).
        lines: spectral lines of the record, with the band.

    Returns:
        The best drive; a drive at rest with an error of 1 if no run has a smaller error.
    """
    settled, iterations, tolerance = plant.settled, settings.iterations, settings.target_error
    wanted = lines.in_band(target)[:, settled:]
    sizes = np.sqrt(np.mean(wanted**2, axis=1))
    drive, response = np.zeros((plant.frf(lines.frequency[:1]).shape[1], target.shape[1])), np.zeros_like(target)
    inverse = regularised_inverse(plant.frf(lines.frequency), lines.frequency, sizes)
    smallest, current_gain, failures, steps = 1.0, settings.gain, 0, list[Step]()
    outcome = f"stopped after the maximum of {iterations} iterations"
    for number in range(1, iterations + 1):
        tried, obstacle = plant.possible(drive + current_gain * lines.correction(inverse, target - response))
        if obstacle:
            outcome = obstacle
            break
        tried_response = plant.run(tried)
        residual = lines.in_band(target - tried_response)[:, settled:]
        errors = np.sqrt(np.mean(residual**2, axis=1)) / sizes
        error = float(np.sqrt(np.mean(errors**2)))
        kept = error < smallest
        steps.append(Step(number=number, gain=current_gain, error=error, errors=errors, kept=kept))
        if settings.progress is not None:
            settings.progress(steps[-1])
        if not kept:
            failures, current_gain = failures + 1, 0.5 * current_gain
            if failures == HALVINGS:
                outcome = f"diverging: {failures} consecutive steps, each with half the gain, increased the error"
                break
            continue
        before, smallest, failures = smallest, error, 0
        drive, response = tried, tried_response
        if smallest <= tolerance:
            outcome = f"the error fell below {100.0 * tolerance:g} %"
            break
        if before - smallest < STALLED * before * current_gain:
            outcome = f"no further progress: the last step reduced the error by less than {100 * STALLED:g} %"
            break
        inverse = regularised_inverse(plant.frf(lines.frequency), lines.frequency, sizes)
    return Replication(
        drive=drive, response=response, steps=tuple(steps), reached=smallest <= tolerance, outcome=outcome
    )
