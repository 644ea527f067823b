"""Text of a fit for the console: values first, then what the data leave open, then the agreement."""

import math
from collections.abc import Sequence

from vehicle.digits import number
from vehicle.model.parameters.paths import unit_of
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.signals.records.counterpart import SHARE_OF_STEP, SIGNIFICANT
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.full_steps import SMALL
from vehicle.studies.tuning.limits_of_data import what_data_leave_open
from vehicle.studies.tuning.tuned_car import Agreement, TunedCar


def value_lines(result: TuningResult, vehicle: Vehicle) -> list[str]:
    """Return a line for each parameter: value, standard error, unit, start value and bounds."""
    width = max((len(parameter.path) for parameter in result.parameters), default=0)
    lines = []
    for parameter in result.parameters:
        value, error = result.values[parameter.path], result.errors[parameter.path]
        spread = f"+- {number(error, 2)}" if math.isfinite(error) else "without a standard error"
        percent = parameter.percent(error, value)
        share = f" ({number(percent, 2)} %)" if math.isfinite(percent) else ""
        shown = number(value, known_digits(value, error))
        lines.append(
            f"{parameter.path:<{width}}  {shown} {spread} {unit_of(vehicle, parameter.path)}{share}, start "
            f"{parameter.start:.6g}, bounds {parameter.low:g} to {parameter.high:g}"
        )
    return lines


def known_digits(value: float, error: float) -> int:
    """Return the significant digits of a value with a standard error: up to the decimals of the error."""
    if not (math.isfinite(error) and error > 0.0 and value != 0.0):
        return 6
    return min(max(math.floor(math.log10(abs(value))) - math.floor(math.log10(error)) + 2, 2), 8)


def tuning_text(tuned: TunedCar) -> str:
    """Return the result of a fit: an unexplained error, values, options, what is left open, agreement, final check."""
    result = tuned.result
    settings = " ".join(f"--set {text}" for text in tuned.settings)
    lines = [tuned.unexplained] if tuned.unexplained else []
    lines += value_lines(result, tuned.start.vehicle)
    lines += [settings or f"do not use this fit: {tuned.refusal}"]
    lines += [*delay_lines(tuned), *source_lines(result, tuned.start.vehicle)]
    lines += [f"left open: {text}" for text in what_data_leave_open(result)]
    if tuned.determined:
        lines.append(
            "the data determine every parameter: all standard errors are below 10 %, all correlations below 0.9"
        )
    lines += agreement_lines(tuned.agreement)
    return "\n".join([*lines, *fit_sentences(tuned)])


def delay_lines(tuned: TunedCar) -> list[str]:
    """Return a line for each fitted delay."""
    result, lines = tuned.result, []
    for delay in result.delays:
        value, error = 1e3 * result.solution[delay.path], 1e3 * result.errors[delay.path]
        target = tuned.measurements[delay.target].target
        digits = min(max(1 - math.floor(math.log10(error)), 0), 4) if 0.0 < error < math.inf else 3
        spread = f"{abs(value):.{digits}f}" + (f" +- {error:.{digits}f}" if math.isfinite(error) else "") + " ms"
        large = abs(value) > max(SIGNIFICANT * error, 500.0 * SHARE_OF_STEP * 2.0 * target.half_sample)
        sentence = f"the {delay.group} of {target.name} are {spread} {'early' if value < 0.0 else 'late'}"
        lines.append(
            f"{sentence}: the sensors have a delay, or parameters that are not fitted are wrong; if you know the "
            f"delay, set {delay.option(1e-3 * value)}"
            if large
            else f"{sentence}; the fit allows for it"
        )
    return lines


def source_lines(result: TuningResult, vehicle: Vehicle) -> list[str]:
    """Return the table of the causes in the stated standard errors, and of what else would move the values."""
    free = [parameter.path for parameter in result.parameters if parameter.path in result.free]
    if not free:
        return []
    names = [f"{path} [{unit_of(vehicle, path)}]" for path in free]
    width = max(48, *map(len, names))
    lines = [
        f"{'standard error from':<{width}} {'noise and misfit':>16} {'noise alone':>12} "
        f"{'shift by half a sample of lag':>30}"
    ]
    for name, path in zip(names, free, strict=True):
        lag = result.lag_shifts[path]
        shift = number(lag, 2) if math.isfinite(lag) else "-"
        lines.append(
            f"{name:<{width}} {number(result.errors[path], 2):>16} "
            f"{number(result.standard_errors[path], 2):>12} {shift:>30}"
        )
    return lines


def agreement_lines(agreement: Sequence[Agreement]) -> list[str]:
    """Return the table of the errors against the measurements before and after the fit."""
    names = [f"{row.measurement}, {row.label}, {row.measure} [{row.unit}]" for row in agreement]
    width = max(48, *map(len, names)) if names else 48
    lines = [f"{'error against the measurement':<{width}} {'before':>9} {'after':>9}"]
    lines += [
        f"{name:<{width}} {row.before:>9.3g} {row.after:>9.3g}" for name, row in zip(names, agreement, strict=True)
    ]
    return lines


def fit_sentences(tuned: TunedCar) -> list[str]:
    """Return sentences on the end of the fit and on its last steps with the complete model."""
    result, final = tuned.result, tuned.final
    before, after = tuned.total_error
    sentences = [
        f"error over all channels: {number(before)} % of RMS before the fit, {number(after)} % after it (comparable "
        f"between fits of the same measurement); {result.evaluations} cars computed"
    ]
    if not result.converged:
        sentences.append(f"not converged: {result.message}; narrow the bounds, or start closer with --set PATH=VALUE")
    if final is None:
        if any(each.signal is not None for each in tuned.measurements):
            sentences.append(
                "not checked with the complete model: add --engine mujoco, which runs the last steps with it"
            )
    else:
        moved = max(final.moved.items(), key=lambda item: abs(item[1]), default=("", 0.0))
        state = "settled" if final.settled else "not settled"
        sentences.append(
            f"last steps with {tuned.engine}: {len(final.largest_steps)}, {state} (last step "
            f"{number(final.largest_steps[-1], 2)} standard errors, limit {SMALL:g})"
            + (f"; {moved[0]} moved most, by {number(moved[1], 2)} standard errors" if moved[0] else "")
        )
    return sentences
