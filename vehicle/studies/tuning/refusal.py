"""Reasons why the values of a fit are not to be used."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle.studies.tuning.fit_result import TuningResult

NO_MOTION = 100.0
"""RMS error of a model that does not move, over the RMS of the measurement [%]: that of a mean of zero."""

FIRST = "check delays (--delay), signs (--turn) and units (--unit) of the channels first"
"""Advice: check the channels before the model is doubted."""


def refusal(result: TuningResult, errors: Sequence[tuple[str, float]]) -> str:
    """Return the reason why the values of a fit are unusable; empty if they are usable.

    Args:
        errors: name of each channel, and its RMS error after the fit over the RMS of the measurement [%].
    """
    for unknown in result.unknowns:
        if unknown.path in result.at_bound:
            value, factor, unit = result.solution[unknown.path], 1.0, ""
            if unknown in result.delays:
                factor, unit = 1e3, " ms"
            return (
                f"{unknown.path} ran into its limit of {factor * value:.5g}{unit}. Either the limit is too tight, or "
                f"the data do not fit this model: {FIRST}"
            )
    name, error = max(errors, key=lambda item: item[1], default=("", 0.0))
    if error > NO_MOTION:
        return (
            f"the error of {name} stays at {error:.3g} % of the measurement, more than that of a car at rest (100 %): "
            f"{FIRST}"
        )
    return ""
