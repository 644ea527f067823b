"""The main job end to end: files, keys, round trips, reproducibility."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from tests.benchmarks.frf_accuracy import banded_input
from tests.patience import HANG
from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.template import SHIPPED
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.runs.output.written_files import MARKER, written
from vehicle.runs.report import page
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import write_signal

ROOT = Path(__file__).parents[2]
FILES = {"summary.json", "vehicle.toml", "time.npz", "frf.csv", "frf.png", "time.png"}


def test_a_run_has_all_files_and_keys(shaker, short_signal, tmp_path):
    outcome = shaker("--input", "short.csv", "--set", "damper.coulomb_friction=100")
    assert outcome.code == 0, outcome.err
    folder = tmp_path / "runs" / "short"
    assert {path.name for path in folder.iterdir()} == FILES | {MARKER}
    assert set(written(folder)) == FILES | {MARKER}
    assert not list((tmp_path / "runs").glob(".*")), "temporary files must be gone"
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()

    summary = json.loads((folder / "summary.json").read_text())
    assert set(summary["input"]) >= {"file", "sha256", "rms_m", "duration_s", "wheel"}
    assert summary["input"]["rms_m"] == pytest.approx(5.25e-4, rel=1e-5)  # six digits in the file
    assert set(summary["slip_share"]) == {"fr", "fl", "slip_velocity"}
    assert set(summary["friction_saturated_share"]) == set(summary["first_slip_s"]) == {"fr", "fl"}
    assert summary["input"]["wheel"] == "fl", "the wheel of the vehicle file"
    assert summary["friction_saturated_share"]["fl"] >= summary["slip_share"]["fl"] > 0.0
    # One velocity for share and first time; the friction is saturated sooner, and has its own key.
    with np.load(folder / "time.npz") as arrays:
        first = arrays["time"][np.abs(arrays["damper_fl_velocity"]) > summary["slip_share"]["slip_velocity"]][0]
    assert summary["first_slip_s"]["fl"] == pytest.approx(first, abs=1e-9)
    assert summary["first_friction_saturated_s"]["fl"] < summary["first_slip_s"]["fl"]
    assert f"{number(100 * summary['slip_share']['fl'])} % (left) of the time, first at {first:.3g} s" in outcome.out
    assert set(summary["comfort"]["seat_rail"]["rms_2_50_hz"]) == {"x", "y", "z", "overall"}
    assert set(summary["static"]) == {"tyre_load_n", "rear_support_load_n", "residual_m"}
    assert summary["static"]["residual_m"] < 1e-6
    assert summary["solver"]["energy_residual"] < 5e-3  # six seconds end in motion; whole runs reach 1e-3
    assert set(summary["peaks"]) == set(load_vehicle().acceleration_channels)
    assert set(summary["files"].values()) == FILES

    record = np.load(folder / "time.npz", allow_pickle=False)
    assert set(record.files) == {"time", "units", "frame", *load_vehicle().channels}
    assert all(np.isfinite(record[name]).all() for name in load_vehicle().channels)
    assert np.allclose(np.diff(record["time"]), 1e-3, rtol=1e-9)

    used = load_vehicle(folder / "vehicle.toml")
    assert used.damper.coulomb_friction == 100.0
    assert used == load_vehicle(None, ["damper.coulomb_friction=100"])

    header = (folder / "frf.csv").read_text().splitlines()[1].split(",")
    assert header[0] == "frequency [Hz]"
    assert header[1:5] == [
        "knuckle_fr_acc_x_magnitude",
        "knuckle_fr_acc_x_phase [deg]",
        "knuckle_fr_acc_x_coherence",
        "knuckle_fr_acc_x_random_error",
    ]
    assert len(header) == 1 + 4 * len(load_vehicle().acceleration_channels)
    for word in ("damper", "resonances", "comfort", "solver", "files"):
        assert word in outcome.out


def test_the_numbers_are_printed_before_the_report_is_made(shaker, short_signal, tmp_path, monkeypatch):
    """A film and a report take longer than the run, and may fail."""

    def fails(runs, progress, **head):
        raise DataError("no report")

    monkeypatch.setattr(page, "report_page", fails)
    outcome = shaker("--input", "short.csv", "--engine", "reduced", "--no-figures", "--report")
    assert (outcome.code, outcome.err.splitlines()[-1]) == (3, "error: no report")
    assert "comfort     seat rail" in outcome.out and "files  " not in outcome.out
    assert not (tmp_path / "runs" / "short").exists()


def test_without_figures_the_other_files_are_the_same_and_no_drawing_library_is_loaded(short_signal, tmp_path):
    code = (
        "import sys\n"
        "from vehicle.commands.shaker import main\n"
        "code = main(sys.argv[1:])\n"
        "slow = ('matplotlib', 'matplotlib.pyplot')\n"
        "print(code, [name for name in slow if name in sys.modules])"
    )
    options = ["--input", "short.csv", "--engine", "reduced", "--quiet", "--output"]
    printed = []
    for folder in (["without", "--no-figures"], ["with"]):
        command = [sys.executable, "-c", code, *options, *folder]
        done = subprocess.run(
            command,
            cwd=tmp_path,
            env=os.environ | {"PYTHONPATH": str(ROOT)},
            capture_output=True,
            text=True,
            timeout=HANG,
        )
        printed.append(done.stdout.strip() + done.stderr)
    assert printed == ["0 []", "0 ['matplotlib']"]
    assert {path.name for path in (tmp_path / "without").iterdir()} == (FILES | {MARKER}) - {"frf.png", "time.png"}
    for name in ("frf.csv", "time.npz", "vehicle.toml"):
        assert (tmp_path / "without" / name).read_bytes() == (tmp_path / "with" / name).read_bytes(), name
    files = json.loads((tmp_path / "without" / "summary.json").read_text())["files"]
    assert set(files) == {"summary", "vehicle", "time", "frf"}


def test_what_was_repaired_and_what_has_no_effect_is_said(shaker, short_signal, tmp_path):
    settings = ["--set", "damper.stribeck_velocity=0.05", "--engine", "reduced"]
    for ixx, repaired in ((1000, True), (1200, False)):
        outcome = shaker("--input", "short.csv", "--set", f"body.inertia.ixx={ixx}", *settings, "--force")
        assert outcome.code == 0, outcome.err
        notices = json.loads((tmp_path / "runs" / "short" / "summary.json").read_text())["notices"]
        assert any("The inertia tensor breaks the triangle inequality" in text for text in notices) is repaired
        # The console leaves out what holds for every run of the shipped car, which no user can change.
        assert "triangle inequality" not in outcome.out and "the car has no seat" not in outcome.out
        assert "note        damper.stribeck_velocity=0.05: has no effect; it acts only with " in outcome.out


def test_the_same_command_twice_gives_the_same_bytes(shaker, short_signal, tmp_path):
    for folder in ("first", "second"):
        assert shaker("--input", "short.csv", "--output", folder, "--engine", "reduced", "--quiet").code == 0
    for name in ("frf.csv", "time.npz", "vehicle.toml", "frf.png", "time.png"):
        assert (tmp_path / "first" / name).read_bytes() == (tmp_path / "second" / name).read_bytes(), name


def test_a_run_repeats_from_its_own_vehicle_file(shaker, short_signal, tmp_path):
    options = ["--set", "bushings.suspension_mount.stiffness=[3e6, 3e6, 8e5]", "--timestep", "0.0005", "--quiet"]
    assert shaker("--input", "short.csv", "--output", "first", *options).code == 0
    outcome = shaker("--input", "short.csv", "--output", "again", "--vehicle", "first/vehicle.toml", "--quiet")
    assert outcome.code == 0 and outcome.out == ""
    assert (tmp_path / "first" / "frf.csv").read_bytes() == (tmp_path / "again" / "frf.csv").read_bytes()


def test_right_wheel_and_text_histories(shaker, short_signal, tmp_path):
    outcome = shaker("--input", "short.csv", "--wheel", "front_right", "--time-format", "csv")
    assert outcome.code == 0, outcome.err
    folder = tmp_path / "runs" / "short"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["input"]["wheel"] == "fr"
    assert summary["slip_share"]["fr"] > summary["slip_share"]["fl"]
    lines = (folder / "time.csv").read_text().splitlines()
    assert lines[1].startswith("time [s],knuckle_fr_acc_x [m/s2]")
    assert len(lines) == 2 + 6001


def test_modes_command(capsys):
    from vehicle.commands.modes import main

    assert main(["--damper", "stuck", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    frequencies = [mode["frequency_hz"] for mode in found["modes"]]
    assert frequencies == sorted(frequencies) and frequencies[-1] < 60.0
    for mode in found["modes"]:
        assert set(mode) == {"frequency_hz", "damping_ratio", "description", "energy", "motions"}
        assert sum(mode["energy"].values()) == pytest.approx(1.0, rel=1e-9)  # shares of one sum
    assert main(["--damper", "sliding"]) == 0
    assert "front wheel hop, sides in phase" in capsys.readouterr().out


def test_a_run_of_an_own_template_and_body_repeats_from_its_folder(shaker, short_signal, tmp_path):
    """The run keeps the templates, those that they use, and the body that lay beside the vehicle file."""
    mine = tmp_path / "mine"
    (mine / "templates").mkdir(parents=True)
    strut = (SHIPPED / "macpherson.toml").read_text(encoding="utf-8").replace('"anti_roll_bar"', '"bar"')
    (mine / "strut.toml").write_text(strut, encoding="utf-8")
    shutil.copy(SHIPPED / "anti_roll_bar.toml", mine / "templates" / "bar.toml")
    body = (FOCUS_FILE.parent / "body_design.toml").read_text(encoding="utf-8")
    (mine / "shell.toml").write_text(body.replace("damping_ratio = 0.03", "damping_ratio = 0.05"), encoding="utf-8")
    text = FOCUS_FILE.read_text(encoding="utf-8").replace('"macpherson"', '"strut"').replace("body_design", "shell")
    (mine / "car.toml").write_text(text, encoding="utf-8")
    common = ("--input", "short.csv", "--engine", "reduced")
    assert shaker(*common, "--vehicle", "mine/car.toml", "--output", "one").code == 0
    shutil.rmtree(mine)
    files = json.loads((tmp_path / "one" / "summary.json").read_text(encoding="utf-8"))["files"]
    assert {files["template_strut"], files["template_bar"], files["body_shell"]} == {
        "templates/strut.toml", "templates/bar.toml", "shell.toml"
    }  # fmt: skip
    outcome = shaker(*common, "--vehicle", "one/vehicle.toml", "--output", "two")
    assert outcome.code == 0, outcome.err
    one, two = (np.load(tmp_path / name / "time.npz") for name in ("one", "two"))
    for name in one.files:
        np.testing.assert_array_equal(one[name], two[name])


def test_published_modes(capsys):
    """Source 1: six rigid body modes below 10 Hz, roll at 6.5 Hz, engine 9 to 20 Hz, right wheel at 28 Hz."""
    from vehicle.commands.modes import main

    rolls = {}
    for ixx in (1000, 1200):
        assert main(["--json", "--set", f"body.inertia.ixx={ixx}"]) == 0
        modes = json.loads(capsys.readouterr().out)["modes"]
        rolls[ixx] = next(m["frequency_hz"] for m in modes if m["description"].startswith("body roll"))
        rigid = [mode for mode in modes if mode["description"].startswith("body ")]
        assert len(rigid) == 6 and rigid[-1]["frequency_hz"] < 10.0
        engine = [mode["frequency_hz"] for mode in modes if mode["description"].startswith("engine")]
        assert len(engine) >= 5 and min(engine) > 9.0 and max(engine) < 20.0
        # Lightly damped, so not the longitudinal ones. Neighbours of the body share its energy.
        wheel = [m for m in modes if m["energy"].get("wheel_fr", 0.0) > 0.15 and m["damping_ratio"] < 0.2]
        assert any(abs(mode["frequency_hz"] - 28.0) < 0.5 for mode in wheel)
    assert rolls[1000] == pytest.approx(6.5, abs=0.3)
    assert rolls[1200] < 0.9 * rolls[1000]


def test_two_plates_are_told_apart(shaker, tmp_path):
    """Independent signals under both wheels: the FRF to the right plate is that of the right plate alone."""
    signals = {
        wheel: random_road(rms=1e-5, seed=seed, duration=24.0, wheel=wheel).displacement[wheel]
        for wheel, seed in (("fr", 1), ("fl", 2))
    }
    time = np.arange(signals["fr"].size) / 1000.0
    write_signal(tmp_path / "both.csv", Signal(time=time, displacement=signals))
    outcome = shaker("--input", "both.csv", "--engine", "reduced")
    assert outcome.code == 0, outcome.err
    folder = tmp_path / "runs" / "both"
    summary = json.loads((folder / "summary.json").read_text())
    assert set(summary["input"]["plate_rms_m"]) == {"fr", "fl"} and min(summary["input"]["plate_rms_m"].values()) > 9e-6
    assert any("independently" in notice and "each of fr, fl" in notice for notice in summary["notices"])
    assert [one["plates"] for one in summary["frf"]["to"]] == [{"fr": 1.0}, {"fl": 1.0}]
    table = np.genfromtxt(folder / "frf.csv", delimiter=",", skip_header=3)
    heads = (folder / "frf.csv").read_text().splitlines()[2].split(",")
    band = (table[:, 0] >= 8.0) & (table[:, 0] <= 45.0)
    assert [one["columns"] for one in summary["frf"]["to"]] == ["<channel>/plate_fr", "<channel>/plate_fl"]
    for wheel, channel in (("fr", "knuckle_fr_acc_z"), ("fl", "knuckle_fr_acc_z"), ("fl", "knuckle_fl_acc_z")):
        head = f"{channel}/plate_{wheel}"
        column = heads.index(f"{head}_magnitude")
        exact = np.abs(Car.load().matrix_frf([channel], table[band, 0], wheel=wheel)[0])
        # A single-input estimate would miss the other plate's share altogether.
        error = np.sqrt(np.mean((table[band, column] - exact) ** 2) / np.mean(exact**2))
        assert error < 0.03, head
    for wheel in ("fr", "fl"):
        assert f"resonances  knuckle_{wheel}_acc_z/plate_{wheel}: " in outcome.out
    outcome = shaker("--input", "both.csv", "--wheel", "front_left", "--force")
    assert outcome.code == 2 and "already state their wheels" in outcome.err


def test_two_plates_that_move_alike_give_the_common_response():
    signal = random_road(rms=1e-5, seed=1, wheel="fr", duration=22.0)
    both = Signal(time=signal.time, displacement=dict.fromkeys(("fr", "fl"), signal.displacement["fr"]))
    run = Car.load().run(both)
    response = run.frf(["seat_rail_acc_z"])
    assert "move alike" in response.reasons[0] and "common motion" in response.reasons[0]
    assert response.response.shape[0] == 1


def test_a_plate_that_follows_the_other_later_is_refused_before_the_run(shaker, tmp_path):
    right = random_road(rms=1e-5, seed=1, wheel="fr", duration=24.0).displacement["fr"]
    left = np.concatenate([np.zeros(1500), right[:-1500]])
    time = np.arange(right.size) / 1000.0
    write_signal(tmp_path / "late.csv", Signal(time=time, displacement={"fr": right, "fl": left}))
    outcome = shaker("--input", "late.csv")
    assert outcome.code == 3 and "plate fl is 1 times plate fr, delayed by 1.5 s" in outcome.err
    assert not (tmp_path / "runs" / "late").exists()


@pytest.mark.parametrize("window", [None, 4.0])
def test_plates_at_rest_have_no_frf_and_one_that_moves_is_taken(window):
    road = random_road(rms=1e-5, seed=1, wheel="fr", duration=24.0)
    still = np.zeros(road.time.size)
    run = Car.load().run(Signal(time=road.time, displacement={"fr": still}), engine="reduced")
    with pytest.raises(DataError, match="no plate moves"):
        run.frf(window=window)
    signal = Signal(time=road.time, displacement={"fr": still, "fl": road.displacement["fr"]})
    run = Car.load().run(signal, engine="reduced")
    found = run.frf(["knuckle_fl_acc_z"], window=window)
    inside = (found.frequency > 10.0) & (found.frequency < 40.0)
    truth = run.car.matrix_frf(["knuckle_fl_acc_z"], found.frequency[inside], wheel="fl")
    assert np.linalg.norm(found.response[:, inside] - truth) < 0.1 * np.linalg.norm(truth)


def test_a_band_limited_input_has_frf_and_resonances_in_its_band_only(shaker, tmp_path):
    """Displacement of 3 to 30 Hz, rounded to 0.3 um, at 2048 Hz; then a sine of 28.4 Hz."""
    values = banded_input(30.0, np.random.default_rng(1))
    ramp = np.minimum(1.0, np.minimum(np.arange(values.size), np.arange(values.size)[::-1]) / 2048.0)
    time = np.arange(values.size) / 2048.0
    for name, signal in (("band", values), ("sine", 0.4e-3 * np.sin(2.0 * np.pi * 28.4 * time))):
        plate = np.round(signal * ramp / 3e-7) * 3e-7
        write_signal(tmp_path / f"{name}.csv", Signal(time=time, displacement={"fl": plate}))
        outcome = shaker("--input", f"{name}.csv", "--engine", "reduced")
        assert outcome.code == 0, outcome.err
        folder = tmp_path / "runs" / name
        summary = json.loads((folder / "summary.json").read_text())
        tops = [peak["frequency_hz"] for peaks in summary["peaks"].values() for peak in peaks]
        table = np.genfromtxt(folder / "frf.csv", delimiter=",", skip_header=2)
        told = np.isfinite(table[:, 1:]).any(axis=1)
        assert any("weaker than its rounding errors and leakage" in notice for notice in summary["notices"])
        if name == "band":
            assert tops and min(tops) > 2.9 and max(tops) < 30.1
            inside = (table[:, 0] >= 3.0) & (table[:, 0] <= 30.0)
            assert np.sum(told & ~inside) <= 2 and np.mean(told[inside]) > 0.98
            low, high = summary["frf"]["degrees_of_freedom_range"]
            assert 0.0 < low < summary["frf"]["degrees_of_freedom"] < high
        else:
            assert not tops and not told.any() and summary["frf"]["degrees_of_freedom"] is None


def keys_of(content, path=""):
    """Dotted names of all keys of nested dictionaries."""
    found = set()
    for key, value in content.items():
        found.add(f"{path}{key}")
        if isinstance(value, dict):
            found |= keys_of(value, f"{path}{key}.")
    return found


def test_the_reduced_engine_gives_the_same_files_and_keys(shaker, short_signal, tmp_path):
    summaries = {}
    for engine in ("mujoco", "reduced"):
        outcome = shaker("--input", "short.csv", "--output", engine, "--engine", engine)
        assert outcome.code == 0, outcome.err
        assert f"solver      {engine}, step" in outcome.out
        summaries[engine] = json.loads((tmp_path / engine / "summary.json").read_text(encoding="utf-8"))
    one, other = summaries["mujoco"], summaries["reduced"]
    assert keys_of(one) == keys_of(other)
    assert {path.name for path in (tmp_path / "mujoco").iterdir()} == {p.name for p in (tmp_path / "reduced").iterdir()}
    assert other["solver"]["engine"] == "reduced" and other["solver"]["energy_residual"] is None
    # The demand of the project for slip; comfort within what both engines differ by over six seconds.
    assert abs(one["slip_share"]["fr"] - other["slip_share"]["fr"]) < 3e-3
    comfort = [summary["comfort"]["seat_rail"]["rms_2_50_hz"]["overall"] for summary in (one, other)]
    assert comfort[0] == pytest.approx(comfort[1], rel=5e-3)


@pytest.mark.parametrize("option", [["--video"], ["--timestep", "0.0005"]])
def test_the_reduced_engine_refuses_what_it_cannot_do(option, shaker, short_signal, tmp_path):
    outcome = shaker("--input", "short.csv", "--engine", "reduced", *option)
    assert outcome.code == 2 and f"{option[0]}: the reduced engine" in outcome.err
    assert not (tmp_path / "runs").exists()
