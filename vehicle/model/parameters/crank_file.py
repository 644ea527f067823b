"""Measured speed of a crankshaft over time."""

from functools import lru_cache
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.model.parameters.driving import HIGHEST_RPM
from vehicle.signals.formats.channel import Channel, Measurement
from vehicle.signals.formats.reader import read_record

UNITS = ("1/min", "rpm", "RPM", "min-1", "r/min")
"""Units of a speed."""


def measured_speed(file: str, channel: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return times [s] and speeds [rad/s] of a crankshaft of a file; its time begins at 0.

    Args:
        file: measurement file of any format of `vehicle.signals.formats`.
        channel: number or name of the channel; empty for the only one in 1/min or rpm.

    Raises:
        ConfigurationError: the file does not exist.
        DataError: the channel is missing, has a gap, or is no speed of an engine.
    """
    path = Path(file)
    return _speed(file, channel, path.stat().st_mtime_ns if path.is_file() else 0)


@lru_cache(maxsize=4)
def _speed(file: str, channel: str, changed: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    measured = _channel(read_record(file), file, channel)
    where = f"{file}: the speed {measured.name!r}"
    if measured.axis is None or measured.kind != "time":
        raise DataError(f"{where} has no times; add a time column")
    time, rpm = np.asarray(measured.axis, dtype=float), np.asarray(measured.values, dtype=float)
    if time.size < 2 or not np.isfinite([time, rpm]).all() or np.any(np.diff(time) <= 0.0):
        raise DataError(f"{where} has a gap or decreasing times; correct the record")
    low, high = float(np.min(rpm)), float(np.max(rpm))
    if low < 0.0 or not 0.0 < high <= HIGHEST_RPM:
        raise DataError(
            f"{where} is {low:g} to {high:g} 1/min but must be 0 to {HIGHEST_RPM:g} 1/min; choose another crank.channel"
        )
    return tuple((time - time[0]).tolist()), tuple((rpm * np.pi / 30.0).tolist())


def _channel(measurement: Measurement, file: str, wanted: str) -> Channel:
    """Return the channel of a number or name, or the only one in 1/min or rpm."""
    channels = measurement.channels
    if wanted.isdigit():
        chosen = channels[int(wanted) - 1 : int(wanted)] if int(wanted) else []
    else:
        chosen = [each for each in channels if (each.name == wanted if wanted else each.unit in UNITS)]
    if len(chosen) != 1:
        listed = ", ".join(f"{n} {each.name!r} [{each.unit}]" for n, each in enumerate(channels, 1))
        failure = f"match {wanted!r}" if wanted else "are in 1/min or rpm"
        raise DataError(f"{file}: {len(chosen)} channels {failure}; set crank.channel to a number or name of: {listed}")
    return chosen[0]
