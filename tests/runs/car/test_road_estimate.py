"""Estimates of cars on road classes without a run: against runs, exact for a viscous car, and what they refuse."""

from typing import Any

import numpy as np
import pytest

from tests.engines.reduced.test_road_expectation import VISCOUS
from vehicle import Car, Road, road
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.runs.car.estimate_limits import loose_share
from vehicle.runs.car.road import lifting_tyres

TABLE = {"front.damper.velocity": [-1, 1], "front.damper.force": [-1600, 1600]}


def test_the_estimate_is_the_mean_of_runs(sedan: Car):
    """Two runs of 10 s scatter by 0.2 %; the linearisation is 0.15 % low on class C, 0.3 % at most 95 of 100 times."""
    runs = [sedan.run(road("C", 80, duration=12, seed=seed), "reduced").comfort().values for seed in (1, 2)]
    estimate = sedan.estimate(road("C", 80))
    for name, tolerance in (("weighted", 0.007), ("weighted_z", 0.007), ("unweighted", 0.01)):
        mean = np.mean([values[name] for values in runs])
        assert estimate.values[name] == pytest.approx(mean, rel=tolerance)


def test_a_viscous_car_is_four_times_as_loud_on_the_class_above(sedan: Car):
    """The level of class C is 4 times that of B, its amplitude twice; friction would take more of the smaller one."""
    car = Car.load("sedan", {**VISCOUS, **TABLE})
    low, high = (car.estimate(road(letter, 80, tyre=None)) for letter in "BC")
    assert high.values["weighted"] == pytest.approx(2.0 * low.values["weighted"], rel=1e-9)
    rubbed = [sedan.estimate(road(letter, 80)).values["weighted"] for letter in "BC"]
    assert rubbed[1] < 1.95 * rubbed[0]


def test_cars_that_differ_in_their_dampers_share_one_linear_part(sedan: Car):
    """A variant of the car has the values of the same car loaded anew."""
    changes = {"front.damper.coulomb_friction": 95, "rear.damper.viscous": 1300, "body.mass": 1250}
    # Another law is incomplete without its numbers.
    law = {"front.damper.viscous_law": "linear", "front.damper.viscous": 1600}
    for changed in (changes, law):
        variant = sedan.with_(changed).estimate(road("B", 90))
        assert variant.values == pytest.approx(Car.load("sedan", changed).estimate(road("B", 90)).values, rel=1e-8)


def test_bands_add_up_and_the_seat_has_its_own_values():
    """The mean squares of neighbouring bands add up; the SEAT value is the ratio of the weighted values."""
    estimate = Car.load("focus_road_seated").estimate(road("C", 60))
    z = "seat_rail_acc_z"
    parts = [estimate.rms(z, band=band) ** 2 for band in ((0.5, 5.0), (5.0, 25.0))]
    assert sum(parts) == pytest.approx(estimate.rms(z, band=(0.5, 25.0)) ** 2, rel=1e-12)
    assert estimate.cushion is not None
    ratio = estimate.cushion.weighted.z / estimate.comfort.weighted.z
    assert estimate.values["seat_value"] == pytest.approx(ratio)
    assert "SEAT value" in repr(estimate)


def test_the_tyre_load_is_that_of_runs(sedan: Car):
    """The mean of both front tyres and two seeds."""
    runs = [sedan.run(road("C", 80, duration=12, seed=seed), "reduced") for seed in (1, 2)]
    loads = [np.std(run[f"tyre_{wheel}_force_z"][2001:]) for run in runs for wheel in ("fr", "fl")]
    estimate = sedan.estimate(road("C", 80)).tyre_load
    assert np.mean([estimate["fr"], estimate["fl"]]) == pytest.approx(np.mean(loads), rel=0.01)


REFUSED: dict[str, tuple[dict[str, Any], Road, str]] = {
    "sticks": ({"front.damper.coulomb_friction": 400}, road("A", 30), "front.damper would stick too often"),
    "control": ({"front.damper.control.law": "skyhook"}, road("C", 80), "front.damper is controlled"),
    "side force": ({"front.damper.side_force_coefficient": 0.2}, road("C", 80), "front.damper has friction that grows"),
    "presliding": (
        {"rear.damper.friction_law": "presliding", "rear.damper.presliding_stiffness": 1e6},
        road("C", 80), "rear.damper has presliding friction",
    ),
    "imbalance": ({"front.imbalance.mass": 0.02, "front.imbalance.radius": 0.2}, road("C", 80), "shake the car too"),
    "obstacle": ({}, road("cleat:20x50", 30), "cleat:20x50 is no class"),
    "level": ({"front.imbalance.mass": 0.02, "front.imbalance.radius": 0.2}, road("level", 30), "level is no class"),
    "cams": ({}, road("C", 80, contact="cams"), "upper envelope"),
    "stop": (
        {"front.damper.stop.displacement": [-0.2, -0.01, 0.01, 0.2], "front.damper.stop.force": [-2e4, 0, 0, 2e4]},
        road("C", 80), "leaves its straight segment at rest",
    ),
    "channel": ({}, road("C", 80), "hub"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_the_estimate_does_not_cover_is_refused_by_name(case: str):
    """Each with the sentence that names it."""
    changes, on, words = REFUSED[case]
    car = Car.load("focus_road" if case == "control" else "sedan", changes)
    with pytest.raises((ConfigurationError, SimulationError), match=words):
        car.estimate(on, ["hub"] if case == "channel" else ())


def test_tyres_that_leave_the_road_are_refused(sedan: Car):
    """On class E the one-sided tyres of the sedan lift, and linear ones pull; on class C neither."""
    one_sided = sedan.with_({f"{path}.one_sided": True for path in lifting_tyres(sedan.vehicle)})
    for car in (one_sided, sedan):
        assert car.estimate(road("C", 80)).values["weighted"] > 0.0
        with pytest.raises(ConfigurationError, match="leaves the road for 12"):
            car.estimate(road("E", 80))


def test_the_share_of_a_gaussian_force_beyond_the_friction():
    """Beyond one standard deviation 31.7 %, without friction always."""
    assert loose_share(100.0, 100.0) == pytest.approx(0.3173, abs=1e-4)
    assert loose_share(0.0, 100.0) == 1.0
