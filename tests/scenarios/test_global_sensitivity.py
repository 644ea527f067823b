"""The global sensitivity from the command line, quick."""

import json

import numpy as np

from scenarios.global_sensitivity import BASE, RANGES, main, points_of
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.vehicle import load_vehicle


def test_ranges_hold_the_car():
    vehicle = load_vehicle()
    for parameter in RANGES:
        # The path exists, both limits are accepted, and the car of the source lies between them.
        load_vehicle(None, [f"{parameter.path}={parameter.low}"])
        load_vehicle(None, [f"{parameter.path}={parameter.high}"])
        assert parameter.low <= value_of(vehicle, parameter.path) <= parameter.high, parameter.path
    assert points_of(BASE).shape == (12288, 10)


def test_quick(tmp_path, capsys):
    folder = tmp_path / "out"
    assert main(["--quick", "--output", str(folder)]) == 0
    files = {path.name for path in folder.iterdir()}
    assert {"results.md", "results.json", "sweep", "indices.png", "weighted_indices.png"} <= files
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert "256 runs" in content["caption"] and "engine reduced" in content["caption"]
    for name in ("unweighted", "weighted"):
        assert np.all(np.isfinite(content[name]["total"])) and len(content[name]["total"]) == 2
    assert content["weighted"]["total"] != content["unweighted"]["total"]
    assert "; 0 failed." in (folder / "results.md").read_text(encoding="utf-8")
