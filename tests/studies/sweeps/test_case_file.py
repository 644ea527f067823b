"""Cases of a file: every value is that of its single run; names, changes, sentence, resumed sweeps, wrong files."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.studies.sweeps.sweep_samples import rows_of
from vehicle import Car, road
from vehicle.commands.sweep import main
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.runs.output.destination import Destination
from vehicle.studies.sweeps.case_file import UNCHANGED, CaseFile, case_results, read_cases
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.sweeps.sweep_study import SweepStudy
from vehicle.studies.sweeps.sweep_table import SweepTable

FILE = """
vehicle = "sedan"
roads = ["A", "B"]
speeds = [60]
duration = 3

[states.laden]
body.mass = 1500

[variants.soft]
"rear.damper.viscous" = 1200
"""

SOFT, HARD = {"rear.damper.viscous": 1200}, {"rear.damper.viscous": 2200}


def test_cars_and_inputs(tmp_path):
    file = tmp_path / "cases.toml"
    file.write_text(FILE, encoding="utf-8")
    cases = read_cases(file)
    assert cases.cars == {
        UNCHANGED: (),
        "soft": ("rear.damper.viscous=1200",),
        "laden": ("body.mass=1500",),
        "laden, soft": ("body.mass=1500", "rear.damper.viscous=1200"),
    }
    assert cases.inputs == [road("A", 60.0, duration=3.0), road("B", 60.0, duration=3.0)]
    both = CaseFile(roads=("A", "cleat:20x50"), speeds=(30.0, 60.0), signals=("low.csv",), duration=5.0)
    assert [getattr(each, "duration", None) for each in both.inputs] == [5.0, 5.0, None, None, None]


def test_each_road_has_its_own_speeds(tmp_path):
    """A cleat is driven slower than a road: speeds as a table, in a file of today and in Python."""
    file, roads = tmp_path / "cases.toml", 'roads = ["C", "cleat:20x50"]\n'
    file.write_text(
        roads + 'speeds = {"cleat:20x50" = [30], C = [80, 110]}\n[variants.soft]\n"damper.viscous" = 900\n',
        encoding="utf-8",
    )
    cases = read_cases(file)
    assert cases.inputs == [road("C", 80.0), road("C", 110.0), road("cleat:20x50", 30.0)]
    assert CaseFile(roads=cases.roads, speeds={"C": (80.0, 110.0), "cleat:20x50": (30.0,)}).inputs == cases.inputs


def test_one_event_has_no_random_error(tmp_path, capsys, monkeypatch):
    """Beside a cleat no error is shown, in its rows and with the mean over road and cleat only that of the road."""
    monkeypatch.chdir(tmp_path)
    lines = ['vehicle = "sedan"', 'roads = ["B", "cleat:20x50"]', 'speeds = {B = [80], "cleat:20x50" = [30]}']
    (tmp_path / "cases.toml").write_text(
        "\n".join([*lines, "duration = 3", "[variants.soft]", '"rear.damper.viscous" = 1200']), encoding="utf-8"
    )
    here = ["--engine", "reduced", "--executor", "tests.studies.sweeps.sweep_samples:threads"]
    assert main(["--cases", "cases.toml", *here, "--output", "out"]) == 0
    tables = {name: rows_of(tmp_path / "out" / f"{name}.csv") for name in ("cases", "differences", "table")}
    road, cleat = (row for row in tables["cases"] if row["car"] == "soft")
    assert float(road["half_width_95 [%]"]) > 0.0 and cleat["half_width_95 [%]"] == ""
    mean, width = np.mean([float(row["change [%]"]) for row in (road, cleat)]), float(road["half_width_95 [%]"]) / 2.0
    said = capsys.readouterr().out
    assert f"{mean:+.1f} +- {width:.1f} %" in said and ("within the error" in said) == (-mean <= width)
    road, cleat = (row for row in tables["differences"] if row["rear.damper.viscous"])
    assert cleat["cars differ on"] == "one event: no random error" and cleat["weighted_difference [m/s2]"]
    for column in ("standard_error", "half_width_95", "weighted_standard_error", "weighted_half_width_95"):
        assert float(road[f"{column} [m/s2]"]) > 0.0 and cleat[f"{column} [m/s2]"] == ""
    base = float(tables["cases"][0]["weighted [m/s2]"])
    relative = 100.0 * float(road["weighted_half_width_95 [m/s2]"]) / base
    assert relative == pytest.approx(2.0 * width, rel=1e-4)
    for row in tables["table"]:
        errors = [float(row[f"{name}_error [-]"]) for name in ("weighted", "unweighted")]
        assert np.isnan(errors).all() if "cleat" in row["input"] else min(errors) > 0.0
    words = ["--road", "cleat:20x50", "--speed", "30", "--vehicle", "sedan", *here, "--output", "one"]
    assert main([*words, "--each", "20%", "--vary", "rear.damper.viscous"]) == 0
    said = capsys.readouterr().out
    assert "no +-" in said and " -\n" in said


def test_command(tmp_path, capsys, monkeypatch):
    """Four cars on two roads: the values of single runs, in table and report; a resumed sweep computes nothing new."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cases.toml").write_text(FILE, encoding="utf-8")
    words = ["--cases", "cases.toml", "--engine", "reduced", "--output", "out"]
    assert main([*words, "--report"]) == 0
    said, rows = capsys.readouterr().out, rows_of(tmp_path / "out" / "cases.csv")
    assert "8 runs, 0 failed" in said and "laden, soft" in said
    # A laden state is no choice: its variant is compared with the laden car, and no state is the smoothest.
    assert "as it is: over all inputs" in said and "laden: over all inputs" in said and "'laden" not in said
    assert [(row["input"], row["car"]) for row in rows][:5] == [
        ("road_A_60", UNCHANGED), ("road_A_60", "soft"), ("road_A_60", "laden"), ("road_A_60", "laden, soft"),
        ("road_B_60", UNCHANGED),
    ]  # fmt: skip
    car = Car.load("sedan")
    changes = {"as it is": {}, "soft": {"rear.damper.viscous": 1200}, "laden": {"body.mass": 1500}}
    for row in rows:
        if row["car"] in changes:
            ride = road(row["input"][5], 60, duration=3)
            single = car.with_(changes[row["car"]]).run(ride, engine="reduced").comfort()
            # Batches run in single precision.
            assert float(row["weighted [m/s2]"]) == pytest.approx(single.weighted.overall, rel=3e-4)
    values = {(row["input"], row["car"]): float(row["weighted [m/s2]"]) for row in rows}
    for row in rows:
        base = "laden" if row["car"].startswith("laden") else UNCHANGED
        change = 100.0 * (float(row["weighted [m/s2]"]) / values[row["input"], base] - 1.0)
        assert float(row["change [%]"]) == pytest.approx(change, abs=1e-3)
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "laden, soft" in page and "mean change" in page
    table = (tmp_path / "out" / "table.csv").read_bytes()
    assert main([*words, "--resume", "--quiet"]) == 0
    assert (tmp_path / "out" / "table.csv").read_bytes() == table


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "roads: no input"),
        ('roads = ["C"]', "speeds: set roads and speeds"),
        ('roads = ["C", "D"]\nspeeds = {C = [80]}', "'D' = [80]"),
        ('roads = ["C"]\nspeeds = {C = []}', "'C' = [80]"),
        ('roads = ["C"]\nspeeds = {C = [80], D = [80]}', "speeds: 'D'"),
        ('roads = ["C"]\nspeeds = {C = 80}', "speeds.C: must be a list, not 80"),
        ('roads = ["C"]\nspeeds = [80]\nspeed = 3', "speed: unknown parameter"),
        ('roads = "C"\nspeeds = [80]', "roads: must be a list, not 'C'"),
        ('roads = ["C"]\nspeeds = [80]', "[variants.soft]"),
        ("roads = [", "TOML"),
    ],
)
def test_wrong_files(tmp_path, text, message):
    file = tmp_path / "cases.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError) as refusal:
        read_cases(file)
    assert str(refusal.value).startswith(str(file)) and message in str(refusal.value)


