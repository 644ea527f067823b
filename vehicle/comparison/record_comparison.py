"""Measured and simulated time histories at common times, and how they agree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.analysis.curve_rating import LONGEST, CurveRating, rate_curve
from vehicle.errors import DataError
from vehicle.records.resampled import at_times
from vehicle.records.table import Record

Vector = npt.NDArray[np.float64]

LEAST_SAMPLES = 20
"""That both have in common: fewer are no time history. Assumed."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordComparison:
    """One time history.

    Attributes:
        channel: name in the model.
        unit: of both.
        time: of the run [s], (n,).
        measured, simulated: (n,).
        rms: of the measured one, in its unit.
        rms_ratio: simulated over measured [-].
        correlation: coefficient at equal times [-].
        rating: after ISO/TS 18571.
        rated_rate: samples a second that were rated [Hz].
    """

    channel: str
    unit: str
    time: Vector
    measured: Vector
    simulated: Vector
    rms: float
    rms_ratio: float
    correlation: float
    rating: CurveRating
    rated_rate: float

    @property
    def lag(self) -> float:
        """Time by which the simulated record is late where both agree best [s]."""
        return self.rating.shift / self.rated_rate


def shifted(records: Sequence[RecordComparison], delay: float) -> list[str]:
    """A sentence where all time histories agree best at one and the same shift, by more than a sample.

    Args:
        records: as of `compare_records`.
        delay: which they were compared with [s].
    """
    lags = {round(one.lag * one.rated_rate) for one in records}
    if len(lags) != 1 or max(map(abs, lags)) < 2:
        return []
    lag = records[0].lag
    return [
        f"the simulated time histories are {lag:.6g} s late, all alike: if the records began at different times, give "
        f"--delay {delay + lag:.6g}"
    ]


def compare_records(measured: Record, simulated: Record, delay: float = 0.0) -> tuple[RecordComparison, ...]:
    """Compare all time histories that both have, over the time that both have.

    The one of the higher rate is low-passed without phase shift and brought to the lower rate.

    Args:
        measured, simulated: with the same units.
        delay: added to the measured times to give those of the run [s].

    Raises:
        DataError: less than `LEAST_SAMPLES` samples in common.
    """
    times = measured.time + delay
    step = max(measured.step, simulated.step)
    start, end = max(times[0], simulated.time[0]), min(times[-1], simulated.time[-1])
    count = int((end - start) / step + 1e-6) + 1
    if end <= start or count < LEAST_SAMPLES:
        raise DataError(
            f"measured from {times[0]:.6g} to {times[-1]:.6g} s of the run, simulated from {simulated.time[0]:.6g} to "
            f"{simulated.time[-1]:.6g} s: too little in common; give --delay S, which is added to the measured times"
        )
    grid = start + step * np.arange(count)
    found = []
    for name, values in measured.channels.items():
        if name not in simulated.channels:
            continue
        truth = at_times(times, values, grid, step)
        curve = at_times(simulated.time, simulated.channels[name], grid, step)
        every = -(-count // LONGEST)
        first, second = (scipy.signal.resample_poly(one, 1, every, padtype="line") for one in (truth, curve))
        size, other = (float(np.sqrt(np.mean(one**2))) for one in (truth, curve))
        spread = float(np.std(truth) * np.std(curve))
        found.append(
            RecordComparison(
                channel=name,
                unit=measured.units[name],
                time=grid,
                measured=truth,
                simulated=curve,
                rms=size,
                rms_ratio=other / size if size > 0.0 else float("nan"),
                correlation=float(np.mean((truth - truth.mean()) * (curve - curve.mean()))) / spread
                if spread > 0.0
                else float("nan"),
                rating=rate_curve(first, second, step * every),
                rated_rate=1.0 / (step * every),
            )
        )
    return tuple(found)
