"""Inputs of a four-post rig: band-limited noise in a modal combination of the plates, or of each plate by itself."""

from __future__ import annotations

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.signals.excitation.iso_road import CLASSES, REFERENCE
from vehicle.signals.excitation.random_road import random_road
from vehicle.signals.excitation.signal import Signal

MOTIONS = {
    "heave": {"fr": 1.0, "fl": 1.0, "rr": 1.0, "rl": 1.0},
    "pitch": {"fr": 1.0, "fl": 1.0, "rr": -1.0, "rl": -1.0},
    "roll": {"fr": 1.0, "fl": -1.0, "rr": 1.0, "rl": -1.0},
    "warp": {"fr": 1.0, "fl": -1.0, "rr": -1.0, "rl": 1.0},
}
"""Factor of each plate in a motion of all: orthogonal, so that every motion of four plates is a sum of them."""

INDEPENDENT = "four_plates"
"""Name of the input whose plates move independently of each other."""

ROAD_CLASS, SPEED_KMH = "A", 80.0
"""Level: the velocity PSD that each wheel meets there, G_v = (2 pi n0)^2 G(n0) V."""

LOWEST_HZ, HIGHEST_HZ = 0.5, 40.0
"""Band [Hz]: from below the ride frequencies of a car to above its wheel modes, where the plates accelerate by 40 m/s2;
hydraulic rigs end there."""

DURATION_S, RATE_HZ = 60.0, 250.0
"""Length [s] and rate [Hz] of the shipped files: six samples a period at the upper edge."""

SEED = 4000
"""First seed; further independent plates take the next ones. Not chosen for any result."""


def level_rms() -> float:
    """RMS [m] of each plate: G_z(f) = (n0)^2 G(n0) V / f^2 from the lowest to the highest frequency."""
    density = REFERENCE**2 * CLASSES[ROAD_CLASS] * SPEED_KMH / 3.6
    return float(np.sqrt(density * (1.0 / LOWEST_HZ - 1.0 / HIGHEST_HZ)))


def four_post(
    name: str, *, factor: float = 1.0, duration: float = DURATION_S, rate: float = RATE_HZ, seed: int = SEED
) -> Signal:
    """Displacements of four plates with constant velocity PSD, from rest to rest.

    Args:
        name: "heave", "pitch", "roll", "warp": one noise times the factors of `MOTIONS`; or "four_plates".
        factor: times the level of `level_rms`.
        duration: length [s].
        rate: samples per second [Hz].
        seed: of the generator.

    Returns:
        The signal.

    Raises:
        ConfigurationError: no such motion, or as of `random_road`.
    """
    if name != INDEPENDENT and name not in MOTIONS:
        raise ConfigurationError(f"motion {name!r}: allowed are {', '.join(MOTIONS)} and {INDEPENDENT}")

    def noise(wheel: str, number: int) -> Signal:
        return random_road(
            rms=factor * level_rms(),
            seed=seed + number,
            wheel=wheel,
            duration=duration,
            rate=rate,
            lower_band_edge=LOWEST_HZ,
            upper_band_edge=HIGHEST_HZ,
        )

    wheels = list(MOTIONS["heave"])
    first = noise(wheels[0], 0)
    if name == INDEPENDENT:
        plates = {wheel: noise(wheel, number).displacement[wheel] for number, wheel in enumerate(wheels)}
    else:
        # No -0.0 in files.
        plates = {wheel: sign * first.displacement[wheels[0]] + 0.0 for wheel, sign in MOTIONS[name].items()}
    return Signal(time=first.time, displacement=plates, source=f"{name} of four plates: {first.source}")
