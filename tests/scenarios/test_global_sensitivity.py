"""The global sensitivity from the command line, quick."""

import json

import numpy as np
import pytest

from scenarios.global_sensitivity import RANGES, _evaluate, main, points_of
from tests.studies.sweeps.sweep_samples import ShortRoad
from vehicle.errors import DataError
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.studies.sweeps.case_result import Result
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.sweep_table import SweepTable


def test_ranges_hold_the_car():
    vehicle = load_vehicle()
    for parameter in RANGES:
        # The path exists, both limits are accepted, and the car of the source lies between them.
        load_vehicle(None, [f"{parameter.path}={parameter.low}"])
        load_vehicle(None, [f"{parameter.path}={parameter.high}"])
        assert parameter.low <= value_of(vehicle, parameter.path) <= parameter.high, parameter.path


def test_points():
    assert points_of(12288, 1).shape == (12288, 10)
    assert points_of(12000, 1).shape == (512 * 12, 10)


def test_quick(tmp_path, capsys):
    arguments = ["--quick", "--output", str(tmp_path / "out"), "--executor"]
    arguments.append("tests.studies.sweeps.sweep_samples:threads")
    assert main(arguments) == 0
    assert " 0 failed" in capsys.readouterr().out
    files = {path.name for path in (tmp_path / "out").iterdir()}
    figures = {"indices.png", "weighted_indices.png"}
    assert {"results.md", "results.json", "table.csv", "sweep.json", "rows.jsonl", *figures} <= files
    content = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert np.all(np.isfinite(content["total"])) and len(content["total"]) == 10
    assert "engine reduced" in content["caption"]
    assert np.all(np.isfinite(content["weighted"]["total"])) and content["weighted"]["total"] != content["total"]
    # Going on computes nothing anew.
    assert main([*arguments, "--resume"]) == 0
    assert "# 0 runs computed" in (tmp_path / "out" / "timing.csv").read_text(encoding="utf-8")


def test_a_failed_run_is_named_by_the_indices(tmp_path):
    points = points_of(24, 1)
    cases = table_cases([parameter.path for parameter in RANGES], points.tolist(), [ShortRoad()])
    results = [Result(values={"unweighted": 1.0 + index, "weighted": 2.0}) for index in range(23)] + [
        Result(reason="no grip")
    ]
    table = SweepTable(cases=cases, results=results, units={"unweighted": "m/s2", "weighted": "m/s2"}, made={})
    with pytest.raises(DataError, match=r"1 of 2 base points have a failed run.* repeat with --retry-failed"):
        _evaluate(tmp_path, table, "caption")


def test_too_few_runs(tmp_path, capsys):
    assert main(["--runs", "5", "--output", str(tmp_path / "out")]) == 2
    assert "--runs 5: needed are at least 12 for 10 parameters" in capsys.readouterr().err
