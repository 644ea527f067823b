"""Obstacles on a level road: texts, shapes, contact, drives and the values of a run."""

from dataclasses import replace

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.runs.output.run_files import summarise
from vehicle.signals.analysis.settled import settling_time
from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.excitation.obstacle import SHAPES, Obstacle
from vehicle.signals.excitation.road_drive import RoadDrive

WHEELS: tuple[tuple[str, float, Side], ...] = (
    ("fr", 0.0, "right"),
    ("fl", 0.0, "left"),
    ("rr", 2.6, "right"),
    ("rl", 2.6, "left"),
)
DRIVE = RoadDrive(road="cleat:20x50@30", speed=36.0, wheels=WHEELS, track=1.5, radius=0.3)


def heights(text, at, **contact):
    """Heights of both tracks [m] at distances [m], (2, n)."""
    road = Obstacle.parse(text).road(length=60.0, patch=contact.pop("patch", 0.0), envelope=contact.get("envelope"))
    return np.array([road.contact_at(np.asarray(at), side)[0] for side in ("right", "left")])


def test_texts_name_shape_sizes_side_and_place() -> None:
    assert Obstacle.parse("cleat") == Obstacle(name="cleat", sizes=(20.0, 50.0))
    assert Obstacle.parse("pothole:40x350:left@12.5") == Obstacle(
        name="pothole", sizes=(40.0, 350.0), side="left", place=12.5
    )
    assert Obstacle.parse("speed_bump:both") == Obstacle(name="speed_bump", sizes=(100.0, 3700.0))
    assert Obstacle.parse("half_round:50").length == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("kerb:50", "must be one of cleat"),
        ("cleat:20", "HEIGHTxLENGTH"),
        ("cleat:20x50:middle", "HEIGHTxLENGTH"),
        ("cleat:20x50@near", "METRES"),
        ("cleat:20x0", "length 0, must be 1 to 50000"),
        ("half_round:900", "radius 900, must be 1 to 500"),
        ("cobbles:10x120x1.5", "1.5 stones"),
        ("speed_bump:100x100", "height 100 mm, .* 50 mm"),
        ("cobbles:20x39x10", "height 20 mm, .* 19.5 mm"),
    ],
)
def test_wrong_texts_are_rejected_with_the_right_form(text, message) -> None:
    with pytest.raises(ConfigurationError, match=message):
        Obstacle.parse(text)


