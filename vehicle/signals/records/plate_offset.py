"""Constant in the displacement of a plate, from a sensor at mid stroke: the position of the sensor, no motion."""

from collections.abc import Mapping

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.signals.records.finding import Finding

MANY_TIMES = 2.0
"""Minimum ratio of the mean to the RMS about it [-]. A record from 0 upwards has less, as a ramp 1.7 and a step in the
middle 1; a step near the beginning has more, but begins at 0."""

LARGEST_POSITION = 0.5
"""Maximum position of a sensor [m]: a larger constant indicates a wrong unit or another quantity."""

FLAT = 8
"""Number of equal samples at the beginning of a record that begins at rest."""

ROUNDING = 1e-9
"""Maximum range of a constant over its mean [-]."""


def offset_of(z: Vector) -> float:
    """Return the constant to be subtracted from the displacement z of a plate [m], (n,); 0 for a motion from 0.

    The mean m is a constant if |m| >= `MANY_TIMES` s, with s the RMS about m, and the record begins nearer to m than to
    0. For a record that begins at rest, the constant is its first value.
    """
    mean, motion = float(np.mean(z)), float(np.std(z))
    if _is_constant(z) or not MANY_TIMES * motion <= abs(mean) <= LARGEST_POSITION or abs(z[0] - mean) >= abs(z[0]):
        return 0.0
    return float(z[0]) if np.ptp(z[:FLAT]) == 0.0 else mean


def without_offsets(plates: Mapping[str, Vector]) -> tuple[dict[str, Vector], list[Finding]]:
    """Return displacements of plates [m], (n,) each, without the constants of their sensors, and the finding.

    Decided once for the record, because a constant taken from some plates only twists the car: each plate that moves
    must have a constant; then a plate that stands loses its own position too.
    """
    offsets = {name: offset for name, z in plates.items() if (offset := offset_of(z)) != 0.0}
    if not offsets:
        return dict(plates), []
    about_zero = [name for name, z in plates.items() if name not in offsets and not _is_constant(z)]
    ratio = max(abs(float(np.mean(plates[name]))) / float(np.std(plates[name])) for name in offsets)
    low, high = 1e3 * min(offsets.values()), 1e3 * max(offsets.values())
    shown = f"{high:.3g} mm" if len(offsets) == 1 else f"{low:.3g} to {high:.3g} mm"
    text = f"{', '.join(offsets)}: the mean of {shown} is {number(ratio, 2)} times the RMS of the motion: "
    if about_zero:
        none = f"{', '.join(about_zero)} {'has' if len(about_zero) == 1 else 'have'} none"
        text += f"the position of the sensor? Not subtracted, because {none}; --detrend subtracts it"
        return dict(plates), [Finding(text, "offset")]
    text += "the position of the sensor; it was subtracted"
    stands = {name: float(z[0]) for name, z in plates.items() if name not in offsets}
    return {name: z - (offsets | stands)[name] for name, z in plates.items()}, [Finding(text, "offset")]


def _is_constant(z: Vector) -> bool:
    return bool(np.ptp(z) <= ROUNDING * abs(float(np.mean(z))))
