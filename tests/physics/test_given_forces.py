"""Histories of forces: as recorded channels, from Python in place of a file; linear responses per unit of a force."""

from typing import Any

import numpy as np
import pytest

from tests.physics.test_applied_forces import BASE, CHANNELS, FREE, HARMONICS, PLACES, forced, level, solved
from tests.validation import validated
from vehicle import Car, load_run, road
from vehicle.commands.shaker import main as shaker
from vehicle.errors import VehicleError
from vehicle.signals.excitation.signal import Signal

RAIL = {"force.a.on": "body", "force.a.at": "seat_rail", "force.a.force": [0.3, 0, 1]}
TORQUE: dict[str, object] = {"on": "engine", "moment": [0, 1, 0], "mean": 15.0, "factor": 0.5}
TORQUE |= {"angle": "crank", "harmonics": [[2, 40, 30]]}


def rise(time: np.ndarray) -> np.ndarray:
    return np.asarray(0.5 * (1.0 - np.cos(np.pi * np.minimum(time, 1.0))))


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_a_run_records_its_forces_and_its_crankshaft(engine):
    run_up = {"crank.rpm": 600, "crank.end_rpm": 1200, "crank.run_up_time": 1.5}
    car = Car.load("focus", {**{f"force.idle.{key}": value for key, value in TORQUE.items()}, **run_up})
    names = ["angle_crank", "seat_rail_acc_z", "torque_idle", "speed_crank"]
    run = car.run(level(car, 2.0), engine=engine, channels=names)
    assert list(run.channels) == names  # in the order of the request
    time = np.arange(2001) / 1e3
    turns = np.where(time < 1.5, 10.0 * time + time**2 * 10.0 / 3.0, 22.5 + 20.0 * (time - 1.5))
    torque = 15.0 + 20.0 * rise(time) * np.cos(4.0 * np.pi * turns + np.radians(30.0))
    speed = np.minimum(600.0 + 400.0 * time, 1200.0)
    validated(
        "Applied forces", f"recorded torque in a run-up from 600 to 1200 rpm, order 2 and a mean, {engine} engine",
        run["torque_idle"][::20], torque[::20],
        source="closed form: 15 + 20 w cos(2 theta + 30 degrees), theta of a linear speed", peak=1e-12, unit="N m",
    )  # fmt: skip
    assert run["angle_crank"] == pytest.approx(2.0 * np.pi * turns, rel=1e-12)
    assert run["speed_crank"] == pytest.approx(speed, rel=1e-12)
    assert [run.recording.units[name] for name in names] == ["rad", "m/s2", "N m", "1/min"]
    assert not set(car.vehicle.force_channels) & set(car.run(level(car, 0.2), engine="reduced").channels)


def test_a_force_from_python_is_that_of_a_file(tmp_path):
    time = np.arange(3001) / 1e3
    push = 200.0 * np.sin(2.0 * np.pi * 9.0 * time) * np.sin(np.pi * time / 3.0) ** 2
    np.savetxt(tmp_path / "push.csv", np.column_stack([time, push]), delimiter=",", header="time [s],push [N]",
               comments="", fmt="%.17g")  # fmt: skip
    smooth = road("level", 0, duration=3)
    signal = smooth.under(Car.load("sedan", RAIL).vehicle).signal()
    assert signal.time == pytest.approx(time, abs=1e-12)
    car = Car.load("sedan", {**RAIL, "force.a.factor": 1.5})
    from_file = car.with_({"force.a.file": str(tmp_path / "push.csv")})
    # With the mean, harmonics in its file, and as a variant of another car: what a run is given takes their place.
    told = car.with_({"force.a.harmonics": [[1, 50, 0]], "force.a.frequency": 5.0})
    names = (*car.vehicle.channels, "force_a")
    expected = from_file.run(smooth, engine="reduced", channels=names)
    for one in (car, told):
        found = one.run(smooth, engine="reduced", channels=names, forces={"a": push})
        # A variant has its matrices from terms: 1e-9 of the built ones.
        assert all(
            np.max(np.abs(found[name] - expected[name])) <= 1e-7 * np.max(np.abs(expected[name])) for name in names
        )
    assert np.max(np.abs(expected["force_a"] - 1.5 * push)) < 1e-9
    by_function = car.run(
        smooth, engine="reduced", channels=names,
        forces={"a": lambda t: 200.0 * np.sin(2.0 * np.pi * 9.0 * t) * np.sin(np.pi * t / 3.0) ** 2},
    )  # fmt: skip
    # The file is a spline through samples at 1 kHz.
    name = "seat_rail_acc_z"
    assert np.max(np.abs(by_function[name] - expected[name])) < 1e-5 * np.max(np.abs(expected[name]))
    precise = car.run(smooth, channels=names, forces={"a": push})
    assert precise.recording.statistics.energies is not None
    assert np.std(precise["seat_rail_acc_z"] - expected["seat_rail_acc_z"]) < 5e-3 * np.std(expected["seat_rail_acc_z"])
    # The vehicle file of the run cannot contain it.
    assert any("force.a: comes from Python" in text for text in precise.recording.statistics.notices)


