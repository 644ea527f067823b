"""Settling of a run that begins at rest while the record of its signal is in motion."""

from collections.abc import Iterable

RAMP_WORDS = "half-cosine ramp"
"""Words in the notices of a signal that was faded in."""

SETTLED = 2.0
"""Time after which a car that began at rest on a moving plate follows the measured one [s], as for runs on a road: four
periods of the body bounce near 2 Hz. Measured on records cut out of runs, RMS error after it over that of the channel:
1.3 to 6.2 % for `focus`, 13 to 25 % before; with stuck dampers (`sedan` on low.csv) still up to 24 %."""


def settling_time(notices: Iterable[str]) -> float:
    """Return the time after which a run follows a record of its signal [s]: `SETTLED` if faded in, otherwise 0."""
    return SETTLED if any(RAMP_WORDS in text for text in notices) else 0.0
