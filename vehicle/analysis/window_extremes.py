"""Largest magnitude in every window of a record: the level of a random signal as a distribution."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.samples import checked_signals, checked_time_step
from vehicle.errors import ConfigurationError, DataError


def window_extremes(time_step: float, signal: ArrayLike, window_s: float = 0.5) -> NDArray[np.float64]:
    """Return max |x| of each of the windows that follow one another; an unfinished one at the end is left out.

    The extreme of one short window of a random signal is itself random. A single published one is compared with the
    percentiles of all windows.

    Args:
        time_step: [s].
        signal: one record, shape (n,).
        window_s: length of a window [s].

    Returns:
        Extremes, shape (w,), in the unit of the signal.

    Raises:
        ConfigurationError: the time step or the window is out of range.
        DataError: more than one signal, a value that is not finite, or a record shorter than a window.
    """
    step = checked_time_step(time_step)
    values = checked_signals("signal", signal)
    if values.shape[0] != 1:
        raise DataError(f"signal: found {values.shape[0]} signals, needed is one at a time, shape (n,)")
    length = float(window_s)
    if not (np.isfinite(length) and length >= step):
        raise ConfigurationError(f"window: found {window_s!r} s, allowed is at least one time step, {step:g} s")
    samples = round(length / step)
    count = values.shape[1] // samples
    if count == 0:
        raise DataError(
            f"signal: found {step * values.shape[1]:g} s, shorter than a window of {length:g} s; "
            "give a longer record or a shorter window"
        )
    return np.asarray(np.abs(values[0, : count * samples]).reshape(count, samples).max(axis=1))
