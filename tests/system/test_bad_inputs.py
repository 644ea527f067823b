"""Bad inputs and faults at the command line: exit code, one clear message, nothing half-written."""

import errno
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.patience import HANG
from tests.system.conftest import csv_text
from vehicle.runs.car import Car

ROOT = Path(__file__).resolve().parents[2]
GOOD = random_road(rms=1e-4, seed=1, wheel="fr", duration=4.0).displacement["fr"]


def _with(line: int, text: str) -> str:
    lines = csv_text(GOOD).splitlines()
    lines[line] = text
    return "\n".join(lines) + "\n"


SIGNALS = [
    ("1 empty file", "", 3, "empty"),
    ("1 header only", "time [s],displacement [m]\n", 3, "ends after the header"),
    ("2 not a number", _with(10, "0.009,#N/A"), 3, ":11:"),
    ("2 infinite", _with(10, "0.009,inf"), 3, ":11:"),
    ("3 uneven steps", csv_text(GOOD).replace("0.010000,", "0.010400,"), 3, "--resample"),
    ("4 repeated time", _with(12, "0.010000,1e-6"), 3, ":13"),
    ("5 no header", csv_text(GOOD, header="0.0,0.0"), 3, "displacement [m]"),
    ("6 decimal comma", csv_text(GOOD).replace(",", ";").replace(".", ","), 0, ""),
    ("7 millimetres as metres", csv_text(GOOD * 1e3), 3, "mm"),
    ("9 acceleration", csv_text(GOOD, header="time [s],acceleration [m/s2]"), 3, "displacement"),
    ("11 too slow", csv_text(GOOD[::50], rate=8.0), 3, "Hz"),
]


@pytest.mark.parametrize(("text", "code", "piece"), [case[1:] for case in SIGNALS], ids=[case[0] for case in SIGNALS])
def test_bad_signals(shaker, tmp_path, text, code, piece):
    (tmp_path / "signal.csv").write_text(text, encoding="utf-8")
    outcome = shaker("--input", "signal.csv", "--quiet")
    assert outcome.code == code, outcome.err
    if code:
        assert outcome.err.count("\n") == 1 and outcome.err.startswith("error: ")
        assert "signal.csv" in outcome.err and piece in outcome.err
        assert not (tmp_path / "runs").exists(), "nothing may be written"


SETTINGS = [
    ("20 NaN stiffness", "bushings.tyre.stiffness=[nan, 1e5, 1e5]", "bushings.tyre.stiffness: found nan"),
    ("50 sign of a product", "body.inertia.izx=-1800", "the sum of the two smaller at least the largest"),
    ("27 no such body", "body.superelement=nothing.toml", "body.superelement: the file 'nothing.toml' is neither"),
    ("30 unknown name", "damper.coulomb_fricton=100", "did you mean front.damper.coulomb_friction"),
    ("33 path in a name", 'body.superelement="../../secret.toml"', "must be a name of letters"),
]
"""Of each way to a refusal one; all values are in tests/model/parameters."""


@pytest.mark.parametrize(("setting", "piece"), [case[1:] for case in SETTINGS], ids=[case[0] for case in SETTINGS])
def test_bad_parameters(shaker, short_signal, tmp_path, setting, piece):
    outcome = shaker("--input", "short.csv", "--set", setting)
    assert outcome.code == 2, outcome.err
    assert outcome.err.count("\n") == 1 and piece in outcome.err
    assert not (tmp_path / "runs").exists()


def test_item_27_bad_superelement_beside_the_vehicle_file(shaker, short_signal, tmp_path):
    text = (ROOT / "vehicle/model/vehicles/focus/trimmed_body.toml").read_text()
    (tmp_path / "trimmed_body.toml").write_text(text.replace("mode_count = 9", "mode_count = 8"))
    focus = (ROOT / "vehicle/model/vehicles/focus/vehicle.toml").read_text()
    (tmp_path / "car.toml").write_text(focus.replace("body_design.toml", "trimmed_body.toml"))
    outcome = shaker("--input", "short.csv", "--vehicle", "car.toml")
    assert outcome.code == 3 and "mode_count" in outcome.err


def test_item_33_link_out_of_the_folder(shaker, short_signal, tmp_path):
    folder = tmp_path / "cars"
    folder.mkdir()
    (folder / "body_design.toml").symlink_to(ROOT / "vehicle/model/vehicles/focus/body_design.toml")
    (folder / "car.toml").write_text((ROOT / "vehicle/model/vehicles/focus/vehicle.toml").read_text())
    outcome = shaker("--input", "short.csv", "--vehicle", "cars/car.toml")
    assert outcome.code == 2 and "is a link to a file outside" in outcome.err