def test_the_best_of_one_state_is_a_sentence(tmp_path):
    """In Python as in the command; without laden states it begins with the inputs."""
    cases = CaseFile(vehicle="sedan", roads=("A",), speeds=(60.0,), duration=3.0, variants={"soft": SOFT, "hard": HARD})
    for speeds, beginning in (((60.0,), "On road_A_60 the smoothest variant is"), ((60.0, 80.0), "Over all inputs ")):
        plan = replace(cases, speeds=speeds).plan(Car.load("sedan"), (), SweepSettings(engine="reduced"))
        assert plan.evaluation_of(plan.run(), "").lines[-1].startswith(beginning)


def test_the_car_of_the_file_takes_the_changes_of_the_study(tmp_path):
    """The front axle of the rig has no rear damper, so a car loaded before that of the file would refuse them."""
    cases = CaseFile(vehicle="sedan", roads=("A",), speeds=(60.0,), duration=3.0, variants={"soft": SOFT, "hard": HARD})
    choice = CarChoice(overrides=("rear.damper.coulomb_friction=20",))
    study = SweepStudy(
        design=cases, car=choice, runs=SweepSettings(engine="reduced"), destination=Destination(output=tmp_path / "out")
    )
    result = study.run()
    assert (result.runs, result.failed) == (3, 0)


