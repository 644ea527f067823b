"""Round numbers for ends of scales and for factors."""

import numpy as np


def round_up(value: float) -> float:
    """Round up to 1, 1.5, 2, 3, 4, 5, 6, 8 or 10 times a power of ten; 1 for zero."""
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
