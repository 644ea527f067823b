"""A record is diagnosed once: the same sentences in every command, and one option that accepts them."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.german_logger import LATE, NAMES, TRUTH, measured_run, write_logger
from vehicle import Car, Choice, compare, diagnose, measured_histories, save_run
from vehicle.commands.compare import main as compare_command
from vehicle.commands.inspect import main as inspect
from vehicle.commands.tune import main as tune
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.table import Record
from vehicle.signals.records.measured import Measured
from vehicle.signals.records.run_findings import beside_run

FRONT = ("knuckle_fl_acc_z", "knuckle_fr_acc_z")
FITTED = [f"{path}={low}:{high}" for path, low, high in zip(TRUTH, (1000, 10), (4000, 200), strict=True)]
MAPS = {name: head.partition(" [")[0] for name, head in NAMES.items()}


@pytest.fixture(scope="module")
def truth():
    return measured_run()


@pytest.fixture(scope="module")
def logger(truth, tmp_path_factory):
    path = tmp_path_factory.mktemp("logger") / "logger.csv"
    return write_logger(path, truth, exchanged=FRONT, inverted="knuckle_rl_acc_z")


@pytest.fixture(scope="module")
def diagnosis(logger):
    """The car of the run has other dampers than the measured one."""
    return diagnose(logger, Car.load("focus_road"))


def maps(*names):
    return [word for name in names or MAPS for word in ("--map", f"{name}={MAPS[name]}")]


def test_a_german_logger_has_one_diagnosis_of_five_sentences(logger, diagnosis):
    first, *sentences = diagnosis.findings
    assert first.kind == "unmapped" and first.options[1] == "plate_fl_displacement=Stempel VL"
    assert sorted(each.kind for each in sentences) == ["delay", "exchanged", "gravity", "offset", "sign"]
    by = {each.kind: each for each in sentences}
    assert "position of the sensor" in by["offset"] and "--detrend" in by["gravity"] and "9.8" in by["gravity"]
    assert "--turn knuckle_rl_acc_z" in by["sign"] and "lag the plates by 12" in by["delay"]
    assert by["exchanged"].startswith("swapped channels: ")
    assert diagnosis.choice.channels["knuckle_fl_acc_z"] == "Radträger VR z"
    assert diagnosis.choice.channels["knuckle_fr_acc_z"] == "Radträger VL z"
    assert diagnosis.inverted == ("knuckle_rl_acc_z",) and diagnosis.choice.detrend
    # The cures leave nothing but the position of the sensors and the delay, which the fit has as an unknown.
    cured = diagnose(logger, Car.load("focus_road"), **diagnosis.arguments)
    assert {each.kind for each in cured.findings} <= {"delay"}


def test_accepted_advice_makes_a_comparison_right(logger, truth, tmp_path, capsys):
    save_run(truth, tmp_path / "run", figures=False)
    words = [str(tmp_path / "run"), "--measured", str(logger), "--delay", "2", "--no-figures"]
    assert compare_command([*words, "--accept-advice", "--output", str(tmp_path / "compared")]) == 0
    said = capsys.readouterr().err
    assert said.count("accepted: ") == 5 and said.count("found: ") == 1  # five, with the names; the offset is taken out
    result = json.loads((tmp_path / "compared" / "compare.json").read_text())
    (accelerations,) = (each for each in result["delays"] if each["group"] == "accelerations")
    assert accelerations["delay_s"] == pytest.approx(LATE, abs=5e-5)
    assert all(each["correlation"] > 0.97 for each in result["records"])
    assert not any("exchanged" in text or "inverted relative" in text for text in result["notices"])
    assert compare_command([*words, *maps(), "--output", str(tmp_path / "kept")]) == 0
    kept = json.loads((tmp_path / "kept" / "compare.json").read_text())
    assert sum("swapped channels" in text or "gravity is included in" in text for text in kept["notices"]) == 2


def test_accepted_advice_makes_a_fit_right(logger, tmp_path, capsys):
    words = ["focus_road", "--record", str(logger), "--parameters", *FITTED, "--engine", "reduced"]
    assert tune([*words, "--accept-advice", "--output", str(tmp_path / "tune")]) == 0
    said = capsys.readouterr().err
    assert said.count("accepted: ") == 4  # the delay is an unknown of the fit
    result = json.loads((tmp_path / "tune" / "tune.json").read_text())
    values = {each["path"]: each["value"] for each in result["parameters"]}
    (delay,) = result["delays"]
    for (path, value), share in zip(TRUTH.items(), (2e-3, 1e-2), strict=True):
        assert values[path] == pytest.approx(value, rel=share)
    assert delay["delay_s"] == pytest.approx(LATE, abs=5e-5)


def test_a_fit_refuses_gravity_with_all_findings(logger, tmp_path, capsys):
    """It ended at 99.9 % of error, with a line of --set."""
    words = ["focus_road", "--record", str(logger), *maps(), "--parameters", *FITTED, "--engine", "reduced"]
    assert tune([*words, "--output", str(tmp_path / "tune")]) == 3
    said = capsys.readouterr()
    assert "gravity is included in" in said.err and "--detrend" in said.err and "swapped channels" in said.err
    assert "inverted relative" in said.err and "--set" not in said.out and not (tmp_path / "tune").exists()


def test_moving_plates_that_nobody_mapped_are_named(logger):
    """One of four plates gave a friction of 32.2 +- 1.2 N for 48 N without a word of the others."""
    others = [f"plate_{wheel}_displacement" for wheel in ("fr", "rl", "rr")]
    choice = Choice(channels={name: column for name, column in MAPS.items() if name not in others}, detrend=True)
    measured = diagnose(logger, Car.load("focus_road"), choice=choice)
    (finding,) = (each for each in measured.findings if each.kind == "unmapped")
    assert all(f"Stempel {corner}" in finding for corner in ("VR", "HL", "HR")) and "Stempel VL" not in finding
    assert {*measured.choice.channels} == {*MAPS}
    notices = measured_histories(Car.load("focus_road"), logger, choice=choice).notices
    assert f"logger.csv: {finding}" in notices


def test_149_no_delay_is_advised_where_the_plates_are_unlike(logger):
    """The plates of the run were lifted by 75 mm; the histories were called late, and following it changed no FRF."""
    other = Car.load("focus_road").run("low.csv", engine="reduced")
    comparison = compare(other, logger, choice=Choice(channels=MAPS, detrend=True))
    assert not any("--delay" in text for text in comparison.notices) and comparison.delays == ()
    assert any("clock and delays are not judged" in text for text in comparison.notices)


def test_inspect_prints_the_findings_and_commands_with_their_options(logger, capsys):
    assert inspect([str(logger)]) == 0
    said = capsys.readouterr().out
    assert said.count("finding: ") == 2 and "position of the sensor" in said and "gravity is included in" in said
    assert said.rstrip().endswith("--detrend")
    # Without a car each channel is diagnosed by itself.
    assert [each.kind for each in diagnose(logger).findings] == ["gravity"] * 5


def test_a_sound_record_has_no_finding_on_channels(truth, tmp_path):
    path = write_logger(tmp_path / "sound.csv", truth)
    found = diagnose(path, Car.load("focus_road", TRUTH), choice=Choice(channels=MAPS, detrend=True)).findings
    assert {each.kind for each in found} == {"delay"}


def test_axes_of_a_point_are_judged_together(tmp_path):
    """The mean along y is no gravity, and the unit of a vertical channel is clear from three axes."""
    time = np.arange(3000) / 100.0
    sine = np.sin(20.0 * time)
    table = np.column_stack([time, sine, 1.0 + sine, 0.6 + sine, sine, 0.8 + sine])
    heads = "time [s],Hub lateral [m/s2],Roof lateral [m/s2],Seat X [m/s2],Seat Y [m/s2],Seat Z [m/s2]"
    np.savetxt(tmp_path / "a.csv", table, fmt="%.6g", delimiter=",", header=heads, comments="")
    (finding,) = diagnose(tmp_path / "a.csv").findings
    assert finding.startswith("Seat Z: ") and "Seat X, Seat Y, Seat Z is 1 m/s2" in finding


@pytest.mark.parametrize(("name", "options"), [("seat_acc_x", ()), ("seat_acc_z", ("--detrend",))])
def test_a_mean_along_x_is_a_motion(name, options):
    """A fit of a record of braking was refused: "the offset of a sensor?"."""
    time = np.arange(3000) / 100.0
    run = Record(time=time, channels={name: np.sin(20.0 * time)}, units={name: "m/s2"})
    record = replace(run, channels={name: 3.0 + run.channels[name]})
    file = Measurement(path=Path("a.csv"), format="csv", channels=())
    measured = Measured(file=file, frf=None, record=record, notices=())
    (finding,) = (each for each in beside_run(measured, record, run, time).findings if each.kind == "offset")
    assert finding.options == options and ("braking, cornering, or an inclined sensor?" in finding) == (not options)


def test_a_cure_in_python_is_that_of_the_command(logger, diagnosis):
    target = measured_histories(Car.load("focus_road"), logger, **diagnosis.arguments)
    assert not any("exchanged" in text or "inverted relative" in text for text in target.notices)
