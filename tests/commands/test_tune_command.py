"""`python -m vehicle tune`: hidden values from a logger file, the fitted file, and refused files."""

import argparse
import json
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.validation import validated
from vehicle.commands.shaker import main as shake
from vehicle.commands.tune import main, parser, settings_of
from vehicle.model.parameters.car_choice import CarChoice
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.records.measured_settings import MeasuredSettings
from vehicle.studies.tuning.fit_settings import LevelSettings, MeasurementFile, ResponseSettings
from vehicle.studies.tuning.measurement_settings import MeasurementSettings
from vehicle.studies.tuning.tuning_study import TuningStudy

HIDDEN = {
    "damper.viscous": 2150.0,
    "damper.coulomb_friction": 100.0,
    "main_spring.stiffness": 26200.0,
    "suspension_mount.stiffness.z": 6.8e5,
}
BOUNDS = ("damper.viscous=800:4000", "damper.coulomb_friction=50:250", "main_spring.stiffness=15000:40000",
          "suspension_mount.stiffness.z=3e5:2e6")  # fmt: skip
CHANNELS = {
    "plate_fl_displacement": ("Shaker FL", "mm", 1e3),
    "knuckle_fl_acc_z": ("Rad VL z", "g", 1.0 / 9.80665),
    "seat_rail_acc_z": ("Sitz z", "m/s2", 1.0),
}
MAP = [word for name, (label, *_) in CHANNELS.items() for word in ("--map", f"{name}={label}")]
NOISE = 0.03


def test_the_options_are_one_object():
    """Of the parsed options nothing but a study goes on, and Python makes the same."""
    words = ["focus", "--frf", "a.uff", "b.uff", "--stuck", "--record", "c.mf4", "--road", "C", "--speed", "80", *MAP]
    words += ["--channels", "seat_rail_acc_z,x", "--band", "4:30", "--lowpass", "50", "--parameters", BOUNDS[0]]
    study = settings_of(parser().parse_args(words, argparse.Namespace(held=ExitStack())))
    frf = [MeasurementFile(file=Path(name), content="frf", stuck=True) for name in ("a.uff", "b.uff")]
    record = MeasurementFile(file=Path("c.mf4"), content="record", road="C", speed=80.0)
    assert study == TuningStudy(
        car=CarChoice(vehicle=vehicle_file("focus")),
        parameters={"damper.viscous": (800.0, 4000.0)},
        measurements=MeasurementSettings(
            files=(*frf, record),
            measured=MeasuredSettings(mapping=tuple(MAP[1::2])),
            responses=ResponseSettings(band=(4.0, 30.0)),
            histories=LevelSettings(band=(4.0, 30.0), lowpass=50.0),
            channels=("seat_rail_acc_z", "x"),
        ),
    )


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    """MDF4 file of a hidden car in MuJoCo over 8 s: other names, other units, another clock, 3 % noise."""
    asammdf = pytest.importorskip("asammdf")
    folder = tmp_path_factory.mktemp("bench")
    noise, length = np.random.default_rng(1), 8000
    high = read_signal(find_input("high.csv"), wheel="fl")
    cut = {wheel: values[: length + 200] for wheel, values in high.displacement.items()}
    beginning = replace(high, time=high.time[: length + 200], displacement=cut)
    run = Car.load("focus", HIDDEN).run(beginning, channels=list(CHANNELS))
    signals = []
    for name, (label, unit, factor) in CHANNELS.items():
        values = factor * run[name][:length]
        if not name.startswith("plate"):
            values = values + NOISE * np.sqrt(np.mean(values**2)) * noise.standard_normal(length)
        signals.append(asammdf.Signal(values, run.time[:length] + 100.0, unit=unit, name=label))
    with asammdf.MDF(version="4.10") as file:
        file.append(signals)
        file.save(folder / "bench.mf4")
    return folder / "bench.mf4"


@pytest.fixture(scope="module")
def fitted(record, tmp_path_factory):
    folder = tmp_path_factory.mktemp("tuned") / "tune"
    assert main(["focus", "--record", str(record), *MAP, "--parameters", *BOUNDS, "--output", str(folder)]) == 0
    return folder


def test_hidden_values_are_found_in_an_mdf4_record(fitted):
    content = json.loads((fitted / "tune.json").read_text(encoding="utf-8"))
    assert content["converged"] and not content["left_open"]
    for row in content["parameters"]:
        hidden = HIDDEN[row["path"]]
        validated(
            "Sweeps, tuning and optimisation",
            f"{row['path']} fitted to an MDF4 record with 3 % noise",
            row["value"],
            hidden,
            abs=3.0 * row["standard_error"],
            unit=row["unit"],
            source="closed form: hidden value of the car that made the record",
        )
        # With a larger standard error the check above would be too weak.
        assert row["standard_error"] < 0.01 * hidden
        # The stated error holds the misfit, too.
        assert 0.0 < row["noise_error"] <= row["standard_error"]
        assert abs(row["start"] / hidden - 1.0) > 0.02
    assert all(row["after"] < 0.2 * row["before"] for row in content["agreement"])