def test_shapes_have_their_sizes() -> None:
    at = np.array([20.0, 30.0 - 1e-4, 30.025, 30.05 + 1e-4, 50.0])
    np.testing.assert_allclose(heights("cleat:20x50@30", at)[0], [0.0, 0.0, 0.02, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(heights("pothole:50x300:left@30", [30.15])[:, 0], [0.0, -0.05], atol=1e-12)
    np.testing.assert_allclose(heights("ramp:50x1000@30", [30.5, 31.0, 40.0])[0], [0.025, 0.05, 0.05], atol=1e-9)
    x = np.linspace(0.0, 3.7, 99)
    radius = 0.05 + 3.7**2 / 0.8
    validated(
        "Roads and excitation", "profile of the speed bump of 100 mm x 3.7 m",
        heights("speed_bump@30", 30.0 + x)[0], 0.1 - radius + np.sqrt(radius**2 - (x - 1.85) ** 2), abs=2e-4, unit="m",
        source="closed form: arc of a circle",
    )  # fmt: skip
    stones = heights("cobbles:10x120x50@30", 30.0 + np.linspace(0.0, 6.0, 4001))
    assert 0.005 < np.ptp(stones[0]) <= 0.02
    assert abs(np.corrcoef(stones)[0, 1]) < 0.9
    assert set(SHAPES) == {"cleat", "half_round", "speed_bump", "ramp", "pothole", "cobbles"}


def test_a_drive_meets_the_obstacle_with_each_wheel() -> None:
    signal = DRIVE.signal()
    front, rear, cams = signal.displacement["fr"], signal.displacement["rr"], DRIVE.envelope
    assert cams is not None
    first = 30.0 - 0.5 * cams.distance - cams.half_length
    assert np.all(front[signal.time < first / 10.0] == 0.0)
    # 2.6 m later at 10 m/s.
    np.testing.assert_allclose(rear[260:], front[:-260], atol=1e-12)
    assert 0.015 < front.max() <= 0.02
    assert signal.time[np.argmax(front > 1e-4)] < 3.0 - 0.1 / 10.0
    assert DRIVE.summary(signal)["obstacle_s"] == pytest.approx([3.0, 3.265])
    assert "two elliptical cams" in signal.source
    assert DRIVE.name == "road_cleat_20x50_at_30_36"
    # Without a place, the obstacle begins after the start of the evaluation.
    near = replace(DRIVE, road="cleat:20x50")
    assert near.obstacle is not None
    assert near.obstacle.begin == pytest.approx(10.0 * (near.skip + 0.5))


def test_the_contact_is_chosen() -> None:
    mean = replace(DRIVE, contact="patch")
    assert mean.envelope is None
    assert mean.signal().displacement["fr"].max() == pytest.approx(0.01, abs=1e-6)  # half of the patch
    rough = replace(DRIVE, road="B", duration=3.0)
    assert rough.envelope is None
    enveloped = replace(rough, contact="cams")
    assert enveloped.identity() != rough.identity()
    assert "contact" not in rough.identity()
    ratio = np.std(enveloped.signal().displacement["fr"]) / np.std(rough.signal().displacement["fr"])
    assert ratio == pytest.approx(1.0, abs=0.02)
    for change, message in (
        ({"patch": 0.0}, "--contact patch --patch 0"),
        ({"contact": "ring"}, "'ring': must be one of patch, cams"),
        ({"road": "cleat:20x50@300", "duration": 5.0}, "300 to .*@METRES"),
        ({"coherence": 1.0}, "--coherence"),
    ):
        with pytest.raises(ConfigurationError, match=message):
            replace(DRIVE, **change).signal()


def test_the_settling_time_of_a_decaying_sine() -> None:
    """exp(-d t) is below 10 % of its first value after ln(10) / d."""
    time = np.arange(0.0, 6.0, 1e-4)
    values = np.where(time > 1.0, np.exp(-2.0 * (time - 1.0)) * np.cos(2.0 * np.pi * 20.0 * (time - 1.0)), 0.0)
    found = settling_time(time, values, 1.5)
    assert found == pytest.approx(np.log(10.0) / 2.0 - 0.5, abs=0.026)
    assert settling_time(time, np.ones_like(time), 1.5) is None
    assert settling_time(time, values, 5.0) == settling_time(time, np.zeros_like(time), 1.5) == 0.0


@pytest.fixture(scope="module")
def rolling_at_30() -> Car:
    base = Car.load("focus_road")
    return Car.load("focus_road", Road("cleat:20x50", speed=30.0).under(base.vehicle).overrides)


@pytest.mark.parametrize("text", ["cleat:20x50", *(name for name in SHAPES if name != "cleat")])
def test_obstacles_need_no_more_than_1_khz(rolling_at_30, text) -> None:
    found = {
        rate: summarise(rolling_at_30.run(Road(text, speed=30.0, rate=rate), engine="reduced"), (), {})
        for rate in (1000.0, 4000.0)
    }
    overall = [summary.comfort["seat_rail"].unweighted[0]["overall"] for summary in found.values()]
    name = "a cleat of 20 x 50 mm" if text == "cleat:20x50" else f"the obstacle {text}"
    validated(
        "Roads and excitation", f"comfort of {name} at 30 km/h, sampled at 1 kHz", overall[0], overall[1],
        rel=1e-3, unit="m/s2", source="second derivation: sampled at 4 kHz",
    )  # fmt: skip
    if text != "cleat:20x50":
        return
    values = found[1000.0].obstacle
    assert values is not None
    assert values.from_s == pytest.approx(2.5, abs=1e-3)
    assert values.vdv["seat_rail"]["z"] > 2.0 * 0.76  # of the mean over the contact patch
    assert set(values.knuckle_peak) == {"fr", "fl", "rr", "rl"}
    assert values.settling_s["seat_rail"] is not None


def test_an_obstacle_lifts_tyres_unless_the_user_decides():
    """Rear tyres of `focus_road` pulled at a cleat of 20 mm with up to 1400 N."""
    vehicle = Car.load("focus_road").vehicle
    lifting = ("front.bushings.tyre.one_sided=true", "rear.bushings.tyre.one_sided=true")
    cleat = Road("cleat:20x50", speed=30)
    assert cleat.under(vehicle).overrides[1:] == lifting
    for overrides in (["*.bushings.tyre.one_sided=false"], ["front.bushings.tyre.one_sided=true"]):
        assert len(cleat.under(vehicle, overrides).overrides) == 1
    assert len(Road("C", speed=30).under(vehicle).overrides) == 1
    run = Car.load("focus_road").run(cleat, engine="reduced")
    wheels = run.car.vehicle.wheels
    assert min(np.min(run[f"tyre_{wheel}_force_z"]) for wheel in wheels) >= -1e-9
    assert any("left its plate" in notice for notice in run.recording.statistics.notices)
