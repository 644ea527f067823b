"""What a sampled record must be before anything is computed from it: numbers, finite, of one length and rate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.errors import ConfigurationError, DataError

SAMPLES_PER_PERIOD = 2.5
"""Least sampling rate over the highest frequency evaluated: an anti-alias filter needs room below Nyquist (2.0)."""

USABLE = 1.0 / SAMPLES_PER_PERIOD
"""Highest frequency that a record holds, as a share of its sampling rate [-]."""


def checked_time_step(time_step: float) -> float:
    """Return the time step [s] when it is a positive finite number, else raise `ConfigurationError`."""
    step = float(time_step)
    if not (np.isfinite(step) and step > 0.0):
        raise ConfigurationError(f"time step: found {time_step!r} s, allowed is a finite number above 0 s")
    return step


def checked_signals(what: str, signals: ArrayLike) -> NDArray[np.float64]:
    """Return one signal (n,) or several (k, n) as floats of shape (k, n); refuse other shapes and non-finite values.

    Args:
        what: how the signals are called in a message.
        signals: samples, shape (n,) or (k, n).

    Raises:
        DataError: wrong shape, no sample, or a NaN or infinite value (the first one is located).
    """
    array = np.asarray(signals, dtype=np.float64)
    if array.ndim not in (1, 2) or array.size == 0:
        raise DataError(f"{what}: found an array of shape {array.shape}, needed is (n,) or (k, n) with n > 0 samples")
    array = np.atleast_2d(array)
    bad = ~np.isfinite(array)
    if bad.any():
        row, column = (int(i) for i in np.argwhere(bad)[0])
        raise DataError(
            f"{what}: found {array[row, column]} at sample {column} of signal {row} "
            f"({int(bad.sum())} values are not finite); repair or cut the record"
        )
    return array


def checked_rows(what: str, signals: ArrayLike | Sequence[NDArray[np.float64]]) -> Sequence[NDArray[np.float64]]:
    """The rows of `checked_signals`; of a sequence of signals (n,) as they stand, without a copy of them all."""
    if isinstance(signals, list | tuple) and all(isinstance(row, np.ndarray) and row.ndim == 1 for row in signals):
        rows = [checked_signals(f"{what} {number}", row)[0] for number, row in enumerate(signals)]
        if rows:
            for number, row in enumerate(rows):
                checked_same_length(f"{what} {number}", row, f"{what} 0", rows[0].size)
            return rows
    return list(checked_signals(what, signals))


def checked_same_length(what: str, signals: NDArray[np.float64], other: str, length: int) -> None:
    """Refuse signals (k, n) whose n differs from the length of the other record; nothing is cut silently."""
    if signals.shape[-1] != length:
        raise DataError(
            f"{what}: found {signals.shape[-1]} samples, {other} has {length}; "
            "both must cover the same time at the same rate"
        )


def checked_band(band: tuple[float, float], time_step: float) -> tuple[float, float]:
    """Return the band (low, high) [Hz] when 0 <= low < high and the sampling rate is at least 2.5 high.

    Raises:
        ConfigurationError: the band is empty, negative or not finite.
        DataError: the record is sampled too slowly for the upper edge.
    """
    low, high = (float(edge) for edge in band)
    if not (np.isfinite([low, high]).all() and 0.0 <= low < high):
        raise ConfigurationError(f"band: found {low:g} to {high:g} Hz, allowed is 0 <= low < high, both finite")
    rate = 1.0 / time_step
    if rate < SAMPLES_PER_PERIOD * high * (1.0 - 1e-9):
        raise DataError(
            f"sampling rate: found {rate:g} Hz, at least {SAMPLES_PER_PERIOD * high:g} Hz is needed to evaluate up to "
            f"{high:g} Hz; sample faster or lower the band edge to {rate / SAMPLES_PER_PERIOD:g} Hz"
        )
    return low, high


def lines_in_band(frequency: NDArray[np.float64], band: tuple[float, float]) -> NDArray[np.bool_]:
    """Tell which lines [Hz], shape (m,), lie in the closed band; a line on an edge counts in spite of rounding."""
    slack = 1e-9 * (frequency[-1] if frequency.size else 0.0)
    return (frequency >= band[0] - slack) & (frequency <= band[1] + slack)


def is_constant(signals: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which of the signals (k, n) do not move: peak to peak within the rounding of their own size."""
    size = np.abs(signals).max(axis=-1)
    return np.asarray(np.ptp(signals, axis=-1) <= 8.0 * np.finfo(np.float64).eps * size)


def checked_names(what: str, names: Sequence[str] | None, count: int) -> tuple[str, ...]:
    """Return one name for each signal: those given, or `what 0`, `what 1`, ..."""
    if names is None:
        return tuple(f"{what} {i}" for i in range(count))
    if len(names) != count:
        raise ConfigurationError(f"names: found {len(names)} for {count} {what} signals; give one for each")
    return tuple(names)
