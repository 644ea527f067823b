"""Speed of a drive from a channel of the record: a velocity, or latitude and longitude of a satellite receiver.

A receiver writes a fix one to ten times a second; rows between repeat it or are empty. With the radii of curvature M
of the meridian and N of the parallel (WGS 84), a position is x = N cos(phi) lambda, y = M phi, and the velocity at a
fix is the slope of the straight lines of least squares over the fixes within `AROUND`. Their scatter gives the
standard error of the speed. Errors of positions that last longer than that cancel.

Source: National Imagery and Mapping Agency, TR8350.2, World Geodetic System 1984, 3rd ed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.recorded_road import PREFIX
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.records.choice import Choice, pick

POSITION = "position:"
"""Prefix of a speed that is two channels, latitude and longitude."""

OF_SPEED = ("speed", "latitude", "longitude")
"""Roles of channels that only give the speed."""

EQUATOR, ECCENTRICITY = 6378137.0, 6.69437999014e-3
"""Semi-major axis a [m] and squared eccentricity e^2 [-] of the ellipsoid (WGS 84)."""

AROUND = 2.0
"""Time before and after a fix whose fixes give its velocity [s]; a car that brakes changes its speed evenly in it."""

UNSURE = 0.02
"""Largest standard error of the speed [-]: the simulated drives differ by as much from the stated speed."""


def recorded_speed(measurement: Measurement, text: str, choice: Choice, time: Vector) -> tuple[Vector, tuple[str, ...]]:
    """Return the speed [m/s] at times (n,), and notices.

    Args:
        measurement: content of the file.
        text: channel:NAME of a velocity, or position:LATITUDE,LONGITUDE.
        choice: units of the roles speed, latitude and longitude, rate and times.
        time: times of the record [s].

    Raises:
        ConfigurationError: another form of the text.
        DataError: a channel that is missing, has another quantity or too few values, or positions that scatter.
    """
    if text.startswith(PREFIX):
        at, speed = _values(measurement, text.removeprefix(PREFIX), "speed", "velocity", "km/h", choice)
        return np.interp(time, at, speed), ()
    names = [name.strip() for name in text.removeprefix(POSITION).split(",")]
    if len(names) != 2 or not all(names):
        raise ConfigurationError(f"--speed {text}: must name two channels, position:LATITUDE,LONGITUDE")
    (at, latitude), (_, longitude) = (
        _values(measurement, name, role, "angle", "deg", choice)
        for name, role in zip(names, ("latitude", "longitude"), strict=True)
    )
    if latitude.size != longitude.size:
        raise DataError(f"{measurement.path}: --speed {text}: has {latitude.size} latitudes and {longitude.size} "
                        "longitudes; choose two channels of one receiver")  # fmt: skip
    at, speed, error = speed_of_positions(at, latitude, longitude)
    share = error / float(np.median(speed)) if np.median(speed) > 0.0 else np.inf
    if not share <= UNSURE:
        raise DataError(
            f"{measurement.path}: --speed {text}: the positions scatter, so that the speed is uncertain by "
            f"{number(100.0 * share, 2)} %, but at most {100.0 * UNSURE:g} % are allowed; set --speed LOW:HIGH"
        )
    low, high = 3.6 * float(speed.min()), 3.6 * float(speed.max())
    notice = (
        f"speed from {at.size} positions: {number(low)} to {number(high)} km/h, standard error "
        f"{number(3.6 * error, 2)} km/h"
    )
    return np.interp(time, at, speed), (notice,)


def speed_of_positions(time: Vector, latitude: Vector, longitude: Vector) -> tuple[Vector, Vector, float]:
    """Return the times of the fixes [s], the speeds there [m/s], and the median of their standard errors [m/s].

    Args:
        time: times [s]; (n,).
        latitude, longitude: positions [rad]; (n,). Repeated positions count once, at their first time.

    Raises:
        DataError: fewer than four fixes.
    """
    fresh = np.flatnonzero((np.diff(latitude) != 0.0) | (np.diff(longitude) != 0.0)) + 1
    at = np.concatenate([[0], fresh])
    if at.size < 4:
        raise DataError(f"diagnose: the record has {at.size} different positions, but a speed needs at least 4; set "
                        "--speed KM/H")  # fmt: skip
    time, latitude, longitude = time[at], latitude[at], longitude[at]
    middle = float(np.mean(latitude))
    flat = 1.0 - ECCENTRICITY * np.sin(middle) ** 2
    parallel, meridian = EQUATOR / np.sqrt(flat), EQUATOR * (1.0 - ECCENTRICITY) / flat**1.5
    position = np.stack([parallel * np.cos(middle) * np.unwrap(longitude), meridian * latitude])
    speeds, errors = np.zeros(time.size), np.full(time.size, np.nan)
    first = np.minimum(np.searchsorted(time, time - AROUND), np.maximum(np.arange(time.size) - 1, 0))
    last = np.maximum(np.searchsorted(time, time + AROUND, "right"), np.arange(time.size) + 2)
    for row, (begin, end) in enumerate(zip(first, last, strict=True)):
        t = time[begin:end] - time[begin:end].mean()
        each = position[:, begin:end] - position[:, begin:end].mean(axis=1, keepdims=True)
        slope = each @ t / (t @ t)
        speeds[row] = float(np.hypot(*slope))
        if t.size > 2:
            # Variance of a slope, s^2/sum t^2, with n - 2 degrees of freedom; mean of both axes.
            residual = each - slope[:, None] * t
            errors[row] = float(np.sqrt(np.sum(residual**2) / (2.0 * (t.size - 2) * (t @ t))))
    return time, speeds, float(np.nanmedian(errors))


def _values(
    measurement: Measurement, name: str, role: str, quantity: str, unit: str, choice: Choice
) -> tuple[Vector, Vector]:
    """Return the times [s] and the values [SI] of a channel without its empty rows."""
    channel = measurement.channels[pick(measurement, name, option="--speed")]
    channel = replace(channel, unit=choice.units.get(role, channel.unit))
    if channel.quantity != quantity:
        raise DataError(
            f"{measurement.path}: --speed: {channel.name!r} is no {quantity} but {channel.quantity or 'without a unit'}"
            f"; choose another channel, or set --unit {role}={unit}"
        )
    values = np.asarray(channel.si_values, dtype=np.float64)
    if choice.rate is not None:
        time = np.arange(values.size) / choice.rate
    elif "time" in choice.channels:
        times = measurement.channels[pick(measurement, choice.channels["time"])]
        time = np.asarray(replace(times, unit=choice.units.get("time", times.unit)).si_values, dtype=np.float64)
    else:
        time = np.zeros(0) if channel.axis is None else channel.axis
    present = np.isfinite(values) if time.size == values.size else np.zeros(0, dtype=bool)
    if np.count_nonzero(present) < 2:
        raise DataError(f"{measurement.path}: --speed: {channel.name!r} has fewer than two values with times; choose "
                        "another channel")  # fmt: skip
    return time[present], values[present]
