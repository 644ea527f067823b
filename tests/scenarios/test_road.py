"""`python -m scenarios.road` as a user runs it; the scaling of a linear car with friction; and its rows."""

import json
from types import SimpleNamespace

import pytest

from scenarios.road.__main__ import main
from scenarios.road.findings import friction_claims, ratio, scaling_claim
from scenarios.road.runs import Ride, RideRuns, one_sided_tyres
from vehicle.model.parameters.force_elements import Tyre
from vehicle.model.parameters.shipped import VEHICLES
from vehicle.model.parameters.vehicle import load_vehicle


def test_a_short_study(rigid_car, tmp_path):
    folder = tmp_path / "road"
    assert main(["--output", str(folder), "--quick", "--vehicle", str(rigid_car)]) == 0
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert {"class_and_speed.png", "friction.png", "results.md"} <= {path.name for path in folder.iterdir()}
    rides = {(ride["road"], ride["friction"]): ride["mean"] for ride in content["rides"]}
    smooth, rough = rides["A", None], rides["C", None]
    # Four times the amplitude: nearly four times the vibration; less, for the friction matters less.
    assert 3.0 < rough["rail"] / smooth["rail"] < 4.0 and 3.0 < rough["load_rear"] / smooth["load_rear"] < 5.0
    assert 0.4 < smooth["seat_value"] < 1.0 and smooth["seat_weighted"] < smooth["rail_weighted"]
    assert rides["A", 250.0]["rail"] > 1.3 * rides["A", 0.0]["rail"]
    assert content["rows"] == []  # one short record judges nothing


def test_twice_the_road_and_twice_the_friction_are_the_same(rigid_car, tmp_path):
    """u = a U(F / a): the reduced engine is linear except for the dampers, and the product of load and slope of rolling
    tyres, which changes these ratios by 3e-5 to 6e-5; with the static load they agree within 1e-6."""
    runs = RideRuns({"rigid": rigid_car}, records=1, duration=2.0, folder=tmp_path)
    pairs = [Ride(car="rigid", road=road, speed=80.0, friction=force) for road, force in (("A", 30.0), ("C", 120.0))]
    for name in ("rail", "seat_weighted", "load_front"):
        single, other = (ratio(runs, ride, name)[0] for ride in pairs)
        assert single == pytest.approx(other, rel=1e-4) and abs(single - 1.0) > 0.002
    (claim,) = scaling_claim(runs, "rigid", ("A", "C"), 80.0, (0.0, 30.0, 120.0))
    assert claim.within


def told(smooth, rough):
    """Runs whose comfort values over the frictions 0, 100, 200 N are given, for classes A and C."""

    def found(ride):
        value = {"A": smooth, "C": rough}[ride.road][int(ride.friction / 100.0)]
        return SimpleNamespace(each=[{"rail": value, "seat_weighted": value}])

    runs = SimpleNamespace(vehicles={"car": SimpleNamespace(seated=True)})
    return type("Told", (SimpleNamespace,), {"__call__": lambda self, ride: found(ride)})(**vars(runs))


def test_the_rows_fail_where_the_finding_does_not_hold():
    asked = ("car", ("A", "C"), 80.0, (0.0, 100.0, 200.0))
    assert all(claim.within for claim in friction_claims(told((1.0, 1.1, 1.5), (1.0, 1.0, 1.1)), *asked))
    assert not any(claim.within for claim in friction_claims(told((1.0, 1.05, 1.02), (1.0, 1.1, 1.3)), *asked))


def test_one_sided_tyres_are_those_of_all_wheels():
    changes = one_sided_tyres(load_vehicle(VEHICLES / "focus_road" / "vehicle.toml"))
    laws = {
        connection.name: connection.law
        for connection in load_vehicle(VEHICLES / "focus_road" / "vehicle.toml", changes).composition.connections
    }
    one_sided = {name: law.one_sided for name, law in laws.items() if isinstance(law, Tyre) and law.one_sided}
    assert sorted(one_sided) == ["tyre_fl", "tyre_fr", "tyre_rl", "tyre_rr"]
