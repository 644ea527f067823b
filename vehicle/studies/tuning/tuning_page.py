"""Report of a fit: values, undetermined parameters, errors and figures before and after, command line."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from vehicle.digits import number
from vehicle.model.parameters.paths import unit_of
from vehicle.names import channel_words
from vehicle.runs.report.car_section import car_section
from vehicle.runs.report.differences import parameter_words
from vehicle.runs.report.markup import Markup, joined, shortened, table, tag
from vehicle.runs.report.page import document, head_line
from vehicle.runs.report.svg_figure import drawing
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.limits_of_data import what_data_leave_open
from vehicle.studies.tuning.posterior_text import NamedPosterior, posterior_sentences
from vehicle.studies.tuning.tuned_car import TunedCar
from vehicle.studies.tuning.tuning_text import delay_lines, fit_sentences

POSTERIOR = "posterior"
"""Name of the picture of the posterior."""

CORRELATION = "correlation"
"""Name of the picture of the correlations."""

SOURCES = (
    "The standard error holds noise alone. With misfit: the data in 20 stretches as observations, whose scatter holds "
    "noise and the part of the misfit that varies. Half a sample of lag: largest shift of the value if one channel, or "
    "all, lag by half a sampling interval."
)
"""Explanation of the columns of the fitted values."""

MOST_NAMED = 3
"""Maximum number of fitted values in the sentence of the result."""


def tuning_page(
    tuned: TunedCar,
    figures: Mapping[str, Callable[[Path], None]],
    command: str,
    posteriors: Sequence[NamedPosterior] = (),
    *,
    author: str = "",
    project: str = "",
) -> str:
    """Return the report of a fit as one HTML document.

    Args:
        tuned: fitted car.
        figures: name of each picture and the function that writes it.
        command: command line of the fit.
        posteriors: see `posterior_lines`; empty without a posterior.
        author, project: names in the head of the page; may be empty.
    """
    names = ", ".join(each.target.name for each in tuned.measurements)
    vehicle = tuned.start.vehicle
    parts = [
        ("Result", "result", _result(tuned, figures)),
        ("Fitted values", "values", _values(tuned)),
        ("What the data leave open", "open", _left_open(tuned)),
        *([("Posterior", "posterior", _posterior(tuned, figures, posteriors))] if posteriors else []),
        ("Before and after", "agreement", _agreement(tuned, figures)),
        ("Residuals", "residuals", _residuals(tuned)),
        ("The fitted car", "car", car_section(tuned.fitted)),
        ("How to repeat the fit", "repeat", joined([tag("pre", command), *_settings(tuned)])),
    ]
    subtitles = (f"tyres {_driving(tuned)}", head_line(author, project))
    return document(f"{vehicle.name} fitted to {names}", subtitles, parts)


def _driving(tuned: TunedCar) -> str:
    """Return how the tyres stand or roll in the measurements."""
    states = []
    for each in tuned.measurements:
        road = None if isinstance(each.target, FrfTarget) else each.target.road
        states.append((tuned.start if road is None else road.rolling).vehicle.driving.words)
    return ", ".join(dict.fromkeys(states))


def _result(tuned: TunedCar, figures: Mapping[str, Callable[[Path], None]]) -> Markup:
    """Return the changes and their effect in two sentences, and the first picture of the curves before and after."""
    result, vehicle = tuned.result, tuned.start.vehicle
    changes = []
    for parameter in result.parameters[:MOST_NAMED]:
        value, error = result.values[parameter.path], result.standard_errors[parameter.path]
        unit = unit_of(vehicle, parameter.path)
        spread = f" ± {number(error, 2)}" if math.isfinite(error) else ""
        start = number(parameter.start, 4)
        changes.append(f"{parameter_words(parameter.path)} of {number(value, 4)}{spread} {unit} instead of {start}")
    if len(result.parameters) > MOST_NAMED:
        changes.append(f"{len(result.parameters) - MOST_NAMED} more")
    row = max(tuned.agreement, key=lambda row: row.before)
    word = "falls" if row.after < row.before else "rises"
    left_open = what_data_leave_open(result)
    texts = [
        *([f"The fit is not to be used: {tuned.refusal}."] if tuned.refusal else []),
        f"The measurement asks for {', '.join(changes)}.",
        f"The largest error against the measurement ({channel_words(row.label)}, {row.measure}) "
        f"{word} from {number(row.before)} to {number(row.after)} {row.unit}; the data "
        + (f"leave open: {left_open[0]}." if left_open else "determine every parameter."),
    ]
    shown = [drawing(figures[name], name) for name in _curves(figures)[:1]]
    return joined([tag("p", " ".join(texts), class_="answer"), *shown])


def _curves(figures: Mapping[str, Callable[[Path], None]]) -> list[str]:
    """Return the names of the figures with curves before and after the fit."""
    return [name for name in figures if name not in (POSTERIOR, CORRELATION)]


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
                *(number(_finite(each.get(parameter.path)), 2) for each in (result.misfit_errors, result.lag_shifts)),
                number(parameter.start, 5),
                number(100.0 * (value / parameter.start - 1.0), 3),
                f"{number(parameter.low, 5)} to {number(parameter.high, 5)}",
            )
        )
    errors = ("standard error", "[%]", "with misfit", "half a sample of lag")
    heads = ("parameter", "unit", "fitted", *errors, "start", "change [%]", "bounds")
    sentences = [tag("p", text) for text in (*delay_lines(tuned), SOURCES, *fit_sentences(tuned))]
    notices = [tag("li", text) for each in tuned.measurements for text in each.notices]
    return joined(
        [
            table(heads, rows, text_columns=2),
            *sentences,
            *([tag("h3", "Notices on the measurements"), tag("ul", *notices, class_="notices")] if notices else []),
        ]
    )


def _settings(tuned: TunedCar) -> list[Markup]:
    """Return the options that set the fitted values, if they are to be used."""
    return [tag("pre", " ".join(f"--set {text}" for text in tuned.settings))] if tuned.settings else []


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def _left_open(tuned: TunedCar) -> Markup:
    sentences = what_data_leave_open(tuned.result)
    if not sentences:
        return tag("p", "Nothing: no pair with a correlation of 0.9 or more, no standard error above 10 %.")
    return tag("ul", *(tag("li", text) for text in sentences), class_="notices")


def _agreement(tuned: TunedCar, figures: Mapping[str, Callable[[Path], None]]) -> Markup:
    rows = [
        (row.measurement, channel_words(row.label), row.measure, row.unit, number(row.before), number(row.after))
        for row in tuned.agreement
    ]
    heads = ("measurement", "channel", "error of", "unit", "before", "after")
    curves = _curves(figures)
    drawings = [drawing(draw, name) for name, draw in figures.items() if name not in (POSTERIOR, *curves[:1])]
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
