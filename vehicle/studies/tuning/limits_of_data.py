"""Statements on what the data of a fit leave open, and the reason why its values must not be used."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from vehicle.digits import number
from vehicle.studies.tuning.fit_result import TuningResult

CORRELATED = 0.9
"""Minimum correlation of a pair that is named: at 0.9 the standard error of each value is 1 / sqrt(1 - 0.9^2) = 2.3
times the standard error for a fixed second value."""

UNSURE = 0.1
"""Minimum relative standard error of a value that is named [-]: the tolerance of a damper or a bushing in series
production, so that the fit would not distinguish it from another specimen."""

NO_MOTION = 100.0
"""RMS error of a model that does not move, over the RMS of the measurement [%]."""

LARGEST_ERROR = 20.0
"""Assumed limit of the RMS error of a channel after a fit, over the RMS of the measurement and beyond its known noise
[%]: above it the parameters do not explain the measurement. At one frequency it is an error of 1.7 dB or 11 degrees,
far above the error of a calibrated sensor, so that something else in the car is wrong. The standard errors contain the
scatter of the residuals, but not the shift of the values by such an error."""

OFTEN_WRONG = (
    "suspension_mount.stiffness.z", "damper.viscous", "damper.coulomb_friction", "tyre.stiffness.z",
    "main_spring.stiffness",
)  # fmt: skip
"""Parameters that vary most between specimens or are known least, named as examples for a further fit."""

FIRST = "first check the delays (--delay), signs (--turn) and units (--unit) of the channels"
"""Advice: check the channels before the model is doubted."""


def what_data_leave_open(result: TuningResult) -> tuple[str, ...]:
    """Return a message for each undetermined parameter or pair; empty if the data determine all parameters.

    For values a and b with relative standard errors s_a, s_b and correlation rho, the relative standard error of a / b
    (rho > 0) or a b (rho < 0) is sqrt(s_a^2 + s_b^2 - 2 |rho| s_a s_b).
    """
    sentences = [held.message() for held in result.unidentified]
    for path in result.at_bound:
        entry = next(unknown for unknown in result.unknowns if unknown.path == path)
        value = result.solution[path]
        side = "lower" if value - entry.low < entry.high - value else "upper"
        sentences.append(
            f"{path} ended at your {side} bound of {value:.6g} and has no standard error: the bound is too tight, or "
            "the model does not fit the data"
        )
    relative = {path: result.deviation_of_u(path, result.errors) for path in result.free}
    # A product, a ratio or a percentage of a delay or of a coordinate has no meaning.
    linear = {each.path for each in result.delays} | {each.path for each in result.parameters if each.is_linear}
    for (i, first), (j, second) in combinations(enumerate(result.free), 2):
        rho = float(result.correlation[i, j])
        if abs(rho) < CORRELATED:
            continue
        if {first, second} & linear:
            sentences.append(f"{first} and {second}: correlation {rho:+.2f}, so an error in one value shifts the other")
            continue
        a, b = relative[first], relative[second]
        both = np.sqrt(max(a**2 + b**2 - 2.0 * abs(rho) * a * b, 0.0))
        word = "ratio" if rho > 0.0 else "product"
        sentences.append(
            f"{first} and {second}: correlation {rho:+.2f}, so their {word} is known within {number(100 * both, 2)} %, "
            f"but the values only within {number(100 * a, 2)} and {number(100 * b, 2)} %"
        )
    sentences += [
        f"{path}: standard error {number(100 * error, 2)} % of the value, above {100 * UNSURE:g} %"
        for path, error in relative.items()
        if error > UNSURE and path not in linear
    ]
    sentences += [
        f"{each.path}: standard error {number(1e3 * relative[each.path] * each.length, 2)} mm, above "
        f"{1e3 * UNSURE * each.length:g} mm"
        for each in result.parameters
        if each.is_linear and relative.get(each.path, 0.0) > UNSURE
    ]
    return tuple(sentences)


def unexplained(errors: Sequence[tuple[str, float, float, float]], others: Sequence[str]) -> str:
    """Return the statement that a fit does not explain the measurement; empty if all channels are explained.

    Args:
        errors: name of each channel, its RMS error before and after the fit, and its known noise, each over the RMS of
            the measurement [%].
        others: examples of parameters of the car that were not fitted.
    """
    left = [entry for entry in errors if entry[2] > np.hypot(LARGEST_ERROR, entry[3])]
    if not left:
        return ""
    name, before, after, _ = max(left, key=lambda entry: entry[2])
    example = f" (for example {' or '.join(others)})" if others else ""
    return (
        f"these parameters do not explain the measurement: the error of {name} is still {number(after)} % of its RMS "
        f"(before the fit {number(before)} %, limit {LARGEST_ERROR:g} %), so the standard errors are too small. Check "
        f"signs (--turn) and units (--unit) of the channels, then fit other parameters{example}, alone and together "
        "with these; the fit with the smallest error is the best"
    )


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
                f"{unknown.path} ended at its bound of {factor * value:.5g}{unit}: the bound is too tight, or the "
                f"model does not fit the data; {FIRST}"
            )
    name, error = max(errors, key=lambda item: item[1], default=("", 0.0))
    if error > NO_MOTION:
        return (
            f"the error of {name} is {error:.3g} % of the measurement, more than for a car that does not move (100 %); "
            f"{FIRST}"
        )
    return ""
