"""Rows of fitted against hidden values, and paragraphs on the reliability of a fit."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from scenarios.claims import OWN_CHECK, Claim, markdown
from scenarios.tuning.data import NOISE, SLIDING
from vehicle.studies.tuning.fit_result import TuningResult
from vehicle.studies.tuning.full_steps import SMALL, FullSteps
from vehicle.studies.tuning.identifiability import WIDEST
from vehicle.studies.tuning.measured_targets import MeasuredTarget

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


def fit_notes(title: str, result: TuningResult, final: FullSteps | None) -> list[str]:
    """Return paragraphs on the end of the fit, the values, unidentified parameters and residuals."""
    notes = [
        f"## {title}\n\n{result.evaluations} cars computed; {result.message} Root of the mean square of the weighted "
        f"residuals {result.before:.3g} before, {result.after:.3g} after. Condition of the weighted Jacobian (columns "
        f"in half widths of the bounds) {result.condition:.3g}.",
        _values(result, final),
    ]
    if result.unidentified:
        sentences = "\n".join(f"- {held.message()}" for held in result.unidentified)
        notes.append(
            "Not identified (a direction of the weighted Jacobian with a standard error above "
            f"{WIDEST:.2g} half widths of the bounds, half of what the bounds alone say):\n\n{sentences}"
        )
    if result.at_bound:
        notes.append(f"At a bound, so without standard error: {', '.join(result.at_bound)}.")
    notes.append(_rows(result))
    return notes


def _values(result: TuningResult, final: FullSteps | None) -> str:
    moved = {} if final is None else final.moved
    rows = []
    for parameter in result.parameters:
        value, error = result.values[parameter.path], result.standard_errors[parameter.path]
        finite = not math.isnan(error)
        shift = f"{moved[parameter.path]:+.2f}" if parameter.path in moved else ""
        errors = (f"{error:.2g}", f"{100 * error / value:.2g} %") if finite else ("none", "")
        fit = (parameter.path, f"{parameter.low:g} to {parameter.high:g}", f"{parameter.start:g}", f"{value:.4g}")
        rows.append((*fit, *errors, _strongest(result, parameter.path), shift))
    columns = ("parameter", "bounds", "start", "fitted", "standard error", "relative", "strongest correlation")
    return markdown((*columns, "moved by the full simulation [standard errors]"), rows)


def _strongest(result: TuningResult, path: str) -> str:
    if path not in result.free or len(result.free) < 2:
        return ""
    row = result.correlation[result.free.index(path)]
    others = [index for index, other in enumerate(result.free) if other != path]
    best = max(others, key=lambda index: abs(row[index]))
    return f"{row[best]:+.2f} with {result.free[best]}"


def _rows(result: TuningResult) -> str:
    columns = ("row", "values", "mean", "RMS", "correlation of neighbours", "counted as one independent value")
    rows = [
        (
            *(row.name, str(row.count), f"{row.mean:+.3f}", f"{row.rms:.3g}"),
            *(f"{row.neighbours:+.2f}", f"{row.inflation:.2g}"),
        )
        for row in result.rows
    ]
    return (
        "Residuals over their assumed standard deviation (FRFs: from the coherence; records: the RMS of the record). "
        "The fit weighs every row with its own RMS, and with the correlation of neighbours where it is beyond three "
        f"standard errors.\n\n{markdown(columns, rows)}"
    )


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
