"""A car as people write it in Python: an own channel, the engine in place, equal cars."""

import numpy as np
import pytest

from vehicle import Car, Signal, sweep
from vehicle.errors import ConfigurationError

FRICTION = "front.damper.coulomb_friction"


@pytest.fixture(scope="module")
def bump():
    time = np.arange(0.0, 1.5, 1e-3)
    return Signal(time=time, displacement={"fl": 0.004 * np.exp(-(((time - 0.5) / 0.05) ** 2))}, source="bump")


@pytest.mark.parametrize("engine", ["reduced", "mujoco"])
def test_an_own_channel_at_a_known_point_has_its_values(bump, engine):
    car = Car.load("sedan").with_channel("twin", "seat_rail").with_channel("hub", [0.0, 0.0, 0.3], on="knuckle_fl")
    run = car.run(bump, engine)
    assert run.recording.statistics.engine == engine and run.recording.units["hub_acc_x"] == "m/s2"
    for axis in "xyz":
        np.testing.assert_array_equal(run[f"twin_acc_{axis}"], run[f"seat_rail_acc_{axis}"])
    assert run.frf("twin z").names == ("twin_acc_z",)


def test_an_own_channel_is_saved_and_swept(bump, tmp_path):
    car = Car.load("sedan").with_channel("tunnel", [1.6, 0.0, 0.45])
    assert Car.load(car.save(tmp_path / "car.toml")) == car
    table = sweep(car, {FRICTION: [40.0]}, bump, measure=lambda run: run["tunnel z"].max(), engine="reduced")
    run = car.with_({FRICTION: 40.0}).run(bump, "reduced")
    assert table.column("<lambda>")[0] == run["tunnel z"].max()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("tunnel", [1.6, 0.0]), r"outputs\.tunnel\.at.*3 numbers"),
        (("tunnel", "seet"), r"outputs\.tunnel\.at.*'seet'.*seat"),
        (("tunnel", ["a", 0, 0]), r"outputs\.tunnel\.at"),
        (("seat_rail", [1.6, 0.0, 0.45]), "with_channel.*'seat_rail'"),
        (("two words", [1.6, 0.0, 0.45]), r"outputs\.two words"),
    ],
)
def test_wrong_channels(arguments, message):
    with pytest.raises(ConfigurationError, match=message):
        Car.load("sedan").with_channel(*arguments)
    with pytest.raises(ConfigurationError, match=r"outputs\.tunnel\.on.*'bodi'.*body"):
        Car.load("sedan").with_channel("tunnel", [1.6, 0.0, 0.45], on="bodi")


def test_cars_with_equal_parameters_are_equal(tmp_path):
    car, other = Car.load("sedan"), Car.load("sedan", {FRICTION: 45.0})
    value = car[FRICTION].value
    assert car == car.with_({FRICTION: value}) == other.with_({FRICTION: value}) != other
    assert car != "sedan" and {car, car.with_({FRICTION: value}), other} == {other, car}
    # The body model counts by its content, also in another folder.
    cars = {}
    for folder, model in (("first", "# one"), ("same", "# one"), ("second", "# another")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "mine.toml").write_text(model, encoding="utf-8")
        file = tmp_path / folder / "car.toml"
        file.write_text('base = "focus"\n[body]\nsuperelement = "mine.toml"\n', encoding="utf-8")
        cars[folder] = Car.load(file)
    assert cars["first"] == cars["same"] != cars["second"]


def test_cars_whose_body_files_were_moved_are_unequal(tmp_path, monkeypatch):
    names = iter(("first", "other"))
    monkeypatch.setattr("vehicle.runs.car.car.own_body_file", lambda vehicle, folder: tmp_path / f"{next(names)}.toml")
    assert Car.load("sedan") != Car.load("sedan")
