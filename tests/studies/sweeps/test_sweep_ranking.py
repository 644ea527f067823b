"""Ranking of the cars of a sweep by comfort, its printed table and its picture."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.ride_comfort import wave_names
from vehicle.studies.sweeps.case import Case, SignalFile
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.comfort_ranking import ranking_evaluation
from vehicle.studies.sweeps.sweep_page import sweep_page
from vehicle.studies.sweeps.sweep_picture import can_be_drawn, draw_ranked
from vehicle.studies.sweeps.sweep_ranking import figure_names, measure_lines, ranked_cars, ranking_lines
from vehicle.studies.sweeps.sweep_table import SweepTable

UNITS = {"unweighted": "m/s2", "weighted": "m/s2"}


def table_of(values, paths, inputs=("a.csv", "b.csv")):
    """A table whose car number i, with parameters `values[i]`, has the weighted value i + 1 on the first input and
    i + 3 on the second."""
    cases, results = [], []
    for number, row in enumerate(values):
        for place, name in enumerate(inputs):
            texts = tuple(f"{path}={value}" for path, value in zip(paths, row, strict=True))
            cases.append(Case(source=SignalFile(path=Path(name), wheel="fl"), overrides=texts))
            weighted = number + 1.0 + 2.0 * place
            results.append(Result(values={"unweighted": 2.0 * weighted, "weighted": weighted}))
    return SweepTable(cases=cases, results=results, units=UNITS, made={})


def ranked(table):
    cars = ranked_cars(table)
    assert cars is not None
    return cars


def test_cars_are_ranked_by_the_mean_over_the_inputs():
    table = table_of([("30", "1"), ("10", "1"), ("20", "1")], ["front.spring", "fixed"])
    cars = ranked(table)
    assert cars.paths == ["front.spring"] and cars.inputs == 2 and cars.point == "at the seat rail"
    assert cars.order == [0, 1, 2] and cars.weighted.tolist() == [2.0, 3.0, 4.0]
    # By hand: (3 / 1 + 5 / 3) / 2 - 1; the ratio of the means would give 100 %.
    assert cars.change(2) == pytest.approx(400.0 / 3.0) and cars.unweighted[1] == 6.0
    lines = ranking_lines(cars)
    assert lines[0].split()[:2] == ["front.spring", "weighted"]
    assert lines[1].split() == ["30", "2", "base", "4"] and lines[2].split() == ["10", "3", "+66.67", "%", "6"]
    assert "mean of 2 inputs; change: mean of the changes on each" in "\n".join(lines)
    assert lines[-1].endswith(": front.spring = 30")


def test_loads_are_states_within_which_cars_are_ranked():
    """The car of the lightest vibration was named by its load, which is no design choice."""
    rows = [("50", "30"), ("50", "10"), ("200", "30"), ("200", "10")]
    table = table_of(rows, ["load.boot.mass", "front.spring"])
    values = (4.0, 3.0, 1.0, 2.0)
    results = [Result(values={"unweighted": value, "weighted": value}) for value in values for _ in ("a", "b")]
    lines = ranking_lines(ranked(replace(table, results=results)))
    for line, (mass, spring, change) in zip(lines[-2:], (("50", "10", "(-25.00 %"), ("200", "30", "(")), strict=True):
        assert line.startswith(f"load.boot.mass = {mass}: ") and f"front.spring = {spring} {change}" in line
    alone = ranking_lines(ranked(table_of([("50",), ("200",)], ["load.boot.mass"])))
    assert alone[-1].startswith("load.boot.mass: ") and "comfortable" not in alone[-1]


def test_another_measure_has_its_table():
    table = replace(table_of([("30",), ("10",)], ["front.spring"]), units={"weighted": "m/s2"})
    lines = measure_lines(table)
    assert lines[0].split() == ["input", "front.spring", "weighted", "[m/s2]"] and len(lines) == 5
    assert lines[1].split() == [table.cases[0].source.name, "30", "1"]


def test_a_value_named_like_an_error_is_a_figure():
    """It has no value column beside it; without any figure the refusal is a sentence."""
    assert figure_names({"path_error": "?"}) == ("path_error",)
    assert figure_names({"travel": "m", "travel_error": "m", "path_error": "m"}) == ("travel", "path_error")
    assert figure_names({"weighted": "m/s2", "unweighted_error": "-"}) == ("weighted",)
    with pytest.raises(DataError, match="measure: "):
        figure_names({})
    table = replace(table_of([("30",), ("10",)], ["front.spring"]), units={"path_error": "m"})
    assert measure_lines(table)[0].split()[-2:] == ["path_error", "[m]"]


def test_a_loud_input_does_not_outweigh_a_quiet_one():
    """By hand: 0.1 to 0.08 and 10 to 10.1 m/s2 are -20 % and +1 %, so -9.5 %; the plain mean rises by 0.8 %."""
    table = table_of([("30",), ("10",)], ["front.spring"])
    values = (0.1, 10.0, 0.08, 10.1)
    results = [Result(values={"unweighted": value, "weighted": value}) for value in values]
    cars = ranked(replace(table, results=results))
    assert cars.change(1) == pytest.approx(-9.5) and cars.order == [1, 0] and cars.best == 1
    assert cars.weighted[1] > cars.weighted[0]


def test_what_an_input_sets_makes_no_car():
    """Over a cleat the tyres of every car may lift off: two cars on two inputs, not four cars."""
    table = table_of([("30",), ("10",)], ["front.spring"])
    cases = [
        replace(case, overrides=(*case.overrides, "tyre.one_sided=true")) if case.source.name == "b" else case
        for case in table.cases
    ]
    cars = ranked(replace(table, cases=cases))
    assert cars.paths == ["front.spring"] and cars.weighted.tolist() == [2.0, 3.0]
    assert ranking_lines(cars)[-1].endswith(": front.spring = 30")


def test_a_failed_run_takes_its_car_out():
    table = table_of([("30",), ("10",), ("20",)], ["front.spring"])
    failed = [replace(table.results[0], values={}, reason="stopped"), *table.results[1:]]
    cars = ranked(replace(table, results=failed))
    assert cars.order == [1, 2] and math.isnan(cars.weighted[0]) and math.isnan(cars.change(1))
    assert ranking_lines(cars)[1].split() == ["10", "3", "-", "6"]
    everything = [replace(result, values={}, reason="stopped") for result in table.results]
    assert ranked_cars(replace(table, results=everything)) is None


def test_the_error_of_the_ranking_is_that_of_the_weighted_value():
    """Over two inputs with errors e and 2 e of a change, each over the value of the first car there."""
    table, names = table_of([("30",), ("10",)], ["front.spring"]), wave_names("weighted")
    sizes = [0.0, 0.0, 0.1, 0.2]  # of the waves of each row: the first car, then the second
    results = [
        replace(
            result,
            values=result.values | dict.fromkeys(names[:-2], size / math.sqrt(2.0)) | dict.fromkeys(names[-2:], 0.0),
        )
        for result, size in zip(table.results, sizes, strict=True)
    ]
    cars = ranked(replace(table, results=results))
    expected = 100.0 * 2.1788 * math.hypot(0.1 / 1.0, 0.2 / 3.0) / 2.0  # the first car has 1 and 3 m/s2
    assert cars.half_width[1] == pytest.approx(expected, rel=1e-4)
    lines = ranking_lines(cars)
    assert lines[0].split()[3:5] == ["change", "+-"] and lines[2].split()[2:5] == ["+66.67", "%", f"{expected:.2f}"]
    assert "+-: " in lines[3]
    large = [replace(each, values=each.values | dict.fromkeys(names, 9.0)) if size else each
             for each, size in zip(results, sizes, strict=True)]  # fmt: skip
    falling = [replace(r, values=r.values | {"weighted": 10.0 - r.values["weighted"]}) for r in large]
    assert "within the error" in ranking_lines(ranked(replace(table, results=falling)))[-1]


def test_many_cars_are_cut_and_the_first_stays():
    table = table_of([(str(100 - i),) for i in range(30)], ["a"], inputs=("a.csv",))
    falling = [replace(r, values={k: 40.0 - v for k, v in r.values.items()}) for r in table.results]
    lines = ranking_lines(ranked(replace(table, results=falling)))
    assert lines[1].split()[0] == "71" and lines[13].split()[:3] == ["100", "39", "base"]
    assert lines[14].startswith("17 ") and "table.csv" in lines[14] and ": a = 71 (-74.36 %" in lines[-1]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_pictures(tmp_path, count):
    values = [tuple(str(v) for v in row) for row in np.array(np.meshgrid(*[[1, 2, 3]] * count)).reshape(count, -1).T]
    cars = ranked(table_of(values, ["a", "b", "c"][:count]))
    assert can_be_drawn(cars)
    draw_ranked(tmp_path / "sweep.png", cars, "tyres standing")
    assert (tmp_path / "sweep.png").stat().st_size > 15_000


def test_texts_are_not_drawn():
    assert not can_be_drawn(ranked(table_of([("soft",), ("hard",)], ["law"])))
    assert not can_be_drawn(None)


def test_the_report_names_best_and_base_with_the_numbers_of_the_table(tmp_path):
    table = table_of([("30", "1"), ("10", "1"), ("20", "1")], ["damper.viscous", "fixed"])
    falling = [replace(r, values={k: 40.0 - v for k, v in r.values.items()}) for r in table.results]
    table = replace(table, results=falling)
    page = table.report(tmp_path / "sweep.html").read_text(encoding="utf-8")
    assert "damper viscous = 20; weighted 36 m/s², unweighted 32 m/s², -5.27 %" in page
    assert "damper viscous = 30; weighted 38 m/s², unweighted 36 m/s²." in page
    assert "--set damper.viscous=20" in page and page.count("<svg") == 1 and ">b<" in page
    with pytest.raises(ConfigurationError, match=r"sweep\.html"):
        table.report(tmp_path / "sweep.html")
    assert str(table).splitlines()[1].split() == ["20", "36", "-5.27", "%", "32"] and "\n" not in repr(table)


def test_a_note_on_the_valid_range_stands_at_the_verdict():
    table = table_of([("30",), ("10",)], ["damper.viscous"])
    page = sweep_page(table, ranking_evaluation(table, ""), "focus", caption="", notes=("outside the valid range: a",))
    assert page.index("Base car") < page.index("<p>outside the valid range: a</p>") < page.rindex("All runs")


def test_parameters_have_the_units_of_the_car(tmp_path):
    """In Python as in the command: printed table, axes and report."""
    pyplot.switch_backend("agg")
    table = table_of([("1000", "soft"), ("1500", "hard")], ["front.damper.viscous", "law"])
    assert str(table).splitlines()[0].split()[:5] == ["front.damper.viscous", "[N", "s/m]", "law", "weighted"]
    numbers = table_of([("1000",), ("1500",)], ["front.damper.viscous"])
    assert numbers.plot().get_xlabel() == "front damper viscous [N s/m]"
    pyplot.close("all")
    page = numbers.report(tmp_path / "sweep.html", author="A. Engineer", project="Ride").read_text(encoding="utf-8")
    assert "Ride, A. Engineer, 20" in page
    assert "<th>front damper viscous (front.damper.viscous) [N s/m]</th>" in page


def test_a_sweep_draws_on_the_axes_of_the_user():
    pyplot.switch_backend("agg")
    values = [("1", "1"), ("2", "3"), ("3", "2")]
    _, axis = pyplot.subplots()
    line = table_of([value[:1] for value in values], ["a"])
    assert line.plot(ax=axis) is axis
    np.testing.assert_array_equal(axis.lines[0].get_ydata(), [2.0, 3.0, 4.0])
    assert table_of(values, ["a", "b"]).plot().get_xlabel() == "a"
    with pytest.raises(ConfigurationError, match="needs two or more cars"):
        table_of([("soft",), ("hard",)], ["law"]).plot()
    pyplot.close("all")
