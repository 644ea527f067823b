"""Amplitudes of a record at orders of a turning part: complex demodulation with the known angle.

    X_o = 2 sum_n h_n x_n exp(-i o W t_n) / sum_n h_n

over segments of a fixed number of turns with Hann windows h that overlap by half. The segments see the same angle, so
that their mean keeps what turns with the part, and their scatter gives its standard error: a road adds to each segment
with another phase. Source: Brandt, Noise and Vibration Analysis, 2nd ed., 2023, chapter 12.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex
from vehicle.errors import DataError
from vehicle.signals.analysis.samples import Vector

TURNS = 16
"""Turns in a segment: its main lobe is four lines wide, a quarter of the distance of two orders."""

OVERLAP = 0.5
"""Overlap of two segments; Hann windows that overlap by half are correlated by 1/6."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OrderLines:
    """Amplitudes at orders of an angle.

    Attributes:
        orders: the orders; (o,).
        frequency: their frequencies [Hz]; (o,).
        amplitude: complex amplitudes X of Re(X exp(i order angle)), in the unit of the channel; (channels, o).
        error: standard error of the real and of the imaginary part; NaN for a single segment; (channels, o).
        segments: number of segments.
    """

    orders: Vector
    frequency: Vector
    amplitude: Complex
    error: Vector
    segments: int


def order_lines(
    time: Vector, channels: Vector, turns: float, orders: Sequence[float], *, begin: float = 0.0
) -> OrderLines:
    """Return the amplitudes of channels at orders of a part that turns at constant speed.

    Args:
        time: times of the samples [s], uniform; the angle is 0 at t = 0; (n,).
        channels: time histories; (channels, n).
        turns: turns of the part per second [Hz].
        orders: multiples of it.
        begin: time from which the record is evaluated [s].
    """
    interval = float(time[1] - time[0])
    first = round((begin - float(time[0])) / interval)
    length, count = round(TURNS / (turns * interval)), time.size - first
    if count < length:
        raise DataError(f"orders: {count * interval * turns:.3g} turns, must be at least {TURNS}; use a longer run")
    highest = max(orders) * turns
    if highest >= 0.5 / interval:
        raise DataError(
            f"orders: order {max(orders):g} is {highest:.4g} Hz but must be below half the sampling rate of "
            f"{1.0 / interval:g} Hz"
        )
    # Whole segments to the end of the record, which is farthest from the start.
    step = max(round(length * (1.0 - OVERLAP)), 1)
    segments = 1 + (count - length) // step
    window = np.hanning(length + 2)[1:-1]
    # The factor 2 turns a mean into an amplitude.
    window *= 2.0 / window.sum()
    frequency = turns * np.array(orders, dtype=float)
    amplitudes = np.zeros((segments, len(channels), len(orders)), dtype=complex)
    for segment in range(segments):
        part = slice(time.size - length - segment * step, time.size - segment * step)
        kernel = window * np.exp(-2j * np.pi * np.outer(frequency, time[part]))
        amplitudes[segment] = (channels[:, part] - channels[:, part].mean(axis=1, keepdims=True)) @ kernel.T
    error = np.full(amplitudes.shape[1:], np.nan)
    if segments > 1:
        scatter = np.mean(np.abs(amplitudes - amplitudes.mean(axis=0)) ** 2, axis=0) * segments / (segments - 1)
        # Variance of one part; the mean of overlapping segments counts as if they were fewer by their correlation.
        error = np.sqrt(0.5 * scatter / segments * (1.0 + 2.0 / 36.0))
    return OrderLines(
        orders=np.array(orders, dtype=float),
        frequency=frequency,
        amplitude=amplitudes.mean(axis=0),
        error=error,
        segments=segments,
    )