@pytest.mark.parametrize("place", PLACES)
def test_a_frf_to_a_force_is_that_of_the_matrices(place):
    car = forced("focus", PLACES[place], **FREE)
    lines = BASE * np.array([order for order, _, _ in HARMONICS])
    unit = np.array([amplitude * np.exp(1j * np.radians(phase)) for _, amplitude, phase in HARMONICS])
    found = car.force_frf(CHANNELS, lines, force="shake", damper="sliding")
    validated(
        "Applied forces", f"FRF to a force, {place}, 8 to 58 Hz: seat rail, knuckle and engine", found * unit,
        solved(car), source="second derivation: matrices with the joints as constraints, line by line", peak=1e-9,
    )  # fmt: skip
    stuck = car.force_frf(CHANNELS, lines, force="shake")
    # A damper that sticks takes the force along its slide.
    gone = place == "force along the slide of a damper"
    assert (np.max(np.abs(stuck)) < 1e-9 * np.max(np.abs(found))) == gone


REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "no such force": (
        {"b": np.zeros(501)},
        ("force: unknown name 'b', no table [force.NAME] of this car; did you mean a"),
    ),
    "another length": (
        {"a": np.zeros(500)},
        ("has values of the shape (500,); give a value for each of the 501 times"),
    ),
    "a number": ({"a": lambda time: 3.0}, "has values of the shape (); give a value for each"),
    "not finite": ({"a": np.full(501, np.nan)}, "forces: force.a has a value that is not finite"),
    "too fast": (
        {"a": lambda time: np.sin(600.0 * np.pi * time) * np.sin(2.0 * np.pi * time) ** 2},
        "solver.record_rate: found 1000 Hz, must be at least",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_history_that_is_none_is_refused(case):
    forces, said = REFUSED[case]
    still = Signal(time=np.arange(501) / 1e3, displacement={"fr": np.zeros(501)})
    with pytest.raises(VehicleError) as error:
        Car.load("focus", RAIL).run(still, engine="reduced", forces=forces)
    assert said in str(error.value)


def test_forces_that_are_not_there_are_refused():
    car, still = Car.load("focus", RAIL), Signal(time=np.arange(501) / 1e3, displacement={"fr": np.zeros(501)})
    with pytest.raises(VehicleError, match=r"force\.a\.enabled is false"):
        car.with_({"force.a.enabled": False}).run(still, engine="reduced", forces={"a": np.zeros(501)})
    with pytest.raises(VehicleError, match="force: unknown name 'shake', no force of this car; did you mean a"):
        car.force_frf(["seat_rail_acc_z"], [5.0], force="shake")
    with pytest.raises(VehicleError, match="no channel 'force_a'"):
        car.run(still, engine="reduced", channels=["force_a"])  # it has no history


def test_a_run_without_the_forces_of_its_car(tmp_path, capsys):
    """It is the run of the car without them, its vehicle file makes it again, and its run-out moves no plate."""
    file = tmp_path / "shaken.toml"
    changes: dict[str, object] = {"front.imbalance.mass": 0.02, "front.imbalance.radius": 0.2, "force.a.mean": 300.0}
    changes |= {**RAIL, "front.nonuniformity.runout": [[1, 3e-4, 0]]}
    Car.load("sedan", changes).save(file)
    words = ["--no-forces", "--vehicle", str(file), "--engine", "reduced", "--speed", "100", "--duration", "3"]
    calm_folder = tmp_path / "calm"
    assert shaker([*words, "--road", "B", "--no-figures", "--output", str(calm_folder), "--quiet"]) == 0
    calm, expected = load_run(calm_folder), Car.load("sedan").run(road("B", 100, duration=3), engine="reduced")
    for name in calm.channels:
        assert np.max(np.abs(calm[name] - expected[name])) <= 1e-9 * max(np.max(np.abs(expected[name])), 1e-6)
    assert calm.car.vehicle.composition.forces == ()
    assert "apply_forces = false" in (calm_folder / "vehicle.toml").read_text(encoding="utf-8")
    for more, said in (
        (["--road", "B", "--rpm", "750"], "--rpm has no effect with --no-forces"),
        (["--road", "B", "--rpm", "1000:2000:500"], "--rpm has no effect with --no-forces"),
        (["--road", "level"], "the forces of the vehicle file are left out by --no-forces"),
    ):
        assert shaker([*words, *more]) == 2
        assert said in capsys.readouterr().err
