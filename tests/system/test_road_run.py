"""A car on a road by the main job: the same plates as the road command, what the summary says, what is refused."""

import csv
import json

import numpy as np
import pytest

from vehicle.commands.road import main as road
from vehicle.commands.sweep import main as sweep
from vehicle.digits import number
from vehicle.runs.output.written_files import MARKER
from vehicle.signals.analysis.comfort import comfort_values
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal, write_signal


def test_the_run_meets_the_road_of_the_road_command(shaker, tmp_path):
    numbers = ["--speed", "80", "--duration", "6", "--seed", "3", "--coherence", "0.5", "--patch", "0.1"]
    outcome = shaker("--road", "b", *numbers, "--engine", "reduced")
    assert outcome.code == 0, outcome.err
    folder = tmp_path / "runs" / "road_B_80"
    summary = json.loads((folder / "summary.json").read_text())
    said = summary["input"]["road"]
    assert {key: said[key] for key in ("class", "profile", "speed_kmh", "seed", "coherence", "contact_patch_m")} == {
        "class": "B",
        "profile": None,
        "speed_kmh": 80.0,
        "seed": 3,
        "coherence": 0.5,
        "contact_patch_m": 0.1,
    }
    assert "G(0.1 cycles/m) = 6.4e-05 m3" in said["words"] and "80 km/h" in said["words"]
    assert summary["input"]["file"] == "road_B_80" and summary["input"]["plate_rms_m"]["fl"] > 0.0
    with (folder / "psd.csv").open(encoding="utf-8") as file:
        head = [line for _, line in zip(range(3), file, strict=False)][2].strip().split(",")
    assert summary["files"]["psd"] == "psd.csv" and head[:2] == ["frequency [Hz]", "knuckle_fr_acc_x [(m/s2)^2/Hz]"]
    table = np.genfromtxt(folder / "psd.csv", delimiter=",", skip_header=3)
    plates = [head.index(f"plate_{wheel}_displacement [(m)^2/Hz]") for wheel in ("fr", "fl")]
    frequency, density = table[:, 0], table[:, plates].mean(axis=1)
    band = (frequency > 3.0) & (frequency < 30.0)
    # G(n0) n0^2 V / f^2 less the contact patch; both tracks hold it together, two windows of it are left to chance.
    patch = np.sinc(frequency[band] / (80.0 / 3.6) * 0.1) ** 2
    share = np.mean(density[band] * frequency[band] ** 2 / patch) / (64e-6 * 0.1**2 * 80.0 / 3.6)
    assert share == pytest.approx(1.0, abs=0.15)
    assert road(["--class", "B", *numbers, "--quiet"]) == 0
    written = read_signal("road.csv", accept_implausible=True)
    with np.load(folder / "time.npz") as arrays:
        for wheel in ("fr", "fl"):
            # Seven digits in the file; the integrator's steps are the samples of the road.
            np.testing.assert_allclose(arrays[f"plate_{wheel}_displacement"], written.displacement[wheel], atol=2e-8)


def test_plates_that_follow_later_run_on_a_road_without_frfs(shaker, tmp_path):
    """One track, one behind the other: no FRF can be had, everything else can."""
    time = np.arange(8001) / 1000.0
    wave = np.random.default_rng(1).normal(size=(9001,)).cumsum() * 2e-5
    wave *= np.minimum(np.arange(9001) / 1000.0, 1.0)
    plates = {"fr": wave[1000:] - wave[1000], "fl": wave[:8001]}
    write_signal(tmp_path / "late.csv", Signal(time=time, displacement=plates))
    assert "or run without FRFs with --any-level" in shaker("--input", "late.csv").err
    outcome = shaker("--input", "late.csv", "--any-level", "--engine", "reduced")
    assert outcome.code == 0, outcome.err
    folder = tmp_path / "runs" / "late"
    files = {"summary.json", "vehicle.toml", "time.npz", "time.png"}
    assert {path.name for path in folder.iterdir()} == files | {MARKER}
    summary = json.loads((folder / "summary.json").read_text())
    assert set(summary["files"].values()) == files and summary["frf"] is None and summary["input"]["road"] is None
    assert "no FRFs: excitations: plate_fl_displacement" in outcome.out
    assert not any(summary["peaks"].values())
    assert summary["comfort"]["seat_rail"]["rms_2_50_hz"]["z"] > 0.0
    assert "±" not in outcome.out


