"""Axles of one piece: on leaf springs with friction, and on links with air springs; statics, rates, engines, energy."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.errors import ConfigurationError
from vehicle.model.laws.amplitude import friction_elements
from vehicle.model.parameters.air_spring import air_stiffness
from vehicle.runs.car import Car
from vehicle.runs.car.axle_data import axle_data
from vehicle.runs.car.road import Road

AXLE = """
base = "sedan"
name = "NAME"

[rear]
template = "NAME"

[rear.hardpoints]
wheel_center = [3.507, 0.749, 0.705]
tyre_patch = [3.507, 0.749, 0.4]
spring_seat = [3.507, 0.5, 0.76]
damper_lower = [3.62, 0.55, 0.66]
damper_upper = [3.57, 0.5, 1.1]
POINTS
[rear.parts]
axle = { mass = 32.0, inertia = [5.5, 0.4, 5.5], between = ["wheel_center"], offset = [0.0, -0.749, 0.0] }
tyre = { mass = 18.5, inertia = [0.54, 0.98, 0.54] }
brake_disc = { mass = 6.0, inertia = [0.03, 0.05, 0.03] }
caliper = { mass = 3.0, inertia = [0.008, 0.008, 0.008], offset = [0.11, -0.04, 0.03] }
damper_bottom = { mass = 1.8, inertia = [0.02, 0.02, 0.001] }
damper_top = { mass = 0.9, inertia = [0.01, 0.01, 0.001] }
PARTS
[rear.bushings.tyre]
stiffness = [1.3e5, 1.15e5, 2.2e5]
damping = [0.0, 0.0, 400.0]
rotational_stiffness = 0.0
slip_stiffness = 8.75e4
cornering_stiffness = 4.64e4
carcass_longitudinal = 3.58e5
carcass_lateral = 1.03e5
trail = 0.032

[rear.bushings.damper_mount]
stiffness = [5e5, 5e5, 6e5]
damping = [500.0, 500.0, 500.0]
rotational_stiffness = 20.0

[rear.damper]
viscous_law = "linear"
viscous = 1800.0
friction_law = "coulomb"
coulomb_friction = 40.0
smoothing = 1e5
slip_velocity = 0.006

"""
LEAF = """
[rear.bushings.leaf_spring]
stiffness = [1.0e6, 4.0e5, 3.0e4]
damping = [500.0, 500.0, 100.0]
rotational_stiffness = 5.0e3
friction_force = [0.0, 0.0, 400.0]
friction_stroke = [0.0, 0.0, 0.002]
"""
AIR = """
[rear.bushings.air_spring]
stiffness = [0.0, 0.0, 1.0e3]
damping = [0.0, 0.0, 0.0]
rotational_stiffness = 0.0
air_area = 0.012
air_volume = 0.0025
air_area_slope = 0.02
air_exchange_time = 3.0
"""
LINKS = """
[rear.bushings.lower_inner]
stiffness = [2e6, 1e6, 2e6]
damping = [800.0, 800.0, 800.0]
rotational_stiffness = 100.0

