"""Pressure in a cylinder over the crank angle from a measurement file, for the gas torque of an engine."""

import math
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.units import allowed_units, find_unit

CYCLE = 720.0
"""Crank angle of a cycle of a four-stroke engine [deg]."""

COARSEST = 3.0
"""Largest step of the crank angle [deg]: up to order 8, the torque of the modelled gas is then off by 4e-5 of its order
2."""

LOWEST_PEAK, HIGHEST_PEAK = 2.0, 400.0
"""Range of the largest pressure [bar]: a motored engine behind a closed throttle, and more than any engine of a car."""

ROUNDING = 1e-3
"""Rounding of crank angles in a file [deg]."""

NEAR_TOP = 60.0
"""Largest angle between the top dead centre of combustion and the largest pressure [deg]."""


def pressure_at(file: str, angles: Vector) -> Vector:
    """Return the absolute pressure in a cylinder at crank angles [Pa], periodic over 720 degrees.

    Cubic spline through the samples of the file.

    Args:
        file: measurement file with a column of crank angles, 0 (or 720) at the top dead centre of combustion, and a
            column of absolute pressures.
        angles: crank angles [rad]; (n,).

    Raises:
        ConfigurationError: the file does not exist.
        DataError: the columns are missing, do not cover a cycle, are not sorted, or are implausible.
    """
    path = Path(file)
    changed = path.stat().st_mtime_ns if path.is_file() else 0
    spline: CubicSpline = _trace(file, changed)
    return np.asarray(spline(np.degrees(angles)))


@lru_cache(maxsize=16)
def _trace(file: str, changed: int) -> CubicSpline:
    """Return the periodic spline of the pressure [Pa] over the crank angle [deg]."""
    measurement = read_record(file)
    angle = np.degrees(_column(measurement, "angle", "crank angle [deg]"))
    pressure = _column(measurement, "pressure", "pressure [bar]")
    if angle.size != pressure.size:
        raise DataError(f"{file}: has {angle.size} crank angles but {pressure.size} pressures")
    steps = np.diff(angle)
    if not (steps > 0.0).all():
        row = int(np.flatnonzero(steps <= 0.0)[0]) + 1
        raise DataError(
            f"{file}: crank angle {angle[row]:g} deg follows {angle[row - 1]:g} deg; the angle must increase through a "
            "single cycle; sort the rows, and average the cycles of a longer record"
        )
    # The first sample of the next cycle may be there or not.
    span = float(angle[-1] - angle[0])
    largest = float(steps.max(initial=CYCLE - span))
    if span > CYCLE + ROUNDING or largest > COARSEST + ROUNDING:
        raise DataError(
            f"{file}: found crank angles from {angle[0]:g} to {angle[-1]:g} deg in steps of up to {largest:g} "
            f"deg, must be a cycle of 720 deg in steps of at most {COARSEST:g} deg; fill gaps, or average the "
            "cycles of a record"
        )
    _plausible(file, angle, pressure)
    if span > CYCLE - ROUNDING:
        angle, pressure = angle[:-1], pressure[:-1]
    closed = np.append(pressure, pressure[0])
    return CubicSpline(np.append(angle, angle[0] + CYCLE), closed, bc_type="periodic", extrapolate="periodic")


def _column(measurement: Measurement, quantity: str, example: str) -> Vector:
    """Return the only channel of a quantity in its SI unit."""
    channels = [channel for channel in measurement.channels if channel.quantity == quantity]
    if len(channels) != 1:
        shown = ", ".join(f"{channel.name!r} [{channel.unit}]" for channel in measurement.channels[:12]) or "none"
        raise DataError(
            f"{measurement.path}: {len(channels)} columns have a unit of {quantity} ({allowed_units(quantity)}), but "
            f"only one column may have it, for example {example!r}; found {shown}"
        )
    values = np.asarray(channels[0].si_values, dtype=np.float64)
    if not np.isfinite(values).all():
        row = int(np.flatnonzero(~np.isfinite(values))[0]) + 1
        raise DataError(f"{measurement.path}: {channels[0].name!r}: row {row} is not a number; correct the row")
    return values


def _plausible(file: str, angle: Vector, pressure: Vector) -> None:
    """Check size and place of the pressures [Pa]."""
    unit = find_unit("bar")
    assert unit is not None
    bar = pressure / unit.factor
    top, lowest = int(np.argmax(bar)), float(bar.min())
    if not LOWEST_PEAK <= bar[top] <= HIGHEST_PEAK:
        raise DataError(
            f"{file}: the largest pressure is {bar[top]:.4g} bar but must be {LOWEST_PEAK:g} to {HIGHEST_PEAK:g} bar; "
            "correct the unit of the column"
        )
    if lowest <= 0.0:
        raise DataError(
            f"{file}: the smallest pressure is {lowest:.4g} bar but must be above 0 bar, because pressures are "
            "absolute; add the ambient pressure, or the offset of the sensor"
        )
    behind = math.remainder(float(angle[top]), CYCLE)
    if abs(behind) > NEAR_TOP:
        raise DataError(
            f"{file}: the largest pressure is at {angle[top]:g} deg but must be within {NEAR_TOP:g} deg of 0 or 720 "
            "deg, "
            "the top dead centre of combustion; shift the angles"
        )
