"""Measured accelerations to be replicated, resampled to the rate of the runs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.signal import MINIMUM_SAMPLES, uniform_time
from vehicle.signals.formats.reader import read_record
from vehicle.signals.formats.table import USABLE
from vehicle.signals.records.channel_faults import copies
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.delays import channel_delays, without_delays
from vehicle.signals.records.integration import filtered
from vehicle.studies.replication.inverse import Lines

LEAST_PERIODS = 2.0
"""Minimum length of a record in periods of the lower edge."""

HIGHEST = 100.0
"""Maximum upper edge [Hz]: up to 100 Hz recorded accelerations are exact within 0.02 %."""

SMALLEST = 1e-6
"""Minimum RMS of an acceleration in the band [m/s2]: a smaller value is below the noise of any sensor."""

OUTSIDE = 0.05
"""Maximum share of the variance of a target outside the band without a notice."""

OVERSAMPLING = 20.0
"""Samples per period of the upper edge for the interpolation by a cubic spline, whose error is then below 3e-5."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Target:
    """Accelerations to be replicated."""

    channels: tuple[str, ...]  # channels of the car, (k,)
    time: Vector  # sampling times from 0 [s], (n,)
    values: Vector  # accelerations [m/s2], (k, n)
    lines: Lines  # spectral lines of the record, with the band
    band: tuple[float, float]  # lower and upper edge [Hz]
    source: Path  # measurement file
    sha256: str  # digest of the file
    notices: tuple[str, ...]  # messages on the processing of the file
    delays: Mapping[str, float] = field(default_factory=dict)  # channel to delay that was taken out [s]


def read_target(path: Path, names: Mapping[str, str], choice: Choice, band: tuple[float, float], rate: float) -> Target:
    """Read accelerations from a measurement file as a target.

    Args:
        names: channel of the car to number, exact name, or pattern of the channel of the file.
        choice: units, rate, filters and excerpt of the file.
        band: lower and upper edge [Hz].
        rate: sampling rate of the runs [Hz].

    Raises:
        ConfigurationError: the record does not cover the band.
        DataError: bad data, another quantity than acceleration, or no vibration in the band.
    """
    measurement = read_record(path, choice.databases)
    times = {role: name for role, name in choice.channels.items() if role == "time"}
    chosen = choose(measurement, replace(choice, channels={**times, **names}))
    chosen.require_uniform(path)
    delays = channel_delays(tuple(names), choice.delays)
    chosen = without_delays(chosen, delays)
    for role, quantity in chosen.quantities.items():
        if quantity != "acceleration":
            raise DataError(
                f"{path}: {role}: is a {quantity} but must be an acceleration; choose another channel, or set "
                f"--unit {role}=m/s2 or {role}=g if the file is wrong"
            )
    values, notices = dict(chosen.values), list(chosen.notices)
    if choice.highpass is not None:
        values, messages = filtered(chosen, choice.highpass)
        notices = list(messages)
    count = chosen.time.size
    if count < MINIMUM_SAMPLES:
        raise DataError(
            f"{path}: contains {count} samples, but at least {MINIMUM_SAMPLES} are needed; use a longer record"
        )
    step = float(chosen.time[-1] - chosen.time[0]) / (count - 1)
    _check_band(path, band, step, count, chosen.highest)
    accelerations, rate_notices = _resampled(np.array([values[name] for name in names]), step, band, rate)
    lines = Lines(accelerations.shape[1], 1.0 / rate, band)
    notices += [
        f"{first} and {second} have the same samples, which is right only in pure heave; otherwise choose "
        f"another channel with --channel {second}=NAME"
        for first, second in copies(chosen.values)
    ]
    notices += [*rate_notices, *_outside(names, np.array([values[name] for name in names]), accelerations, lines, band)]
    for name, inside in zip(names, lines.in_band(accelerations), strict=True):
        if float(np.std(inside)) < SMALLEST:
            raise DataError(
                f"{path}: {name}: RMS {np.std(inside):.3g} m/s2 between {band[0]:g} and {band[1]:g} Hz, must be at "
                f"least {SMALLEST:g} m/s2; choose another channel or --band"
            )
    return Target(
        channels=tuple(names),
        time=uniform_time(samples=accelerations.shape[1], timestep=1.0 / rate),
        values=accelerations,
        lines=lines,
        band=band,
        source=path,
        sha256=measurement.sha256,
        notices=tuple(notices),
        delays=delays,
    )


def _check_band(path: Path, band: tuple[float, float], step: float, count: int, held: float) -> None:
    """Check that a record covers a band; `held` is the highest frequency of its content [Hz]."""
    lowest, highest = LEAST_PERIODS / (step * (count - 1)), min(USABLE / step, held, HIGHEST)
    if not lowest <= band[0] < band[1] <= highest * (1.0 + 1e-9):
        raise ConfigurationError(
            f"--band {band[0]:g}:{band[1]:g}: {path} contains {step * (count - 1):.4g} s at {1.0 / step:.6g} Hz; the "
            f"edges must be ascending and within {lowest:.3g} to {highest:.4g} Hz"
        )


def _resampled(values: Vector, step: float, band: tuple[float, float], rate: float) -> tuple[Vector, list[str]]:
    """Resample records by inverse FFT up to the end of the band, then cubic splines; with a notice of another rate."""
    if abs(rate * step - 1.0) < 1e-9:
        return values, []
    count = values.shape[1]
    lines = Lines(count, step, band)
    spectrum = scipy.fft.rfft(values - values.mean(axis=1, keepdims=True), lines.size)
    spectrum[:, lines.used[-1] + 1 :] = 0.0
    finer = max(1, int(np.ceil(OVERSAMPLING * band[1] * step)))
    fine = finer * scipy.fft.irfft(spectrum, finer * lines.size)[:, : finer * count]
    samples = int(np.floor(step * (count - 1) * rate * (1.0 + 1e-9))) + 1
    at = np.minimum(np.arange(samples) / rate, step * (count - 1))
    resampled = scipy.interpolate.CubicSpline(np.arange(fine.shape[1]) * (step / finer), fine, axis=1)(at)
    return resampled, [
        f"target resampled from {1.0 / step:.6g} Hz to the {rate:g} Hz of the runs, up to {band[1]:g} Hz"
    ]


def _outside(
    names: Sequence[str] | Mapping[str, str], as_found: Vector, values: Vector, lines: Lines, band: tuple[float, float]
) -> list[str]:
    """Return a notice for each target with a significant part outside the band, which is not replicated."""
    shares = 1.0 - np.var(lines.in_band(values), axis=1) / np.maximum(np.var(as_found, axis=1), 1e-300)
    return [
        f"{name}: {100.0 * share:.0f} % of the variance of the target is outside {band[0]:g} to {band[1]:g} Hz and not "
        "replicated"
        for name, share in zip(names, shares, strict=True)
        if share > OUTSIDE
    ]
