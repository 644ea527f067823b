"""Which commands let the tyres roll, and what they say of it."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from vehicle import Car, optimise, road
from vehicle.commands import fmu, modes, orders, shaker
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.driving import Driving, tyre_words
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.sweeps.case import SignalFile, all_tyre_words, drivings
from vehicle.studies.sweeps.case_table import table_cases
from vehicle.studies.sweeps.plan import plan_sweep

ROAD = ["--road", "A", "--speed", "72", "--duration", "3", "--engine", "reduced", "--quiet"]


def drive(vehicle: str, *, tyre: str | None = None, overrides: Sequence[str] = ()) -> tuple[str, ...]:
    """What a road at 72 km/h asks of a car."""
    return road("A", 72.0, tyre=tyre).under(load_vehicle(Path(vehicle)), overrides).overrides


def test_tyres_roll_on_a_road_by_default() -> None:
    assert drive("sedan") == ("driving.speed=20.0",)
    assert drive("sedan", tyre="standing") == ()
    assert drive("sedan", overrides=["driving.speed=20"]) == drive("sedan", overrides=["speed=0"]) == ()
    # On blocks behind, as on its rig.
    assert drive("focus") == ()
    assert drive("focus", tyre="rolling") == ("driving.speed=20.0",)


def test_words_of_several_runs() -> None:
    speeds = {0.0, 80.0 / 3.6, 50.0 / 3.6, 120.0 / 3.6}
    assert tyre_words(Driving(speed=one) for one in speeds) == "standing or rolling at 50, 80 and 120 km/h"
    sources = [
        RoadDrive(road="A", speed=speed, wheels=(("fr", 0.0, "right"),), track=1.5, driving=speed / 3.6)
        for speed in (80.0, 50.0)
    ]
    cases = table_cases(["front.damper.viscous"], [(1000,), (2000,)], sources, vehicle=vehicle_file(Path("sedan")))
    rolling = {name: tyre_words(cars) for name, cars in drivings(cases).items()}
    assert rolling == {"road_A_80": "rolling at 80 km/h", "road_A_50": "rolling at 50 km/h"}
    assert all_tyre_words(cases) == "rolling at 50 and 80 km/h"
    varied = table_cases(
        ["speed"], [(0,), (20,)], [SignalFile(path=Path("low.csv"), wheel="fr")], vehicle=cases[0].vehicle
    )
    assert all_tyre_words(varied) == "standing or rolling at 72 km/h"


def test_a_run_says_what_its_tyres_do(tmp_path: Path) -> None:
    said = {}
    for name, more in (("rolling", []), ("standing", ["--tyre", "standing"])):
        assert shaker.main([*ROAD, *more, "--vehicle", "sedan", "--output", str(tmp_path / name)]) == 0
        summary = json.loads((tmp_path / name / "summary.json").read_text())
        assert summary["tyre"] == {"rolling": "rolling at 72 km/h", "standing": "standing"}[name]
        said[name] = summary["comfort"]["seat_rail"]["rms_2_50_hz"]["x"]
    assert said["rolling"] < 0.7 * said["standing"]
    # Its vehicle file repeats it.
    again = ["--vehicle", str(tmp_path / "rolling" / "vehicle.toml"), "--output", str(tmp_path / "again")]
    assert shaker.main([*ROAD, *again]) == 0
    repeated = json.loads((tmp_path / "again" / "summary.json").read_text())
    assert repeated["comfort"]["seat_rail"]["rms_2_50_hz"]["x"] == said["rolling"]


def test_modes_at_a_speed(capsys: pytest.CaptureFixture[str]) -> None:
    assert modes.main(["--vehicle", "sedan", "--speed", "80", "--damper", "sliding", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["tyre"] == "rolling at 80 km/h"
    roll = next(mode for mode in found["modes"] if mode["description"].startswith("body roll"))
    assert 1.7 < roll["frequency_hz"] < 2.2  # on standing tyres 3.8 Hz
    assert found["growing"] == []


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (modes, ["--vehicle", "sedan", "--speed", "80"]),
        (orders, ["--vehicle", "sedan", "--speed", "60:80:10"]),
        (fmu, ["sedan", "--speed", "80"]),
    ],
)
def test_a_speed_that_is_given_twice_is_refused(
    command: Any, words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert command.main([*words, "--set", "driving.speed=1"]) == 2
    assert "--speed and --set driving.speed=1: both set driving.speed; leave" in capsys.readouterr().err


def test_studies_over_the_speed_of_a_road_are_refused() -> None:
    car, ride = Car.load("sedan"), road("A", 80, duration=3)
    message = r"driving\.speed=1.*: the road already sets another speed, 80 km/h"
    with pytest.raises(ConfigurationError, match=message):
        plan_sweep(car, {"driving.speed": [1.0, 20.0]}, ride)
    with pytest.raises(ConfigurationError, match=message):
        optimise(
            car.with_({"driving.speed": 22.2}),
            {"driving.speed": (1.0, 20.0), "body.mass": (1100.0, 1300.0)},
            ride,
            ["weighted"],
        )
    with pytest.raises(ConfigurationError, match=message):
        car.with_({"driving.speed": 1.0}).run(ride)
    # The same speed, rounded, and standing tyres do not contradict the road.
    plan_sweep(car, {"driving.speed": [0.0, 22.2]}, ride)
