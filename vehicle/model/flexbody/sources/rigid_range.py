"""Frequency range in which a softly hung body moves as a rigid one: between its support modes and its elastic modes.

The mode indicator I = sum |Re H| |H| / sum |H|^2 over all accelerances is 1 where they are real, as those of a rigid
body are, and has a minimum at each resonance (Williams, Crowley and Vold, IMAC 1985).
"""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.errors import DataError

_REAL = 0.9
"""Minimum of the mode indicator in the range [-]: noise of 45 % of H gives 0.9, a resonance 0.1 to 0.5."""

MARGIN = 2.0
"""Factor between the range and the nearest resonance [-]. The fit includes stiffness of the support and elastic motion
up to w^4, so that (1/2)^6, 2 % of an elastic mode, is left."""

LEAST_LINES = 20
"""Minimum number of lines: each FRF has five coefficients of its own for the scatter."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RigidRange:
    """Frequency range [Hz] and the resonances at its ends; None for the end of the file."""

    low: float
    high: float
    below: float | None = None
    above: float | None = None


def rigid_range(
    frequency: Vector, response: Complex, band: tuple[float, float] | None, limits: RigidRange | None = None
) -> RigidRange:
    """Return the range of the fit: the widest one without resonance, or a stated one that is checked.

    Args:
        frequency: frequencies [Hz], (m,).
        response: accelerances [m/s2/N], (n, m).
        band: stated range [Hz]; None chooses it.
        limits: resonances that limit a stated range.

    Raises:
        DataError: too few lines, or a resonance in the range.
    """
    size = np.abs(response)
    indicator = (np.abs(response.real) * size).sum(axis=0) / (size**2).sum(axis=0)
    if band is not None:
        inside = np.flatnonzero((frequency >= band[0]) & (frequency <= band[1]))
        low = [index for index in inside if indicator[index] < _REAL]
        if low:
            worst = low[int(np.argmin(indicator[low]))]
            raise DataError(
                f"--band {band[0]:g}:{band[1]:g}: contains a resonance at {frequency[worst]:.4g} Hz, where the body "
                f"is not rigid (mode indicator {indicator[worst]:.2f}, must be {_REAL} and more); choose a range "
                "between the modes of the support and the first elastic mode, or leave --band out"
            )
        below, above = (None, None) if limits is None else (limits.below, limits.above)
        return _with_lines(frequency, RigidRange(low=band[0], high=band[1], below=below, above=above))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], indicator >= _REAL, [False]]).astype(int))).reshape(-1, 2)
    if not edges.size:
        raise DataError("no line is free of resonances: check the phase of the FRFs, or record more averages")
    begin, end = max(edges.tolist(), key=lambda run: frequency[run[1] - 1] / frequency[run[0]])
    below = float(frequency[begin]) if begin else None
    above = float(frequency[end - 1]) if end < frequency.size else None
    return _with_lines(
        frequency,
        RigidRange(
            low=float(frequency[0]) if below is None else MARGIN * below,
            high=float(frequency[-1]) if above is None else above / MARGIN,
            below=below,
            above=above,
        ),
    )


def _with_lines(frequency: Vector, chosen: RigidRange) -> RigidRange:
    """Return a range, or raise DataError if it has too few lines."""
    lines = int(np.sum((frequency >= chosen.low) & (frequency <= chosen.high)))
    if lines < LEAST_LINES:
        raise DataError(
            f"{lines} lines from {chosen.low:.4g} to {chosen.high:.4g} Hz, must be at least {LEAST_LINES}; record with "
            f"a finer resolution, or hang the body softer: its support modes must be below a quarter of the first "
            "elastic mode"
        )
    return chosen
