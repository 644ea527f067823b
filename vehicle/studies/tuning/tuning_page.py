"""Report of a fit: values, undetermined parameters, errors and figures before and after, command line."""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from markupsafe import Markup

from vehicle.digits import number
from vehicle.model.parameters.paths import unit_of
from vehicle.names import channel_words
from vehicle.runs.report.car_section import car_section
from vehicle.runs.report.differences import parameter_words
from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import document, head_line
from vehicle.runs.report.svg_figure import drawing
from vehicle.studies.tuning.fit_result import known
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.limits_of_data import what_data_leave_open
from vehicle.studies.tuning.posterior_text import NamedPosterior, posterior_sentences
from vehicle.studies.tuning.tuned_car import TunedCar
from vehicle.studies.tuning.tuning_text import delay_lines, fit_sentences

fill = templates(__file__)

POSTERIOR = "posterior"
"""Name of the picture of the posterior."""

CORRELATION = "correlation"
"""Name of the picture of the correlations."""

MOST_NAMED = 3
"""Maximum number of fitted values in the printed result."""


def tuning_page(
    tuned: TunedCar,
    figures: Mapping[str, Callable[[Path], None]],
    command: str,
    posteriors: Sequence[NamedPosterior] = (),
    *,
    author: str = "",
    project: str = "",
) -> str:
    """Return the report of a fit as one HTML document."""
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
        ("How to repeat the fit", "repeat", fill("repeat_fit", command=command, settings=tuned.settings)),
    ]
    subtitles = (f"tyres {_driving(tuned)}", head_line(author, project))
    return document(f"{vehicle.name} fitted to {names}", subtitles, parts)


def _driving(tuned: TunedCar) -> str:
    """Return the states of the tyres in the measurements: standing, or rolling at a speed."""
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
        value, error = result.values[parameter.path], result.errors[parameter.path]
        unit = unit_of(vehicle, parameter.path)
        spread = f" ± {number(error, 2)}" if math.isfinite(error) else ""
        start = number(parameter.start, 4)
        changes.append(f"{parameter_words(parameter.path)} {number(value, 4)}{spread} {unit} (before {start})")
    if len(result.parameters) > MOST_NAMED:
        changes.append(f"{len(result.parameters) - MOST_NAMED} more")
    row = max(tuned.agreement, key=lambda row: row.before)
    word = "falls" if row.after < row.before else "rises"
    left_open = what_data_leave_open(result)
    texts = [
        *([f"Do not use this fit: {tuned.refusal}."] if tuned.refusal else []),
        *([_sentence(tuned.unexplained)] if tuned.unexplained else []),
        f"Fitted: {', '.join(changes)}.",
        f"The largest error ({channel_words(row.label)}, {row.measure}) "
        f"{word} from {number(row.before)} to {number(row.after)} {row.unit}"
        + (f"; the data leave open: {left_open[0]}" if left_open else "")
        + ("; the data determine every parameter." if tuned.determined else "."),
    ]
    shown = [drawing(figures[name], name) for name in _curves(figures)[:1]]
    return fill("answer", texts=[" ".join(texts)], figure=Markup().join(shown))


def _sentence(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}."


def _left_open(tuned: TunedCar) -> Markup:
    said = [_sentence(tuned.unexplained)] if tuned.unexplained else []
    return fill("left_open", sentences=[*said, *what_data_leave_open(tuned.result)], determined=tuned.determined)


def _curves(figures: Mapping[str, Callable[[Path], None]]) -> list[str]:
    """Return the names of the figures with curves before and after the fit."""
    return [name for name in figures if name not in (POSTERIOR, CORRELATION)]


def _values(tuned: TunedCar) -> Markup:
    result, vehicle = tuned.result, tuned.start.vehicle
    rows = []
    for parameter in result.parameters:
        value, error = result.values[parameter.path], result.errors[parameter.path]
        rows.append(
            (
                parameter_words(parameter.path),
                parameter.path,
                unit_of(vehicle, parameter.path),
                number(value, 5),
                *(number(known(each), 2) for each in (error, parameter.percent(error, value))),
                *(number(known(each.get(parameter.path)), 2) for each in (result.standard_errors, result.lag_shifts)),
                number(parameter.start, 5),
                number(known(parameter.percent(value - parameter.start, parameter.start)), 3),
                f"{number(parameter.low, 5)} to {number(parameter.high, 5)}",
            )
        )
    noted = [text for each in tuned.measurements for text in each.notices]
    return fill("fitted", rows=rows, delays=delay_lines(tuned), sentences=fit_sentences(tuned), noted=noted)


def _agreement(tuned: TunedCar, figures: Mapping[str, Callable[[Path], None]]) -> Markup:
    rows = [
        (row.measurement, channel_words(row.label), row.measure, row.unit, number(row.before), number(row.after))
        for row in tuned.agreement
    ]
    curves = _curves(figures)
    drawings = [drawing(draw, name) for name, draw in figures.items() if name not in (POSTERIOR, *curves[:1])]
    return fill("agreement", rows=rows, figures=drawings)


def _posterior(
    tuned: TunedCar, figures: Mapping[str, Callable[[Path], None]], posteriors: Sequence[NamedPosterior]
) -> Markup:
    posterior = posteriors[0][1]
    rows = [
        (
            parameter_words(parameter.path),
            parameter.path,
            unit_of(tuned.start.vehicle, parameter.path),
            *(number(value, 4) for value in ends),
        )
        for parameter, ends in zip(posterior.car.parameters, posterior.interval().T.tolist(), strict=True)
    ]
    rows += [
        (f"comfort on {name}", "", "m/s2", *(number(value, 4) for value in ends))
        for name, ends in zip(posterior.car.signals, posterior.comfort().T.tolist(), strict=True)
    ]
    figure = drawing(figures[POSTERIOR], POSTERIOR)
    return fill("posterior", rows=rows, sentences=posterior_sentences(posteriors), figure=figure)


def _residuals(tuned: TunedCar) -> Markup:
    rows = [
        (row.name, str(row.count), number(row.rms), f"{row.neighbours:+.2f}", number(row.inflation, 2))
        for row in tuned.result.rows
    ]
    return fill("residuals", rows=rows)
