"""Amplitudes of a record at orders of a turning part whose speed changes: an order cut over its speed.

    X_o = 2 sum_n h_n W_n x_n exp(-i o theta_n) / sum_n h_n W_n

over segments of a fixed number of turns with Hann windows h over the angle theta that overlap by half; W dt = d theta,
so that the windows are those of a record over the angle. A constant of the record is subtracted. Source: Brandt, Noise
and Vibration Analysis, 2nd ed., 2023, chapter 12.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex
from vehicle.errors import DataError
from vehicle.signals.analysis.samples import Vector

TURNS = 8
"""Turns in a segment: half orders lie four lines apart, at zeros of the window."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OrderCut:
    """Amplitudes at orders over the speed.

    Attributes:
        orders: the orders; (o,).
        turns: turns per second in the middle of each segment [Hz]; (k,).
        amplitude: complex amplitudes X of Re(X exp(i order angle)), in the unit of the channel; (channels, o, k).
    """

    orders: Vector
    turns: Vector
    amplitude: Complex


def order_cut(
    time: Vector, channels: Vector, angle: Vector, speed: Vector, orders: Sequence[float], *, begin: float = 0.0
) -> OrderCut:
    """Return the amplitudes of channels at orders of a part that turns at a changing speed.

    Args:
        time: times of the samples [s]; (n,).
        channels: time histories; (channels, n).
        angle: angle of the part [rad], rising; (n,).
        speed: its angular speed [rad/s]; (n,).
        orders: multiples of the angle.
        begin: time from which the record is evaluated [s].
    """
    turned = angle / (2.0 * np.pi)
    first = float(turned[min(int(np.searchsorted(time, begin - 1e-9)), time.size - 1)])
    if turned[-1] - first < TURNS:
        raise DataError(f"orders: {turned[-1] - first:.3g} turns, must be at least {TURNS}; use a longer run")
    highest, rate = max(orders) * float(np.max(speed)) / (2.0 * np.pi), 1.0 / float(time[1] - time[0])
    if highest >= 0.5 * rate:
        raise DataError(
            f"orders: order {max(orders):g} reaches {highest:.4g} Hz but must be below half the sampling rate of "
            f"{rate:g} Hz"
        )
    middles = np.arange(first + 0.5 * TURNS, turned[-1] - 0.5 * TURNS + 1e-9, 0.5 * TURNS)
    amplitudes = np.zeros((len(middles), len(channels), len(orders)), dtype=complex)
    speeds = np.zeros(len(middles))
    for segment, middle in enumerate(middles):
        part = slice(*np.searchsorted(turned, [middle - 0.5 * TURNS, middle + 0.5 * TURNS]))
        # Hann window over the angle, times W dt = d theta; the factor 2 turns a mean into an amplitude.
        window = (1.0 + np.cos(2.0 * np.pi * (turned[part] - middle) / TURNS)) * speed[part]
        window *= 2.0 / window.sum()
        values = channels[:, part] - channels[:, part].mean(axis=1, keepdims=True)
        amplitudes[segment] = values @ (window * np.exp(-1j * np.outer(orders, angle[part]))).T
        speeds[segment] = np.interp(middle, turned, speed)
    return OrderCut(
        orders=np.array(orders, dtype=float), turns=speeds / (2.0 * np.pi), amplitude=amplitudes.transpose(1, 2, 0)
    )
