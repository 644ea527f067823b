"""Usual ranges of the figures of a car: each has a source, each figure outside is flagged, the sedan has none."""

import json
import math

import pytest

from vehicle.model.parameters.shipped import CARS
from vehicle.runs.car import Car
from vehicle.runs.car.usual_figures import AXLE_FIGURES, usual_figures, usual_ranges

BAR = ("front", "roll stiffness, anti-roll bar or beam [N m/deg]")
STEER = "bump steer, toe-in per 100 mm [deg]"
SHARES = ("share of roll stiffness, suspension [%]", "share of roll stiffness, with tyres [%]")
FOCUS_ROAD = {
    # Inertia, front hardpoints and front bar are those of the publication; the rear axle is assumed.
    ("", "k_x / mean track"), ("", "k_y^2 / a b"), ("", "k_z^2 / a b"), ("", "roll [Hz]"), BAR,
    ("front", STEER), ("rear", STEER),
    *((axle, name) for axle in ("front", "rear") for name in SHARES),
}  # fmt: skip
# On rubber blocks behind: its body moves on them, not on a rear axle.
FOCUS = {
    BAR,
    ("front", STEER),
    *(("", name) for name in ("heave [Hz]", "heave, damping [%]", "pitch [Hz]", "roll [Hz]")),
}
BRAKING = "anti-dive (front) or anti-lift (rear), braking [%]"
UNUSUAL = {
    "sedan": set(),
    "sedan_steering": set(),
    # The ranges are those of cars and vans.
    "light_truck": {("", "mass [kg]")},
    "focus_road": FOCUS_ROAD,
    "focus_road_seated": FOCUS_ROAD,
    "focus": FOCUS,
    "focus_measured_roll": {*FOCUS, ("", "roll, damping [%]")},
    "kinematic_reference": {
        ("", "unsprung mass [% of the mass]"), ("front", "roll centre above ground [mm]"),
        ("front", "anti-dive / anti-lift angle, braking [deg]"),
        ("front", "anti-lift / anti-squat angle, driving [deg]"),
        ("front", BRAKING), ("rear", BRAKING),
        ("front", "anti-lift (front) or anti-squat (rear), driving [%]"),
        ("front", "caster [deg]"), ("front", "caster trail [mm]"), ("front", "scrub radius [mm]"), ("front", STEER),
    },
}  # fmt: skip
"""Figures outside their usual range by the name of the shipped car."""


@pytest.mark.parametrize("name", CARS)
def test_the_unusual_figures_of_the_shipped_cars(name):
    data = Car.load(name).show()
    unusual = [figure for figure in data.usual if figure.unusual]
    assert {(figure.axle, figure.name) for figure in unusual} == UNUSUAL[name]
    text = str(data)
    flagged = [line for line in text.splitlines() if line.startswith("! ")]
    assert len(flagged) == len(unusual) == len(set(flagged))
    assert text.count(" !") == len(unusual)
    entries = json.loads(json.dumps(data.summary(), allow_nan=False))["usual"]
    assert sum(entry["unusual"] for entry in entries) == len(unusual)


def test_every_figure_has_a_range_with_a_source():
    # Sprung mass and spring rate at the wheel are parts of other figures; an arm of parallel links is infinitely long.
    without = {"sprung mass [kg]", "spring times ratio squared [N/mm]", "side-view swing arm [m]"}
    for figure in Car.load("sedan").show().usual:
        assert math.isnan(figure.low) == (figure.name in without), figure.name
        assert figure.source or figure.name in without
    for name, entry in usual_ranges().items():
        assert len(entry["source"]) > 10, name
        ranges = [entry[key] for key in ("all", "front", "rear") if key in entry]
        assert ranges and all(low < high for low, high in ranges), name
    assert {name.strip() for name in AXLE_FIGURES} - without <= set(usual_ranges())


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"*.bushings.tyre.stiffness.z": 6e5}, "tyre deflection, static [mm]"),
        ({"front.parts.tyre.mass": 60.0}, "unsprung mass, both wheels [kg]"),
        ({"front.hardpoints.strut_top.x": 0.95}, "caster [deg]"),
        ({"front.hardpoints.tie_inner.z": 0.62}, STEER),
        ({"front.main_spring.stiffness": 90000.0}, "ride frequency [Hz]"),
    ],
)
def test_a_figure_outside_its_range_is_flagged(change, name):
    figures = usual_figures(Car.load("sedan", change).show())
    assert name in {figure.name for figure in figures if figure.unusual and figure.axle == "front"}


def test_the_range_of_the_unsprung_mass_is_in_proportion_to_the_load_of_the_axle():
    (front, _) = (figure for figure in Car.load("sedan").show().usual if figure.name.startswith("unsprung mass, both"))
    loads = Car.load("sedan").static.tyre_load
    assert front.high == pytest.approx(0.17 * (loads["fr"] + loads["fl"]) / 9.81, rel=1e-9)
