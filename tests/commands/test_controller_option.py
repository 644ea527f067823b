"""`shaker --controller`: the FMU of a controller for all semi-active dampers of a car."""

import json
import sys
import tomllib
from pathlib import Path

import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[fmu]'")

from tests.model.laws.controller_files import controller_fmu
from vehicle.commands import shaker
from vehicle.model.parameters.vehicle import load_vehicle

if sys.platform != "linux":
    pytest.skip("the library of the tests is for Linux", allow_module_level=True)

ROAD = ["--road", "A", "--speed", "80", "--duration", "2.5", "--engine", "reduced", "--quiet", "--no-figures"]


def controllers_of(car):
    """Law and FMU of each controlled damper."""
    controls = [damper.law.controlled for damper in car.composition.dampers]
    return [(control.law, control.fmu) for control in controls if control is not None]


def test_all_dampers_with_a_control_have_the_controller(tmp_path, monkeypatch, capsys):
    folder = tmp_path / "my contröllers"
    folder.mkdir()
    controller_fmu(folder / "skyhook.fmu")
    # The path is relative to the folder of the command, in the results it is a whole path.
    monkeypatch.chdir(tmp_path)
    option = ["--vehicle", "focus_road", "--controller", "my contröllers/skyhook.fmu"]
    assert shaker.main([*ROAD, *option, "--output", "run"]) == 2
    said = capsys.readouterr().err
    assert "native code" in said and "vehicle trust" in said and not Path("run").exists()
    option.append("--trust")
    assert shaker.main([*ROAD, *option, "--output", "run"]) == 0
    car = load_vehicle(tmp_path / "run" / "vehicle.toml")
    assert controllers_of(car) == 4 * [("fmu", str(folder / "skyhook.fmu"))]
    assert tomllib.loads((tmp_path / "run" / "vehicle.toml").read_text())["front"]["damper"]["control"]["law"] == "fmu"
    # The user has allowed the file: it runs again without the option.
    again = ["--vehicle", "run/vehicle.toml"]
    assert shaker.main([*(word for word in ROAD if word != "--quiet"), *again, "--output", "again"]) == 0
    assert f"controller  {folder / 'skyhook.fmu'} runs as native code with all your rights" in capsys.readouterr().out
    comfort = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert shaker.main([*ROAD, *option[:2], "--set", "*.control.law=skyhook", "--output", "own"]) == 0
    expected = json.loads((tmp_path / "own" / "summary.json").read_text())
    assert comfort["comfort"] == expected["comfort"]


def test_a_wildcard_sets_the_controller_of_all_dampers(tmp_path):
    path = controller_fmu(tmp_path / "skyhook.fmu")
    car = load_vehicle(Path("focus_road"), ["*.control.law=fmu", f"*.control.fmu={path}"])
    assert controllers_of(car) == 4 * [("fmu", str(path))]


def test_a_path_that_a_vehicle_file_does_not_accept(tmp_path, capsys):
    path = controller_fmu(tmp_path / "skyhook #1.fmu")
    option = ["--vehicle", "focus_road", "--controller", str(path), "--output", str(tmp_path / "run")]
    assert shaker.main([*ROAD, *option]) == 2
    text = capsys.readouterr().err
    assert f"--controller {path}: the path contains a quotation mark, bracket, # or backslash" in text
    assert not (tmp_path / "run").exists()


def test_a_car_without_controls_and_a_bad_fmu_are_refused(tmp_path, capsys):
    path = controller_fmu(tmp_path / "skyhook.fmu")
    assert shaker.main([*ROAD, "--vehicle", "sedan", "--controller", str(path), "--output", str(tmp_path / "a")]) == 2
    assert "sedan has no semi-active damper" in capsys.readouterr().err
    bad = controller_fmu(tmp_path / "bad.fmu", output="c")
    option = ["--vehicle", "focus_road", "--controller", str(bad), "--trust", "--output", str(tmp_path / "b")]
    assert shaker.main([*ROAD, *option]) == 3
    assert "bad.fmu: found inputs body_velocity, wheel_velocity and outputs c" in capsys.readouterr().err
    assert not (tmp_path / "b").exists()
    assert shaker.main([*ROAD, "--vehicle", "sedan", "--trust", "--output", str(tmp_path / "c")]) == 2
    assert "--trust: no damper of sedan is controlled by an FMU" in capsys.readouterr().err
