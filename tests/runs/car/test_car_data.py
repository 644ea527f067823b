"""Masses, loads, stiffnesses and modes of a car against statics by hand."""

import copy
import json
import math
import re

import numpy as np
import numpy.typing as npt
import pytest

from tests.engines.kinematics.instant_centres import across, motion, rod
from tests.validation import validated
from vehicle import Car
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car.axle import axle_statics, mass_and_cog
from vehicle.runs.car.axle_data import axle_data
from vehicle.runs.car.car_data import CarData

Vector = npt.NDArray[np.float64]

RIGID = [
    "front.bushings.arm_front.stiffness=[1e10,1e10,1e10]",
    "front.bushings.arm_rear.stiffness=[1e10,1e10,1e10]",
    "front.bushings.suspension_mount.stiffness=[1e10,1e10,1e10]",
    "rear.bushings.pivot.stiffness=[1e10,1e10,1e10]",
    *(f"{path}.rotational_stiffness=0" for path in ("front.bushings.arm_rear", "front.bushings.suspension_mount")),
    *(f"{path}.rotational_stiffness=0" for path in ("front.bushings.arm_front", "rear.bushings.pivot")),
    "rear.bushings.damper_mount.rotational_stiffness=0",
    *(f"rear.parts.damper_{end}.mass=0.02" for end in ("top", "bottom")),
]
"""The sedan on bushings as stiff as ideal joints, with light rear dampers."""


@pytest.fixture(scope="module")
def cars() -> dict[str, Car]:
    return {name: Car.load(name) for name in ("focus", "focus_road", "sedan")}


@pytest.fixture(scope="module")
def shown(cars) -> dict[str, CarData]:
    return {name: car.show() for name, car in cars.items()}


@pytest.fixture(scope="module")
def rigid() -> Car:
    return Car.load("sedan", RIGID)


def points(car: Car, wheel: str) -> dict[str, Vector]:
    end = f"_{wheel}"
    return {name.removesuffix(end): np.array(at) for name, at in car.vehicle.points.items() if name.endswith(end)}


@pytest.mark.parametrize("name", ["focus", "focus_road", "sedan"])
def test_the_loads_carry_the_weight(shown, name):
    data = shown[name]
    loads = sum(sum(axle.load_n.values()) for axle in data.axles) + sum(data.support_n.values())
    validated("Static equilibrium", f"{name}: sum of all ground loads is the weight of the whole car", loads,
              data.mass_kg * data.gravity, rel=1e-9, unit="N", source="conservation: vertical equilibrium")  # fmt: skip
    assert data.sprung_kg + data.unsprung_kg == pytest.approx(data.mass_kg)
    carried = sum(axle.sprung_kg for axle in data.axles) + sum(data.support_n.values()) / data.gravity
    assert carried == pytest.approx(data.sprung_kg)


def test_the_loads_balance_about_the_centre_of_gravity(shown):
    """The tyres of the sedan have no rotational stiffness, so that loads alone balance the weight."""
    data = shown["sedan"]
    moment = sum(sum(axle.load_n.values()) * (axle.x_m - data.cog_m[0]) for axle in data.axles)
    validated("Static equilibrium", "sedan: moment of the wheel loads about the centre of gravity", moment, 0.0,
              abs=1e-3, unit="N m", source="conservation: equilibrium of moments")  # fmt: skip
    assert data.cog_behind_front_m / data.wheelbase_m == pytest.approx(1.0 - data.front_share, abs=1e-6)
    masses = {body: matrix[0, 0] for body, matrix in Car.load("sedan").matrices.body_masses.items()}
    assert data.mass_kg == pytest.approx(sum(masses.values()))


def strut_motion(p: dict[str, Vector]) -> tuple[Vector, Vector]:
    """Velocity of the wheel centre and angular velocity of a strut's knuckle, per unit of wheel travel."""
    links = [rod(p, "lower_ball", "arm_front"), rod(p, "lower_ball", "arm_rear"), rod(p, "tie_outer", "tie_inner")]
    return motion([*links, *across(p["strut_top"], p["strut_top"] - p["damper_bottom"])], p["wheel_center"])


def test_motion_ratios_of_a_strut(cars, shown):
    """The lower seat approaches the strut top with v . u along the spring."""
    for name in ("focus_road", "sedan"):
        p = points(cars[name], "fr")
        velocity, rotation = strut_motion(p)
        along = p["strut_top"] - p["spring_lower"]
        seat = velocity + np.cross(rotation, p["spring_lower"] - p["wheel_center"])
        ratio = float(seat @ along / np.linalg.norm(along))
        front = shown[name].axles[0]
        validated("Suspension kinematics", f"strut of {name}: motion ratios of spring and damper",
                  np.array([front.spring_ratio, front.damper_ratio]), ratio, abs=1e-6,
                  source="second derivation: velocity of the spring seat from the hardpoints")  # fmt: skip


