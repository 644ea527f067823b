"""Scales of a film: numbers that read well, and displacement as a colour."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

COLOURS = (
    (0.10, 0.18, 0.55),
    (0.00, 0.50, 0.75),
    (0.05, 0.68, 0.45),
    (0.98, 0.80, 0.10),
    (0.95, 0.40, 0.05),
    (0.80, 0.06, 0.04),
)
"""From rest (blue) to the top of the scale (red), evenly spaced; the order of the rainbow, as modal analysis has it."""


def colours(values: npt.ArrayLike, top: float) -> npt.NDArray[np.float32]:
    """Colours of values between 0 and the top of the scale; what lies above is drawn as the top.

    Args:
        values: (n,), same unit as `top`.
        top: largest value of the scale, above 0.

    Returns:
        Red, green, blue and opacity 1, (n, 4).
    """
    table = np.array(COLOURS)
    place = np.clip(np.atleast_1d(np.asarray(values, dtype=float)) / top, 0.0, 1.0) * (len(table) - 1)
    rgb = [np.interp(place, np.arange(len(table)), column) for column in table.T]
    return np.column_stack([*rgb, np.ones(len(place))]).astype(np.float32)


def round_up(value: float) -> float:
    """The next 1, 1.5, 2, 3, 4, 5, 6, 8 or 10 times a power of ten; 1 for zero."""
    if value <= 0.0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    steps = np.array([1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0])
    return float(steps[steps >= value / power * (1.0 - 1e-12)][0] * power)


def round_factor(factor: float) -> float:
    """Round an exaggeration down to 1, 1.5, 2, 3, 5 or 7 times a power of ten; never below 1."""
    power = 10.0 ** np.floor(np.log10(max(factor, 1.0)))
    steps = np.array([1.0, 1.5, 2.0, 3.0, 5.0, 7.0])
    return float(steps[steps <= max(factor, 1.0) / power * (1.0 + 1e-12)][-1] * power)
