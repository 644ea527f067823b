"""Report of a fit: values, undetermined parameters, errors and figures before and after, command line."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from vehicle.model.parameters.paths import unit_of
from vehicle.runs.report.markup import Markup, joined, number, shortened, table, tag
from vehicle.runs.report.page import document
from vehicle.runs.report.svg_figure import drawing
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.limits_of_data import what_data_leave_open
from vehicle.studies.tuning.posterior_text import NamedPosterior, posterior_sentences
from vehicle.studies.tuning.tuned_car import TunedCar
from vehicle.studies.tuning.tuning_text import fit_sentences

POSTERIOR = "posterior"
"""Name of the picture of the posterior."""


def tuning_page(
    tuned: TunedCar,
    figures: Mapping[str, Callable[[Path], None]],
    command: str,
    posteriors: Sequence[NamedPosterior] = (),
) -> str:
    """Return the report of a fit as one HTML document.

    Args:
        tuned: fitted car.
        figures: name of each picture and the function that writes it.
        command: command line of the fit.
        posteriors: see `posterior_lines`; empty without a posterior.
    """
    names = ", ".join(each.target.name for each in tuned.measurements)
    vehicle = tuned.start.vehicle
    parts = [
        ("Fitted values", "values", _values(tuned)),
        ("What the data leave open", "open", _left_open(tuned)),
        *([("Posterior", "posterior", _posterior(tuned, figures, posteriors))] if posteriors else []),
        ("Before and after", "agreement", _agreement(tuned, figures)),
        ("Residuals", "residuals", _residuals(tuned)),
        ("How to repeat the fit", "repeat", joined([tag("pre", command), tag("pre", tuned.settings)])),
    ]
    return document(f"{vehicle.name} fitted to {names}", (f"tyres {_driving(tuned)}",), parts)


def _driving(tuned: TunedCar) -> str:
    """Return how the tyres stand or roll in the measurements."""
    words = []
    for each in tuned.measurements:
        road = None if isinstance(each.target, FrfTarget) else each.target.road
        words.append((tuned.start if road is None else road.rolling).vehicle.driving.words)
    return ", ".join(dict.fromkeys(words))


def _values(tuned: TunedCar) -> Markup:
    result, vehicle = tuned.result, tuned.start.vehicle
    rows = []
    for parameter in result.parameters:
        value, error = result.values[parameter.path], result.standard_errors[parameter.path]
        finite = math.isfinite(error)
        rows.append(
            (
                parameter.path,
                unit_of(vehicle, parameter.path),
                number(value, 5),
                number(error if finite else None, 2),
                number(100.0 * error / value if finite else None, 2),
                number(parameter.start, 5),
                number(100.0 * (value / parameter.start - 1.0), 3),
                f"{number(parameter.low, 5)} to {number(parameter.high, 5)}",
            )
        )
    heads = ("parameter", "unit", "fitted", "standard error", "[%]", "start", "change [%]", "bounds")
    sentences = [tag("p", text) for text in fit_sentences(tuned)]
    notices = [tag("li", text) for each in tuned.measurements for text in each.notices]
    return joined(
        [
            table(heads, rows, text_columns=2),
            *sentences,
            *([tag("h3", "Notices on the measurements"), tag("ul", *notices, class_="notices")] if notices else []),
        ]
    )


def _left_open(tuned: TunedCar) -> Markup:
    sentences = what_data_leave_open(tuned.result)
    if not sentences:
        return tag("p", "Nothing: no pair with a correlation of 0.9 or more, no standard error above 10 %.")
    return tag("ul", *(tag("li", text) for text in sentences), class_="notices")


def _agreement(tuned: TunedCar, figures: Mapping[str, Callable[[Path], None]]) -> Markup:
    rows = [
        (row.measurement, row.channel, row.measure, row.unit, number(row.before), number(row.after))
        for row in tuned.agreement
    ]
    heads = ("measurement", "channel", "error of", "unit", "before", "after")
    drawings = [drawing(draw, name) for name, draw in figures.items() if name != POSTERIOR]
    return joined([table(heads, rows, text_columns=4), *drawings])


def _posterior(
    tuned: TunedCar, figures: Mapping[str, Callable[[Path], None]], posteriors: Sequence[NamedPosterior]
) -> Markup:
    posterior = posteriors[0][1]
    rows = [
        (parameter.path, unit_of(tuned.start.vehicle, parameter.path), *(number(value, 4) for value in ends))
        for parameter, ends in zip(posterior.car.parameters, posterior.interval().T.tolist(), strict=True)
    ]
    rows += [
        (f"comfort on {name}", "m/s2", *(number(value, 4) for value in ends))
        for name, ends in zip(posterior.car.signals, posterior.comfort().T.tolist(), strict=True)
    ]
    return joined(
        [
            table(("", "unit", "5 %", "median", "95 %"), rows, text_columns=2),
            *(tag("p", text) for text in posterior_sentences(posteriors)),
            drawing(figures[POSTERIOR], POSTERIOR),
        ]
    )


def _residuals(tuned: TunedCar) -> Markup:
    rows = [
        (row.name, str(row.count), number(row.rms), f"{row.neighbours:+.2f}", number(row.inflation, 2))
        for row in tuned.result.rows
    ]
    heads = ("row", "values", "RMS", "correlation of neighbours", "values per independent value")
    return joined(
        [
            tag(
                "p",
                "Residuals over their assumed standard deviation: for FRFs from the coherence, for time histories the "
                "RMS of the record. The fit weights each row with its own RMS and the correlation of neighbours.",
            ),
            shortened(f"{len(rows)} rows", heads, rows),
        ]
    )
