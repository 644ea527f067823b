"""Rows of fitted against hidden values, and paragraphs on the reliability of a fit."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from scenarios.claims import OWN_CHECK, Claim
from scenarios.tuning.data import NOISE, SLIDING
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.full_steps import SMALL, FullSteps
from vehicle.studies.tuning.limits_of_data import what_data_leave_open
from vehicle.studies.tuning.measured_targets import MeasuredTarget
from vehicle.studies.tuning.tuning_text import source_lines, value_lines

WITHIN = 3.0
"""Standard errors: 99.7 % of the values of a normal distribution; one of nine is beyond in one fit of forty."""


def demonstration_claims(final: FullSteps, from_records: FullSteps | None, true: Mapping[str, float]) -> list[Claim]:
    """Return the rows on every hidden value, on the damper from the bump records, and on the final check."""
    claims = [_recovered(f"{path}, all levels in one fit", final.result, path, value) for path, value in true.items()]
    claims.append(_checked("all levels in one fit", final))
    if from_records is not None:
        claims += [_recovered(f"{path}, bump records alone", from_records.result, path, true[path]) for path in SLIDING]
        claims.append(_checked("bump records alone", from_records))
    return claims


def _recovered(name: str, result: TuningResult, path: str, true: float) -> Claim:
    """Return the row of a hidden value."""
    held = next((parameter for parameter in result.unidentified if parameter.path == path), None)
    if held is not None:
        return OWN_CHECK.statement(
            name, f"hidden {true:g}", f"not identified by the data, held at {held.held_at:g}", True, held.message()
        )
    away = result.deviation(path, true)
    start = next(parameter.start for parameter in result.parameters if parameter.path == path)
    allowed = WITHIN * result.standard_errors[path]
    why = (
        f"hidden value, not printed: {away:+.2f} standard errors of {result.standard_errors[path]:.3g} away, "
        f"allowed {WITHIN:g}; started at {start:g}"
    )
    return OWN_CHECK.number(name, true, result.values[path], allowed, why)


def _checked(name: str, final: FullSteps) -> Claim:
    path, largest = max(final.moved.items(), key=lambda item: abs(item[1]))
    steps = ", ".join(f"{step:.2g}" for step in final.largest_steps)
    return OWN_CHECK.statement(
        f"final check with the full simulation: {name}",
        "no step left",
        f"weighted residuals {final.first:.3f} at the values of the fast models, {final.result.after:.3f} at the end; "
        f"largest steps {steps} standard errors; {path} moved most, by {largest:+.1f} standard errors",
        final.settled,
        f"Gauss-Newton steps with the Jacobian of the fast models; the last must be below {SMALL:g} standard errors",
    )


def data_note(measurements: Sequence[MeasuredTarget], engine: str, quick: bool) -> str:
    """Return a note on the data, and on the effect of model errors."""
    names = ", ".join(measurement.target.name for measurement in measurements)
    short = (
        " --quick: fewer parameters, levels, channels and frequencies, and the reduced engine in place of MuJoCo."
        if quick
        else ""
    )
    return (
        f"Data: {names}; engine {engine}, hidden parameters, {100 * NOISE:g} % noise (standard deviation of ln|H|, of "
        f"the phase in rad, and of a record over its RMS, before the low-pass filter of the fit), seeded, "
        f"coherence to match.{short} In the loop: the "
        "matrices with stuck dampers for low, the reduced engine for all others. Their model error enters the standard "
        "errors in so far as it makes the residuals larger or correlated; the part that looks like a change of "
        "parameters does not show there, and is taken out by the last steps with the full simulation ('moved')."
    )


def frozen_note(damper: TuningResult, true: Mapping[str, float]) -> str:
    """Return a note on the damper fitted with all other parameters frozen."""
    parts = [
        f"{path} {damper.values[path]:.4g}, {damper.deviation(path, true[path]):+.1f} standard errors from the hidden "
        "value"
        for path in damper.free
    ]
    return (
        f"With the rest frozen: {'; '.join(parts)}. These standard errors do not know that the frozen values are "
        "uncertain (what the stuck car does not show stays at its start) and that the fast model is not exact: a "
        "reason for one fit of everything."
    )


def fit_notes(title: str, result: TuningResult, final: FullSteps | None, vehicle: Vehicle) -> list[str]:
    """Return paragraphs on the end of a fit: values, standard errors, what the data leave open."""
    moved = {} if final is None else final.moved
    shifts = ", ".join(f"{path} {shift:+.2f}" for path, shift in moved.items())
    lines = [*value_lines(result, vehicle), *source_lines(result, vehicle), *what_data_leave_open(result)]
    return [
        f"## {title}\n\n{result.evaluations} cars computed; {result.message} Root of the mean square of the weighted "
        f"residuals {result.before:.3g} before, {result.after:.3g} after. Condition of the weighted Jacobian (columns "
        f"in half widths of the bounds) {result.condition:.3g}."
        + (f" Moved by the full simulation, in standard errors: {shifts}." if shifts else ""),
        "\n".join(["```text", *lines, "```"]),
    ]


def fit_numbers(result: TuningResult) -> dict[str, Any]:
    """Return a fit as plain data for `results.json`."""
    plain = ("values", "standard_errors", "free", "at_bound", "condition", "evaluations", "converged")
    return {
        **{name: getattr(result, name) for name in plain},
        "start": {parameter.path: parameter.start for parameter in result.parameters},
        "correlation": result.correlation.tolist(),
        "unidentified": [asdict(parameter) for parameter in result.unidentified],
        "weighted_residual": {"before": result.before, "after": result.after},
    }
