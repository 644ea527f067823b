"""Time at which the evaluation of a run begins: comfort, slip shares, densities."""

from __future__ import annotations

from collections.abc import Mapping

from vehicle.errors import ConfigurationError


def evaluation_start(durations: Mapping[str, float], skip: float | None, default: float) -> float:
    """Return the start of the evaluation, the same for all inputs.

    Args:
        durations: name of each input to its length [s].
        skip: requested start [s]; None for the default.
        default: start where none is requested [s].

    Returns:
        Start [s].

    Raises:
        ConfigurationError: negative, not finite, or not shorter than an input.
    """
    start = default if skip is None else skip
    for name, duration in durations.items():
        if not 0.0 <= start < duration:
            said = " (the default)" if skip is None else ""
            raise ConfigurationError(f"--skip {start:g} s{said}: allowed is 0 s to less than {name}, {duration:g} s")
    return float(start)
