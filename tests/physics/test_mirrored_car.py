"""A car reflected in its middle plane, with reflected plates, has the reflected motion and loads."""

import copy
import re
from typing import Any

import numpy as np
import pytest

from vehicle.model.parameters.force_table import ForceTable
from vehicle.model.parameters.shipped import vehicle_file
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car
from vehicle.signals.excitation.signal import Signal

FILE = vehicle_file("sedan")
STEP_TABLE = {"displacement": [-0.002, 0.0001, 0.002], "force": [-1500.0, 40.0, 500.0]}
FLUID = {"chamber_stiffness": 4e5, "track_mass": 80.0, "track_damping": 1200.0}
DECOUPLER = {
    "decoupler_gap": 5e-5, "decoupler_mass": 1.0, "decoupler_damping": 60.0, "decoupler_stiffness": 2e3,
    "decoupler_seat": 2e5,
}  # fmt: skip
RUBBER = {"friction_force": [40.0, 30.0, 40.0], "friction_stroke": [2e-4, 1e-4, 2e-4]}
PENDULUM: dict[str, Any] = {
    "moving": "engine", "carrier": "body", "at": [0.75, 0.3, 0.6], "stiffness": [2e5, 1e5, 1e5],
    "damping": [200.0, 100.0, 200.0], "rotational_stiffness": 50.0, "axes": ["pendulum_end", "linear_mount"],
}  # fmt: skip
OF_A_SIDE: dict[str, Any] = {
    "moving": "knuckle_fr", "carrier": "body", "at": [0.8, 0.5, 0.5], "stiffness": [1e3, 2e3, 3e3],
    "damping": [20.0, 20.0, 20.0], "rotational_stiffness": 0.0,
}  # fmt: skip
LOAD: dict[str, Any] = {"mass": 60.0, "at": [3.4, 0.2, 0.7], "inertia": [3.0, 4.0, 5.0], "products": [0.3, 0.2, 0.4]}


def crooked(*, rubber):
    """The sedan with every law over displacement and different sides; rubber friction in place of a decoupler."""
    table = read_table(FILE)
    front, rear, engine = table["front"], table["rear"], table["engine"]
    front["right"] = {"damper": {"coulomb_friction": 140.0}, "bushings": {"arm_rear": {"stiffness": [3e6, 5e6, 1e6]}}}
    front["damper"]["stop"] = {"displacement": [-0.02, -0.0008, 0.001, 0.02], "force": [-4000.0, 0.0, 0.0, 5000.0]}
    front["bushings"]["arm_front"]["table_y"] = STEP_TABLE
    rear["damper"] |= {"friction_law": "presliding", "presliding_stiffness": 5e5, "side_force_coefficient": 0.1}
    rear["bushings"]["tyre"]["one_sided"] = True
    mount = engine["bushings"]["hydromount"]
    del mount["maxwell_stiffness"], mount["maxwell_damping"]
    mount |= FLUID if rubber else FLUID | DECOUPLER
    table["connection"] = {"pendulum": PENDULUM | (RUBBER if rubber else {}), "of_a_side": dict(OF_A_SIDE)}
    table["hardpoints"]["pendulum_end"] = [0.68, 0.46, 1.05]
    table["load"] = {"trunk": dict(LOAD)}
    return table


def other_side(name):
    """Name of the same element on the other side of the car."""
    return re.sub(r"(^|_)([fr])([lr])(?=_|$)", lambda m: m[1] + m[2] + {"l": "r", "r": "l"}[m[3]], name)


def reflected(table):
    """The vehicle file of the reflected car."""
    table = copy.deepcopy(table)

    def reflect(point):
        point[1] = -point[1]

    for points in (table["hardpoints"], table["engine"]["hardpoints"]):
        for point in points.values():
            reflect(point)
    reflect(table["body"]["cog"])
    table["front"]["left"] = table["front"].pop("right")
    for link in table["connection"].values():
        reflect(link["at"])
        link["moving"] = other_side(link["moving"])
    load = table["load"]["trunk"]
    reflect(load["at"])
    load["products"] = [-load["products"][0], load["products"][1], -load["products"][2]]
    return table


def plates(duration):
    """Smooth independent motions of four plates from rest, 2 to 6 mm RMS up to 30 Hz."""
    time = np.arange(round(duration * 1000)) * 1e-3
    rise = np.clip(time / 0.2, 0.0, 1.0) ** 3
    rng, lines = np.random.default_rng(4), np.arange(1.0, 30.0, 1.7)
    motion = {}
    for wheel in ("fl", "fr", "rl", "rr"):
        phases = rng.uniform(0.0, 2.0 * np.pi, len(lines))
        waves = np.cos(2.0 * np.pi * np.outer(time, lines) + phases) - np.cos(phases)
        motion[wheel] = 4e-3 * rise * (waves @ lines**-1.5)
    return Signal(time=time, displacement=motion)


# In MuJoCo the arms of the twist beam are a chain, whose centrifugal forces are of first order in the step: 3e-4 at
# 1 ms along x and y of the rear knuckles, half of it at 0.5 ms, a tenth with a tenth of the motion.
@pytest.mark.parametrize(("engine", "duration", "limit"), [("reduced", 1.5, 1e-6), ("mujoco", 0.4, 1e-3)])
def test_a_reflected_car_has_the_reflected_motion(engine, duration, limit):
    table, signal = crooked(rubber=engine == "mujoco"), plates(duration)
    car, image = (Car(vehicle_of(each, FILE.parent), folder=FILE.parent) for each in (table, reflected(table)))
    turned = Signal(time=signal.time, displacement={other_side(w): z for w, z in signal.displacement.items()})
    names = [*car.vehicle.channels, *car.vehicle.requested_channels]
    run = car.run(signal, engine=engine, channels=names)
    seen = image.run(turned, engine=engine, channels=[other_side(name) for name in names])
    for name in names:
        # A rotation about x or z, as in roll, is reversed.
        sign = -1.0 if name.endswith(("_y", "_torque")) else 1.0
        found, exact = sign * np.asarray(seen[other_side(name)]), np.asarray(run[name])
        scale = np.sqrt(np.mean(exact**2))
        assert scale > 0.0 and np.sqrt(np.mean((found - exact) ** 2)) < limit * scale, name
    assert np.ptp(run["tyre_fr_force_z"]) > 500.0 and run["tyre_fr_force_z"][0] - run["tyre_fl_force_z"][0] > 100.0


def test_a_table_of_one_side_is_not_reflected():
    table = crooked(rubber=False)
    table["front"]["left"] = {"bushings": {"arm_front": {"table_y": STEP_TABLE}}}
    car = Car(vehicle_of(table, FILE.parent), folder=FILE.parent)
    tables = [link.table("y") for link in car.vehicle.composition.connections if "arm_front" in link.name]
    points = {key: tuple(values) for key, values in STEP_TABLE.items()}
    assert tables == [ForceTable(**points)] * 2
