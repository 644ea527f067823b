"""Make signals begin at rest, without offset and velocity, as the car starts in equilibrium on plates at rest."""

from collections.abc import Mapping

import numpy as np

from vehicle.signals.analysis.samples import Vector
from vehicle.signals.records.settling import RAMP_WORDS

RAMP_S = 0.5
"""Length of the half-cosine ramp [s]: half a period of 1 Hz, the lower end of the range of interest."""

OFFSET_SHARE = 0.01
"""Maximum first value over the RMS [-]; a larger one is a step of the plate at t = 0."""

POSITION_SHARE = 2.0
"""Maximum first value over the RMS [-] of a motion about zero; a larger one may be the position of a sensor."""

VELOCITY_SHARE = 0.1
"""Maximum first difference over the RMS of all differences [-]; a larger one is a velocity jump at t = 0."""


def half_cosine(*, samples: int, timestep: float, length: float) -> Vector:
    """Return `half_cosine_at` for samples at a time step [s] from 0 on, (n,); ones for a length of 0."""
    return half_cosine_at(np.asarray(np.arange(samples) * timestep), length) if length > 0.0 else np.ones(samples)


def half_cosine_at(time: Vector, length: float) -> Vector:
    """Return the weights (1 - cos(pi t / length)) / 2 from 0 to `length` [s], 0 before and 1 after [-]."""
    return np.asarray(0.5 * (1.0 - np.cos(np.pi * np.clip(time / length, 0.0, 1.0))))


def half_cosine_rate_at(time: Vector, length: float) -> Vector:
    """Return the derivative of `half_cosine_at` [1/s]."""
    inside = (time > 0.0) & (time < length)
    return np.asarray(np.where(inside, 0.5 * np.pi / length * np.sin(np.pi * time / length), 0.0))


def taper(*, samples: int, timestep: float, length: float) -> Vector:
    """Return weights with a half-cosine rise at the beginning and fall at the end [-], shape (n,)."""
    rise = half_cosine(samples=samples, timestep=timestep, length=length)
    return rise * rise[::-1]


def start_from_rest(
    displacement: Mapping[str, Vector], *, timestep: float
) -> tuple[dict[str, Vector], tuple[str, ...]]:
    """Apply the half-cosine ramp to all wheels if at least one does not begin at rest; subtract nothing.

    Args:
        displacement: wheel -> plate displacement [m], shape (n,).
        timestep: sampling interval [s].

    Returns:
        Displacements, and a notice for each cause with the length of the ramp; no notice if unchanged.
    """
    causes = [cause for wheel, z in displacement.items() for cause in _causes(wheel, z, timestep)]
    plates = {wheel: np.array(z) for wheel, z in displacement.items()}
    if not causes:
        return plates, ()
    samples = next(iter(plates.values())).size
    length = min(RAMP_S, 0.1 * (samples - 1) * timestep)
    weights = half_cosine(samples=samples, timestep=timestep, length=length)
    done = f"all plates are faded in over the first {length:.3g} s ({RAMP_WORDS})"
    # Adding 0.0 avoids -0.0 for a negative first value.
    return {wheel: z * weights + 0.0 for wheel, z in plates.items()}, tuple(f"{cause}; {done}" for cause in causes)


def _causes(wheel: str, z: Vector, timestep: float) -> list[str]:
    rms = float(np.std(z))
    first = float(z[0])
    if abs(first) > OFFSET_SHARE * rms:
        zero = (
            ": the zero of the sensor? Subtract the mean (shaker --remove-mean)"
            if abs(first) > POSITION_SHARE * rms
            else ""
        )
        return [f"plate {wheel} begins at {1e3 * first:.3g} mm, not at 0, and moves by {1e3 * rms:.3g} mm (RMS){zero}"]
    steps = np.diff(z)
    if abs(steps[0]) > VELOCITY_SHARE * float(np.sqrt(np.mean(steps**2))):
        return [f"plate {wheel} begins with a velocity of {steps[0] / timestep:.3g} m/s, not at rest"]
    return []
