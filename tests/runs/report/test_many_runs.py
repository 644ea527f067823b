"""Report of more runs than have pictures of their own."""

import dataclasses
import re
from pathlib import Path

import pytest
from markupsafe import Markup

from tests.runs.report.test_page import Outline
from vehicle.runs.report.finished_run import read_run
from vehicle.runs.report.page import Trial, report_page
from vehicle.signals.records.run_summary import RunSummary


@pytest.mark.usefixtures("no_figures")
def test_of_many_runs_the_first_the_calmest_and_the_loudest_have_pictures(reported, monkeypatch):
    """A page of 32 runs had 43 MB: each run had its drawing, its time histories and its modes."""
    monkeypatch.setattr("vehicle.runs.report.page.curves_over_each_other", lambda runs: Markup(len(runs)))
    run, runs = read_run(reported.folder), []
    for name, factor in zip("abcdefg", (1.0, 1.1, 0.9, 1.2, 1.3, 1.0, 1.05), strict=True):
        content = run.summary.to_json()
        content["comfort"]["seat_rail"]["iso2631"]["vector_sum"]["weighted_rms"] *= factor
        summary = RunSummary.from_json(content)
        runs.append(dataclasses.replace(run, name=name, place=Path("runs") / name, summary=summary))
    found = Outline()
    page = report_page(runs, trial=lambda run: Trial(content=Markup()))
    found.feed(page)
    words = " ".join(found.words)
    assert "7 runs: " in words
    assert len(re.findall(r"[a-g] against a ", words)) == 2
    assert words.count("This run has no pictures here.") == 4 and "all 7 runs" in words
    drawn = re.findall(r"Frequency responses of ([a-g])\b", words)
    assert drawn == re.findall(r"Time histories of ([a-g])\b", words) == ["a", "c", "e"]
    assert page.count('{"name":"a, c, e",') == 1  # equal modes once
