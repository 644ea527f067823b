"""Comfort section of the report: weighted and unweighted accelerations, and likely reactions."""

from __future__ import annotations

from markupsafe import Markup

from vehicle.digits import number
from vehicle.names import point_words
from vehicle.runs.report.comfort_class import REACTIONS, reactions
from vehicle.runs.report.finished_run import FinishedRun
from vehicle.runs.report.markup import templates
from vehicle.signals.records.run_summary import unweighted_rms

fill = templates(__file__)

NO_FIGURE = Markup()


def comfort(run: FinishedRun, bands: Markup = NO_FIGURE) -> Markup:
    """Return tables of weighted and unweighted accelerations, and of reactions with the values of this run.

    Args:
        bands: figure of the frequencies, left of the reactions; may be empty.
    """
    points, totals = [], {}
    for point, value in run.comfort.items():
        iso, (raw, (low, high)) = value["iso2631"], unweighted_rms(value)
        totals[point_words(point)] = iso["vector_sum"]["weighted_rms"]
        rows = [
            (
                axis,
                iso[axis]["weighting"],
                *(number(iso[axis][key]) for key in ("weighted_rms", "mtvv", "crest_factor", "vdv", "msdv")),
                number(raw[axis]),
            )
            for axis in "xyz"
        ]
        whole = iso["vector_sum"]
        rows.append(
            ("all", "", number(whole["weighted_rms"]), "", "", number(whole["vdv"]), "", number(raw["overall"]))
        )
        span = f", {run.span} of the run" if run.span else ""
        caption = f"{point_words(point).capitalize()}, {iso['standard']}{span}"
        points.append((caption, low, high, rows, iso["reasons"]))
    matches = [
        (_range(low, high), word, [point for point, total in totals.items() if word in reactions(total)])
        for word, low, high in REACTIONS
    ]
    return fill("comfort", bands=bands, points=points, reactions=matches, seat=run.summary.get("seat_value"))


def _range(low: float, high: float) -> str:
    if low == 0.0:
        return f"below {high:g} m/s²"
    return f"above {low:g} m/s²" if high == float("inf") else f"{low:g} to {high:g} m/s²"
