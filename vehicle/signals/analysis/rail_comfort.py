"""Ride comfort of a rail passenger after EN 12299: continuous comfort of 5 s, mean comfort of 5 minutes.

    C(t) = sqrt(mean a_w^2 over 5 s),    N_MV = 6 sqrt(C_x95^2 + C_y95^2 + C_z95^2)

The index 95 is the 95 % quantile of the 60 values of 5 minutes, by linear interpolation.
"""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.analysis.samples import checked_rows, checked_time_step
from vehicle.signals.analysis.weighting import weighted_record, weighting

INTERVAL, ZONE = 5.0, 300.0
"""Time of a value of continuous comfort, and of a value of mean comfort [s] (EN 12299:2009, 6.1 and 7)."""

WEIGHTINGS = ("Wd", "Wd", "Wb_en12299")
"""Weightings of the floor along x, y and z (EN 12299:2009, table 2)."""

SCALE = ((1.5, "very comfortable"), (2.5, "comfortable"), (3.5, "medium"), (4.5, "uncomfortable"))
"""Upper limits of N_MV and their words (EN 12299:2009, annex: scale of the mean comfort)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RailComfort:
    """Comfort of a record on the floor of a train.

    Attributes:
        continuous: C of each interval along x, y and z [m/s2], (3, intervals).
        mean: N_MV of each whole zone of 5 minutes, (zones,).
    """

    continuous: Vector
    mean: Vector


def rail_comfort(time_step: float, xyz: Vector, *, skip: float = 0.0, from_rest: bool = False) -> RailComfort:
    """Return continuous and mean comfort of accelerations on the floor.

    Args:
        time_step: sampling interval [s].
        xyz: accelerations along x, y and z [m/s2], (3, n).
        skip: time that is left out at the beginning [s].
        from_rest: True for a record that begins at rest; of any other the settling of the filters is left out too.

    Raises:
        DataError: an axis is missing, or less than 5 minutes are left.

    Source: EN 12299:2009.
    """
    step, rows = checked_time_step(time_step), checked_rows("acceleration", xyz)
    if len(rows) != len(WEIGHTINGS):
        raise DataError(f"EN 12299: found {len(rows)} axes, must be the three axes x, y and z")
    begin = max(skip, 0.0 if from_rest else max(weighting(name).settling_s for name in WEIGHTINGS))
    first, interval = round(begin / step), round(INTERVAL / step)
    count = (rows[0].size - first) // interval
    in_zone = round(ZONE / INTERVAL)
    if count < in_zone:
        raise DataError(
            f"EN 12299: only {(rows[0].size - first) * step:.4g} s are left after the first {begin:g} s, but the mean "
            f"comfort needs at least {ZONE:g} s; use a longer record"
        )
    kept = slice(first, first + count * interval)
    squares = [weighted_record(step, row, name)[kept] ** 2 for row, name in zip(rows, WEIGHTINGS, strict=True)]
    continuous = np.sqrt([square.reshape(count, interval).mean(axis=1) for square in squares])
    # (axes, zones, values of a zone)
    zones = continuous[:, : count // in_zone * in_zone].reshape(3, -1, in_zone)
    quantiles = np.quantile(zones, 0.95, axis=2)
    return RailComfort(continuous=continuous, mean=6.0 * np.sqrt(np.sum(quantiles**2, axis=0)))


def comfort_words(mean: float) -> str:
    """Return the words of the standard for a mean comfort N_MV."""
    return next((name for limit, name in SCALE if mean < limit), "very uncomfortable")
