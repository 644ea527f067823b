"""Every traceback that was seen, every input that hung: one message, an exit code of the contract, at once."""

import os
import sys

import pytest

from tests.patience import process
from tests.system.conftest import csv_text
from tests.system.test_bad_inputs import GOOD
from vehicle.commands.command_line import FAULT, run_command
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car

NESTED = "[" * 2000 + "]" * 2000

SETTINGS = [
    ("61 recording rate too low", "solver.record_rate=1e-9", "solver.record_rate: found 1e-09 Hz, must be at least"),
    (
        "61 recording rate too high",
        "solver.record_rate=1e9",
        "solver.record_rate: found 1000000000.0 Hz, must be at most",
    ),
    ("61 step too short", "solver.timestep=1e-9", "solver.timestep: found 1e-09 s, must be at least"),
    ("60 nested lists", f"body.cog={NESTED}", "brackets are nested too deep"),
    ("60 open brackets", "body.cog=" + "[" * 5000, "brackets are nested too deep"),
    ("65 a number for a vector", "bushings.tyre.stiffness=2e5", "bushings.tyre.stiffness.z=2e5"),
    ("a NUL byte", "name=a\0b", "contains a NUL character"),
]


@pytest.mark.parametrize(("setting", "piece"), [case[1:] for case in SETTINGS], ids=[case[0] for case in SETTINGS])
def test_settings(setting, piece, shaker, short_signal, tmp_path):
    outcome = shaker("--input", "short.csv", "--engine", "reduced", "--set", setting)
    assert outcome.code == 2, outcome.err
    assert outcome.err.count("\n") == 1 and piece in outcome.err and FAULT not in outcome.err
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_an_inertia_that_no_number_holds(engine, shaker, short_signal):
    outcome = shaker("--input", "short.csv", "--engine", engine, "--set", "body.inertia.izx=1e30")
    assert outcome.code in (2, 4) and outcome.err.count("\n") == 1 and FAULT not in outcome.err


def test_a_plate_that_stands_still(shaker, tmp_path):
    (tmp_path / "still.csv").write_text(csv_text(0.0 * GOOD))
    for option in ([], ["--any-level"]):
        outcome = shaker("--input", "still.csv", "--engine", "reduced", *option)
        assert outcome.code == 3 and "no plate moves" in outcome.err and outcome.err.count("\n") == 1


def test_nested_tables_in_a_vehicle_file(shaker, short_signal, tmp_path):
    for text in ("[" + ".".join(["a"] * 2000) + "]\n", f"a = {NESTED}\n", "a = " + "{a=" * 2000 + "1" + "}" * 2000):
        (tmp_path / "car.toml").write_text(text)
        outcome = shaker("--input", "short.csv", "--vehicle", "car.toml")
        assert outcome.code == 2 and "nested too deep" in outcome.err and outcome.err.count("\n") == 1


@pytest.mark.parametrize("option", ["--vehicle", "--input"])
def test_a_pipe_with_no_writer_is_no_file(option, shaker, short_signal, tmp_path):
    """Opening it would wait for ever."""
    os.mkfifo(tmp_path / "pipe.toml")
    arguments = ["--input", "short.csv"] if option == "--vehicle" else []
    outcome = shaker(*arguments, option, "pipe.toml")
    assert outcome.code == 2 and "pipe.toml" in outcome.err


def test_a_table_that_is_a_pipe(short_signal, tmp_path, capsys):
    from vehicle.commands.sweep import main

    os.mkfifo(tmp_path / "pipe.csv")
    assert main(["--input", str(short_signal), "--table", str(tmp_path / "pipe.csv")]) == 3
    assert "not a file" in capsys.readouterr().err


FILM = [
    ["--slow-motion", "0.5"], ["--slow-motion", "nan"], ["--slow-motion", "inf"], ["--video-duration", "0"],
    ["--video-duration", "inf"], ["--exaggeration", "0"], ["--exaggeration", "nan"], ["--video-start", "-1"],
]  # fmt: skip


@pytest.mark.parametrize("option", FILM, ids=" ".join)
def test_film_options_are_refused_before_the_run(option, shaker, short_signal, tmp_path, monkeypatch):
    monkeypatch.setattr(Car, "run", lambda *_, **__: pytest.fail("the car was run"))
    outcome = shaker("--input", "short.csv", "--video", *option)
    assert outcome.code == 2 and f"{option[0]} {option[1]}: must be at least" in outcome.err
    assert not (tmp_path / "runs").exists()


def test_the_working_folder_is_refused_before_the_run(shaker, short_signal, tmp_path, monkeypatch):
    monkeypatch.setattr(Car, "run", lambda *_, **__: pytest.fail("the car was run"))
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path / "empty")
    outcome = shaker("--input", "../short.csv", "--output", ".", "--force")
    assert outcome.code == 2 and "is the current folder" in outcome.err


def test_a_wrong_wheel_or_channel_of_an_frf(car):
    with pytest.raises(ConfigurationError, match=r"wheel rr \(rear_right\): focus has no such wheel"):
        car.matrix_frf(["seat_rail_acc_z"], [10.0], wheel="rr")
    with pytest.raises(ConfigurationError, match="no acceleration channel 'seat'"):
        car.matrix_frf(["seat"], [10.0])


def test_an_unknown_opengl_backend(shaker, short_signal, monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "bogus")
    outcome = shaker("--input", "short.csv")
    assert outcome.code == 2 and outcome.err.startswith(
        "error: environment variable MUJOCO_GL=bogus: is not an OpenGL backend"
    )


@pytest.mark.parametrize("redirection", [">&-", ">/dev/full", ">&- 2>&-", "2>&-"])
def test_closed_and_full_streams(redirection, tmp_path):
    """The list of modes is the result: where nobody can read it, the exit code says so."""
    done = process("bash", "-c", f'"{sys.executable}" -m vehicle.modes --json {redirection}', cwd=tmp_path)
    assert done.returncode == (0 if redirection == "2>&-" else 6)
    assert done.stderr.count("\n") == (0 if "2>&-" in redirection else 1)


def test_a_file_name_that_standard_output_cannot_write(tmp_path):
    """A pipe of Windows has the encoding cp1252."""
    (tmp_path / "Größe Ω.csv").write_text(csv_text(GOOD))
    words = (sys.executable, "-m", "vehicle", "inspect", "Größe Ω.csv")
    done = process(*words, cwd=tmp_path, text=False, PYTHONIOENCODING="cp1252")
    assert done.returncode == 0
    assert "Größe \\u03a9.csv" in done.stdout.decode("cp1252")


def test_an_unforeseen_error_is_one_line_too(capsys):
    def job():
        raise LookupError("nobody thought of this")

    assert run_command(job) == 4
    assert capsys.readouterr().err.startswith(f"error: {FAULT} (LookupError: nobody thought of this)")
    assert run_command(job, debug=True) == 4
    assert "Traceback" in capsys.readouterr().err