[rear.bushings.upper_inner]
stiffness = [2e6, 1e6, 2e6]
damping = [800.0, 800.0, 800.0]
rotational_stiffness = 100.0
"""
POINTS = """lower_outer = [3.507, 0.55, 0.62]
lower_inner = [3.0, 0.55, 0.64]
upper_outer = [3.507, 0.1, 0.82]
upper_inner = [3.1, 0.45, 0.84]
"""
FILES = {
    "leaf_axle": AXLE.replace("POINTS", "").replace("PARTS", "") + LEAF,
    "air_axle": AXLE.replace("POINTS", POINTS).replace("PARTS", "lower_link.mass = 2.0\nupper_link.mass = 1.5\n")
    + AIR
    + LINKS,
}
UNSPRUNG = 32.0 + 18.5 + 6.0 + 3.0
"""Mass of axle, wheel and brake of one side [kg]; the dampers hang between axle and body."""


@pytest.fixture(scope="module")
def axles(tmp_path_factory):
    cars = {}
    for name, text in FILES.items():
        file = tmp_path_factory.mktemp(name) / "vehicle.toml"
        file.write_text(text.replace("NAME", name), encoding="utf-8")
        cars[name] = Car.load(file)
    return cars


def test_half_of_an_axle_may_have_the_mass_of_a_truck(axles):
    """An axle of 900 kg was refused, since its halves had the limit of a part of one side; a tyre still has it."""
    leaf = axles["leaf_axle"]
    heavy = leaf.with_({"rear.parts.axle.mass": 450.0, "rear.parts.axle.inertia": [90.0, 20.0, 90.0]})
    more = sum(heavy.static.tyre_load.values()) - sum(leaf.static.tyre_load.values())
    assert more == pytest.approx(2.0 * (450.0 - 32.0) * leaf.vehicle.gravity, rel=1e-6)
    for path, limit in (("axle", 500), ("tyre", 150)):
        with pytest.raises(ConfigurationError, match=rf"mass: found 600 kg, must be 0.02 to {limit} kg"):
            leaf.with_({f"rear.parts.{path}.mass": 600.0})


def test_wheel_rates_in_equal_travel(axles):
    rates = {name: axle_data(car, "rear").wheel_rate_n_per_m for name, car in axles.items()}
    validated(
        "Suspension kinematics", "leaf axle: wheel rate in equal travel", rates["leaf_axle"], 3e4, rel=2e-4, unit="N/m",
        source="closed form: stiffness of the spring; the rotational stiffness of the damper mounts adds 1e-4",
    )  # fmt: skip
    air = axles["air_axle"]
    # Between the wheel load, less axle, wheel and brake, and that less the half links and dampers too.
    loads = air.static.tyre_load["rr"] - air.vehicle.gravity * np.array([UNSPRUNG, UNSPRUNG + 1.75 + 1.8])
    low, high = sorted(1e3 + air_stiffness(load, 0.012, 0.0025, 0.02)[0] for load in loads)
    assert low < rates["air_axle"] < 1.06 * high  # the links turn on their bushings, and carry preload


def test_small_vibrations_have_the_tangent_of_the_leaves(axles):
    leaf = axles["leaf_axle"]
    plain = leaf.with_({"rear.bushings.leaf_spring.friction_force": [0.0, 0.0, 0.0],
                        "rear.bushings.leaf_spring.stiffness": [1e6, 4e5, 3e4 + 400.0 / 0.002]})  # fmt: skip
    frequency = np.linspace(0.5, 20.0, 40)
    stuck, spring = (car.matrix_frf(("seat_rail_acc_z",), frequency, wheel="rr") for car in (leaf, plain))
    validated(
        "Bushings, springs and stops", "leaf axle: FRF of the seat rail for small motion", stuck, spring, peak=1e-4,
        unit="m/s2 per m", source="closed form: springs of the stiffness K + Fmax/x2",
    )  # fmt: skip


def test_friction_of_the_leaves_by_energy():
    """Loop of the leaves of a spring: energy 4 sum l (X - l/k) of the leaves that slide in an amplitude X."""
    law, amplitude = friction_elements(400.0, 0.002), 0.03
    x = amplitude * np.sin(2.0 * np.pi * np.linspace(0.0, 2.0, 40_001))
    force = law.path(x)[20_000:]
    loop = float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(x[20_000:])))
    slides = law.limit < law.stiffness * amplitude
    closed = 4.0 * np.sum((law.limit * (amplitude - law.limit / law.stiffness))[slides])
    validated(
        "Bushings, springs and stops", "leaf spring: energy of a loop of 30 mm", loop, closed, rel=1e-4, unit="J",
        source="closed form: 4 sum l (X - l/k) of sliders in series with springs",
    )  # fmt: skip


def test_both_engines_and_energy(axles):
    """The axle with air springs; rides on leaf springs: `test_light_truck.py`."""
    name = "air_axle"
    road = Road("B", speed=60, duration=5, period="record")
    stepped, run = (axles[name].run(road, engine=engine) for engine in ("mujoco", "reduced"))
    channels = ("seat rail z", "knuckle rr z")
    validated(
        "Reduced engine", f"{name}: RMS of seat rail and knuckle over MuJoCo, class B",
        np.array([np.std(run[each]) / np.std(stepped[each]) for each in channels]), 1.0, abs=2e-3,
        source="second derivation: time integration in MuJoCo",
    )  # fmt: skip
    energies = stepped.recording.statistics.energies
    assert energies is not None
    validated(
        "Bushings, springs and stops", f"{name}: work, less stored and dissipated energy", energies.residual, 0.0,
        abs=3e-4, source="conservation: energy balance",
    )  # fmt: skip
