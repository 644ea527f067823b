"""Checks of sampled records: finite values, equal lengths, sampling rate and band."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from vehicle.arrays import Complex as Complex
from vehicle.arrays import Mask
from vehicle.arrays import Vector as Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.mapped_table import release

SAMPLES_PER_PERIOD = 2.5
"""Minimum sampling rate over the highest evaluated frequency; above Nyquist (2.0), because of the anti-alias filter."""

USABLE = 1.0 / SAMPLES_PER_PERIOD
"""Highest usable frequency of a record over its sampling rate [-]."""


def checked_time_step(time_step: float) -> float:
    """Return the time step [s]; raise `ConfigurationError` unless it is positive and finite."""
    step = float(time_step)
    if not (np.isfinite(step) and step > 0.0):
        raise ConfigurationError(f"time step: found {time_step!r} s, must be a finite number above 0 s")
    return step


def checked_signals(label: str, signals: ArrayLike) -> Vector:
    """Return a signal (n,) or several (k, n) as floats of shape (k, n); reject other shapes and non-finite values.

    Args:
        label: name of the signals in messages.
        signals: samples, shape (n,) or (k, n).
    """
    array = np.asarray(signals, dtype=np.float64)
    if array.ndim not in (1, 2) or array.size == 0:
        raise DataError(f"{label}: found an array of shape {array.shape}, must be (n,) or (k, n) with n > 0 samples")
    array = np.atleast_2d(array)
    bad = ~np.isfinite(array)
    if bad.any():
        row, column = (int(i) for i in np.argwhere(bad)[0])
        raise DataError(
            f"{label}: found {array[row, column]} at sample {column} of signal {row} "
            f"({int(bad.sum())} values are not finite); correct or cut the record"
        )
    release(array)
    return array


def checked_single(label: str, item: str, signal: ArrayLike) -> Vector:
    """Return a single signal as floats, shape (n,); see `checked_signals`. The message calls it an `item`."""
    array = checked_signals(label, signal)
    if len(array) != 1:
        raise DataError(f"{label}: found {len(array)} signals, must be one {item}, shape (n,)")
    return np.asarray(array[0])


def checked_rows(label: str, signals: ArrayLike | Sequence[Vector]) -> Sequence[Vector]:
    """Return the rows of `checked_signals`; a sequence of signals (n,) is not copied to a single array."""
    if isinstance(signals, list | tuple) and all(isinstance(row, np.ndarray) and row.ndim == 1 for row in signals):
        rows = [checked_signals(f"{label} {number}", row)[0] for number, row in enumerate(signals)]
        if rows:
            for number, row in enumerate(rows):
                checked_same_length(f"{label} {number}", row, f"{label} 0", rows[0].size)
            return rows
    return list(checked_signals(label, signals))


def checked_same_length(label: str, signals: Vector, reference: str, length: int) -> None:
    """Raise an error if the length n of signals (k, n) differs from the length of the reference record."""
    if signals.shape[-1] != length:
        raise DataError(
            f"{label}: found {signals.shape[-1]} samples, {reference} has {length}; "
            "both must cover the same time at the same rate"
        )


def checked_band(band: tuple[float, float], time_step: float) -> tuple[float, float]:
    """Return the band (low, high) [Hz]; check 0 <= low < high and a sampling rate of at least 2.5 high."""
    low, high = (float(edge) for edge in band)
    if not (np.isfinite([low, high]).all() and 0.0 <= low < high):
        raise ConfigurationError(f"band: found {low:g} to {high:g} Hz, must be 0 <= low < high, both finite")
    rate = 1.0 / time_step
    if rate < SAMPLES_PER_PERIOD * high * (1.0 - 1e-9):
        raise DataError(
            f"sampling rate: found {rate:g} Hz, must be at least {SAMPLES_PER_PERIOD * high:g} Hz to evaluate up to "
            f"{high:g} Hz; sample faster or lower the band edge to {rate / SAMPLES_PER_PERIOD:g} Hz"
        )
    return low, high


def lines_in_band(frequency: Vector, band: tuple[float, float]) -> Mask:
    """Return a mask of the lines [Hz], shape (m,), in the closed band; rounding does not exclude a line on an edge."""
    slack = 1e-9 * (frequency[-1] if frequency.size else 0.0)
    return (frequency >= band[0] - slack) & (frequency <= band[1] + slack)


def band_shares(frequency: Vector, spacing: float, band: tuple[float, float]) -> Vector:
    """Return the share of each line k df in a band: the part of its cell, df/2 to both sides, inside the band; (m,).

    A mean square over the band is then an integral over its width, whatever the length of the record, and neighbouring
    bands add up. A line on an edge counts half, the line at 0 Hz whole in a band from 0 Hz on.

    Args:
        frequency: lines [Hz]; (m,).
        spacing: df [Hz].
        band: lowest and highest frequency [Hz].
    """
    low = band[0] or -spacing
    inside = np.minimum(frequency + 0.5 * spacing, band[1]) - np.maximum(frequency - 0.5 * spacing, low)
    return np.asarray(np.clip(inside / spacing, 0.0, 1.0))


def is_constant(signals: Vector) -> Mask:
    """Return a mask of the constant signals among (k, n): peak-to-peak value within the rounding of their magnitude."""
    size, extent = np.abs(signals).max(axis=-1), np.ptp(signals, axis=-1)
    release(signals)
    return np.asarray(extent <= 8.0 * np.finfo(np.float64).eps * size)


def refuse_constant(inputs: Vector, names: Sequence[str]) -> None:
    """Reject inputs of an FRF, (p, n), of which one does not move."""
    for row in np.flatnonzero(is_constant(inputs)).tolist():
        others = " or ".join(name for name in names if name != names[row])
        raise DataError(
            f"{names[row]}: constant at {inputs[row, 0]:.3g}, so there is no FRF from this channel; use "
            f"{others or 'a channel that moves'}"
        )


def checked_names(label: str, names: Sequence[str] | None, count: int) -> tuple[str, ...]:
    """Return a name for each signal: the given names, or `label 0`, `label 1`, ..."""
    if names is None:
        return tuple(f"{label} {i}" for i in range(count))
    if len(names) != count:
        raise ConfigurationError(f"names: found {len(names)} names for {count} {label} signals; name each signal")
    return tuple(names)
