"""Forces of a vehicle file that are none: each one sentence with the key and what to set."""

import pytest

from vehicle import Car, road
from vehicle.errors import ConfigurationError, DataError

ON: dict[str, object] = {"on": "engine", "moment": [0, 1, 0], "harmonics": [[2, 40, 0]], "frequency": 25.0}

FORCES: dict[str, tuple[dict[str, object], str]] = {
    "unknown part": ({**ON, "on": "engin"}, "force.a.on: unknown part 'engin'; did you mean engine"),
    "the world": ({**ON, "on": "world"}, "force.a.on: unknown part 'world'"),
    "a plate": ({**ON, "on": "plate_fr"}, "force.a.on: unknown part 'plate_fr'"),
    "unknown point": ({**ON, "at": "engine_cg"}, "force.a.at: unknown point 'engine_cg'; did you mean engine_cog"),
    "unknown joint": ({"joint": "spin"}, "force.a.joint: 'spin' is not a hinge or slide; did you mean"),
    "joint and part": ({"joint": "damper_fr", "on": "engine"}, "force.a.on: found with joint"),
    "force and moment": ({**ON, "force": [0, 0, 1]}, "found both of force and moment"),
    "neither": ({"on": "engine"}, "found neither of force and moment"),
    "no direction": (
        {**ON, "moment": [0, 0, 0]},
        "force.a.moment: must be three numbers, not all zero; found [0.0, 0.0, 0.0]",
    ),
    "its own reaction": ({**ON, "against": "engine"}, "force.a.against: found 'engine'"),
    "order zero": ({**ON, "harmonics": [[0, 40, 0]]}, "of order 0; for the constant part set mean"),
    "negative order": ({**ON, "harmonics": [[-1, 40, 0]]}, "the order must be above 0"),
    "an order twice": ({**ON, "harmonics": [[2, 40, 0], [2, 10, 90]]}, "repeats order 2"),
    "negative amplitude": ({**ON, "harmonics": [[2, -40, 0]]}, "the amplitude must be at least 0"),
    "not a number": ({**ON, "harmonics": [[2, float("nan"), 0]]}, "must be three finite numbers"),
    "two numbers": ({**ON, "harmonics": [[2, 40]]}, "must be three finite numbers: order, amplitude, phase [deg]"),
    "angle and frequency": ({**ON, "angle": "crank"}, "force.a.angle: set either"),
    "neither of them": ({**ON, "frequency": None}, "force.a.angle: set either"),
    "unknown angle": ({**ON, "frequency": None, "angle": "wheel"}, ("unknown angle 'wheel'; did you mean wheel_")),
    "half an order of a wheel": (
        {**ON, "frequency": None, "angle": "wheel_fr", "harmonics": [[0.5, 40, 0]]},
        "a wheel has whole orders",
    ),
    "unknown key": ({**ON, "harmonic": 3}, "force.a.harmonic"),
    "a torque in N mm": (
        {**ON, "harmonics": [[2, 42500, 0]]},
        "force.a.harmonics: found 42500 N m, must be at most 5000",
    ),
    "a mean torque in N mm": ({**ON, "mean": 6e3}, "force.a.mean: found 6000 N m, must be at most 5000 N m (a block"),
    "a factor": ({**ON, "factor": -200.0}, "force.a.harmonics: found 8000 N m, must be at most 5000 N m"),
    "too large": ({**ON, "mean": 1e6}, "force.a.mean: found 1000000.0 N, must be at most 100000.0"),
}


@pytest.mark.parametrize("case", FORCES)
def test_a_wrong_force_is_refused(case):
    force, said = FORCES[case]
    with pytest.raises(ConfigurationError) as raised:
        Car.load("focus", {f"force.a.{key}": value for key, value in force.items() if value is not None})
    assert said in str(raised.value)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"front.imbalance.mass": 20.0, "front.imbalance.radius": 0.2}, "20 g is 0.02"),
        ({"front.imbalance.mass": 0.02}, "front.imbalance.radius: missing"),
        ({"front.nonuniformity.runout": [[1, 0.3, 0]]}, "front.nonuniformity.runout: found an amplitude of 0.3 m"),
        ({"front.nonuniformity.rfv": [[1, 2000, 0]]}, "found an amplitude of 2000 N, must be at most 1000 N"),
        (
            {"front.nonuniformity.lfv": [[0.5, 20, 0]]},
            ("front.nonuniformity.lfv: found a half order, but a wheel has whole orders"),
        ),
        ({"front.nonuniformity.rolling_runout": [[0, 1e-4, 0]]}, "of order 0; a constant part shakes nothing"),
        ({"front.nonuniformity.runout": [[1, -1e-4, 0]]}, "add 180 degrees to the phase"),
        (
            {"rear.right.nonuniformity.runout": [[1, 1e-4, 0]], "rear.right.nonuniformity.rfv": [[1, 20, 0]]},
            "rear.right.nonuniformity.rfv: found together with runout",
        ),
        ({"front.brake_variation.torque": [[1, 20]]}, "front.brake_variation.torque: found [1.0, 20.0], must be three"),
        ({"front.brake_variation.torque": [[1, 20, 0], [1, 5, 0]]}, "repeats order 1"),
        ({"front.brake_variation.torque": [[1, 2e3, 0]]}, "2000 N m, must be at most 1000 N m"),
        ({"front.nonuniformity.tfv": [[1, 20, 0]]}, ("unknown parameter front.nonuniformity.tfv; did you mean")),
        ({"crank.rpm": 12000}, "crank.rpm: found 12000.0 1/min, must be at most 10000.0 (engines idle at 600 to 1000)"),
        (
            {"crank.rpm": 750, "crank.end_rpm": 200, "crank.run_up_time": 9},
            "crank.end_rpm: found 200.0 1/min, must be at",
        ),
        ({"crank.rpm": 12.5}, "crank.rpm: found 12.5 1/min, must be at least 300.0"),
    ],
)
def test_a_wrong_wheel_or_crank_is_refused(changes, said):
    with pytest.raises(ConfigurationError) as raised:
        Car.load("sedan", changes)
    assert said in str(raised.value)


