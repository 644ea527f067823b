"""Periodic input, whose FRF has no leakage, with which the engines are tested."""

import numpy as np

from vehicle.signals.excitation.band import lines_in_band, period_of
from vehicle.signals.excitation.rest import half_cosine
from vehicle.signals.excitation.signal import Signal, uniform_time

RATE = 1000.0


def multisine(*, rms: float, seed: int, period: float, periods: int, band: tuple[float, float] = (1.0, 50.0)) -> Signal:
    """Equal velocity amplitude and random phase on every line k / T of the band; it fades in over half a second.

    Source: Pintelon and Schoukens, System Identification, 2nd edition (random phase multisine).
    """
    steps = round(period * RATE)
    lines = lines_in_band(steps=steps, rate=RATE, lower=band[0], upper=band[1])
    phase = 2.0 * np.pi * np.random.Generator(np.random.PCG64(seed)).random(int(lines[-1]))[lines - 1]
    one = period_of(np.exp(1j * phase) / lines, lines, steps)
    z = np.tile(one * (rms / np.sqrt(np.mean(one**2))), periods)
    z = np.append(z, z[0]) * half_cosine(samples=z.size + 1, timestep=1.0 / RATE, length=0.5)
    return Signal(time=uniform_time(samples=z.size, timestep=1.0 / RATE), displacement={"fr": z})
