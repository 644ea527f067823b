"""Measured accelerations that the car is to answer with, on the samples of its runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.excitation.signal import MINIMUM_SAMPLES, uniform_time
from vehicle.signals.records.channel_faults import copies
from vehicle.signals.records.choice import Choice, choose
from vehicle.signals.records.integration import filtered
from vehicle.signals.records.reader import read_record
from vehicle.signals.records.table import USABLE
from vehicle.studies.replication.inverse import Lines, Vector

LEAST_PERIODS = 2.0
"""Periods of the lower edge that a record must hold."""

HIGHEST = 100.0
"""Largest upper edge [Hz]: up to it the recorded accelerations are true within 0.02 %."""

SMALLEST = 1e-6
"""RMS of an acceleration in the band [m/s2] below which no sensor has seen motion."""

OUTSIDE = 0.05
"""Share of the variance of a target outside the band from which on it is mentioned."""

OVERSAMPLING = 20.0
"""Samples for each period of the upper edge between which a cubic spline is drawn: its error is below 3e-5 there."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Target:
    """Accelerations to be met.

    Attributes:
        channels: of the car, k.
        time: [s], (n,), from 0.
        values: [m/s2], (k, n).
        lines: of the record, with the band.
        band: edges [Hz].
        source: the file.
        sha256: of its bytes.
        notices: what was done to them.
    """

    channels: tuple[str, ...]
    time: Vector
    values: Vector
    lines: Lines
    band: tuple[float, float]
    source: Path
    sha256: str
    notices: tuple[str, ...]


def read_target(path: Path, names: Mapping[str, str], choice: Choice, band: tuple[float, float], rate: float) -> Target:
    """Read a target.

    Args:
        path: a measurement file of any format.
        names: channel of the car to the number, exact name, or pattern of the one in the file.
        choice: what else is asked of the file.
        band: edges [Hz].
        rate: samples a second of the runs [Hz].

    Raises:
        ConfigurationError: a band that the record does not hold.
        DataError: bad data, another quantity than acceleration, nothing in the band.
    """
    measurement = read_record(path, choice.databases)
    times = {role: name for role, name in choice.channels.items() if role == "time"}
    chosen = choose(measurement, replace(choice, channels={**times, **names}))
    chosen.require_uniform(path)
    for role, quantity in chosen.quantities.items():
        if quantity != "acceleration":
            raise DataError(
                f"{path}: {role}: found a {quantity}; a drive is found from accelerations; choose another channel, or "
                f"give --unit {role}=m/s2 or {role}=g if the file is wrong"
            )
    values, notices = dict(chosen.values), list(chosen.notices)
    if choice.highpass is not None:
        values, said = filtered(chosen, choice.highpass)
        notices = list(said)
    count = chosen.time.size
    if count < MINIMUM_SAMPLES:
        raise DataError(f"{path}: {count} samples; allowed from {MINIMUM_SAMPLES} on; this is no record of a vibration")
    step = float(chosen.time[-1] - chosen.time[0]) / (count - 1)
    _check_band(path, band, step, count, chosen.highest)
    found, said_of_band = _on_samples(np.array([values[name] for name in names]), step, band, rate)
    lines = Lines(found.shape[1], 1.0 / rate, band)
    notices += [
        f"{one} and {other} hold the same samples: right for heave alone; else choose another: --channel {other}=NAME"
        for one, other in copies(chosen.values)
    ]
    notices += [*said_of_band, *_outside(names, np.array([values[name] for name in names]), found, lines, band)]
    for name, inside in zip(names, lines.in_band(found), strict=True):
        if float(np.std(inside)) < SMALLEST:
            raise DataError(
                f"{path}: {name}: RMS {np.std(inside):.3g} m/s2 between {band[0]:g} and {band[1]:g} Hz; needed is at "
                f"least {SMALLEST:g} m/s2; choose another channel or --band"
            )
    return Target(
        channels=tuple(names),
        time=uniform_time(samples=found.shape[1], timestep=1.0 / rate),
        values=found,
        lines=lines,
        band=band,
        source=path,
        sha256=measurement.sha256,
        notices=tuple(notices),
    )


def _check_band(path: Path, band: tuple[float, float], step: float, count: int, held: float) -> None:
    lowest, highest = LEAST_PERIODS / (step * (count - 1)), min(USABLE / step, held, HIGHEST)
    if not lowest <= band[0] < band[1] <= highest * (1.0 + 1e-9):
        raise ConfigurationError(
            f"--band {band[0]:g}:{band[1]:g}: {path} holds {step * (count - 1):.4g} s at {1.0 / step:.6g} Hz, so the "
            f"edges may be {lowest:.3g} to {highest:.4g} Hz, the lower one first"
        )


def _on_samples(values: Vector, step: float, band: tuple[float, float], rate: float) -> tuple[Vector, list[str]]:
    """Records at another rate: their spectrum up to the end of the band, evaluated finely, and splines between."""
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
    found = scipy.interpolate.CubicSpline(np.arange(fine.shape[1]) * (step / finer), fine, axis=1)(at)
    return found, [f"target brought from {1.0 / step:.6g} Hz to the {rate:g} Hz of the runs, up to {band[1]:g} Hz"]


def _outside(
    names: Sequence[str] | Mapping[str, str], as_found: Vector, values: Vector, lines: Lines, band: tuple[float, float]
) -> list[str]:
    """A notice for each target of which a part lies outside the band and is left out."""
    shares = 1.0 - np.var(lines.in_band(values), axis=1) / np.maximum(np.var(as_found, axis=1), 1e-300)
    return [
        f"{name}: {100.0 * share:.0f} % of the variance of the target lies outside {band[0]:g} to {band[1]:g} Hz and "
        "is not replicated"
        for name, share in zip(names, shares, strict=True)
        if share > OUTSIDE
    ]
