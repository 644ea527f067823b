"""The benchmark runs and says what it should; times are not judged here."""

import json
import os

import mujoco
import pytest

from tests.benchmarks import speed

SMALL = speed.Effort(repeats=1, starts=0, steps=50, seconds=0.25, accuracy_seconds=0.25, cases=1)
TIMES = {"step_us", "plain_step_us", "realtime_factor", "reduced_realtime_factor"}
TIMES |= {"reduced_few_realtime_factor", "four_wheel_step_us", "four_wheel_step_ratio"}
TIMES |= {"four_wheel_reduced_realtime_factor", "batch_realtime_factor", "case_ms", "import_ms", "first_car_ms"}
TIMES |= {"shaker_ms", "kernel_ms", "run_ms", "four_wheel_run_ms", "reduced_run_ms", "reduced_bare_ms"}
TIMES |= {"reduced_few_ms", "four_wheel_reduced_ms", "four_wheel_bare_ms", "batch_ms"}
SHARES = {"stated_errors_share", "four_wheel_stated_errors_share"}
COUNTS = {"rows", "dof", "four_wheel_rows", "four_wheel_dof"}
KEYS = {*COUNTS, *SHARES, "timestep", *TIMES, "rms_error", "rms_error_channel", "slip_error", "reduced_rms_error"}
PARTS = {"parts_us", "plain_parts_us"}


@pytest.fixture(autouse=True)
def same_cores_afterwards():
    before = os.sched_getaffinity(0)
    yield
    os.sched_setaffinity(0, before)


def test_benchmark_prints_and_compares(tmp_path, capsys, monkeypatch):
    figures = speed.measure(SMALL)
    monkeypatch.setattr(speed, "measure", lambda effort: figures)
    assert speed.main(["--json"], SMALL) == 0
    text = capsys.readouterr().out
    found = json.loads(text)
    assert set(found) == KEYS | PARTS | {"ratios"} and set(speed.SHOWN) == KEYS
    assert (found["rows"], found["dof"]) == (66, 63)
    assert (found["four_wheel_rows"], found["four_wheel_dof"]) == (120, 113)
    assert all(found[name] > 0.0 for name in TIMES) and all(found[name] < 1.0 for name in SHARES)
    assert found["ratios"]["run_ms"] == pytest.approx(found["run_ms"] / found["kernel_ms"])
    for parts in (found["parts_us"], found["plain_parts_us"]):
        assert set(parts) == {"step", *speed.PARTS} and all(value > 0.0 for value in parts.values())
        assert sum(parts[name] for name in speed.PARTS) <= parts["step"]
    (tmp_path / "before.json").write_text(text)
    assert speed.main(["--compare", str(tmp_path / "before.json")], SMALL) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(KEYS) + 2 + len(speed.PARTS)
    assert sum("before" in line for line in lines) == len(KEYS) - 1
    assert mujoco.get_mjcb_time() is None
    assert len(os.sched_getaffinity(0)) == 1


def test_the_plain_step_moves_the_car(car):
    # A car at rest would let the solver stop at once, and the plain step would look faster than it is.
    signal = speed.piece(0.5)
    assert speed.stepping_time(car, signal, 50, form="plain") > 0.0
    assert max(abs(signal.displacement["fr"])) > 1e-5