def test_seeds_of_a_road_give_the_error_of_a_difference(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments = ["--vehicle", "focus_road", "--vary", "*.damper.coulomb_friction=20,90", "--engine", "reduced"]
    arguments += ["--road", "A", "--speed", "100", "--duration", "4", "--output", "out", "--quiet"]
    assert sweep([*arguments, *(word for seed in "123" for word in ("--seed", seed))]) == 0
    with (tmp_path / "out" / "table.csv").open(encoding="utf-8", newline="") as file:
        comfort = {(row["input"], row["*.damper.coulomb_friction"]): float(row["unweighted [m/s2]"])
                   for row in csv.DictReader(file)}  # fmt: skip
    with (tmp_path / "out" / "differences.csv").open(encoding="utf-8", newline="") as file:
        *each, _, mean = csv.DictReader(file)
    gaps = [comfort[f"road_A_100_seed_{seed}", "90"] - comfort[f"road_A_100_seed_{seed}", "20"] for seed in (1, 2, 3)]
    assert len(each) == 6 and mean["input"] == "road_A_100, mean of 3 seeds"
    assert float(mean["difference [m/s2]"]) == pytest.approx(np.mean(gaps), rel=1e-4)
    error = np.std(gaps, ddof=1) / np.sqrt(3)
    assert float(mean["standard_error_of_difference [m/s2]"]) == pytest.approx(error, rel=1e-4)
    assert float(mean["half_width_95 [m/s2]"]) == pytest.approx(4.303 * error, rel=1e-3)
    assert sweep([*arguments, "--force", "--seed", "1", "--seed", "1"]) == 2


def test_a_road_is_evaluated_from_two_seconds_on(shaker, tmp_path):
    given = ["--road", "B", "--speed", "80", "--duration", "5", "--engine", "reduced"]
    outcome = shaker(*given)
    assert outcome.code == 0 and "5 s, evaluated from 2 to 5 s, plate RMS" in outcome.out
    folder = tmp_path / "runs" / "road_B_80"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["evaluated_s"] == [2.0, 5.0]
    with np.load(folder / "time.npz") as arrays:
        time, rail = arrays["time"], [arrays[f"seat_rail_acc_{axis}"] for axis in "xyz"]
        velocity = arrays["damper_fr_velocity"]
    late = (time >= 2.0 - 1e-9) & (time < 5.0 - 1e-9)
    value = comfort_values(time[1] - time[0], [[record[late] for record in rail]])
    expected, half = value.overall[0], summary["comfort"]["seat_rail"]["half_interval"]
    assert half["unweighted"] == pytest.approx(1.96 * value.error[0] * expected, rel=1e-9)
    assert "only 2 wheels" in outcome.out and "(rear support right, rear support left)" in outcome.out
    percent = number(100.0 * half["unweighted"] / expected, 2)
    assert f"seat rail {expected:.4f} m/s2 ± {percent} % unweighted RMS" in outcome.out
    # 3 s are too short for the error by the linear car.
    assert " % weighted RMS (ISO 2631-1); ±: 95 % interval over roads of class B\n" in outcome.out
    assert "explained_by_linear_car" not in summary["comfort"]["seat_rail"]
    assert summary["comfort"]["seat_rail"]["rms_2_50_hz"]["overall"] == pytest.approx(expected, rel=1e-9)
    assert summary["comfort"]["seat_rail"]["iso2631"]["duration_s"] == pytest.approx(3.0, abs=2e-3)
    limit = summary["slip_share"]["slip_velocity"]
    assert summary["slip_share"]["fr"] == pytest.approx(np.mean(np.abs(velocity[late]) > limit), abs=1e-9)
    assert "from 2 s on" in (folder / "psd.csv").read_text(encoding="utf-8")[:200]
    # Slower than 19 km/h the last wheel rises late; a wheelbase of 2.615 m takes 1.88 s at 5 km/h.
    assert RoadDrive(road="B", speed=5.0, wheels=(("fr", 0.0, "right"), ("rr", 2.615, "right")), track=1.5).skip == 3.4
    for skip, refusal in (
        ("-1", ": must be at least 0"),
        ("nan", ": must be at least 0"),
        ("5", " s: must be at least 0 and below the 5 s"),
    ):
        outcome = shaker(*given, "--output", "other", "--skip", skip)
        assert outcome.code == 2 and f"--skip {skip}{refusal}" in outcome.err
    assert "the 1.5 s of road_B_80; choose a longer --duration" in shaker(*given, "--duration", "1.5").err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "set --input FILE, or a road, for example --road C --speed 80"),
        (["--road"], "--road: the road is missing; give a class of ISO 8608 (A to H) or FILE.csv"),
        (["--road", "C"], "the speed on the road is missing"),
        (["--road", "Z", "--speed", "80"], "road class 'Z': must be one of A, B"),
        (
            ["--road", "none.csv", "--speed", "80"],
            "--road none.csv: unknown; give a class of ISO 8608 (A to H), the file of a measured profile, an obstacle",
        ),
        (["--road", "C", "--speed", "80", "--input", "low.csv"], "--road C and --input exclude each other"),
        (
            ["--road", "C", "--speed", "80", "--wheel", "front_left"],
            "--wheel: belongs to --input (a road moves the plates of all",
        ),
        (["--road", "C", "--speed", "80", "--remove-mean"], "--remove-mean: belongs to --input"),
        (["--input", "low.csv", "--speed", "80"], "--speed: belongs to a road, for example --road C --speed 80"),
        (["--input", "low.csv", "--any-level", "--seed", "2"], "--seed: belongs to a road class of ISO 8608"),
    ],
)
def test_refusals(shaker, tmp_path, arguments, message):
    outcome = shaker(*arguments)
    assert outcome.code == 2 and message in outcome.err
    assert not (tmp_path / "runs").exists()