def test_wheel_rate_of_a_trailing_arm(rigid):
    """k_w = d2U/dz2 of the energy of the spring and of the weights on an arm that swings about its pivot."""
    p, data = points(rigid, "rr"), axle_data(rigid, "rear")
    parts = {one.name: one for one in rigid.vehicle.composition.parts}
    on_arm = ["arm_rr", "tyre_rr", "brake_disc_rr", "caliper_rr"]
    law = next(one.law for one in rigid.vehicle.composition.springs if one.name == "main_spring_rr")
    gravity, length = rigid.vehicle.gravity, float(np.linalg.norm(p["spring_upper"] - p["spring_lower"]))

    def turned(point: Vector, angle: float) -> Vector:
        c, s = math.cos(angle), math.sin(angle)
        x, y, z = point - p["pivot"]
        return np.asarray(p["pivot"] + np.array([c * x - s * z, y, s * x + c * z]))

    def energy(angle: float, force: float) -> float:
        shorter = length - float(np.linalg.norm(p["spring_upper"] - turned(p["spring_lower"], angle)))
        weights = sum(parts[name].numbers.mass * turned(np.array(parts[name].cog), angle)[2] for name in on_arm)
        return float(force * shorter + 0.5 * law.stiffness * shorter**2 + gravity * weights)

    statics = axle_statics(rigid, "rear", ideal=False)
    force = next(spring.preload for spring in statics.parts.springs)
    heights = np.array([-1e-3, 0.0, 1e-3])
    lever = (p["wheel_center"] - p["pivot"])[[0, 2]]
    reach = float(np.linalg.norm(lever))
    angles = [math.asin((lever[1] + z) / reach) - math.asin(lever[1] / reach) for z in heights]
    low, middle, high = (energy(angle, force) for angle in angles)
    validated("Suspension kinematics", "trailing arm: wheel rate from the energy of spring and weights",
              data.wheel_rate_n_per_m, (high - 2.0 * middle + low) / 1e-6, rel=2e-3, unit="N/m",
              source="closed form: second derivative of the energy")  # fmt: skip
    validated("Suspension kinematics", "trailing arm: load from the energy of spring and weights",
              data.load_n["rr"], (high - low) / 2e-3, rel=2e-3, unit="N",
              source="closed form: derivative of the energy")  # fmt: skip
    ratio = data.spring_ratio or 0.0
    assert data.spring_at_wheel_n_per_m == pytest.approx(law.stiffness * ratio**2)


def test_roll_stiffness_of_a_beam_and_of_an_anti_roll_bar(rigid):
    """K = c (dtheta/dz)^2 t^2 with the twist theta of each half: energy c (2 theta)^2 / 2 for two wheels."""
    rear, p = axle_data(rigid, "rear"), points(rigid, "rr")
    axis = p["beam"] * [1.0, 0.0, 1.0] - p["pivot"]
    twist = axis[1] / np.cross(axis, p["wheel_center"] - p["pivot"])[2]
    torsion = rigid.vehicle.table["rear"]["beam_torsion"]["torsional_stiffness"]
    own = "closed form: twist of each half from the hardpoints"
    validated("Suspension kinematics", "roll stiffness of a twist beam on rigid pivots", rear.roll.bars,
              torsion * (twist * rear.track_m) ** 2, rel=2e-3, unit="N m/rad", source=own)  # fmt: skip
    front, p = axle_data(rigid, "front"), points(rigid, "fr")
    velocity, rotation = strut_motion(p)
    rod_top = velocity + np.cross(rotation, p["stab_rod_top"] - p["wheel_center"])
    along = p["stab_rod_top"] - p["stab_end"]
    turn = np.cross([0.0, 1.0, 0.0], p["stab_end"] - p["stab_body"])
    twist = float(rod_top @ along / (turn @ along))
    torsion = rigid.vehicle.table["front"]["stabilizer"]["torsional_stiffness"]
    validated("Suspension kinematics", "roll stiffness of an anti-roll bar on a rigid axle", front.roll.bars,
              torsion * (twist * front.track_m) ** 2, rel=2e-3, unit="N m/rad", source=own)  # fmt: skip
    assert front.roll.total == pytest.approx(1.0 / (1.0 / front.roll.suspension + 1.0 / front.roll.tyres))
    assert front.ride_rate_n_per_m == pytest.approx(1.0 / (1.0 / front.wheel_rate_n_per_m + 1.0 / front.tyre_n_per_m))


