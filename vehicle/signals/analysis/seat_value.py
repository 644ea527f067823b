"""What a seat does to the vibration of its rail: weighted accelerations of both and their ratio, the SEAT value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.exposure import vector_sum, vibration_dose_value, weighted_rms
from vehicle.signals.analysis.weighting import weighted_record


@dataclass(frozen=True, kw_only=True, slots=True)
class SeatValue:
    """Seat effective amplitude transmissibility along z: below 1 the seat isolates."""

    rms: float
    """weighted RMS on the seat over that of the rail [-]"""
    vdv: float
    """the same of the vibration dose value, for shocks [-]"""
    weighting: str
    """of both"""


def seat_value(
    time_step: float, seat: ArrayLike, rail: ArrayLike, *, place: str = "seat", skip: float = 0.0
) -> SeatValue:
    """SEAT = a_w(seat) / a_w(rail), vertical accelerations that are weighted alike: as on a seat, by Wk.

    Args:
        time_step: [s].
        seat, rail: acceleration along z on the cushion and below it [m/s2], shape (n,).
        place: "seat", or "seat_bs6841" with Wb.
        skip: seconds left out at the beginning; the filters run through them.

    Raises:
        ConfigurationError: a place that is no seat.
        DataError: the rail is at rest, or as of `weighted_record`.

    Source: ISO 10326-1; Griffin, Handbook of Human Vibration (1990), chapter 9.
    """
    if place not in ("seat", "seat_bs6841"):
        raise ConfigurationError(f"SEAT value: found place {place!r}, allowed are seat and seat_bs6841")
    name = application(place).weightings[2]
    above, below = (weighted_record(time_step, one, name)[round(skip / time_step) :] for one in (seat, rail))
    base = weighted_rms(below)
    if base == 0.0:
        raise DataError("SEAT value: the rail is at rest, so there is nothing that the seat could transmit")
    doses = [vibration_dose_value(time_step, one) for one in (above, below)]
    return SeatValue(rms=weighted_rms(above) / base, vdv=doses[0] / doses[1], weighting=name)


def weighted_rms_of(
    time_step: float, xyz: ArrayLike, *, place: str = "seat", skip: float = 0.0
) -> tuple[float, float, float, float]:
    """Weighted RMS of each axis and their vector sum [m/s2]; arguments as of `evaluate`.

    Source: ISO 2631-1:1997, 6.1 and 6.5.
    """
    one, records = application(place), np.asarray(xyz, dtype=np.float64)
    x, y, z = (
        weighted_rms(weighted_record(time_step, record, name)[round(skip / time_step) :])
        for record, name in zip(records, one.weightings, strict=True)
    )
    return x, y, z, vector_sum((x, y, z), one.comfort_factors)
