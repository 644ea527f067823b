"""`python -m scenarios.bump` as a user runs it, and how its numbers are read off."""

import json
import subprocess

import numpy as np
import pytest

from scenarios.bump.__main__ import extreme_claims, main
from scenarios.bump.figures import BANNER, HALF, side_by_side
from scenarios.bump.runs import FIGURE_AXES, relative_acceleration, ring_down_time, slip_after
from vehicle.excitation.bump import bump
from vehicle.rendering.backend import film_available, find_ffmpeg


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study") / "bump"
    assert main(["--output", str(folder), "--quick"]) == 0
    return folder


@pytest.fixture(scope="module")
def bump_run(car):
    return car.run(bump(amplitude=7.5e-3, duration=1.2, start=0.3, noise_rms=0.0))


def test_first_slips_and_what_is_not_judged(results):
    content = json.loads((results / "results.json").read_text(encoding="utf-8"))
    rows = {row["name"]: (row["status"], row["within"]) for row in content["rows"]}
    # By the slip velocity of all other rows the first slip is later than the end of stick, which the source saw.
    assert rows.pop("bump 7.5 mm, first slip against Fd") == ("predicted", True)
    assert rows.pop("bump 7.5 mm, first slip with Fd 125 N [s]")[0] == "predicted"
    assert {name: found for name, found in rows.items() if "est " not in name} == {
        "bump 7.5 mm, end of stick with Fd 125 N [s]": ("chosen", True),
        "bump 1.5 mm": ("chosen", True),
    }
    assert len(rows) == 2 + 2 * len(FIGURE_AXES)
    slip, end = (content[key]["125 N"] for key in ("first_slip_s", "first_saturated_s"))
    assert slip > end + 0.005
    assert content["slip_velocity"] == 0.012
    assert len(content["not_judged"]) == 5
    assert all(name.startswith("ring-down") for name in content["not_judged"])
    # The literal reading is twice as high, so it slips sooner; the source says later.
    assert "(literal): first slip 5.03" in (results / "results.md").read_text(encoding="utf-8")
    names = {path.name for path in results.glob("*.png")}
    assert {"histories_vertical.png", "histories_horizontal.png", "friction.png", "ring_down.png"} < names


def test_relative_acceleration_is_the_rate_of_the_damper_velocity(bump_run):
    relative = relative_acceleration(bump_run)
    rate = np.gradient(bump_run["damper_fr_velocity"], bump_run.time)
    # Differences of 1 ms smear the jumps at the ends of stick, and the strut turns a little: 10 % in the RMS.
    assert np.std(relative - rate) < 0.1 * np.std(relative)
    before = bump_run.time < 0.32
    # Stuck: what is left is the creep of the smooth law, under the vertical difference by rotation.
    vertical = bump_run["damper_top_fr_acc_z"] - bump_run["knuckle_fr_acc_z"]
    assert np.max(np.abs(relative[before])) < 0.5 * np.max(np.abs(vertical[before]))


def test_slip_after_is_told_as_if_the_bump_began_at_five_seconds(bump_run):
    at = slip_after(bump_run, 0.3, 1e-3)
    assert at is not None
    sample = np.argmin(np.abs(bump_run.time - (at - 4.7)))
    speed = np.abs(bump_run["damper_fr_velocity"])
    assert speed[sample] > 1e-3 >= speed[sample - 1]
    assert slip_after(bump_run, 0.3, 10.0) is None


def test_every_end_of_an_axis_is_a_row():
    inside = {point: (low[0] + 0.1, high[0] + 0.1) for point, (_, _, low, high) in FIGURE_AXES.items()}
    assert all(claim.within for claim in extreme_claims(inside, inside, "literal"))
    still = dict.fromkeys(FIGURE_AXES, (0.01, -0.01))
    assert [claim.within for claim in extreme_claims(still, still, "literal")] == [False] * 12


def test_ring_down_of_a_known_decay():
    time = np.arange(0.0, 10.0, 1e-3)
    rate, frequency = 1.2, 50.0
    motion = np.exp(-rate * time) * np.cos(2 * np.pi * frequency * time)
    motion[time < 1.0] *= 5.0  # the bump itself does not count
    # exp(-1.2 t) is down to a fifth after ln(5)/1.2; the last swing above it is at most half a period earlier.
    expected = np.log(5.0) / rate
    found = ring_down_time(time, motion, 1.0)
    assert expected - 0.5 / frequency - 1e-3 <= found <= expected + 1e-3
    assert np.isnan(ring_down_time(time[:1800], motion[:1800], 1.0))


def test_a_film_must_be_an_mp4(tmp_path, capsys):
    assert main(["--output", str(tmp_path / "out"), "--video", "film.avi", "--quick"]) == 2
    assert ".mp4" in capsys.readouterr().err


@pytest.mark.render
def test_the_film_shows_both_bumps_in_step(car, tmp_path):
    if (reason := film_available()) is not None:
        pytest.skip(reason)
    runs = [car.run(bump(amplitude=size, duration=1.0, start=0.3)) for size in (1.5e-3, 7.5e-3)]
    path = tmp_path / "film.mp4"
    side_by_side(path, runs, start=0.4, duration=0.1)
    command = [find_ffmpeg(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(command, capture_output=True, check=True)
    frames = np.frombuffer(done.stdout, dtype=np.uint8).reshape(-1, BANNER + HALF[1], 2 * HALF[0], 3)
    assert len(frames) == 3
    left, right = (frames[-1][BANNER:, here].astype(float) for here in (slice(HALF[0]), slice(HALF[0], None)))
    assert np.std(left) > 10.0
    # Another position and other captions; the compression alone makes 1.4 of 255 between two equal halves.
    assert 3.0 < np.mean(np.abs(left - right)) < 40.0
    # The line with the time is the same in both: 1.8 from the compression; two other digits make 3.3.
    clock = (slice(70, 94), slice(0, 130))
    assert np.std(left[clock]) > 20.0
    assert np.mean(np.abs(left[clock] - right[clock])) < 2.5
