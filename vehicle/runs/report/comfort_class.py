"""Likely reactions to a frequency-weighted acceleration, from ISO 2631-1."""

import math

REACTIONS = (
    ("not uncomfortable", 0.0, 0.315),
    ("a little uncomfortable", 0.315, 0.63),
    ("fairly uncomfortable", 0.5, 1.0),
    ("uncomfortable", 0.8, 1.6),
    ("very uncomfortable", 1.25, 2.5),
    ("extremely uncomfortable", 2.0, math.inf),
)
"""Likely reactions to overall vibration total values in public transport, from and up to [m/s2]; the ranges overlap
(ISO 2631-1:1997, C.2.3)."""

CREST_FACTOR_LIMIT = 9.0
"""Crest factor up to which the weighted RMS is enough (ISO 2631-1:1997, 6.2.1)."""


def reactions(weighted_rms: float) -> tuple[str, ...]:
    """Return the likely reactions to a vibration total value.

    Args:
        weighted_rms: vector sum of the weighted RMS accelerations [m/s2].

    Returns:
        One or two of `REACTIONS`, the milder first; both ends of a range belong to it, but those of the first and the
        last ("less than 0.315", "greater than 2").
    """
    return tuple(word for word, low, high in REACTIONS if _within(weighted_rms, low, high))


def _within(value: float, low: float, high: float) -> bool:
    if low == 0.0:
        return value < high
    return value > low if math.isinf(high) else low <= value <= high
