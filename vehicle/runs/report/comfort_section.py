"""Comfort section of the report: weighted and unweighted accelerations, and likely reactions."""

from __future__ import annotations

from vehicle.digits import number
from vehicle.names import point_words
from vehicle.runs.report.comfort_class import REACTIONS, reactions
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import Markup, joined, table, tag
from vehicle.signals.records.run_summary import unweighted_rms

NO_ERROR = (
    "MTVV, VDV, crest factor and SEAT value have no error estimate: they belong to this record, and another road of "
    "the same class gives other values. Repeat the run with other seeds for their scatter."
)
"""Sentence below the tables."""


def comfort(run: FinishedRun) -> Markup:
    """Return tables of weighted and unweighted accelerations, and of reactions with the values of this run."""
    parts, totals = [], {}
    for point, value in run.comfort.items():
        iso, (raw, (low, high)) = value["iso2631"], unweighted_rms(value)
        totals[point_words(point)] = iso["vector_sum"]["weighted_rms"]
        heads = (
            "axis",
            "weighting",
            "weighted RMS [m/s²]",
            "MTVV [m/s²]",
            "crest factor",
            "VDV [m/s¹·⁷⁵]",
            "MSDV [m/s¹·⁵]",
            f"unweighted RMS, {low:g} to {high:g} Hz [m/s²]",
        )
        rows = [
            (
                axis,
                iso[axis]["weighting"],
                *(number(iso[axis][key]) for key in ("weighted_rms", "mtvv", "crest_factor", "vdv", "msdv")),
                number(raw[axis]),
            )
            for axis in "xyz"
        ]
        rows.append(
            (
                "all",
                "",
                number(iso["vector_sum"]["weighted_rms"]),
                "",
                "",
                number(iso["vector_sum"]["vdv"]),
                "",
                number(raw["overall"]),
            )
        )
        span = f", {run.span} of the run" if run.span else ""
        caption = f"{point_words(point).capitalize()}, {iso['standard']}{span}"
        parts.append(table(heads, rows, caption=caption, text_columns=2))
        parts += [tag("p", text) for text in iso["reasons"]]
    matches = {word: [point for point, total in totals.items() if word in reactions(total)] for word, _, _ in REACTIONS}
    body = [
        tag(
            "tr",
            tag("td", _range(low, high)),
            tag("td", word),
            tag("td", ", ".join(matches[word])),
            class_="here" if matches[word] else None,
        )
        for word, low, high in REACTIONS
    ]
    parts.append(
        tag(
            "div",
            tag(
                "table",
                tag(
                    "caption",
                    "Likely reactions in public transport (ISO 2631-1:1997, C.2.3); ranges overlap; lower is better",
                ),
                tag(
                    "thead", tag("tr", tag("th", "weighted acceleration"), tag("th", "reaction"), tag("th", "this run"))
                ),
                tag("tbody", *body),
            ),
            class_="table whole",
        )
    )
    seat = run.summary.get("seat_value")
    if seat is not None:
        text = f"SEAT value {number(seat['rms'])} by RMS, {number(seat['vdv'])} by dose: the seat isolates below 1."
        parts.append(tag("p", text))
    parts.append(tag("p", NO_ERROR))
    parts.append(tag("p", "The standard applies to the vibration on the seat surface; the seat rail is below it."))
    return joined(parts)


def _range(low: float, high: float) -> str:
    if low == 0.0:
        return f"below {high:g} m/s²"
    return f"above {low:g} m/s²" if high == float("inf") else f"{low:g} to {high:g} m/s²"
