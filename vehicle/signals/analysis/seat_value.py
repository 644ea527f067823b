"""SEAT value: ratio of the weighted vibration on a seat to its rail; weighted RMS by axis."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.exposure import vector_sum, vibration_dose_value, weighted_rms
from vehicle.signals.analysis.weighting import weighted_record
from vehicle.stored import Stored


@dataclass(frozen=True, kw_only=True, slots=True)
class SeatValue(Stored):
    """Seat effective amplitude transmissibility along z: a seat with a value below 1 isolates."""

    rms: float
    """weighted RMS, seat over rail [-]"""
    vdv: float
    """vibration dose value, seat over rail, for shocks [-]"""
    weighting: str
    """weighting of both accelerations"""


def seat_value(
    time_step: float, seat: ArrayLike, rail: ArrayLike, *, contact: str = "seat", skip: float = 0.0
) -> SeatValue:
    """Return the SEAT value a_w(seat) / a_w(rail) of vertical accelerations, both weighted by Wk (or Wb).

    Args:
        time_step: sampling interval [s].
        seat, rail: acceleration along z on the cushion and on the rail [m/s2], shape (n,).
        contact: point of contact, "seat", or "seat_bs6841" with Wb.
        skip: time skipped at the beginning [s]; the filters process it.

    Raises:
        ConfigurationError: a point of contact other than a seat.
        DataError: the acceleration of the rail is zero, or `weighted_record` rejects a record.

    Source: ISO 10326-1; Griffin, Handbook of Human Vibration (1990), chapter 9.
    """
    if contact not in ("seat", "seat_bs6841"):
        raise ConfigurationError(f"SEAT value: the point of contact must be seat or seat_bs6841, not {contact!r}")
    name = application(contact).weightings[2]
    above, below = (weighted_record(time_step, record, name)[round(skip / time_step) :] for record in (seat, rail))
    base = weighted_rms(below)
    if base == 0.0:
        raise DataError("SEAT value: the acceleration of the seat rail is zero throughout; check its channel")
    doses = [vibration_dose_value(time_step, record) for record in (above, below)]
    return SeatValue(rms=weighted_rms(above) / base, vdv=doses[0] / doses[1], weighting=name)


def weighted_rms_of(
    time_step: float, xyz: ArrayLike, *, contact: str = "seat", skip: float = 0.0
) -> tuple[float, float, float, float]:
    """Return the weighted RMS of x, y and z and their vector sum [m/s2]; for the arguments see `evaluate`.

    Source: ISO 2631-1:1997, 6.1 and 6.5.
    """
    x, y, z = map(weighted_rms, weighted_axes(time_step, xyz, contact=contact, skip=skip))
    return x, y, z, vector_sum((x, y, z), application(contact).comfort_factors)


def weighted_axes(time_step: float, xyz: ArrayLike, *, contact: str = "seat", skip: float = 0.0) -> Vector:
    """Return the weighted records of x, y and z [m/s2], (3, n), as in `weighted_rms_of`."""
    records, names = np.asarray(xyz, dtype=np.float64), application(contact).weightings
    rows = (weighted_record(time_step, record, name) for record, name in zip(records, names, strict=True))
    return np.stack([row[round(skip / time_step) :] for row in rows])
