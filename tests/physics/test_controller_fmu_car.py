"""A controller in an FMU on the complete car: equal to the own law in both engines, and failures in a run."""

import sys

import numpy as np
import pytest

pytest.importorskip("fmpy", reason="FMPy is missing: pip install 'vehicle-on-shaker[fmu]'")

from tests.model.laws.controller_files import PARAMETERS, controller_fmu
from tests.validation import validated
from vehicle.core.trusted_code import trust
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.handover.fmu.fmu_file import write_fmu
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road

if sys.platform != "linux":
    pytest.skip("the library of the tests is for Linux", allow_module_level=True)

ROAD = Road("A", speed=80.0, duration=2.2)
OBSERVED = ("seat_rail_acc_z", "damper_rl_force", "damper_fr_coefficient")


def car_with(law, *values):
    texts = [f"law={law}", "control_period=0.002", "delay=0.004", *values]
    return Car.load("focus_road", [f"{axle}.damper.control.{text}" for axle in ("front", "rear") for text in texts])


def trusted(path):
    return f"fmu={path}", f"fmu_sha256={trust(path)}"


@pytest.mark.parametrize(("engine", "version"), [("reduced", "2"), ("reduced", "3"), ("mujoco", "2")])
def test_a_skyhook_controller_equals_the_own_law(tmp_path, engine, version):
    path = controller_fmu(tmp_path / "skyhook.fmu", version)
    own, outside = (
        car.run(ROAD, engine=engine, channels=OBSERVED)
        for car in (car_with("skyhook"), car_with("fmu", *trusted(path)))
    )
    assert np.ptp(own["damper_fr_coefficient"]) > 2000.0
    for name in OBSERVED:
        validated(
            "Semi-active dampers", f"{name} with a skyhook controller in an FMI {version}.0 FMU, {engine} engine",
            outside[name], own[name], peak=1e-10, unit=own.recording.units[name],
            source="second derivation: the own law of the car; the controller is a C program",
        )  # fmt: skip


def test_each_run_begins_anew(tmp_path):
    car = car_with("fmu", *trusted(controller_fmu(tmp_path / "skyhook.fmu")))
    first, second = (car.run(ROAD, engine="reduced", channels=OBSERVED) for _ in range(2))
    for name in OBSERVED:
        np.testing.assert_array_equal(first[name], second[name])


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_a_failure_stops_the_run_with_its_time(tmp_path, engine):
    path = controller_fmu(tmp_path / "faulty.fmu", parameters=(*PARAMETERS, "skyhook_share"))
    car = car_with("fmu", *trusted(path), "skyhook_share=0.75")
    with pytest.raises(SimulationError, match=r"^damper_fr: controller faulty\.fmu reports an error at t = 0\.1000 s"):
        car.run(ROAD, engine=engine)


def test_a_missing_file_is_said_before_a_run():
    car = car_with("fmu", "fmu=nowhere/none.fmu")
    with pytest.raises(ConfigurationError, match=r"controller .*focus_road/nowhere/none\.fmu: the file does not exist"):
        car.check("reduced")
    with pytest.raises(ConfigurationError, match=r"fmu: missing; law = fmu needs fmu"):
        car_with("fmu")


def test_an_fmu_of_a_car_refuses_a_controller_in_it(tmp_path):
    car = car_with("fmu", *trusted(controller_fmu(tmp_path / "skyhook.fmu")))
    with pytest.raises(ConfigurationError, match="cannot contain another FMU; set law = skyhook, and in the other"):
        write_fmu(car, tmp_path / "car.fmu")
