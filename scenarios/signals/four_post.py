"""Generate inputs of a four-post rig: band-limited noise in modal combinations, or independent for each plate."""

import numpy as np

from scenarios.signals.random_road import random_road
from vehicle.errors import ConfigurationError
from vehicle.signals.analysis.road_level import CLASSES, REFERENCE
from vehicle.signals.excitation.signal import Signal

MOTIONS = {
    "heave": {"fr": 1.0, "fl": 1.0, "rr": 1.0, "rl": 1.0},
    "pitch": {"fr": 1.0, "fl": 1.0, "rr": -1.0, "rl": -1.0},
    "roll": {"fr": 1.0, "fl": -1.0, "rr": 1.0, "rl": -1.0},
    "warp": {"fr": 1.0, "fl": -1.0, "rr": -1.0, "rl": 1.0},
}
"""Factor of each plate in a combined motion: orthogonal, so every motion of four plates is a sum of these motions."""

INDEPENDENT = "four_plates"
"""Name of the input with independent plates."""

ROAD_CLASS, SPEED_KMH = "A", 80.0
"""Road class and speed [km/h] of the level: velocity PSD at each wheel, G_v = (2 pi n0)^2 G(n0) V."""

LOWEST_HZ, HIGHEST_HZ = 0.5, 40.0
"""Band [Hz]: from below the ride frequencies of a car to above its wheel modes, where the plates accelerate by 40 m/s2,
the limit of hydraulic rigs."""

DURATION_S, RATE_HZ = 60.0, 250.0
"""Length [s] and rate [Hz] of the shipped files: six samples per period at the upper edge."""

SEED = 4000
"""Seed of the first plate; other independent plates use the next seeds. Not chosen for any result."""


def level_rms() -> float:
    """Return the RMS of each plate [m]: G_z(f) = (n0)^2 G(n0) V / f^2 from the lowest to the highest frequency."""
    density = REFERENCE**2 * CLASSES[ROAD_CLASS] * SPEED_KMH / 3.6
    return float(np.sqrt(density * (1.0 / LOWEST_HZ - 1.0 / HIGHEST_HZ)))


def four_post(name: str, *, factor: float = 1.0, duration: float = DURATION_S) -> Signal:
    """Generate displacements of four plates with constant velocity PSD, from rest to rest.

    Args:
        name: "heave", "pitch", "roll", "warp": a noise times the factors of `MOTIONS`; or "four_plates".
        factor: factor on the level of `level_rms`.
        duration: length [s].

    Raises:
        ConfigurationError: unknown motion, or a parameter out of range, see `random_road`.
    """
    if name != INDEPENDENT and name not in MOTIONS:
        raise ConfigurationError(f"motion {name!r}: must be one of {', '.join(MOTIONS)}, {INDEPENDENT}")

    def noise(wheel: str, number: int) -> Signal:
        return random_road(
            rms=factor * level_rms(),
            seed=SEED + number,
            wheel=wheel,
            duration=duration,
            rate=RATE_HZ,
            lower_band_edge=LOWEST_HZ,
            upper_band_edge=HIGHEST_HZ,
        )

    wheels = list(MOTIONS["heave"])
    first = noise(wheels[0], 0)
    if name == INDEPENDENT:
        plates = {wheel: noise(wheel, number).displacement[wheel] for number, wheel in enumerate(wheels)}
    else:
        # Adding 0.0 avoids -0.0 in files.
        plates = {wheel: sign * first.displacement[wheels[0]] + 0.0 for wheel, sign in MOTIONS[name].items()}
    return Signal(time=first.time, displacement=plates, source=f"{name} of four plates: {first.source}")