def car_with(**force: object) -> Car:
    return Car.load("sedan", {f"force.a.{key}": value for key, value in force.items()})


def test_a_force_that_cannot_act_in_a_run_is_refused():
    shake = {"on": "engine", "moment": [0, 1, 0], "harmonics": [[2, 40, 0]]}
    smooth = road("level", 100, duration=3)
    with pytest.raises(ConfigurationError, match=r"crank does not rotate; .*--set crank\.rpm"):
        car_with(**shake, angle="crank").run(smooth)
    with pytest.raises(ConfigurationError, match="wheel_fr does not rotate; the wheels stand; drive on a road"):
        car_with(**shake, angle="wheel_fr").run("low.csv")
    with pytest.raises(ConfigurationError, match=r"solver\.record_rate: found 1000 Hz, must be at least 2000 Hz"):
        car_with(**shake, frequency=150.0).run(smooth)
    with pytest.raises(ConfigurationError, match=r"solver\.timestep: found 0\.001 s, must be at most .* 100 Hz"):
        car_with(**shake, frequency=50.0).with_({"solver.timestep": 1e-3}).run(smooth)
    with pytest.raises(ConfigurationError, match="moves no plate, and sedan has no force that shakes it; add a force"):
        Car.load("sedan").run(smooth)
    stored = {"body.superelement": "trimmed_body.toml", "force.a.on": "body", "force.a.force": [0, 0, 1]}
    with pytest.raises(DataError, match="no node at the attachment"):
        _ = Car.load("focus", {**stored, "force.a.at": [2.0, 0.4, 1.0]}).model


ABOUT_THE_AXLE: dict[str, tuple[dict[str, object], str]] = {
    "moment on the tyre": (
        {"on": "tyre_fl", "moment": [0, 1, 0], "mean": 500.0},
        "for steady braking set mean=0 and add two forces of the mean 1639 N: along x on knuckle_fl at tyre_patch_fl",
    ),
    "brake between knuckle and disc": (
        {"on": "knuckle_fl", "against": "brake_disc_fl", "moment": [0, 1, 0], "mean": 100.0},
        "a mean moment of -100 N m about the axle of wheel fl",
    ),
    "torque in the joint": ({"joint": "spin_rr", "mean": 10.0}, "a mean moment of 10 N m about the axle of wheel rr"),
    "force off the axle": (
        {"on": "tyre_fl", "at": "tyre_patch_fl", "force": [1, 0, 0], "mean": 100.0},
        "a mean moment of -30.5 N m about the axle of wheel fl",
    ),
}


@pytest.mark.parametrize("case", ABOUT_THE_AXLE)
def test_a_mean_moment_about_the_axle_of_a_rolling_wheel_is_refused(case):
    force, said = ABOUT_THE_AXLE[case]
    table = {f"force.a.{key}": value for key, value in force.items()}
    with pytest.raises(ConfigurationError) as raised:
        Car.load("sedan", {"driving.speed": 30.0, **table})
    assert "force.a.mean: found " in str(raised.value) and said in str(raised.value)
    if "joint" not in force:
        Car.load("sedan", table)


def test_mean_forces_on_a_rolling_wheel_without_moment_about_its_axle_are_taken():
    for force in ({"moment": [1, 0, 0]}, {"force": [1, 0, 0]}, {"moment": [0, 1, 0], "against": "brake_disc_fl"}):
        table = {f"force.a.{key}": value for key, value in {"on": "tyre_fl", "mean": 100.0, **force}.items()}
        Car.load("sedan", {"driving.speed": 30.0, **table})
