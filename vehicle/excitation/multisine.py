"""Periodic random-phase multisine: the input for frequency responses without leakage."""

from __future__ import annotations

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.excitation.band import (
    LOWER_BAND_EDGE_HZ,
    UPPER_BAND_EDGE_HZ,
    lines_in_band,
    period_of,
    positive,
    samples_of,
)
from vehicle.excitation.rest import RAMP_S, half_cosine
from vehicle.excitation.signal import Signal, uniform_time


def multisine(
    *,
    rms: float,
    seed: int,
    period: float = 4.0,
    periods: int = 8,
    rate: float = 1000.0,
    lower_band_edge: float = LOWER_BAND_EDGE_HZ,
    upper_band_edge: float = UPPER_BAND_EDGE_HZ,
    ramp_length: float = RAMP_S,
    wheel: str = "fr",
) -> Signal:
    """Equal velocity amplitude on every line of a period, with random phases, repeated.

    z(t) = a sum over k of cos(2 pi k t / T + phi_k) / k, for all k / T within the band. All lines are multiples of 1
    / T, so that after the transient a window of one period holds whole cycles of each line and the FRF is exact at
    them.

    Args:
        rms: root mean square of one period [m]; exact.
        seed: seed of the PCG64 generator (uniform phases).
        period: T [s].
        periods: number of periods; the first also holds the ramp and the transient, discard it.
        rate: samples per second [Hz].
        lower_band_edge: lowest frequency [Hz].
        upper_band_edge: highest frequency [Hz].
        ramp_length: half-cosine rise from rest at the beginning [s]; 0 for none.
        wheel: driven wheel.

    Returns:
        Signal with periods * period * rate + 1 samples.

    Raises:
        ConfigurationError: a parameter is out of range.

    Source: Pintelon and Schoukens, System Identification, 2nd edition (random phase multisine).
    """
    positive("RMS", rms, "m")
    if periods < 1:
        raise ConfigurationError(f"{periods!r} periods; allowed: from 1")
    if not 0.0 <= ramp_length <= period:
        raise ConfigurationError(f"ramp {ramp_length!r} s; allowed: 0 to one period, {period:g} s")
    steps = samples_of(period, rate)
    lines = lines_in_band(steps=steps, rate=rate, lower=lower_band_edge, upper=upper_band_edge)
    phase = 2.0 * np.pi * np.random.Generator(np.random.PCG64(seed)).random(int(lines[-1]))[lines - 1]
    one = period_of(np.exp(1j * phase) / lines, lines, steps)
    one = one * (rms / np.sqrt(np.mean(one**2)))
    z = np.append(np.tile(one, periods), one[0])
    ramp = half_cosine(samples=z.size, timestep=1.0 / rate, length=ramp_length)
    notices = (f"half-cosine ramp over the first {ramp_length:g} s of the first period",) if ramp_length > 0.0 else ()
    return Signal(
        time=uniform_time(samples=z.size, timestep=1.0 / rate),
        displacement={wheel: z * ramp + 0.0},
        notices=notices,
        source=(
            f"multisine, RMS {rms:g} m, {lines.size} lines {lines[0] / period:g} to {lines[-1] / period:g} Hz of "
            f"equal velocity, {periods} periods of "
            f"{period:g} s at {rate:g} Hz, seed {seed}"
        ),
    )
