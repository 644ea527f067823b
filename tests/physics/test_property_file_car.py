"""A car with property files of Adams Car runs in both engines as with the same numbers in its file."""

import numpy as np
import pytest

from tests.property_file_set import write_car
from vehicle.commands.new import main
from vehicle.model.parameters.toml_file import write_text
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

RATE = 1000.0


@pytest.fixture(scope="module")
def from_files(tmp_path_factory):
    return Car.load(write_car(tmp_path_factory.mktemp("adams")))


@pytest.fixture(scope="module")
def runs(from_files):
    t = np.arange(0.0, 2.0, 1.0 / RATE)
    plates = Signal(time=t, displacement={"fr": 8e-3 * np.sin(2 * np.pi * 3.0 * t) * np.minimum(1.0, t)})
    return {engine: from_files.run(plates, engine=engine) for engine in ("mujoco", "reduced")}


def test_both_engines_agree(runs):
    exact, fast = runs["mujoco"], runs["reduced"]
    for name in ("seat_rail_acc_z", "damper_fr_force"):
        difference = np.sqrt(np.mean((fast[name] - exact[name]) ** 2))
        assert difference < 2e-2 * np.std(exact[name]), name
    assert np.max(np.abs(exact["damper_fr_velocity"])) > 0.05


def test_the_damper_follows_its_file(from_files, runs):
    damper = from_files.vehicle.table["front"]["damper"]
    velocity, force = (runs["mujoco"][f"damper_fr_{name}"] for name in ("velocity", "force"))
    sliding = np.abs(velocity) > 1e-2
    expected = np.interp(velocity, damper["velocity"], damper["force"]) + 80.0 * np.sign(velocity)
    assert np.mean(np.abs(force - expected)[sliding] > 1e-6) < 0.05


def test_the_numbers_of_the_run_are_those_of_the_files(from_files, tmp_path):
    (tmp_path / "vehicle.toml").write_text(write_text(from_files.vehicle))
    assert load_vehicle(tmp_path / "vehicle.toml") == from_files.vehicle


def test_a_new_car_takes_a_damper_file(tmp_path, capsys):
    write_car(tmp_path)
    assert main([str(tmp_path / "mine"), "--from", "sedan", "--damper-curve-front", str(tmp_path / "front.dpr")]) == 0
    damper = load_vehicle(tmp_path / "mine" / "vehicle.toml").table["front"]["damper"]
    assert damper["force"][0] == -1300.0 and damper["velocity"][-1] == 1.0
    text = (tmp_path / "mine" / "vehicle.toml").read_text(encoding="utf-8")
    assert "force = [-1300.0" in text and "# [N] given: front.dpr" in text
