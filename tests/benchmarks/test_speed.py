"""The benchmark runs and says what it should; times are not judged here."""

from __future__ import annotations

import json
import os

import pytest

from tests.benchmarks import speed

SMALL = speed.Effort(repeats=1, steps=50, seconds=0.5)
KEYS = {"rows", "dof", "timestep", "step_us", "python_step_us", "plain_step_us", "realtime_factor", "rms_error"}


@pytest.fixture(autouse=True)
def same_cores_afterwards():
    before = os.sched_getaffinity(0)
    yield
    os.sched_setaffinity(0, before)


def test_benchmark_prints_and_compares(tmp_path, capsys):
    assert speed.main(["--json"], SMALL) == 0
    text = capsys.readouterr().out
    found = json.loads(text)
    assert set(found) == KEYS == set(speed.SHOWN)
    assert (found["rows"], found["dof"]) == (102, 63)
    assert all(value > 0.0 for value in found.values())
    (tmp_path / "before.json").write_text(text)
    assert speed.main(["--compare", str(tmp_path / "before.json")], SMALL) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(KEYS) and all("before" in line for line in lines)
    assert len(os.sched_getaffinity(0)) == 1


def test_the_plain_step_moves_the_car(car):
    # A car at rest would let the solver stop at once, and the plain step would look faster than it is.
    signal = speed.piece(0.5)
    assert speed.stepping_time(car, signal, 50, form="plain") > 0.0
    assert max(abs(signal.displacement["fr"])) > 1e-5
