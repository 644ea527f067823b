"""Findings of a report against the tables of its run."""

import re
from dataclasses import replace
from html import unescape
from types import SimpleNamespace

import numpy as np
import pytest
from markupsafe import Markup

from vehicle import Car
from vehicle.commands.summary_text import summary_text
from vehicle.runs.report.answer import explained
from vehicle.runs.report.comparison_section import wheelbase_words
from vehicle.runs.report.findings import damper_sentences
from vehicle.runs.report.page import warned
from vehicle.signals.formats.frf_file import read_frf
from vehicle.signals.records.run_summary import read_summary


def test_the_share_of_incoherent_lines_is_that_of_the_table(reported):
    responses, words = read_frf(reported.folder / "frf.csv"), unescape(re.sub(r"<[^>]+>", "", reported.text))
    for channel, point in (("knuckle_fl_acc_z", "knuckle"), ("seat_rail_acc_z", "seat rail")):
        coherence = responses.coherence[responses.channels.index(channel)]
        finite = coherence[np.isfinite(coherence)]
        low = np.mean(finite < 0.9)
        assert 0.05 < abs(low - 0.5) < 0.5, "both sides would look alike"
        said = re.search(
            rf"At the {point} the median of the coherence is ([0-9.]+); it is below 0.9 on ([0-9.]+) %", words
        )
        assert said is not None
        assert float(said[1]) == pytest.approx(np.median(finite), abs=1e-3)
        assert float(said[2]) == pytest.approx(100.0 * low, rel=0.05)


def test_mode_and_path_are_explained_only_where_one_is_named(reported):
    words, explanation = "caused mainly by the mode", "Mode and path come from the linear model"
    assert words in reported.text and explanation in reported.text
    for statement in ("stays at 0.1 m/s²", f"rises, {words} of 8.1 Hz"):
        assert (explanation in explained(Markup(statement))) == (words in statement)


@pytest.mark.parametrize(
    ("wheels", "words"),
    [
        (["fl"], "the damper sticks"),
        (["fr", "fl"], "both dampers stick"),
        (["fr", "fl", "rr", "rl"], "all dampers stick"),
    ],
)
def test_one_two_and_four_dampers_stick(reported, wheels, words):
    summary = read_summary(reported.folder)
    shares = dict.fromkeys(wheels, 0.0)
    summary = replace(
        summary,
        slip_share=summary.slip_share | shares,
        first_slip_s=dict.fromkeys(wheels),
        friction_saturated_share=shares,
    )
    assert f"\ndamper      {words} all the time (|v| < 6 mm/s)\nresonances" in summary_text(summary)


@pytest.mark.parametrize(
    ("full", "console", "page"),
    [
        (5e-5, ["both dampers stick all the time (|v| < 6 mm/s)"], "Both dampers are stuck all the time: "),
        (
            0.04,
            [
                "both dampers slide slowly at times, never faster than 6 mm/s",
                "above 1 mm/s, where friction reaches its full value, for 4 % (right) and 4 % (left)",
            ],
            "Both dampers are at times sliding slowly, seldom or never faster than 6 mm/s.",
        ),
    ],
)
def test_console_and_report_give_dampers_without_slip_one_state(reported, full, console, page):
    summary = read_summary(reported.folder)
    summary = replace(
        summary,
        slip_share=summary.slip_share | {"fr": 0.0, "fl": 0.0},
        first_slip_s={"fr": None, "fl": None},
        friction_saturated_share={"fr": full, "fl": full},
    )
    lines = summary_text(summary).splitlines()
    first = next(k for k, line in enumerate(lines) if line.startswith("damper "))
    ending = next(k for k, line in enumerate(lines) if line.startswith("resonances "))
    assert [line[12:] for line in lines[first:ending]] == console
    assert damper_sentences(summary)[0].startswith(page)


def test_a_warning_of_the_solver_stands_at_the_verdict():
    """In a report of several runs the findings of each run are folded."""

    def run(name, *warnings):
        return SimpleNamespace(name=name, summary=SimpleNamespace(solver=SimpleNamespace(warnings=warnings)))

    runs = [run("a"), run("b", "rotates", "wrong <by> 35 %"), run("c", "rotates")]
    assert warned(runs) == "<p>Warning (b and 1 more run): wrong &lt;by&gt; 35 %.</p>"
    assert warned(runs[:1]) == "" and warned(runs[2:]) == "<p>Warning: rotates.</p>"


def test_the_wheelbase_filter_of_runs_is_named_where_it_differs():
    """Half of speed over wheelbase by hand: 80 and 60 km/h over 2.757 m are 4.03 and 3.02 Hz."""
    sedan = Car.load("sedan")

    def run(name, speed, road="B"):
        car = sedan.with_({"driving.speed": speed / 3.6})
        return SimpleNamespace(name=name, car=car, summary=SimpleNamespace(input=SimpleNamespace(road=road)))

    (text,) = wheelbase_words([run("a", 80.0), run("b", 60.0)])
    assert "(a 4.03, b 3.02 Hz)" in text
    assert wheelbase_words([run("a", 80.0), run("b", 80.0)]) == []
    assert wheelbase_words([run("a", 80.0, None), run("b", 60.0)]) == []