def test_the_rear_plates_follow_by_the_wheelbase_over_the_speed(shaker, tmp_path):
    """2.615 m at 94.14 km/h are 100 ms: a hundred samples later the rear plates do the same, to rounding."""
    outcome = shaker(
        *("--road", "B", "--speed", "94.14", "--duration", "5", "--vehicle", "focus_road", "--engine", "reduced")
    )
    assert outcome.code == 0, outcome.err
    folder = tmp_path / "runs" / "road_B_94.14"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["input"]["road"]["behind_m"] == pytest.approx({"fr": 0.0, "fl": 0.0, "rr": 2.615, "rl": 2.615})
    with np.load(folder / "time.npz") as arrays:
        plates = {wheel: arrays[f"plate_{wheel}_displacement"] for wheel in ("fr", "fl", "rr", "rl")}
    for front, rear in (("fr", "rr"), ("fl", "rl")):
        # Before, at rest but for the rounding of the spline.
        assert np.std(plates[front]) > 1e-3 and np.ptp(plates[rear][:100]) < 1e-20
        # An input is a spline through the samples at the steps of the engine: rounding alone.
        np.testing.assert_allclose(plates[rear][100:], plates[front][:-100], rtol=0.0, atol=1e-12)
    assert np.std(plates["fr"] - plates["fl"]) > 1e-3
    # The rear plates repeat the front ones on every road: no FRF, and no advice that nobody can follow.
    assert summary["frf"] is None and not any("no FRF" in notice for notice in summary["notices"])
    assert "(front right)" in outcome.out and "(rear left)" in outcome.out
