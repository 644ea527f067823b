"""Frequency response from whole periods of a periodic input: a ratio of lines, without leakage or window."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.analysis.samples import (
    checked_band,
    checked_same_length,
    checked_signals,
    checked_time_step,
    lines_in_band,
)
from vehicle.errors import ConfigurationError, DataError

EXCITED = 1e-6
"""Least share of the largest line of the excitation [-]: a line below it is not part of the periodic input."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PeriodicResponse:
    """FRF at the lines that a periodic input excites."""

    frequency: NDArray[np.float64]
    """excited lines in the band [Hz], shape (m,)"""
    response: NDArray[np.complex128]
    """H(f) [unit of response / unit of excitation], shape (k, m)"""
    periods: int
    """periods averaged, after those skipped [-]"""
    repeatability: NDArray[np.float64]
    """RMS difference of the first and the last period used over the RMS of the last, shape (k,) [-]; what is left of
    the transient (and the noise); NaN with a single period, 0 for a response at rest"""


def periodic_response(
    time_step: float,
    excitation: ArrayLike,
    responses: ArrayLike,
    *,
    period_s: float,
    skip_periods: int,
    band: tuple[float, float] = (1.0, 50.0),
) -> PeriodicResponse:
    """Return H(f) = Y(f) / X(f) at the harmonics of a periodic input, from whole periods in the steady state.

    A linear system in its steady state under a periodic input has exactly the input's period, so the discrete
    transform of whole periods has no leakage and the ratio of the lines is the FRF of the sampled signals. The only
    error is what is left of the transient: choose `skip_periods` by the slowest mode (exp(-zeta omega t)) and look at
    `repeatability`.

    Args:
        time_step: [s].
        excitation: shape (n,).
        responses: shape (n,) or (k, n).
        period_s: period of the input, a whole number of time steps [s].
        skip_periods: periods dropped at the start [-].
        band: lines returned, both edges included [Hz].

    Raises:
        ConfigurationError: period not a whole number of steps, skip negative.
        DataError: no whole period left, no excited line in the band, lengths differ, values not finite.
    """
    step = checked_time_step(time_step)
    edges = checked_band(band, step)
    x = checked_signals("excitation", excitation)
    y = checked_signals("responses", responses)
    if x.shape[0] != 1:
        raise DataError(f"excitation: found {x.shape[0]} signals, needed is one, shape (n,)")
    checked_same_length("responses", y, "the excitation", x.shape[1])
    length = round(period_s / step)
    if length < 4 or abs(period_s / step - length) > 1e-6 * length:
        raise ConfigurationError(
            f"period_s: found {period_s:g} s = {period_s / step:.9g} time steps, "
            "allowed is a whole number of at least 4"
        )
    if skip_periods < 0:
        raise ConfigurationError(f"skip_periods: found {skip_periods}, allowed is 0 or more")
    periods = x.shape[1] // length - skip_periods
    if periods < 1:
        raise DataError(
            f"record too short: {x.shape[1]} samples hold {x.shape[1] // length} whole periods of {length} samples and "
            f"{skip_periods} are skipped; at least {(skip_periods + 1) * length} samples are needed"
        )
    used = slice(skip_periods * length, (skip_periods + periods) * length)
    spectrum_x = np.fft.rfft(x[0, used].reshape(periods, length).mean(axis=0))
    blocks = y[:, used].reshape(y.shape[0], periods, length)
    spectrum_y = np.fft.rfft(blocks.mean(axis=1), axis=1)  # (k, m)

    lines = np.fft.rfftfreq(length, step).astype(np.float64)
    inside = lines_in_band(lines, edges) & (lines > 0.0)
    # line 0 holds the static offset, which says nothing about the vibration
    excited = inside & (np.abs(spectrum_x) > EXCITED * np.abs(spectrum_x[1:]).max())
    if not excited.any():
        raise DataError(f"excitation: no line of its period is excited in {edges[0]:g} to {edges[1]:g} Hz")

    repeatability = np.full(y.shape[0], np.nan)
    if periods > 1:
        last = blocks[:, -1] - blocks[:, -1].mean(axis=1, keepdims=True)
        size = np.sqrt((last**2).mean(axis=1))
        change = np.sqrt(((blocks[:, 0] - blocks[:, -1]) ** 2).mean(axis=1))
        repeatability = np.divide(change, size, out=np.zeros_like(size), where=size > 0.0)
    return PeriodicResponse(
        frequency=lines[excited],
        response=spectrum_y[:, excited] / spectrum_x[excited],
        periods=periods,
        repeatability=repeatability,
    )
