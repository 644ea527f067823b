"""`python -m vehicle sweep` as a user runs it."""

import argparse
import re
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.studies.sweeps.sweep_samples import rows_of
from vehicle import Car, Road
from vehicle.commands.sweep import main, parser, settings_of
from vehicle.runs.output.destination import Destination, ReportChoice
from vehicle.signals.excitation.input_files import find_input
from vehicle.studies.sweeps.case import SignalFile
from vehicle.studies.sweeps.chosen_cars import EveryCombination, VariationTable, every_combination
from vehicle.studies.sweeps.parameter_effects import SingleChanges
from vehicle.studies.sweeps.plan import plan_sweep
from vehicle.studies.sweeps.sobol_sweep import SobolSample
from vehicle.studies.sweeps.sweep_inputs import InputChoice
from vehicle.studies.sweeps.sweep_settings import SweepSettings
from vehicle.studies.sweeps.sweep_study import SweepStudy
from vehicle.studies.sweeps.sweep_table import read_variations

HEAD = ("--author", "A. Engineer", "--project", "Ride")
"""Names in the head of a report."""


@pytest.fixture
def signal(tmp_path):
    from scenarios.signals.random_road import random_road

    road = random_road(rms=3e-4, seed=1, wheel="fl", duration=3.0)
    path = tmp_path / "road.csv"
    lines = [f"{t:.3f},{z:.9g}" for t, z in zip(road.time, road.displacement["fl"], strict=True)]
    path.write_text("time [s],displacement [m]\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return path


def table_of(folder):
    return rows_of(folder / "table.csv")


@pytest.mark.parametrize(
    ("words", "design"),
    [
        (["--vary", "damper.viscous=1,2"], EveryCombination(("damper.viscous=1,2",))),
        (["--table", "cars.csv"], VariationTable(Path("cars.csv"))),
        (["--sobol", "64", "--vary", "damper.viscous=1:2"], SobolSample(("damper.viscous=1:2",), 64)),
        (["--each", "+-15%,5mm", "--vary", "damper"], SingleChanges(("damper",), 0.15, 0.005)),
        (["--each", "15"], SingleChanges((), 0.15)),
    ],
)
def test_the_options_are_one_object(words, design):
    """Of the parsed options nothing but a study goes on, and Python makes the same."""
    typed = [
        "--road",
        "B",
        "--speed",
        "80",
        "--seed",
        "3",
        "--skip",
        "1",
        "--measure",
        "travel",
        "--resume",
        "--retry-failed",
        *words,
    ]
    settings = settings_of(parser().parse_args(typed, argparse.Namespace(held=ExitStack())))
    drive = InputChoice(road=("B",), speed=(80.0,), seed=(3,))
    runs = SweepSettings(jobs=None, skip=1.0, measure=("travel",), retry_failed=True)
    assert settings == SweepStudy(design=design, inputs=drive, runs=runs, destination=Destination(resume=True))


def test_a_study_in_python_writes_the_table_of_the_command(signal, tmp_path, capsys):
    options = ["--input", str(signal), "--skip", "0.5", "--engine", "reduced"]
    assert main([*options, "--vary", "damper.viscous=1500,2000", "--output", str(tmp_path / "a"), "--report"]) == 0
    study = SweepStudy(
        design=EveryCombination({"damper.viscous": [1500, 2000]}),
        inputs=signal,
        runs=SweepSettings(jobs=None, skip=0.5, engine="reduced"),
        destination=Destination(output=tmp_path / "b"),
        report=ReportChoice(report=""),
    )
    said = str(study.run())
    assert said.replace(str(tmp_path / "b"), str(tmp_path / "a")) == capsys.readouterr().out.rstrip()
    for name in ("table.csv", "differences.csv", "sweep.png"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "b", "road.csv"]


def test_variations_make_a_table(signal, tmp_path, capsys):
    output = tmp_path / "out"
    arguments = ["--input", str(signal), "--output", str(output), "--skip", "0.5", "--engine", "reduced"]
    arguments += ["--set", "damper.viscous=2000", "--vary", "damper.coulomb_friction=62.5, 250"]
    assert main([*arguments, "--vary", "bushings.suspension_mount.stiffness.z=7e5"]) == 0
    assert "2 runs, 0 failed" in capsys.readouterr().out
    rows = table_of(output)
    varied = ["damper.viscous", "damper.coulomb_friction", "bushings.suspension_mount.stiffness.z"]
    assert read_variations(output / "table.csv") == (varied, [("2000", "62.5", "7e5"), ("2000", "250", "7e5")])
    assert [row["damper.coulomb_friction"] for row in rows] == ["62.5", "250"]
    assert {row["damper.viscous"] for row in rows} == {"2000"} and {row["input"] for row in rows} == {"road"}
    assert float(rows[0]["unweighted [m/s2]"]) != float(rows[1]["unweighted [m/s2]"]) > 0.0
    assert {row["engine"] for row in rows} == {"reduced"}
    first, second = rows_of(output / "differences.csv")
    assert (first["difference [m/s2]"], first["half_width_95 [m/s2]"]) == ("0", "0")
    comfort = [float(row["unweighted [m/s2]"]) for row in rows]
    assert float(second["difference [m/s2]"]) == pytest.approx(comfort[1] - comfort[0], rel=1e-4)
    error = float(rows[0]["unweighted_error [-]"]) * comfort[0]
    assert float(first["standard_error [m/s2]"]) == pytest.approx(error, rel=1e-4)
    assert float(second["standard_error_of_difference [m/s2]"]) > 0.0
    # A second call is rejected, or continues with --resume.
    again = [*arguments, "--vary", "bushings.suspension_mount.stiffness.z=7e5"]
    assert main(again) == 2
    said = capsys.readouterr().err
    assert "--resume" in said and "--force" in said
    assert main([*again, "--resume", "--quiet"]) == 0
    assert "# 0 runs computed" in (output / "timing.csv").read_text(encoding="utf-8")
    assert table_of(output) == rows


def test_a_table_of_variations(tmp_path):
    file = tmp_path / "variations.csv"
    file.write_text("damper.viscous, damper.coulomb_friction\n# a remark\n1500,75\n2250,125\n", encoding="utf-8")
    assert read_variations(file) == (["damper.viscous", "damper.coulomb_friction"], [("1500", "75"), ("2250", "125")])
    assert list(every_combination(["a=1,2", "b=x"])) == [("a=1", "b=x"), ("a=2", "b=x")]
    first, *_, last = every_combination(["a=[1, 2, 3],[4,5,6]", "b=7,8"])
    assert (first, last) == (("a=[1, 2, 3]", "b=7"), ("a=[4,5,6]", "b=8"))


@pytest.mark.parametrize(
    ("arguments", "message", "code"),
    [
        ([], "--vary PATH=A,B,C", 2),
        (["--vary", "damper.viscous"], "must be PATH=A,B,C, PATH=A:B:N", 2),
        (["--vary", "damper.viscous=1,,2"], "must be PATH=A,B,C, PATH=A:B:N", 2),
        (["--vary", "a=1", "--vary", "a=2"], "given twice", 2),
        (["--vary", "damper.viscous=1:2"], "damper.viscous=1:2: contains bounds", 2),
        (["--vary", "damper.viscous=1000", "--skip", "3"], "--skip 3 s: must be at least 0 and below the 3 s ", 2),
        (["--vary", "damper.viscous=1000", "--skip", "-5"], "--skip -5: must be at least 0", 2),
        (["--vary", "damper.viscous=1000", "--skip", "nan"], "--skip nan: must be at least 0", 2),
        (["--vary", "damper.viscous=1000", "--jobs", "0"], "--jobs 0: must be at least 1", 2),
        (
            ["--vary", "damper.viscous=1000", "--set", "damper.vicsous=1"],
            ("did you mean front.damper.viscous"),
            2,
        ),
        (
            ["--vary", "damper.vicsous=1000"],
            ("varied parameter damper.vicsous=1000: unknown parameter damper.vicsous"),
            2,
        ),
        (["--vary", "damper.viscous=1000", "--resume", "--force"], "leave one of them out", 2),
        (["--vary", "damper.viscous=1000", "--executor", "here"], "must be dask://host:port", 2),
        (["--table", "missing.csv"], "cannot be read", 3),
        (["--vary", "damper.viscous=1000", "--executor", "..:x"], "--executor ..:x: TypeError", 2),
        (["--vary", "damper.viscous=1000", "--executor", "json:nothing"], "has no attribute 'nothing'", 2),
        (["--vary", "damper.viscous=1000", "--executor", "json:loads"], "--executor json:loads: TypeError", 2),
        (["--vary", "bushings.tyre.stiffness=1e5"], "is a vector; set all components as [x, y, z]", 2),
    ],
)
def test_bad_usage(arguments, message, code, signal, tmp_path, capsys):
    assert main(["--input", str(signal), "--output", str(tmp_path / "out"), *arguments]) == code
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out" / "rows.jsonl").exists()


def test_bad_tables(tmp_path, signal, capsys):
    file = tmp_path / "variations.csv"
    for text, message in (
        ("a\n", "at least one row"),
        ("a,b\n1\n", "row 1: found 1 cells, must be 2"),
        ("a,b,a\n1,2,3\n", "repeated column a; remove"),
        ("a\n" + "1" * 200_000 + "\n", "cannot be read (field larger than field limit"),
    ):
        file.write_text(text, encoding="utf-8")
        assert main(["--input", str(signal), "--output", str(tmp_path / "out"), "--table", str(file)]) == 3
        assert message in capsys.readouterr().err


def test_a_folder_with_other_files_is_refused(signal, tmp_path, capsys):
    output = tmp_path / "out"
    output.mkdir()
    (output / "thesis.txt").write_text("mine", encoding="utf-8")
    assert main(["--input", str(signal), "--output", str(output), "--vary", "damper.viscous=1", "--force"]) == 2
    assert "contains files that are not results of a run: thesis.txt; --force" in capsys.readouterr().err


def test_failed_rows_are_no_success(signal, tmp_path, capsys):
    arguments = ["--input", str(signal), "--vary", "damper.viscous=-1,2000", "--skip", "0.5", "--engine", "reduced"]
    assert main([*arguments, "--output", str(tmp_path / "out")]) == 4
    printed = capsys.readouterr()
    assert "1 of 2 runs failed" in printed.err and "--allow-failed" in printed.err and "2 runs, 1 failed" in printed.out
    assert [row["failed because"] != "" for row in table_of(tmp_path / "out")] == [True, False]
    assert main([*arguments, "--output", str(tmp_path / "out"), "--resume", "--allow-failed", "--report", *HEAD]) == 0
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "Ride, A. Engineer, 20" in page
    assert "1 failed runs" in page and "damper.viscous=-1" in page and "python -m vehicle sweep --input" in page
    assert "report.html" in capsys.readouterr().out


def test_the_engine_and_its_reason_are_told_before_the_runs():
    """On class C parts rotate beyond the valid range of the reduced engine; on class A they do not."""
    car, change = Car.load("sedan"), {"rear.damper.viscous": [1600.0]}
    roads = [Road("A", speed=80.0, duration=4.0), Road("C", speed=50.0, duration=4.0)]
    assert plan_sweep(car, change, roads).range_notes() == ()  # no damper has a range
    (note,) = plan_sweep(car, change, roads).engine_notes()
    assert note.startswith("engine mujoco on road_C_50 (1 of 2 inputs)") and "first car" in note
    assert re.search(r"2\.86 deg; --engine reduced .* about \d+ s for all 2 runs \(on class C comfort", note)
    assert plan_sweep(car, change, roads[:1]).engine_notes() == ()
    (note,) = plan_sweep(car, change, roads, SweepSettings(engine="reduced")).engine_notes()
    assert re.search(r"reduced engine on road_C_50, .*first car: .* 2\.86 deg \(on class C comfort within", note)
    # Where a linear tyre pulls, no difference from MuJoCo is stated.
    rough = [Road("D", speed=100.0, duration=4.0)]
    (note,) = plan_sweep(car, change, rough, SweepSettings(engine="reduced")).engine_notes()
    assert "--set AXLE.bushings.tyre.one_sided=true" in note and "class C" not in note
    assert plan_sweep(car, change, roads[:1], SweepSettings(engine="reduced")).engine_notes() == ()
    # With MuJoCo the time of the other engine is stated, and whether it is valid.
    for inputs, means in (
        (roads[:1], "within the valid range of the reduced engine (comfort within 0.1 %)"),
        (roads, "outside the valid"),
    ):
        (note,) = plan_sweep(car, change, inputs, SweepSettings(engine="mujoco")).engine_notes()
        assert note.startswith("engine mujoco, ") and "--engine reduced " in note and means in note
    # The stated difference, and the engine that the note names.
    (chosen,), (reduced,) = (
        plan_sweep(car, change, roads[1], SweepSettings(engine=engine)).run().results for engine in ("auto", "reduced")
    )
    assert chosen.engine == "mujoco" and reduced.engine == "reduced"
    assert reduced.values["unweighted"] == pytest.approx(chosen.values["unweighted"], rel=0.004)


def test_one_event_is_known():
    sedan = Car.load("sedan").vehicle
    for source, random in (
        (SignalFile(path=find_input("low.csv"), wheel="fl"), True),
        (SignalFile(path=find_input("bump_7p5mm.csv"), wheel="fl"), False),
        (Road("C", 80.0, duration=3.0).under(sedan), True),
        (Road("cleat:20x50", 30.0).under(sedan), False),
    ):
        assert source.signal().random == random, source.name


def test_a_car_that_fails_has_no_note_on_the_engine():
    road = Road("C", speed=50.0, duration=4.0)
    friction = {last: {"front.damper.coulomb_friction": [-1.0, last]} for last in (-2.0, 100.0)}
    assert plan_sweep(Car.load("sedan"), friction[-2.0], road).engine_notes() == ()
    # The last car needs MuJoCo, too, and it can be run.
    (note,) = plan_sweep(Car.load("sedan"), friction[100.0], road).engine_notes()
    assert note.startswith("engine mujoco on road_C_50 (1 of 1 inputs)") and "last car" in note


def test_two_sweeps_in_one_folder(signal, tmp_path, capsys):
    from vehicle.runs.output.locks import folder_lock

    arguments = ["--input", str(signal), "--output", str(tmp_path / "out"), "--vary", "damper.viscous=2000"]
    (tmp_path / ".out.lock").write_text("999999\n", encoding="utf-8")  # of a killed process: nobody holds it
    assert main([*arguments, "--skip", "0.5", "--engine", "reduced"]) == 0
    assert not (tmp_path / ".out.lock").exists()
    rows = (tmp_path / "out" / "rows.jsonl").read_bytes()
    for option in ("--force", "--resume"):
        with folder_lock(tmp_path / "out"):
            assert main([*arguments, option]) == 2
        assert "is writing there; wait until it ends" in capsys.readouterr().err
        assert (tmp_path / "out" / "rows.jsonl").read_bytes() == rows


def test_an_interrupted_force_keeps_the_old_sweep_and_goes_on(signal, tmp_path, capsys, monkeypatch):
    out = tmp_path / "out"
    arguments = ["--input", str(signal), "--output", str(out), "--skip", "0.5", "--engine", "reduced"]
    arguments += ["--executor", "tests.faults.commands:InProcess", "--vary"]
    assert main([*arguments, "damper.viscous=2000"]) == 0
    old = {path.name: path.read_bytes() for path in out.iterdir()}

    def interrupted(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("vehicle.studies.sweeps.sweep.write_table", interrupted)
        assert main([*arguments, "damper.viscous=2500", "--force"]) == 130
    said = capsys.readouterr().err.splitlines()
    assert said[-2:] == [
        f"notice: {out}: the finished rows are kept in .out.partial/rows.jsonl; continue with --resume",
        "error: interrupted; every file written so far is complete",
    ]
    assert {path.name: path.read_bytes() for path in out.iterdir()} == old
    assert main([*arguments, "damper.viscous=2500"]) == 2
    assert main([*arguments, "damper.viscous=2500", "--resume"]) == 0
    assert "# 0 runs computed" in (out / "timing.csv").read_text(encoding="utf-8")
    assert [row["damper.viscous"] for row in table_of(out)] == ["2500"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "road.csv"]


def test_a_varied_parameter_without_effect_is_noted():
    car, road = Car.load("sedan"), Road("B", speed=80, duration=8)
    (note,) = plan_sweep(car, {"front.damper.viscous": [1000, 2000], "rear.damper.viscous": [1000]}, road).notes
    assert note.startswith("front.damper.viscous=1000: has no effect") and "front.damper.viscous_law" in note
    assert not plan_sweep(car, {"front.damper.coulomb_friction": [40, 80]}, road).notes
