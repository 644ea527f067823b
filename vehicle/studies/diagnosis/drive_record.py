"""Record of a drive for a diagnosis: its accelerations, its speed, and the parts of it that can be used.

A part is usable if the car drives straight on at a steady speed over a random road: the speed is near the usual one,
the slow horizontal acceleration (braking, cornering) is small, and no window is far rougher than the rest (an obstacle,
a pothole, a standstill).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.measured import read_measured
from vehicle.studies.diagnosis.drive_speed import OF_SPEED, recorded_speed
from vehicle.studies.diagnosis.features import HIGHEST, LOWEST, WINDOW_S

SLOWEST, FASTEST = 20.0, 200.0
"""Speeds of a drive [km/h]: slower, the waves of a road are too short; faster, no road is public."""

STEADY = 0.05
"""Largest deviation of the speed in a part [-]."""

LARGEST_SLOW = 0.8
"""Largest slow horizontal acceleration [m/s2], beyond its median: harder braking moves 5 % of the load of an axle."""

SLOW_BAND = 0.4
"""Frequency below which an acceleration is slow [Hz]."""

ROUGHER, SMOOTHER, CREST = 3.0, 0.25, 5.5
"""Largest and smallest RMS of a second over the median, and largest peak over the RMS of its window, of half of the
channels [-]. On a random road the peak of a channel is 3.2 to 5, and the RMS of a second up to 2.3 times the median."""

SHORTEST, LONGEST = 16.0, 60.0
"""Least and most time of a record that is used [s]: seven windows, and a minute."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class DriveRecord:
    """Record of a drive.

    Attributes:
        name: name of the file.
        channels: names of accelerations of the model.
        samples: accelerations [m/s2]; (channels, n).
        rate: sampling rate [Hz].
        highest: highest usable frequency [Hz].
        speeds: least and greatest speed [m/s].
        speed: speed at the samples [m/s], (n,); None if the user states the speed.
        notices: messages on the record.
    """

    name: str
    channels: tuple[str, ...]
    samples: Vector
    rate: float
    highest: float
    speeds: tuple[float, float]
    speed: Vector | None = None
    notices: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Parts:
    """Usable parts of a record.

    Attributes:
        spans: first and last sample of each part.
        seconds: their total length [s].
        speeds: least and greatest speed in them [m/s].
        left_out: reason to the time that it leaves out [s].
    """

    spans: tuple[tuple[int, int], ...]
    seconds: float
    speeds: tuple[float, float]
    left_out: Mapping[str, float]


def read_drive(
    file: Path,
    acceleration_channels: Sequence[str],
    speed: float | str | tuple[float, float],
    choice: Choice,
    inverted: Collection[str] = (),
) -> DriveRecord:
    """Read a record of a drive.

    Args:
        file: record of any format.
        acceleration_channels: accelerations of the model.
        speed: speed [km/h], range of the speed [km/h], "channel:NAME", or "position:LATITUDE,LONGITUDE".
        choice: channel of the model to channel of the file, units and excerpt.
        inverted: channels measured in the opposite direction.

    Raises:
        ConfigurationError: a speed out of range, or no name of a channel.
        DataError: no acceleration, or bad data.
    """
    measurement = read_record(file, choice.databases)
    of_model = replace(choice, units={name: unit for name, unit in choice.units.items() if name not in OF_SPEED})
    measured = read_measured(
        file, acceleration_channels, of_model, inverted=inverted, measurement=measurement, histories_only=True
    )
    record = measured.record
    assert record is not None
    channels = tuple(record.channels)
    drive = DriveRecord(
        name=file.name,
        channels=channels,
        samples=np.array([record.channels[name] for name in channels]),
        rate=1.0 / record.step,
        highest=record.highest or 0.4 / record.step,
        speeds=(0.0, 0.0),
        notices=measured.notices,
    )
    if not isinstance(speed, str):
        low, high = (speed, speed) if isinstance(speed, int | float) else speed
        if not SLOWEST <= low <= high <= FASTEST:
            raise ConfigurationError(
                f"--speed {low:g} to {high:g} km/h: must be {SLOWEST:g} to {FASTEST:g} km/h, the lower first"
            )
        return replace(drive, speeds=(low / 3.6, high / 3.6))
    at_samples, notices = recorded_speed(measurement, speed, choice, record.time)
    speeds = float(at_samples.min()), float(at_samples.max())
    return replace(drive, speed=at_samples, speeds=speeds, notices=(*drive.notices, *notices))


