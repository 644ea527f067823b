"""Cab of 600 kg on four mounts, with a seat on it: statics, transmission; its rides: `test_light_truck.py`."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.runs.car import Car

MASS, STIFFNESS, DAMPING = 600.0, 9e4, 1500.0

MOUNT = f"stiffness = [3e5, 3e5, {STIFFNESS}]\ndamping = [800.0, 800.0, {DAMPING}]\nrotational_stiffness = 0.0\n"
CORNERS = [f"{end}_{side}" for end in ("front", "rear") for side in ("right", "left")]

CAR = f"""
base = "sedan"
name = "cab_car"

[outputs]
front_right = {{ on = "body", at = [1.0, 0.6, 1.3] }}
front_left = {{ on = "body", at = [1.0, -0.6, 1.3] }}
rear_right = {{ on = "body", at = [2.4, 0.6, 1.3] }}
rear_left = {{ on = "body", at = [2.4, -0.6, 1.3] }}
cab_middle = {{ on = "cab", at = [1.7, 0.0, 1.3] }}

[cab]
template = "cab"
hardpoints.cab_cog = [1.7, 0.0, 1.3]
hardpoints.front_mount = [1.0, 0.6, 1.3]
hardpoints.rear_mount = [2.4, 0.6, 1.3]
hardpoints.floor = [1.5, 0.5, 1.2]
parts = {{ cab = {{ mass = {MASS}, inertia = [250.0, 350.0, 300.0] }} }}

[seat.driver]
template = "seat_occupant"
ports = {{ body = "cab.cab" }}
hardpoints = {{ rail = [1.5, 0.5, 1.2] }}
parts.seat = {{ mass = 20.0, inertia = [1.0, 1.0, 1.0] }}
parts.occupant = {{ mass = 50.0, inertia = [1.0, 1.0, 1.0] }}
occupant_spring = {{ stiffness = 5e4, damping = 1500.0 }}

[seat.driver.bushings.cushion]
stiffness = [2e5, 2e5, 3e4]
damping = [1000.0, 1000.0, 800.0]
rotational_stiffness = 0.0
""" + "".join(f"\n[cab.bushings.cab_{corner}]\n{MOUNT}" for corner in CORNERS)


@pytest.fixture(scope="module")
def car(tmp_path_factory):
    file = tmp_path_factory.mktemp("cab") / "vehicle.toml"
    file.write_text(CAR, encoding="utf-8")
    return Car.load(file)


def test_the_cab_adds_its_weight(car):
    plain = sum(Car.load("sedan").static.tyre_load.values())
    validated(
        "Static equilibrium", "wheel loads of a car with a cab and its seat, less those without",
        sum(car.static.tyre_load.values()) - plain, (MASS + 70.0) * car.vehicle.gravity, rel=1e-6, unit="N",
        source="closed form: weight of cab, seat and occupant",
    )  # fmt: skip


def test_transmission_of_four_mounts(car):
    """m a = 4 (K + B s) (mean of the floor - a) / s2 - force of the cushion, with mounts symmetric about the CoG."""
    frequency = np.linspace(0.5, 20.0, 50)
    s = 2j * np.pi * frequency
    names = [*(f"{corner}_acc_z" for corner in CORNERS), "cab_middle_acc_z", "cab_floor_acc_z", "seat_acc_z"]
    *floor, cab, rail, seat = car.matrix_frf(names, frequency, wheel="fr")
    mounts, cushion = 4.0 * (STIFFNESS + DAMPING * s) / s**2, (3e4 + 800.0 * s) / s**2
    validated(
        "Bushings, springs and stops", "cab on four mounts, vertical acceleration of its centre of gravity", cab,
        (mounts * np.mean(floor, axis=0) + cushion * (seat - rail)) / (MASS + mounts), peak=1e-4, unit="m/s2 per m",
        source="closed form: Newton's law of the cab on its mounts and the cushion",
    )  # fmt: skip