@pytest.mark.parametrize("name", ["focus_road", "sedan"])
@pytest.mark.parametrize("axle", ["front", "rear"])
def test_rates_are_those_of_the_stiffness_matrix(cars, shown, name, axle):
    """K of the whole car with the body held and without the tyres' own stiffness, condensed at the wheels."""
    car = cars[name]
    data = next(one for one in shown[name].axles if one.name == axle)
    statics, system = axle_statics(car, axle, ideal=False), car.matrices.system
    free = statics.columns
    stiffness, joints = system.stiffness[np.ix_(free, free)].copy(), system.constraints[:, free]
    joints = joints[np.abs(joints).max(axis=1) > 0.0]
    rows = []
    for index, wheel in enumerate(statics.wheels):
        law = next(one.law for one in car.vehicle.composition.connections if one.name == f"tyre_{data.wheels[index]}")
        assert law is not None
        center, patch = (statics.jacobian(wheel, point) for point in statics.places(index))
        stiffness -= patch[0].T @ np.diag(law.stiffness) @ patch[0]
        stiffness -= law.rotational_stiffness * patch[1].T @ patch[1]
        rows.append((center[0][2], patch[0][2]))
    system_matrix = np.block([[stiffness, joints.T], [joints, np.zeros((len(joints), len(joints)))]])
    rates = []
    for other in (1.0, -1.0):
        load = np.concatenate([rows[0][1] + other * rows[1][1], np.zeros(len(joints))])
        moved = np.linalg.lstsq(system_matrix, load, rcond=1e-14)[0][: free.size]
        rates.append(1.0 / float(rows[0][0] @ moved))
    source = "second derivation: K and joints of the linear car"
    # The static plane forces of the tyres are part of K, and none are on contact points that roll freely.
    validated("Suspension kinematics", f"{name}, {axle}: wheel rate", data.wheel_rate_n_per_m, rates[0], rel=2e-3,
              unit="N/m", source=source)  # fmt: skip
    lever = 0.5 * data.track_m**2
    validated("Suspension kinematics", f"{name}, {axle}: roll stiffness of the suspension", data.roll.suspension,
              rates[1] * lever, rel=2e-3, unit="N m/rad", source=source)  # fmt: skip


def test_unsprung_mass_of_a_trailing_arm(rigid):
    """Each part counts by its distance from the pivot over that of the wheel; dampers of 20 g by their ratio."""
    p, parts = points(rigid, "rr"), {one.name: one for one in rigid.vehicle.composition.parts}
    lever = (p["wheel_center"] - p["pivot"])[0]
    names = [f"{name}_rr" for name in ("arm", "tyre", "brake_disc", "caliper")]
    mass = 2.0 * sum(parts[name].numbers.mass * (parts[name].cog[0] - p["pivot"][0]) / lever for name in names)
    validated("Suspension kinematics", "trailing arm: unsprung mass", axle_data(rigid, "rear").unsprung_kg, mass,
              within=(mass, mass + 4.0 * 0.02 * 1.174), unit="kg",
              source="closed form: levers about the pivot")  # fmt: skip


def test_what_is_not_defined_is_said_in_words(shown):
    one_axle = shown["focus"]
    assert one_axle.wheelbase_m is None and one_axle.roll_share is None
    assert one_axle.support_percent(one_axle.axles[0]) is None
    text = str(one_axle)
    assert "wheelbase, anti-dive [%] and distribution of roll stiffness are not defined, because only 1 axle" in text
    assert "rear support right 1948 N" in text and "nan" not in text
    assert "rear: no steering figures, because its template five_link has no steering_axis" in str(shown["focus_road"])
    weightless = Car.load("sedan", {"gravity": 0.0}).show()
    assert "not defined without gravity" in str(weightless) and weightless.axles[0].ride_frequency_hz is None


def test_figures_and_modes_name_the_damping_that_each_takes(cars, shown):
    """By hand: damping ratio of the front wheels alone with the smaller of both constants is that of their modes."""
    text = str(shown["sedan"])
    constants = re.search(r"front: the figures .* at 0.1 m/s, (\d+) N s/m; modes .* fast motion, (\d+) N s/m", text)
    assert constants is not None and "rear: the figures" not in text and "damping at 0.1 m/s [%]" in text
    at_velocity, smallest = map(float, constants.groups())
    law = cars["sedan"].vehicle.table["front"]["damper"]
    force = np.interp([-0.1, 0.1], law["velocity"], law["force"])
    assert at_velocity == pytest.approx(float(np.ptp(force)) / 0.2, abs=0.5)
    assert smallest == pytest.approx(np.min(np.diff(law["force"]) / np.diff(law["velocity"])), abs=0.5)
    axle = shown["sedan"].axles[0]
    c = smallest * axle.damper_ratio**2 + cars["sedan"]["front.bushings.tyre.damping"].value[2]
    k, m = axle.wheel_rate_n_per_m + axle.tyre_n_per_m, axle.unsprung_kg / 2.0
    hop = [mode for mode in cars["sedan"].modes("sliding") if mode.description.startswith("front wheel hop")]
    # The body and the bushings, which the calculation leaves out, move with the wheels in these modes.
    assert [mode.damping_ratio for mode in hop] == pytest.approx([c / (2.0 * math.sqrt(k * m))] * 2, rel=0.08)


