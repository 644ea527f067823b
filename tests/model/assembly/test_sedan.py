"""The sedan and the kinematic reference: another make, from files; its source is typed here again."""

import mujoco
import numpy as np
import pytest

from tests.validation import validated
from vehicle.model.parameters.shipped import VEHICLES
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car

POINTS = {  # x forward, y to the left, z up from the middle of the front axle [m], left side
    "wheel_center": (0.0, 0.750062, 0.0),
    "arm_rear": (-0.04318, 0.37338, -0.12573),
    "arm_front": (0.27051, 0.34544, -0.05969),
    "lower_ball": (0.02794, 0.66294, -0.10414),
    "strut_top": (-0.08382, 0.54102, 0.46863),
    "damper_bottom": (-0.00508, 0.61976, -0.00127),
    "tie_inner": (-0.2, 0.2, -0.05),
    "tie_outer": (-0.2, 0.574803759, -0.00127),
}
WHEELBASE, LENGTH = 2.75717, 0.482914


@pytest.fixture(scope="module")
def sedan():
    return Car.load(VEHICLES / "sedan" / "vehicle.toml")


@pytest.fixture(scope="module")
def reference():
    return Car.load("kinematic_reference")


def test_its_points_are_those_of_the_source(reference):
    points = {name: np.array(point) for name, point in reference.vehicle.points.items()}
    centre = 0.5 * (points["wheel_center_fl"] + points["wheel_center_fr"])
    for name, (forward, left, up) in POINTS.items():
        np.testing.assert_allclose(points[f"{name}_fl"] - centre, [-forward, -left, up], atol=1e-12)
        np.testing.assert_allclose(points[f"{name}_fr"] - centre, [-forward, left, up], atol=1e-12)
    assert points["wheel_center_rr"][0] - centre[0] == pytest.approx(WHEELBASE, abs=1e-12)
    line = points["strut_top_fr"] - points["damper_bottom_fr"]
    assert np.linalg.norm(line) == pytest.approx(LENGTH, abs=1e-6)
    # Any seat on the strut axis gives the same force.
    way = points["spring_lower_fr"] - points["damper_bottom_fr"]
    np.testing.assert_allclose(np.cross(way, line), 0.0, atol=1e-6)


def test_its_masses_are_those_of_the_source(reference):
    mass: dict[str, float] = {part.name: part.numbers.mass for part in reference.vehicle.composition.parts}

    def front(*names: str) -> float:
        return sum(mass[f"{name}_fr"] for name in names)

    assert front("brake_disc") == 9.962 and front("a_arm") == 2.72 and front("steering_rod") == 1.13
    assert front("knuckle", "caliper") == pytest.approx(13.51)
    strut = ("damper_bottom", "damper_top", "suspension_mount", "main_spring_lower", "main_spring_upper")
    assert front(*strut) == pytest.approx(13.5)
    assert front("tyre") == pytest.approx(18.0 + 11.2)
    assert reference.vehicle.body.mass + mass["engine"] == pytest.approx(1442.1)


def test_its_damper_is_that_of_the_source():
    own = load_vehicle(VEHICLES / "sedan" / "vehicle.toml").composition.dampers[0]
    velocity = np.linspace(0.01, 2.0, 400)
    for sign in (1.0, -1.0):
        exact = 4352.487 * velocity / (1.0 + 1.3 * velocity)
        force = sign * np.interp(sign * velocity, own.law.velocity, own.law.force)
        assert own.name == "damper_fr"
        validated(
            "Dampers and friction", f"damper of the sedan, {'bump' if sign > 0.0 else 'rebound'}, 0.01 to 2 m/s", force,
            exact, rel=0.02, unit="N", source="closed form: law of the source of the sedan, c v / (1 + 1.3 v)",
        )  # fmt: skip


def test_it_stands_and_rides(sedan):
    model, static = sedan.model.model, sedan.model.static
    places = {wheel.name: wheel.patch[0] for wheel in sedan.vehicle.composition.wheels}
    data, gravity = mujoco.MjData(model), sedan.vehicle.gravity
    mujoco.mj_kinematics(model, data)
    arm = model.body_mass @ (data.xipos[:, 0] - places["fr"])
    loads = static.tyre_load
    validated(
        "Static equilibrium", "sedan: load of the rear axle", loads["rr"] + loads["rl"],
        gravity * arm / (places["rr"] - places["fr"]), rel=1e-6, unit="N",
        source="closed form: moment of all masses about the front axle",
    )  # fmt: skip
    validated(
        "Static equilibrium", "sedan: sum of the wheel loads", sum(loads.values()), gravity * model.body_mass.sum(),
        rel=1e-9, unit="N", source="conservation: m g from the masses of all bodies",
    )  # fmt: skip
    assert loads["fr"] == pytest.approx(loads["fl"], rel=1e-6) and static.residual < 1e-6
    sliding = [(mode.description, mode.frequency) for mode in sedan.modes("sliding")]
    heave = [frequency for name, frequency in sliding if name.startswith("body heave")]
    hop = [frequency for name, frequency in sliding if " wheel hop" in name and frequency < 30.0]
    assert len(heave) == 1 and 1.2 < heave[0] < 1.6
    assert len(hop) == 4 and min(hop) > 11.0 and max(hop) < 15.0
