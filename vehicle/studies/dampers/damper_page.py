"""Report of fitted dampers: laws, errors of the tests, pictures of every test, and the lines of the vehicle file."""

import math
from collections.abc import Sequence
from functools import partial

from markupsafe import Markup

from vehicle.digits import number
from vehicle.drawing.rendering.damper_plot import DamperLoop, plot_band, plot_damper, plot_settings
from vehicle.runs.report.markup import templates
from vehicle.runs.report.page import document, head_line
from vehicle.runs.report.svg_figure import drawing
from vehicle.studies.dampers.damper_band import band_of
from vehicle.studies.dampers.damper_ranges import RATIO
from vehicle.studies.dampers.damper_text import (
    candidates,
    caption_of,
    choice_sentence,
    expected_rows,
    notice_lines,
    range_rows,
    setting_rows,
    vehicle_lines,
)
from vehicle.studies.dampers.fitted_damper import FittedDamper
from vehicle.studies.dampers.next_tests import HEADS, NextTest, Use, next_sentence, result_sentences
from vehicle.studies.dampers.over_condition import control_lines, curve_lines, settings_of

fill = templates(__file__)

PAGE_POINTS = 600
"""Maximum number of points of a line in the page, a cycle of a sine and more."""


def damper_page(
    fits: Sequence[FittedDamper],
    command: str,
    further: Sequence[NextTest] = (),
    use: Use | None = None,
    *,
    author: str = "",
    project: str = "",
) -> str:
    """Return the report of fitted dampers as one HTML document.

    Args:
        further, use: further tests, and the velocities at which the force matters; see `next_tests`.
    """
    parts = []
    if len(fits) > 1:
        parts.append(("Over the conditions", "conditions", _conditions(fits)))
    for number_of_fit, fitted in enumerate(fits):
        condition = fitted.condition_words
        parts.append((f"Law{f' at {condition}' if condition else ''}", f"law{number_of_fit}", _law(fitted)))
    if further:
        heads, rows = HEADS[: len(further[0].cells)], [test.cells for test in further]
        texts = [next_sentence(further, use), *result_sentences(further, use)]
        parts.append(("Next test", "next", fill("next_test", texts=texts, heads=heads, rows=rows)))
    parts.append(("How to repeat the fit", "repeat", fill("repeat_damper", command=command)))
    tests = dict.fromkeys(test for fitted in fits for test in fitted.tests)
    return document(f"Damper from {len(tests)} test{'s'[: len(tests) > 1]}", (head_line(author, project),), parts)


def loops_of(fitted: FittedDamper, points: int = 0) -> list[DamperLoop]:
    """Return measured and fitted force of each test, settled samples, at most `points` of them if not 0."""
    loops = []
    for test, error, outside in zip(fitted.tests, fitted.fit.fitted, fitted.fit.left_out, strict=True):
        rows = test.settled.nonzero()[0]
        rows = rows[:: 1 + rows.size // points] if points else rows
        label = f"{test.name}: error {error:.3f}, left out {outside:.3f}"
        loops.append(
            DamperLoop(label, test.displacement[rows], test.velocity[rows], test.force[rows],
                       fitted.force(test)[rows])
        )  # fmt: skip
    return loops


def _conditions(fits: Sequence[FittedDamper]) -> Markup:
    """Return table and picture of damping and friction over the conditions, and the lines of a semi-active damper."""
    settings = settings_of(fits)
    heads = ["condition", "damping [N s/m]", "friction [N]", "bend force [N]", "slope [N s/m]"]
    rows = [(each.words, *(number(value, 4) for value in each[1:])) for each in settings]
    shown = {each.words: (each.damping, each.friction) for each in settings}
    figure = drawing(partial(plot_settings, curves=curve_lines(fits), settings=shown), "Laws against the conditions")
    return fill("settings", heads=heads, rows=rows, figure=figure, lines=control_lines(fits))


def shown(value: float) -> str:
    """Return a number with three digits, or a dash for an unknown one."""
    return "-" if math.isnan(value) else number(value, 3)


def _law(fitted: FittedDamper) -> Markup:
    """Return law, parameters, errors and pictures of the tests, and the lines of the vehicle file."""
    fit = fitted.fit
    parameters = [
        (name, unit, number(value, 5), number(error, 2))
        for (name, unit), value, error in zip(fit.law.parameters.items(), fit.values, fit.errors, strict=True)
    ]
    parameters += [
        (name, unit, number(value, 5), number(error, 2)) for name, unit, value, error in setting_rows(fitted)
    ]
    tests = [
        (f"{test.name}: {test.caption}", *(number(error, 3) for error in errors))
        for test, *errors in zip(fitted.tests, fit.fitted, fit.left_out, fit.whole, strict=True)
    ]
    slow, fast = (number(1e3 * speed, 2) for speed in (fitted.speeds[0] / RATIO, RATIO * fitted.speeds[1]))
    heads = ["law", "parameters", "left out", "slower", "faster", f"at {slow} mm/s [N]", f"at {fast} mm/s [N]"]
    laws = [
        (each.fit.tested_law.title, len(each.fit.tested_law.parameters), *(shown(value) for value in each[1:]))
        for each in candidates(fitted)
    ]
    ranges = [(text, shown(inside), shown(outside)) for text, outside, inside in range_rows(fitted)]
    expected = [(text, *map(shown, errors)) for text, errors in expected_rows(fitted)]
    band = partial(plot_band, band=band_of(fitted), tested=fitted.speeds)
    sentence = f"{fit.tested_law.title[:1].upper()}{fit.tested_law.title[1:]}: {choice_sentence(fitted)}."
    return fill(
        "law",
        sentence=sentence,
        tests=tests,
        figure=drawing(partial(plot_damper, loops=loops_of(fitted, PAGE_POINTS)), f"Tests: {caption_of(fitted)}"),
        parameters=parameters,
        laws=laws,
        heads=heads,
        ranges=ranges,
        expected=expected,
        band=drawing(band, "Force over velocity with its band"),
        left_open=fitted.left_open(),
        noted=notice_lines(fitted),
        lines=vehicle_lines(fitted),
    )