TRIPLE = """
mirrored = true
use = [
  { template = "wheel", with = { hub = "arm" } },
  { template = "shock_absorber", with = { lower = "arm" } },
]
joint = [{ kind = "free", child = "arm" }]
connection = [
  { name = "arm_inner", moving = "arm", carrier = "body", at = "arm_inner" },
  { name = "arm_outer", moving = "arm", carrier = "body", at = "arm_outer" },
  { name = "arm_top", moving = "arm", carrier = "body", at = "arm_top" },
]
spring = [
  { name = "main_spring", lower = {part = "arm", at = "spring_lower"}, upper = {part = "body", at = "spring_upper"} },
]
output = [{ name = "knuckle", on = "arm", at = "wheel_center" }]

[hardpoints]
arm_inner = "inner bushing"
arm_outer = "outer bushing"
arm_top = "upper bushing"
spring_lower = "lower seat of the main spring"
spring_upper = "upper seat of the main spring"

[parts]
arm = { shape = "trailing_arm", points = ["arm_outer", "arm_inner", "wheel_center"] }
"""
"""An arm on three bushings, which no ideal joints let swing."""


def test_an_axle_that_ideal_joints_lock_is_shown_on_its_bushings(tmp_path):
    (tmp_path / "triple.toml").write_text(TRIPLE, encoding="utf-8")
    rear = copy.deepcopy(dict(Car.load("sedan").vehicle.table["rear"]))
    rear["template"] = "triple"
    rear["hardpoints"] = {name: at for name, at in rear["hardpoints"].items() if name not in ("pivot", "beam")}
    rear["hardpoints"] |= {"arm_inner": [3.06, 0.3, 0.72], "arm_outer": [3.06, 0.6, 0.72], "arm_top": [3.1, 0.5, 0.9]}
    pivot = rear["bushings"].pop("pivot")
    rear["bushings"] |= {"arm_inner": pivot, "arm_outer": pivot}
    rear["bushings"]["arm_top"] = {"stiffness": [1e4] * 3, "damping": [500.0] * 3, "rotational_stiffness": 20.0}
    del rear["beam_torsion"]
    car = Car(vehicle_of({**Car.load("sedan").vehicle.table, "rear": rear}, tmp_path), folder=tmp_path)
    data = car.show()
    assert [axle.ideal for axle in data.axles] == [True, False]
    assert "note: rear: geometry, motion ratios and unsprung mass are computed with its bushings" in str(data)
    assert math.isfinite(data.axles[1].geometry.roll_centre_height_m) and data.axles[1].roll.bars == 0.0


def test_summary_is_json_and_lines_are_short(shown, cars):
    for data in shown.values():
        summary = json.loads(json.dumps(data.summary(), allow_nan=False))
        assert summary["axles"][0]["geometry"]["roll_centre_height_m"] == data.axles[0].geometry.roll_centre_height_m
        assert len(summary["parameters"]) == len(data.parameters) > 150
        for value in (data, data.axles[0], data.parameters[5]):
            assert "\n" not in repr(value)
    assert repr(shown["sedan"]) == "CarData(sedan, 1653 kg, 51 % in front, CoG 489 mm high)"


def test_loads_are_shown_or_how_to_add_a_driver(shown):
    seated = Car.load("focus_road_seated", {"load.trunk.mass": 80.0, "load.trunk.at": (3.6, 0.0, 0.7)}).show()
    assert "\nload          trunk 80 kg, driver (on a seat) 55 kg\n" in str(seated)
    line = re.search("^load +none: .*; (--set .*) adds a driver$", str(shown["sedan"]), re.MULTILINE)
    assert line is not None
    driven = Car.load("sedan", line[1].removeprefix("--set ").split(" --set "))
    assert mass_and_cog(driven)[0] == pytest.approx(shown["sedan"].mass_kg + 75.0, abs=1e-9)


def test_a_rolling_car_is_shown_at_its_speed(shown):
    moving = Car.load("sedan", {"driving.speed": 20.0}).show()
    assert moving.tyres == "rolling at 72 km/h" and moving.axles[0].geometry == shown["sedan"].axles[0].geometry
    for figure, still in zip(moving.figures, shown["sedan"].figures, strict=True):
        # The figures are those of the car at rest, the modes beside them those at its speed.
        assert figure.frequency_hz == still.frequency_hz and figure.modes != still.modes