def test_the_fitted_file_runs_and_the_report_is_whole(fitted, tmp_path):
    car = Car.load(fitted / "vehicle.toml")
    content = json.loads((fitted / "tune.json").read_text(encoding="utf-8"))
    for row in content["parameters"]:
        assert value_of(car.vehicle, row["path"]) == pytest.approx(row["value"], rel=1e-9)
    words = ["--vehicle", str(fitted / "vehicle.toml"), "--input", "low.csv", "--engine", "reduced", "--quiet"]
    assert shake([*words, "--output", str(tmp_path / "run")]) == 0
    page = (fitted / "report.html").read_text(encoding="utf-8")
    settings = " ".join(f"--set {text}" for text in content["set"])
    for text in ("focus fitted to bench", "What the data leave open", settings, "<svg", "last steps with mujoco"):
        assert text in page
    answer = page.partition('<p class="answer">')[2].partition("</p>")[0]
    first, error = content["parameters"][0], max(content["agreement"], key=lambda row: row["before"])
    assert f"damper viscous {first['value']:.4g} ± " in answer and "(before 2250)" in answer
    assert f"from {error['before']:.3g} to {error['after']:.3g} {error['unit']}; the data determine" in answer
    assert {"time_1_bench.png", "correlation.png"} <= {path.name for path in fitted.iterdir()}


def test_console_says_what_is_unexplained_then_the_values(record, tmp_path, capsys):
    """FRFs estimated from the same record; friction and viscous damping of a stuck damper are not determined."""
    words = ["focus", "--frf", str(record), "--stuck", *MAP, "--parameters", BOUNDS[0], BOUNDS[3], "--spacing", "1"]
    assert main([*words, "--output", str(tmp_path / "tune")]) == 0
    lines = capsys.readouterr().out.splitlines()
    # The dampers slid: a car with stuck ones cannot follow, and the first line says it.
    assert lines[0].startswith("these parameters do not explain the measurement: ")
    assert lines[1].startswith("damper.viscous ") and "start 2250, bounds 800 to 4000" in lines[1]
    assert lines[3].startswith("--set damper.viscous=2250 --set suspension_mount.stiffness.z=")
    assert sum("do not determine damper.viscous" in line for line in lines) == 1


def test_posterior_of_the_record_and_a_rival_law(record, tmp_path, capsys):
    pytest.importorskip("emcee")
    words = ["focus", "--frf", str(record), *MAP, "--parameters", "damper.coulomb_friction=60:200", BOUNDS[3]]
    words += ["--spacing", "1", "--engine", "reduced", "--posterior", "--samples", "16", "--discrepancy", "5"]
    words += ["--rival", "damper.coulomb_friction=1", "damper.viscous=1000:8000"]
    assert main([*words, "--output", str(tmp_path / "tune")]) == 0
    said = capsys.readouterr().out
    for text in (
        "posterior: median, 90 % interval",
        "comfort on bench.mf4: ",
        "evidence: fitted law ",
        "R-hat at most 1.00",
    ):
        assert text in said
    content = json.loads((tmp_path / "tune" / "tune.json").read_text(encoding="utf-8"))["posterior"]
    for row in content["parameters"]:
        assert row["low"] < HIDDEN[row["path"]] < row["high"] and row["r_hat"] < 1.01
    assert "posterior.png" in {path.name for path in (tmp_path / "tune").iterdir()}
    assert 'id="posterior"' in (tmp_path / "tune" / "report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "message", "code"),
    [
        ([], "the measurement is missing; add --frf FILE or --record FILE", 2),
        (["--signal", "low.csv"], "--signal: must follow the --frf or --record that it belongs to", 2),
        (["--record", "FILE", "--stuck"], "--stuck: belongs to --frf", 2),
        (["--band", "3:45"], "belongs to --frf", 2),
        (["--samples", "64"], "belongs to --posterior", 2),
        (["--record", "FILE", *MAP, *("--parameters", BOUNDS[0]), "--posterior"], "--posterior needs measured FRFs", 3),
        (["--record", "FILE", *MAP], "the parameters to fit are missing", 2),
        (["--record", "FILE", *MAP, "--parameters", "damper.viscous=1,2"], "damper.viscous=1,2: contains values", 2),
        (["--record", "FILE", *MAP, "--parameters", "damper.viscous=3e3:4e3"], "0 < lower < start < upper", 2),
        (["--record", "FILE", *MAP[2:], *("--parameters", BOUNDS[0])], "contains no moving plate", 3),
        (["--record", "FILE", *("--parameters", BOUNDS[0])], "set --map CHANNEL=NAME", 3),
        (["--record", "FILE", *MAP, "--to", "100.01", *("--parameters", BOUNDS[0])], "at least 32 are needed", 3),
        (
            ["--record", "FILE", *MAP, "--unit", "seat_rail_acc_z=V", *("--parameters", BOUNDS[0])],
            "seat_rail_acc_z is a voltage",
            3,
        ),
        (
            ["--record", "FILE", *MAP, *("--parameters", "damper.stribeck_friction=50:300")],
            "--parameters damper.stribeck_friction",
            2,
        ),
    ],
)
def test_refused_by_name(record, tmp_path, capsys, arguments, message, code):
    words = [str(record) if word == "FILE" else word for word in arguments]
    assert main(["focus", *words, "--output", str(tmp_path / "tune")]) == code
    assert message in capsys.readouterr().err
    assert not (tmp_path / "tune").exists()
