"""Segments of a record and their effective averages; largest magnitude in every window; windows of its spectrum."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vehicle.arrays import Indices
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.samples import Vector, checked_single, checked_time_step

MINIMUM_AVERAGES = 8.0
"""Minimum effective averages: with 8, the coherence of unrelated signals is 1/8, and the random error of an FRF at a
coherence of 0.5 is 25 %."""

BATCH = 12
"""Frequency windows processed in a batch: their data fit in the processor caches."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Segments:
    """Segments of a record for Welch's method."""

    length: int
    """samples in a segment [-]"""
    step: int
    """samples from one segment to the next [-]"""
    count: int
    """number of whole segments [-]"""
    averages: float
    """effective number of independent averages of the overlapping segments [-]"""
    window: Vector
    """Hann window, shape (length,) [-]"""

    @property
    def overlap(self) -> int:
        """Overlap of successive segments [samples]."""
        return self.length - self.step


def effective_averages(window: Vector, step: int, count: int) -> float:
    """Return the effective number of independent averages of `count` overlapping segments of a white record.

    K_eff = K / (1 + 2 sum_j (1 - j/K) rho_j),  rho_j = (sum w(i) w(i + j step))^2 / (sum w^2)^2

    Args:
        window: samples of the window, shape (length,).
        step: samples from one segment to the next.
        count: number of segments K.

    Source: Welch (1967), IEEE Trans. Audio Electroacoustics 15, the variance of the averaged periodogram.
    """
    power = float(window @ window)
    correlated = 0.0
    for j in range(1, min(count, -(-window.size // step))):
        shift = j * step
        rho = (float(window[:-shift] @ window[shift:]) / power) ** 2 if shift < window.size else 0.0
        correlated += (1.0 - j / count) * rho
    return count / (1.0 + 2.0 * correlated)


def cut_into_segments(
    samples: int, time_step: float, *, window_s: float, overlap: float, minimum_averages: float
) -> Segments:
    """Cut a record of `samples` samples into Hann-windowed segments.

    Args:
        samples: length of the record [-].
        time_step: sampling interval [s].
        window_s: length of a segment [s]; the line spacing is 1 / window_s.
        overlap: overlap of successive segments over their length, 0 <= overlap < 1 [-].
        minimum_averages: required effective averages [-].

    Raises:
        ConfigurationError: window or overlap out of range.
        DataError: the record is too short; the message contains the required length.
    """
    if not (np.isfinite(window_s) and window_s >= 8.0 * time_step):
        raise ConfigurationError(f"window_s: found {window_s:g} s, must be at least {8.0 * time_step:g} s (8 steps)")
    if not 0.0 <= overlap < 1.0:
        raise ConfigurationError(f"overlap: found {overlap:g}, must be 0 <= overlap < 1")
    length = round(window_s / time_step)
    step = max(1, length - round(overlap * length))
    # Periodic Hann window: its sum over half overlap is constant.
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi / length * np.arange(length))
    count = 0 if samples < length else 1 + (samples - length) // step
    averages = effective_averages(window, step, count) if count else 0.0
    if averages < minimum_averages:
        needed = max(1, int(np.ceil(minimum_averages)))
        while effective_averages(window, step, needed) < minimum_averages:
            needed += 1
        raise DataError(
            f"record too short: {samples * time_step:.4g} s give {averages:.3g} averages with windows of {window_s:g} "
            f"s and {100 * overlap:g} % overlap but must give at least {minimum_averages:g}; record at least "
            f"{(length + (needed - 1) * step) * time_step:.4g} s, or use a shorter window"
        )
    return Segments(length=length, step=step, count=count, averages=averages, window=window)


def windows_of_equal_length(
    centres: NDArray[np.int_], halves: NDArray[np.int_]
) -> Iterator[tuple[Indices, NDArray[np.int_]]]:
    """Group windows of spectral lines by their length, at most `BATCH` in a batch.

    Args:
        centres: centre line of each window, shape (m,).
        halves: half width n of each window [lines], shape (m,).

    Yields:
        Indices of the windows of a batch, shape (s,), and their lines, shape (s, 2 n + 1).
    """
    for half in np.unique(halves):
        group = np.flatnonzero(halves == half)
        for first in range(0, group.size, BATCH):
            members = group[first : first + BATCH]
            yield members, centres[members, None] + np.arange(-half, half + 1)


def window_extremes(time_step: float, signal: ArrayLike, window_s: float = 0.5) -> Vector:
    """Return max |x| of successive windows; an incomplete window at the end is ignored.

    The extreme of a short window of a random signal is random. A single published extreme is compared with the
    percentiles of all windows.

    Args:
        time_step: sampling interval [s].
        signal: record, shape (n,).
        window_s: length of a window [s].

    Returns:
        Extremes, shape (w,), in the unit of the signal.
    """
    step = checked_time_step(time_step)
    values = checked_single("signal", "signal", signal)
    length = float(window_s)
    if not (np.isfinite(length) and length >= step):
        raise ConfigurationError(f"window: found {window_s!r} s, must be at least one time step, {step:g} s")
    samples = round(length / step)
    count = values.size // samples
    if count == 0:
        raise DataError(
            f"signal: found {step * values.size:g} s, shorter than a window of {length:g} s; "
            "use a longer record or a shorter window"
        )
    return np.asarray(np.abs(values[: count * samples]).reshape(count, samples).max(axis=1))
