"""Cars and runs to files and other processes and back: the same car, the same channels and values."""

import dataclasses
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle import load_run, road, save_run
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Car, Run
from vehicle.signals.records.run_summary import read_summary

CHANGES = {"damper.coulomb_friction": 93.75, "body.mass": 830}


@pytest.fixture(scope="module")
def runs():
    """A run of each engine on a plate, and one on a road."""
    car, signal = Car.load("focus", CHANGES), random_road(rms=2e-3, seed=4, wheel="fl", duration=5.0)
    return {
        "reduced": car.run(signal, engine="reduced"),
        "mujoco": car.run(signal),
        "road": Car.load("sedan").run(road("B", 80, duration=4), engine="reduced"),
    }


def require_same(found: Run, expected: Run) -> None:
    assert found.channels == expected.channels and found.recording.units == expected.recording.units
    for name in expected.channels:
        np.testing.assert_array_equal(found[name], expected[name], err_msg=name)
    assert found.car == expected.car
    assert (found.skip, found.road, found.wheel) == (expected.skip, expected.road, expected.wheel)
    assert found.comfort() == expected.comfort()
    assert found.slip_share(expected.wheel) == expected.slip_share(expected.wheel)
    assert found.first_slip(expected.wheel) == expected.first_slip(expected.wheel)
    if expected.road is None:
        # The rounding step of a signal is that of its samples: the estimate is the same to the last digits.
        one, other = found.frf("seat rail z"), expected.frf("seat rail z")
        np.testing.assert_allclose(one.response, other.response, rtol=1e-9)
        np.testing.assert_allclose(one.coherence, other.coherence, rtol=1e-9)
    statistics = found.recording.statistics
    assert (statistics.engine, statistics.energies) == (
        expected.recording.statistics.engine,
        expected.recording.statistics.energies,
    )


@pytest.mark.parametrize(
    ("name", "time_format"), [("reduced", "npz"), ("mujoco", "npz"), ("road", "npz"), ("road", "csv")]
)
def test_a_saved_run_is_a_run_again(runs, name, time_format, tmp_path):
    folder = save_run(runs[name], tmp_path / "run", figures=False, time_format=time_format)
    loaded = Run.load(folder)
    if time_format == "npz":
        require_same(loaded, runs[name])
    assert loaded.channels == load_run(str(folder)).channels == runs[name].channels
    # It can be saved again, with the same notices.
    again = save_run(loaded, tmp_path / "again", figures=False)
    assert sorted(read_summary(again).notices) == sorted(read_summary(folder).notices)
    # Its car is that of the folder, so that sweeps and variants start from it.
    assert Car.load(loaded.car.origin["file"]) == loaded.car
    with pytest.raises(ConfigurationError, match=r"a\.mp4.*engine='mujoco'"):
        loaded.film(tmp_path / "a.mp4")


def test_a_folder_without_its_files_is_no_run(runs, tmp_path):
    with pytest.raises(ConfigurationError, match=r"contains no summary\.json"):
        Run.load(tmp_path)
    folder = runs["reduced"].save(tmp_path / "run")
    (folder / "time.npz").unlink()
    with pytest.raises(DataError, match=r"time\.npz: is missing, although summary\.json lists it as time"):
        Run.load(folder)


def test_a_saved_car_is_the_car(tmp_path):
    car = Car.load("sedan").with_({"body.inertia.iyy": 2500}).with_({"body.mass": 1500, "front.damper.gas_force": 150})
    file = car.save(tmp_path / "mine" / "car.toml")
    assert Car.load(file) == car
    with pytest.raises(ConfigurationError, match=r"car\.toml: exists"):
        car.save(file)
    changed = Car.load(file).with_({"body.mass": 1400})
    assert Car.load(changed.save(file, force=True)) == changed
    # In another place, without its file, a car is the same but for the sources of its values.
    moved = pickle.dumps(Car.load(file))
    file.unlink()
    assert pickle.loads(moved)["body.mass"].value == 1400
    with pytest.raises(ConfigurationError, match=r"must end in \.toml"):
        car.save(tmp_path / "car.txt")


def test_a_saved_car_has_its_own_body_and_laws_beside_it(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    (first / "curve.csv").write_text("velocity [m/s],force [N]\n-1,-900\n0,0\n1,900\n", encoding="utf-8")
    (first / "car.toml").write_text(
        'base = "focus_road"\n[front.damper]\nviscous_law = "table"\ncurve = "curve.csv"\n', encoding="utf-8"
    )
    car = Car.load(first / "car.toml").with_({"body.mass": 850})
    assert Car.load(car.save(second / "car.toml")) == car


def test_cars_and_runs_are_pickled(runs):
    for run in runs.values():
        require_same(pickle.loads(pickle.dumps(run)), run)
    base = Car.load("sedan")
    for car in (base, base.with_(CHANGES_OF_SEDAN), base.with_(CHANGES_OF_SEDAN).with_(["body.mass=1500"])):
        car.poles  # noqa: B018 - models and matrices are made, and left out
        text = pickle.dumps(car)
        assert len(text) < 2e5
        copy = pickle.loads(text)
        assert copy == car and (copy.overrides, copy.origin) == (car.overrides, car.origin)
        np.testing.assert_array_equal(copy.poles.poles, car.poles.poles)
        assert copy.with_(["body.cog.z=1.0"]) == car.with_(["body.cog.z=1.0"])


CHANGES_OF_SEDAN = ["front.damper.coulomb_friction=60", "body.inertia.iyy=2500"]


def overall(car: Car) -> float:
    """Comfort of a car on the signal of the fixture; what a notebook sends to a pool."""
    signal = random_road(rms=2e-3, seed=4, wheel="fl", duration=2.0)
    return car.run(signal, engine="reduced").comfort().unweighted.overall


def test_a_pool_runs_variants_as_this_process_does():
    base = Car.load("focus")
    cars = [base.with_({"damper.coulomb_friction": friction}) for friction in (40.0, 120.0)]
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert list(pool.map(overall, cars)) == [overall(car) for car in cars]


def test_a_repr_is_a_line(runs):
    """What a notebook shows of the objects of a car and of a run has no arrays."""
    run = runs["mujoco"]
    car = run.car
    objects = [car, car.vehicle, car.model, car.matrices, car.poles, car.static, car.trimmed_body, car.load_rows]
    objects += [run, run.signal, run.recording, run.frf("seat rail z"), *run.frfs("seat rail z")]
    objects += [run.frfs("seat rail z")[0].response, run.comfort(), run.psd(), *car.modes()[:3]]
    for each in objects:
        text = repr(each)
        assert len(text) < 300 and "\n" not in text and "array(" not in text, text[:300]
    mode = car.modes()[0]
    assert repr(mode) == f"Mode({mode.frequency:.4g} Hz, damping {100 * mode.damping_ratio:.3g} %, {mode.description})"
    assert dataclasses.is_dataclass(mode)
