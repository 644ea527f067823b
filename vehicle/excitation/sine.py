"""A sine that rises from rest."""

from __future__ import annotations

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.excitation.band import positive, samples_of
from vehicle.excitation.rest import half_cosine
from vehicle.excitation.signal import Signal, uniform_time


def sine(
    *,
    frequency: float,
    amplitude: float,
    duration: float,
    rate: float = 1000.0,
    ramp_periods: float = 1.0,
    wheel: str = "fr",
) -> Signal:
    """Sine with a half-cosine rise over its first periods.

    z = w(t) A sin(2 pi f t), w from 0 to 1 over ramp_periods / f.

    Args:
        frequency: f [Hz], at most 0.8 of the Nyquist frequency.
        amplitude: A [m].
        duration: length [s].
        rate: samples per second [Hz].
        ramp_periods: length of the rise in periods [-]; 0 begins with the full velocity.
        wheel: driven wheel.

    Raises:
        ConfigurationError: a parameter is out of range.
    """
    positive("amplitude", amplitude, "m")
    if not 0.0 < frequency <= 0.4 * rate:
        raise ConfigurationError(
            f"frequency {frequency!r} Hz; allowed: above 0 to {0.4 * rate:g} Hz (0.8 of the Nyquist frequency)"
        )
    if not 0.0 <= ramp_periods <= duration * frequency:
        raise ConfigurationError(
            f"ramp of {ramp_periods!r} periods; allowed: 0 to the record's {duration * frequency:g}"
        )
    time = uniform_time(samples=samples_of(duration, rate) + 1, timestep=1.0 / rate)
    ramp = half_cosine(samples=time.size, timestep=1.0 / rate, length=ramp_periods / frequency)
    return Signal(
        time=time,
        displacement={wheel: ramp * amplitude * np.sin(2.0 * np.pi * frequency * time)},
        source=(
            f"sine, {frequency:g} Hz, amplitude {amplitude:g} m, {duration:g} s at {rate:g} Hz, rise over "
            f"{ramp_periods:g} periods"
        ),
    )
