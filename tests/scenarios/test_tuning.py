"""`python -m scenarios.tuning` on made data."""

import json

import pytest

from scenarios.tuning.__main__ import main
from scenarios.tuning.claims import demonstration_claims, frozen_note
from scenarios.tuning.data import AUTHORS, HIDDEN, QUICK
from tests.studies.tuning.two_masses import TRUE, MeasuredMasses
from vehicle.model.parameters.ranges import Range
from vehicle.studies.tuning.full_steps import FullSteps
from vehicle.studies.tuning.least_squares import fit


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "tuning"
    assert main(["--output", str(folder), "--quick"]) == 0
    return folder


def test_hidden_values_are_found(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    assert len(content["rows"]) == len(QUICK) + 1
    assert all(row["within"] for row in content["rows"])
    rows = content["all"]
    for path in QUICK:
        assert rows["start"][path] != pytest.approx(HIDDEN[path], rel=0.15)
        # Three standard errors count for something only where they are small.
        assert abs(rows["values"][path] - HIDDEN[path]) < 0.01 * HIDDEN[path]
    assert content["not_judged"]
    text = (results / "results.md").read_text(encoding="utf-8")
    assert "Moved by the full simulation, in standard errors: " in text
    assert all(f"\n{path} " in text for path in QUICK) and "standard error from" in text
    files = {path.name for path in results.iterdir()}
    assert {"high_frf.csv", "frf_1_high.png", "time_2_bump_7p5mm.png", "parameters.png", "correlation.png"} <= files


def test_the_hidden_car_is_no_secret_of_the_fit():
    # Starts are those of the authors, and no start or bound of the fit is a hidden value.
    assert {parameter.path for parameter in AUTHORS} == set(HIDDEN)
    assert all(HIDDEN[parameter.path] not in (parameter.low, parameter.start, parameter.high) for parameter in AUTHORS)


@pytest.fixture(scope="module")
def masses():
    """A fit of four parameters, of which one acts on nothing."""
    parameters = [Range(path=path, low=value / 9, high=9 * value, start=1.4 * value) for path, value in TRUE.items()]
    nothing = Range(path="colour", low=1.0, high=9.0, start=2.0)
    return fit([*parameters, nothing], [MeasuredMasses(seed=9)], dict)


def finished(result, *, settled=True):
    moved = dict.fromkeys(result.free, -0.5)
    return FullSteps(result=result, first=1.1, moved=moved, largest_steps=(0.5, 0.1), settled=settled)


def test_rows_say_what_was_missed(masses):
    rows = demonstration_claims(finished(masses), None, {**TRUE, "colour": 3.0})
    assert [row.within for row in rows] == [True] * 5
    assert rows[3].ours == "not identified by the data, held at 2"
    away = {**TRUE, "upper": TRUE["upper"] + 4.0 * masses.standard_errors["upper"]}
    assert [row.within for row in demonstration_claims(finished(masses, settled=False), None, away)] == [
        True,
        False,
        True,
        False,
    ]


def test_a_note_says_how_far_the_frozen_fit_is_off(masses):
    assert "damping 1" in frozen_note(masses, {**TRUE, "colour": 2.0})
