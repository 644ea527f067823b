"""Rows with published interval, place and status from `scenarios.evidence`."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from scenarios.claims import Claim, Interval, Source, interval_claim, not_contradicted
from scenarios.evidence import Evidence, evidence_of, status_of
from scenarios.interval_probability import AGREES_ABOVE, interval_probability


def evidence_claim(
    key: str, name: str, ours: npt.ArrayLike, why: str, *, printed: float | None = None, error: float | None = None
) -> Claim:
    """Return the row of an evidence: it agrees where the probability of its interval is above 5 %.

    The probability contains the scatter of ours over its seeds and the error that the evidence states. The row is
    undecided where two standard errors of our mean turn the verdict.

    Args:
        key: of the evidence.
        name: what is compared, with its unit.
        ours: own value, or one for each seed, (n,); infinite where what is timed never happens.
        why: reason of a disagreement, and how ours was found.
        printed: the number itself where the source prints one, shown instead of the interval.
        error: error of the model in the unit of the row, see `slip_error`; by default the error of the evidence.
    """
    evidence, values = evidence_of(key), np.atleast_1d(np.asarray(ours, dtype=float))
    if error is not None:
        evidence = replace(evidence, error=error)
    if evidence.same:
        why = f"the half second of {evidence_of(evidence.same).place} again, counted there; {why}"
    row = interval_claim(name, evidence.interval, float(np.mean(values)), why, status=status_of(key))
    source = _source(evidence, printed)
    if source != "axis interval":  # an interval from 0 on is printed ("no slip") and can be tested
        row = replace(row, status=status_of(key), within=row.inside, why=why)
    row = replace(row, place=evidence.place, evidence=key, source=source)
    if printed is not None:
        deviation = (float(np.mean(values)) - printed) / printed if printed else None
        row = replace(row, published=printed, deviation=deviation)
    if not np.all(np.isfinite(values)):
        never = f"never in {np.sum(~np.isfinite(values))} of {values.size}"
        return replace(row, ours=never, deviation=None, within=False, inside=False)
    if values.size > 1:
        row = replace(row, ours=f"{np.mean(values):.4g} +- {np.std(values, ddof=1):.2g} ({values.size} values)")
    if row.status == "not testable" or (values.size == 1 and not evidence.error):
        return row
    probability = interval_probability(values, evidence.interval, error=evidence.error)
    rule = (
        f"{100.0 * probability:.3g} % is the probability of {_words(evidence)}, must exceed {100.0 * AGREES_ABOVE:g} %"
    )
    within = not_contradicted(values, evidence.interval, evidence.error)
    return replace(row, within=within, probability=probability, why=f"{rule}; {why}")


def reason(interval: Interval, trials: Mapping[str, float]) -> str:
    """Return a text on experiments for a disagreement: our value with each change, those in the interval first."""
    low, high = interval
    texts = {label: f"{label} {value:.3g}" for label, value in trials.items()}
    inside = [texts[label] for label, value in trials.items() if low <= value <= high]
    outside = [text for text in texts.values() if text not in inside]
    if not inside:
        return f"experiments: no modification reaches the interval ({', '.join(outside)})"
    others = f"; not with {', '.join(outside)}" if outside else ""
    return f"experiments: reached with {', '.join(inside)}{others}"


def _words(evidence: Evidence) -> str:
    error = f" with a model error of {evidence.error:.3g} {evidence.unit}" if evidence.error else ""
    unit = "" if evidence.unit == "-" else f" {evidence.unit}"
    low, high = evidence.interval
    text = (
        f"at most {high:g}" if math.isinf(low) else f"at least {low:g}" if math.isinf(high) else f"{low:g} to {high:g}"
    )
    return f"{text}{unit}{error}"


def _source(evidence: Evidence, printed: float | None) -> Source:
    if evidence.place.startswith("table"):
        return "table"
    return "axis interval" if printed is None and evidence.place.startswith("figure") else "text"
