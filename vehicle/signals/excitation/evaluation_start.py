"""Start time of the evaluation of a run: comfort, slip shares, densities."""

from collections.abc import Mapping

from vehicle.errors import ConfigurationError


def evaluation_start(durations: Mapping[str, float], skip: float | None, default: float) -> float:
    """Return the start of the evaluation [s], equal for all inputs.

    Args:
        durations: name of each input to its length [s].
        skip: requested start [s]; None for the default.
        default: default start [s].
    """
    start = default if skip is None else skip
    for name, duration in durations.items():
        if not 0.0 <= start < duration:
            remark = " (the default)" if skip is None else ""
            remedy = "; choose a longer --duration" if skip is None else ""
            raise ConfigurationError(
                f"--skip {start:g} s{remark}: must be at least 0 and below the {duration:g} s of {name}{remedy}"
            )
    return float(start)