def test_item_35_existing_output(shaker, short_signal, tmp_path):
    kept = tmp_path / "runs" / "short" / "mine.txt"
    kept.parent.mkdir(parents=True)
    kept.write_text("mine")
    outcome = shaker("--input", "short.csv", "--output", "runs/short")
    assert outcome.code == 2 and "give --force" in outcome.err and kept.read_text() == "mine"
    outcome = shaker("--input", "short.csv", "--force")
    assert (
        outcome.code == 2
        and "files that are not results of a run: mine.txt" in outcome.err
        and kept.read_text() == "mine"
    )
    outcome = shaker("--input", "short.csv", "--engine", "reduced")
    assert outcome.code == 0 and "runs/short exists; writing runs/short-2" in outcome.err
    assert (tmp_path / "runs" / "short-2" / "summary.json").exists() and kept.read_text() == "mine"
    outcome = shaker("--input", "short.csv", "--output", ".", "--force")
    assert outcome.code == 2 and "contains the input" in outcome.err and short_signal.exists()


def test_item_35_output_that_cannot_be_written(shaker, short_signal, tmp_path):
    (tmp_path / "file").write_text("")
    outcome = shaker("--input", "short.csv", "--output", "file/run")
    assert outcome.code == 6 and "cannot be written" in outcome.err


def test_item_36_a_lost_state_gives_no_numbers(shaker, short_signal, tmp_path, monkeypatch):
    from vehicle.engines.simulation.plate_arrays import PlateBlock

    load, lost = PlateBlock._load, round(1.5 / Car.load().vehicle.solver.step)

    def break_down(self, offset):
        load(self, offset)
        self.height[max(lost - offset, 0) :] = np.nan

    monkeypatch.setattr(PlateBlock, "_load", break_down)
    outcome = shaker("--input", "short.csv")
    assert outcome.code == 4
    assert "no longer finite at t = 1.50" in outcome.err and "joint" in outcome.err
    assert outcome.out == "" and not (tmp_path / "runs" / "short").exists()
    saved = np.load(tmp_path / "runs" / "short.failed.npz", allow_pickle=False)
    assert 1.4 < float(saved["time"]) <= 1.51 and np.isfinite(saved["qpos"]).all()
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()


def test_item_38_interrupt(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-m", "vehicle.shaker", "--input", "high.csv"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + HANG
    while not (tmp_path / "runs" / ".high.partial").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert (tmp_path / "runs" / ".high.partial").exists(), "the run never began"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=HANG)
    assert process.returncode == 130
    assert said.strip().splitlines()[-1] == "error: interrupted; every file written so far is complete"
    assert not list(tmp_path.glob("runs/*")) and not list(tmp_path.glob("runs/.*"))


def test_item_39_full_disk(shaker, short_signal, tmp_path, monkeypatch):
    def full(path, *_, **__):
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr("vehicle.runs.output.run_files.write_frf", full)
    outcome = shaker("--input", "short.csv")
    assert outcome.code == 6 and "No space left on device" in outcome.err
    assert not list(tmp_path.glob("runs/*")) and not list(tmp_path.glob("runs/.*"))


def test_item_39_closed_pipe(tmp_path):
    command = (
        f'set -o pipefail; "{sys.executable}" -m vehicle.modes --json | head -c 1 >/dev/null; echo "${{PIPESTATUS[0]}}"'
    )
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"},
        capture_output=True,
        text=True,
        timeout=HANG,
    )
    assert done.stderr == "" and done.stdout.strip() in {"0", "6"}


def test_item_40_no_rendering_library(shaker, short_signal, tmp_path, monkeypatch):
    from vehicle.drawing.rendering import backend
    from vehicle.errors import MissingPartError

    def missing():
        raise MissingPartError("films need libOSMesa: apt-get install libosmesa6")

    monkeypatch.setattr(backend, "require_film", missing)
    outcome = shaker("--input", "short.csv", "--video")
    assert outcome.code == 5 and "libosmesa6" in outcome.err
    assert not (tmp_path / "runs").exists(), "refused before anything is simulated"


def test_usage_errors(shaker, short_signal):
    assert shaker().code == 2
    outcome = shaker("--input", "short.csv", "--wheel", "rear_left")
    assert (
        outcome.code == 2
        and ("wheel rl (rear_left): focus has no such wheel; choose from fr (front_right)") in outcome.err
    )
    outcome = shaker("--input", "short.csv", "--set", "damper")
    assert outcome.code == 2 and "PATH=VALUE" in outcome.err
