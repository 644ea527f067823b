"""`python -m vehicle drive`: files, figures, and what it refuses."""

import json

import numpy as np
import pytest

from vehicle.commands.drive import main
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.formats.csv_table import write_table

CHANNEL = "knuckle_fr_acc_z"


@pytest.fixture(scope="module")
def measured(car, high_piece, tmp_path_factory):
    """What a logger would have written of the knuckle: another rate, g, another name, a clock that began earlier."""
    run = car.run(high_piece, engine="reduced", channels=(CHANNEL,))
    time = np.arange(int(4.0 * 1600) + 1) / 1600
    path = tmp_path_factory.mktemp("drive") / "logger.csv"
    values = np.interp(time, run.time, run[CHANNEL])
    heads = ["time [s]", "Dof 12 +Z [g]", "Dof 13 +Z [g]", "Dof 14 +Z [g]"]
    write_table(path, heads, [time + 3.0, values / 9.80665, 0.0 * values, 5.0 * values / 9.80665], [])
    return path


def test_a_drive_file_is_written_and_read_again(measured, high_piece, tmp_path, capsys):
    folder = tmp_path / "found"
    given = ["--target", str(measured), "--channel", f"{CHANNEL}=Dof 12*", "--band", "2:40", "--target-error", "8"]
    assert main([*given, "--output", str(folder)]) == 0
    said = capsys.readouterr()
    assert "iteration 1 of at most 15: error" in said.err and "fell below 8 %" in said.out
    summary = json.loads((folder / "summary.json").read_text())
    assert {path.name for path in folder.iterdir()} == {*summary["files"].values(), ".vehicle-files"}
    assert summary["reached"] and summary["error"] < 0.08 and summary["drive"]["wheels"] == ["fr"]
    assert any("1600 Hz" in text for text in summary["notices"])
    assert {"response.png", "convergence.png"} <= set(summary["files"].values())
    drive = read_signal(folder / "drive.csv")
    assert drive.wheels == ("fr",) and drive.duration == pytest.approx(4.0)
    errors = [step["error"] for step in summary["iterations"]]
    assert min(errors) == summary["error"] and errors[0] > 2.0 * errors[-1]


def test_without_figures_the_tables_of_a_drive_are_written(measured, tmp_path):
    folder = tmp_path / "plain"
    given = ["--target", str(measured), "--channel", f"{CHANNEL}=Dof 12*", "--band", "2:40", "--iterations", "1"]
    assert main([*given, "--no-figures", "--quiet", "--output", str(folder)]) == 0
    files = json.loads((folder / "summary.json").read_text())["files"]
    assert {path.name for path in folder.iterdir()} == {*files.values(), ".vehicle-files"}
    assert {"drive.csv", "response.csv", "iterations.csv"} < set(files.values())
    assert not any(name.endswith(".png") for name in files.values())


BAD = {
    "no such channel of the car": (["--channel", "knuckle_acc_z=Dof 12*"], 2, "no acceleration channel"),
    "no such channel of the file": (["--channel", f"{CHANNEL}=Dof 9*"], 3, "matches no channel"),
    "no acceleration": (["--channel", f"{CHANNEL}=1", "--unit", "mm"], 3, "is a displacement but must"),
    "band beyond the record": (["--channel", f"{CHANNEL}=1", "--band", "0.1:50"], 2, "and within 0.5 to 100 Hz"),
    "band upside down": (["--channel", f"{CHANNEL}=1", "--band", "50:1"], 2, "the lower first, for example 1:50"),
    "gain": (["--channel", f"{CHANNEL}=1", "--gain", "1.5"], 2, "--gain 1.5: must be above 0 and up to 1"),
    "too few channels": (
        ["--channel", f"{CHANNEL}=1", "--wheel", "front_right", "--wheel", "front_left"], 2, "at least as many channels"
    ),
    "a sensor that is dead": (["--channel", f"{CHANNEL}=2"], 3, "must be at least 1e-06 m/s2"),
    "unit": (["--channel", f"{CHANNEL}=1", "--unit", "kg"], 2, "--unit kg: unknown unit"),
    "beyond a shaker": (["--channel", "seat_rail_acc_x=3", "--wheel", "front_right"], 4, "would have to be"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_bad_targets_are_refused(case, measured, tmp_path, capsys):
    given, code, sentence = BAD[case]
    assert main(["--target", str(measured), *given, "--output", str(tmp_path / "none")]) == code
    error = capsys.readouterr().err
    assert error.startswith("error: ") and sentence in error, error
    assert not (tmp_path / "none").exists()
