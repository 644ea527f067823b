"""Measured and simulated time histories at common times, and how they agree."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.analysis.record_rating import RecordRating, rate_record
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.analysis.time_shift import TimeShift
from vehicle.signals.formats.table import Record
from vehicle.signals.records.counterpart import Counterpart, counterparts
from vehicle.signals.records.resampled import at_times

LEAST_SAMPLES = 20
"""That both have in common: fewer are no time history. Assumed."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordComparison:
    """One time history."""

    channel: str  # name in the model
    unit: str  # of both
    time: Vector  # of the run [s], (n,)
    measured: Vector  # measured, simulated: (n,)
    simulated: Vector
    rms: float  # of the measured one, in its unit
    rms_ratio: float  # simulated over measured [-]
    correlation: float  # coefficient at equal times [-]
    rating: RecordRating  # after ISO/TS 18571, of windows at the full rate
    clock: TimeShift | None  # time shift and drift of the simulated record; None if the records do not correlate

    @property
    def lag(self) -> float:
        """Time by which the simulated record is late in the middle of the common time [s]; NaN where untold."""
        return self.clock.shift if self.clock is not None else math.nan

    @property
    def drift(self) -> float:
        """Change of the lag per time [-]; NaN if the record does not determine it."""
        resolved = self.clock is not None and math.isfinite(self.clock.drift_error)
        return self.clock.drift if resolved and self.clock is not None else math.nan


def compare_records(
    measured: Record, simulated: Record, times: Vector | None = None, begin: float = -math.inf
) -> tuple[tuple[RecordComparison, ...], list[Counterpart]]:
    """Compare all common time histories over the common time.

    The record with the higher rate is low-passed without phase shift and resampled to the lower rate.

    Args:
        measured, simulated: with the same units.
        times: times of the measured samples on the clock of the run [s], (n,); by default those of the record.
        begin: beginning of the compared part on the clock of the run [s].

    Returns:
        The comparisons, and how each measured channel fits its counterpart when both are shifted.

    Raises:
        DataError: less than `LEAST_SAMPLES` samples in common.
    """
    times = measured.time if times is None else times
    step = max(float(times[-1] - times[0]) / (times.size - 1), simulated.step)
    start, end = max(times[0], simulated.time[0], begin), min(times[-1], simulated.time[-1])
    count = int((end - start) / step + 1e-6) + 1
    if end <= start or count < LEAST_SAMPLES:
        raise DataError(
            f"measured from {times[0]:.6g} to {times[-1]:.6g} s of the run, simulated from "
            f"{simulated.time[0]:.6g} to {simulated.time[-1]:.6g} s: too little in common; set --delay S, "
            "which is added to the measured times"
        )
    grid = start + step * np.arange(count)
    parts = counterparts(measured, simulated, times)
    comparisons = [_compared(measured, simulated, times, grid, step, part) for part in parts]
    return tuple(comparisons), parts


def _compared(
    measured: Record, simulated: Record, times: Vector, grid: Vector, step: float, part: Counterpart
) -> RecordComparison:
    """Compare one channel at common times."""
    truth = at_times(times, measured.channels[part.channel], grid, step)
    curve = at_times(simulated.time, simulated.channels[part.channel], grid, step)
    size, other = (float(np.sqrt(np.mean(values**2))) for values in (truth, curve))
    spread = float(np.std(truth) * np.std(curve))
    return RecordComparison(
        channel=part.channel,
        unit=part.unit,
        time=grid,
        measured=truth,
        simulated=curve,
        rms=size,
        rms_ratio=other / size if size > 0.0 else math.nan,
        correlation=float(np.mean((truth - truth.mean()) * (curve - curve.mean()))) / spread
        if spread > 0.0
        else math.nan,
        rating=rate_record(truth, curve, step),
        clock=part.reliable_shift,
    )


def unlike_copies(records: Sequence[RecordComparison]) -> list[str]:
    """Return a notice for each pair of equal measured channels whose simulated channels differ."""
    said = []
    for index, record in enumerate(records):
        for other in records[:index]:
            if not np.ptp(record.measured) > 0.0 or record.unit != other.unit:
                continue
            same = np.array_equal(record.measured, other.measured)
            if same and not np.allclose(record.simulated, other.simulated, atol=1e-3 * float(np.std(record.simulated))):
                said.append(
                    f"{other.channel} and {record.channel} have the same samples in the measurement, but not in "
                    f"the run: was a channel copied? Choose another channel: --map {record.channel}=NAME"
                )
    return said