def usable_parts(record: DriveRecord) -> Parts:
    """Return the parts of a record that a diagnosis can use.

    Raises:
        DataError: they are shorter than `SHORTEST`.
    """
    window, count = round(WINDOW_S * record.rate), record.samples.shape[1]
    good, left_out = np.ones(count, dtype=bool), dict[str, float]()

    def leave_out(reason: str, bad: Vector) -> None:
        fresh = float(np.sum(bad & good) / record.rate)
        if fresh > 0.0:
            left_out[reason] = fresh
        good[bad] = False

    if record.speed is not None:
        # The speed around which the car drives longest.
        middles = np.geomspace(SLOWEST / 3.6, FASTEST / 3.6, 200)
        near = np.abs(record.speed / middles[:, None] - 1.0) <= STEADY
        usual = middles[int(np.argmax(near.sum(axis=1)))]
        leave_out("another speed", np.abs(record.speed / usual - 1.0) > STEADY)
    horizontal = [row for row, name in enumerate(record.channels) if not name.endswith("_z")]
    if horizontal:
        accelerations = slow(record.samples[horizontal], record.rate)
        apart = accelerations - np.median(accelerations, axis=1, keepdims=True)
        leave_out("braking or cornering", np.sqrt(np.sum(apart**2, axis=0)) > LARGEST_SLOW)
    second = max(round(record.rate), 1)
    # Within the bands of the features: beyond them a stiff mount rattles without an obstacle.
    low = LOWEST, min(HIGHEST, 0.8 * record.rate / 2.0)
    inside = scipy.signal.butter(2, low, "bandpass", fs=record.rate, output="sos")
    fast = scipy.signal.sosfiltfilt(inside, record.samples, axis=1)
    level = np.sqrt(scipy.ndimage.uniform_filter1d(fast**2, second, axis=1, mode="nearest"))
    usual_level = np.median(level[:, good], axis=1, keepdims=True) if good.any() else np.ones((len(level), 1))
    over_window = np.sqrt(scipy.ndimage.uniform_filter1d(fast**2, window, axis=1, mode="nearest"))
    peaks = scipy.ndimage.maximum_filter1d(np.abs(fast), second, axis=1)
    # Half of the channels: the friction of one damper lets a single sensor jump without an obstacle.
    rough, high = np.median(level / usual_level, axis=0), np.median(peaks / over_window, axis=0)
    leave_out("single obstacles", (rough > ROUGHER) | (high > CREST))
    leave_out("standstill", np.all(level < SMOOTHER * usual_level, axis=0))
    spans, used = [], 0.0
    for first, last in _runs(good):
        if last - first >= window and used < LONGEST:
            last = min(last, first + int((LONGEST - used) * record.rate))
            if last - first >= window:
                spans.append((first, last))
                used += (last - first) / record.rate
    if used < SHORTEST:
        reasons = ", ".join(f"{reason} {seconds:.3g} s" for reason, seconds in left_out.items()) or "a short record"
        raise DataError(
            f"{record.name}: {used:.3g} s can be used, but a diagnosis needs {SHORTEST:g} s of steady drive straight "
            f"on (left out: {reasons}); record a longer drive at a steady speed"
        )
    if record.speed is None:
        speeds = record.speeds
    else:
        each = [float(np.mean(record.speed[first:last])) for first, last in spans]
        speeds = min(each), max(each)
    return Parts(spans=tuple(spans), seconds=used, speeds=speeds, left_out=left_out)


def slow(values: Vector, rate: float) -> Vector:
    """Return values below `SLOW_BAND`, (..., n), from values at a rate [Hz]."""
    return np.asarray(scipy.signal.sosfiltfilt(scipy.signal.butter(2, SLOW_BAND, fs=rate, output="sos"), values))


def _runs(good: Vector) -> list[tuple[int, int]]:
    """Return first and end of the runs of True, the longest first."""
    steps = np.flatnonzero(np.diff(np.concatenate([[0], good.astype(int), [0]])))
    runs = [(int(first), int(last)) for first, last in zip(steps[::2], steps[1::2], strict=True)]
    return sorted(runs, key=lambda run: run[0] - run[1])