def test_states_alone_have_no_best(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cases.toml").write_text(FILE.partition("[variants")[0], encoding="utf-8")
    assert main(["--cases", "cases.toml", "--engine", "reduced", "--output", "out"]) == 0
    said = capsys.readouterr().out
    assert "no variants" in said and "smoothest" not in said and "%)" not in said


def test_a_figure_that_is_0_has_no_change_in_percent():
    """Two states on two inputs; one figure of a base car is 0, or missing."""
    cases = CaseFile(vehicle="sedan", roads=("A", "B"), speeds=(60.0,), states={"laden": {"body.mass": 1500}},
                     variants={"soft": SOFT})  # fmt: skip
    plan = cases.plan(Car.load("sedan"), (), SweepSettings(engine="reduced", measure="travel"))
    listed = [plan.cases[number] for number in range(8)]

    def results(values, cases=cases, rows=listed):
        finished = [Result(values={"travel": value}) for value in values]
        return case_results(SweepTable(cases=rows, results=finished, units={"travel": "m"}, made={}), cases)

    with pytest.raises(DataError, match=r"--cases: travel of 'laden' on road_B_60 is 0"):
        results([1.0] * 6 + [0.0, 1.0])
    soft = results([1.0] * 7 + [0.0])
    assert soft.changes[1, 3] == -100.0
    missing = results([np.nan, 1.0] * 4)
    assert "travel" in missing.sentence and missing.rows()[1][1:] == ["no value", "no value", "base"]
    # A load is no choice, so nothing is compared, and 0 is a result.
    states = results([0.0] * 4, replace(cases, variants={}), [listed[number] for number in (0, 2, 4, 6)])
    assert states.rows()[1][1:] == ["0", "0", "base"] and states.lines()


def test_equal_cars_and_other_options_are_refused(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cases.toml").write_text(FILE + '[variants.same]\n"rear.damper.viscous" = 1200\n', encoding="utf-8")
    assert main(["--cases", "cases.toml"]) == 2
    assert "cases 'soft' and 'same'" in capsys.readouterr().err
    assert main(["--cases", "cases.toml", "--vary", "damper.viscous=1,2"]) == 2
    assert re.search("--cases .* remove --vary", capsys.readouterr().err)


def test_cars_are_compared_by_one_figure(tmp_path, capsys, monkeypatch):
    """Another figure than comfort has its name, unit and error; several ones are refused before the first run."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cases.toml").write_text(FILE, encoding="utf-8")
    words = ["--cases", "cases.toml", "--engine", "reduced", "--quiet", "--report", "--output"]
    for name in ("weighted", "travel"):
        assert main([*words, name, "--measure", name]) == 0
    comfort, travel = (rows_of(tmp_path / name / "cases.csv") for name in ("weighted", "travel"))
    assert main([*words, "comfort"]) == 0
    for row, ranked in zip(comfort, rows_of(tmp_path / "comfort" / "cases.csv"), strict=True):
        assert row.items() <= ranked.items()
    car = Car.load("sedan").with_({"body.mass": 1500, "rear.damper.viscous": 1200})
    expected = car.run(road("A", 60, duration=3), engine="reduced").figure("travel")
    (row,) = (row for row in travel if (row["input"], row["car"]) == ("road_A_60", "laden, soft"))
    assert float(row["travel [m]"]) == pytest.approx(expected, rel=1e-4)
    page = (tmp_path / "travel" / "report.html").read_text(encoding="utf-8")
    assert re.search("lower travel|lowest travel", page) and "road_A_60 [m]" in page and "acceleration" not in page
    with pytest.raises(ConfigurationError, match=r"--measure: .*travel, weighted"):
        read_cases(tmp_path / "cases.toml").plan(Car.load("sedan"), (), SweepSettings(measure=["travel", "weighted"]))
