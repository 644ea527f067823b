"""Generate the bump of Bommer 2006: one period of a raised cosine, with random noise before and after."""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from scenarios.signals.random_road import random_road
from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.band import SHAKER_EDGE_HZ, SHAKER_ROLL_OFF_ORDER, positive, samples_of
from vehicle.signals.excitation.signal import Signal, uniform_time

BUMP_START_S = 5.0
"""Time of the beginning of the bump [s] (thesis section 3.2.2)."""

BUMP_DURATION_S = 1.0 / 3.0
"""Length of the bump [s]: one period of cos(6 pi t)."""

NOISE_RMS = 5e-5
"""RMS of the noise before and after the bump [m] (thesis section 3.2.2)."""

NOISE_SEED = 7
"""Seed of the noise, different from the random inputs: the noise is not a scaled copy of the input `low`."""

Reading = Literal["height", "literal"]


def bump_shape(
    time: ArrayLike, *, amplitude: float, start: float = BUMP_START_S, reading: Reading = "height"
) -> Vector:
    """Return one period of a raised cosine, zero before and after.

    height: x = A/2 (1 - cos(6 pi (t - start))), peak A; literal: x = A (1 - cos(6 pi (t - start))), peak 2 A.

    Displacement and velocity are continuous at both ends, the acceleration jumps (by 18 pi^2 A for height).

    Args:
        time: times [s], shape (n,).
        amplitude: A [m].
        start: beginning of the bump [s].
        reading: 'height' as shipped, or 'literal' as printed.

    Returns:
        Displacement [m], shape (n,).

    Source: thesis section 3.2.2; the slip times of the source support the reading "height".
    """
    if reading not in ("height", "literal"):
        raise ConfigurationError(f"reading {reading!r} of the bump; allowed: 'height', 'literal'")
    since = np.asarray(time, dtype=np.float64) - start
    factor = 0.5 * amplitude if reading == "height" else amplitude
    inside = (since > 0.0) & (since < BUMP_DURATION_S)
    return np.where(inside, factor * (1.0 - np.cos(6.0 * np.pi * since)), 0.0)


def bump(
    *,
    amplitude: float,
    wheel: str,
    reading: Reading = "height",
    duration: float = 10.0,
    rate: float = 1000.0,
    start: float = BUMP_START_S,
    noise_rms: float = NOISE_RMS,
    seed: int = NOISE_SEED,
    noise_edge: float = SHAKER_EDGE_HZ,
) -> Signal:
    """Generate a bump with random noise of the shaker before, during and after the bump.

    z = bump_shape + noise. The shaker of the source could not hold a static load and kept moving. The noise has the
    spectrum and band of the random inputs and continues through the bump: an interruption would add jumps or another
    frequency at the moment when the damper begins to slip. Its RMS is exact over the record without the bump.

    Args:
        amplitude: A of the bump [m].
        wheel: wheel whose plate moves, such as `car.vehicle.shaker_wheel`.
        reading: 'height' (peak A) or 'literal' (peak 2 A).
        duration: length of the record [s].
        rate: samples per second [Hz].
        start: beginning of the bump [s].
        noise_rms: RMS of the noise before and after the bump [m]; 0 for none.
        seed: seed of the noise.
        noise_edge: lower band edge of the noise [Hz].

    Raises:
        ConfigurationError: a parameter is out of range.

    Source: thesis section 3.2.2.
    """
    positive("bump amplitude", amplitude, "m")
    steps = samples_of(duration, rate)
    if not 0.0 <= start <= duration - BUMP_DURATION_S:
        raise ConfigurationError(
            f"bump at {start!r} s; allowed: 0 to {duration - BUMP_DURATION_S:.6g} s, so that it ends within the record"
        )
    time = uniform_time(samples=steps + 1, timestep=1.0 / rate)
    z = bump_shape(time, amplitude=amplitude, start=start, reading=reading)
    if noise_rms != 0.0:
        positive("noise RMS", noise_rms, "m")
        noise = random_road(
            rms=noise_rms,
            seed=seed,
            wheel=wheel,
            duration=duration,
            rate=rate,
            lower_band_edge=noise_edge,
            roll_off_order=SHAKER_ROLL_OFF_ORDER,
        ).displacement[wheel]
        outside = (time <= start) | (time >= start + BUMP_DURATION_S)
        z = z + noise * (noise_rms / np.std(noise[outside]))
    return Signal(
        time=time,
        displacement={wheel: z},
        source=(
            f"bump, A {amplitude:g} m ({reading} reading), from {start:g} s, noise RMS {noise_rms:g} m outside, "
            f"seed {seed}"
        ),
    )
