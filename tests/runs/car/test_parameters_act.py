"""A changed number of a car acts, or a notice says that it has no effect; `tests.benchmarks` has the whole check."""

import pytest

from tests.benchmarks.parameters_without_effect import STATES, effects, numeric_paths
from vehicle import Car
from vehicle.model.parameters.idle import idle_parameters
from vehicle.model.parameters.shipped import CARS

EVERY = 40
"""Every so many of the parameters of a car are tried here."""


@pytest.mark.parametrize("name", CARS)
def test_no_parameter_is_silent(name):
    car = Car.load(name)
    paths = numeric_paths(car)
    chosen = dict(list(paths.items())[len(name) % EVERY :: EVERY])
    chosen |= {path: value for path, value in paths.items() if path.startswith("driving.hold_")}
    found = effects(car, chosen)
    assert found.silent == [] and len(found.acting) > len(found.refused)


STANDING = {
    "front.bushings.tyre.stiffness.x": 2e5,
    "front.bushings.tyre.damping.y": 100.0,
    "front.bushings.tyre.rotational_stiffness": 0.0,
}
ROLLING = {"driving.hold_frequency": 0.1, "front.bushings.tyre.slip_stiffness": 7e4, "front.bushings.tyre.trail": 0.02}


def test_parameters_of_rolling_and_of_standing_tyres_are_told_apart():
    paths = {path: value for path, value in numeric_paths(Car.load("sedan")).items() if path in STANDING | ROLLING}
    assert len(paths) == len(STANDING | ROLLING)
    for state, (acting, noted) in zip(STATES.values(), ((STANDING, ROLLING), (ROLLING, STANDING)), strict=True):
        found = effects(Car.load("sedan", state), paths)
        assert (set(found.acting), set(found.noted), found.silent) == (set(acting), set(noted), [])


def test_a_part_with_inertia_a_force_left_out_and_a_step_of_the_reduced_engine():
    overrides = ["front.parts.tyre.radius=0.02", "solver.timestep=1e-3", "force.a.on=engine", "force.a.force=[0, 0, 1]",
                 "force.a.mean=10", "force.a.enabled=false"]  # fmt: skip
    vehicle = Car.load("sedan", overrides).vehicle
    notices = idle_parameters(vehicle, [*overrides[:2], "force.a.mean=10"], "reduced")
    assert [notice.partition(": has no effect; it acts only with ")[2] for notice in notices] == [
        "a part without front.parts.tyre.inertia",
        "--engine mujoco, because the reduced engine chooses its own step",
        "force.a.enabled = true",
    ]
    assert idle_parameters(vehicle, ["solver.timestep=1e-3"], "mujoco") == ()
    assert idle_parameters(vehicle, ["force.a.enabled=false"]) == ()
    without = Car.load("sedan", [*overrides, "apply_forces=false"]).vehicle
    assert idle_parameters(without, ["force.a.enabled=false"]) == ()


def test_a_rod_without_inertia_has_a_radius_and_no_products():
    rod, car = "front.parts.steering_rod", Car.load("sedan")
    keys = ("radius", *(f"products.{axis}" for axis in "xyz"))
    found = effects(car, {f"{rod}.{key}": numeric_paths(car)[f"{rod}.{key}"] for key in keys})
    assert found.acting == [f"{rod}.radius"] and found.silent == []
    assert list(found.noted.values()) == [
        f"{rod}.{key}=0.01: has no effect; it acts only with {rod}.inertia" for key in keys[1:]
    ]


def test_the_stroke_of_an_axis_without_friction_is_named():
    car = Car.load("sedan_steering")
    path = "steering.bushings.rack_guide_right.friction_stroke"
    (text,) = idle_parameters(car.vehicle, [f"{path}.x=1e-4"])
    assert text == f"{path}.x=1e-4: has no effect; it acts only with {path.replace('stroke', 'force')}.x above zero"
    assert idle_parameters(car.vehicle, [f"{path}.y=1e-4"]) == ()
