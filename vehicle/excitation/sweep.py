"""A logarithmic sine sweep whose amplitude follows a power of the frequency."""

from __future__ import annotations

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.excitation.band import positive, samples_of
from vehicle.excitation.rest import RAMP_S, taper
from vehicle.excitation.signal import Signal, uniform_time


def log_sweep(
    *,
    start_frequency: float,
    end_frequency: float,
    amplitude: float,
    duration: float,
    amplitude_exponent: float = -1.0,
    rate: float = 1000.0,
    taper_length: float = RAMP_S,
    wheel: str = "fr",
) -> Signal:
    """Sine whose frequency grows (or falls) by the same factor in every second.

    f(t) = f1 (f2/f1)^(t/T), phase = 2 pi f1 T / ln(f2/f1) ((f2/f1)^(t/T) - 1), z = w(t) A (f(t)/f1)^p sin(phase).

    Args:
        start_frequency: f1 [Hz].
        end_frequency: f2 [Hz].
        amplitude: A, displacement amplitude at f1 [m].
        duration: T [s].
        amplitude_exponent: p [-]: 0 constant displacement, -1 constant velocity, -2 constant acceleration.
        rate: samples per second [Hz].
        taper_length: half cosine w from and to rest at both ends [s].
        wheel: driven wheel.

    Raises:
        ConfigurationError: a parameter is out of range.

    Source: Farina, Simultaneous measurement of impulse response and distortion with a swept-sine technique, AES 108
    (2000).
    """
    positive("amplitude", amplitude, "m")
    for frequency in (start_frequency, end_frequency):
        if not 0.0 < frequency <= 0.4 * rate:
            raise ConfigurationError(
                f"frequency {frequency!r} Hz; allowed: above 0 to {0.4 * rate:g} Hz (0.8 of the Nyquist frequency)"
            )
    if start_frequency == end_frequency:
        raise ConfigurationError(
            f"sweep from {start_frequency!r} Hz to itself; allowed: two frequencies; a sine has one"
        )
    if not 0.0 <= taper_length <= 0.5 * duration:
        raise ConfigurationError(f"taper {taper_length!r} s; allowed: 0 to half of the record, {0.5 * duration:g} s")
    time = uniform_time(samples=samples_of(duration, rate) + 1, timestep=1.0 / rate)
    growth = np.log(end_frequency / start_frequency)
    ratio = np.exp(growth * time / duration)
    phase = 2.0 * np.pi * start_frequency * duration / growth * (ratio - 1.0)
    weights = taper(samples=time.size, timestep=1.0 / rate, length=taper_length)
    return Signal(
        time=time,
        displacement={wheel: weights * amplitude * ratio**amplitude_exponent * np.sin(phase) + 0.0},
        source=(
            f"log sweep, {start_frequency:g} to {end_frequency:g} Hz, amplitude {amplitude:g} m at the start, times "
            f"(f/f1)^{amplitude_exponent:g}, {duration:g} s at {rate:g} Hz"
        ),
    )
