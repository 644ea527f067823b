"""`python -m scenarios.road` as a user runs it; the scaling of a linear car with friction; and its rows."""

import json

import pytest

from scenarios.road import Ride, Rides, friction_claims, main, scaling_claim
from vehicle.runs.car import Car


def test_a_short_study(rigid_car, tmp_path):
    folder = tmp_path / "road"
    assert main(["--output", str(folder), "--quick", "--vehicle", str(rigid_car)]) == 0
    content = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    assert {"friction.png", "results.md"} <= {path.name for path in folder.iterdir()}
    rides = {(ride["road"], ride["friction"]): ride for ride in content["rides"]}
    smooth, rough = rides["A", None], rides["C", None]
    # Four times the amplitude: nearly four times the vibration; less, for the friction matters less.
    assert (
        3.0 < rough["unweighted"] / smooth["unweighted"] < 4.0 and 3.0 < rough["load_rear"] / smooth["load_rear"] < 5.0
    )
    assert 0.4 < smooth["seat_value"] < 1.0 and smooth["seat_weighted"] < smooth["weighted"]
    assert rides["A", 250.0]["unweighted"] > 1.3 * rides["A", 0.0]["unweighted"]
    assert content["rows"] == []  # one short record judges nothing


def test_twice_the_road_and_twice_the_friction_are_the_same(rigid_car, tmp_path):
    """u = a U(F / a): the reduced engine is linear except for the dampers, and the product of load and slope of rolling
    tyres, which changes these ratios by 3e-5 to 6e-5; with the static load they agree within 1e-6."""
    rides = Rides({"rigid": Car.load(rigid_car)}, records=1, duration=2.0, folder=tmp_path)
    pairs = [Ride(car="rigid", road=road, friction=force) for road, force in (("A", 30.0), ("C", 120.0))]
    for name in ("unweighted", "seat_weighted", "load_front"):
        single, other = (rides.ratio(ride, name)[0] for ride in pairs)
        assert single == pytest.approx(other, rel=1e-4) and abs(single - 1.0) > 0.002
    (claim,) = scaling_claim(rides, "rigid", ("A", "C"), (0.0, 30.0, 120.0))
    assert claim.within


class Told(Rides):
    """Rides whose comfort values over the frictions 0, 100, 200 N are given, for classes A and C."""

    def __init__(self, rigid_car, tmp_path, smooth, rough):
        super().__init__({"car": Car.load(rigid_car)}, records=1, duration=2.0, folder=tmp_path)
        self.values = {"A": smooth, "C": rough}

    def each(self, ride, name):
        return [self.values[ride.road][int(ride.friction / 100.0)]]


def test_the_rows_fail_where_the_finding_does_not_hold(rigid_car, tmp_path):
    asked = ("car", ("A", "C"), (0.0, 100.0, 200.0))
    good = Told(rigid_car, tmp_path, (1.0, 1.1, 1.5), (1.0, 1.0, 1.1))
    assert all(claim.within for claim in friction_claims(good, *asked))
    bad = Told(rigid_car, tmp_path, (1.0, 1.05, 1.02), (1.0, 1.1, 1.3))
    assert not any(claim.within for claim in friction_claims(bad, *asked))
