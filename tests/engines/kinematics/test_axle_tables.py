"""Equilibrium of an axle on tables, stops and gas: against the element laws of the time simulation, and by hand."""

from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt
import pytest

from vehicle.engines.kinematics.axle_statics import AxleStatics
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.toml_file import read_table
from vehicle.model.parameters.vehicle import vehicle_of
from vehicle.runs.car import Car

STOP = {"displacement": [-0.08, -0.05, -0.02, 0.03, 0.06], "force": [-8000.0, -2000.0, 0.0, 0.0, 1500.0]}
SPRING = {"displacement": [-0.3, -0.15, -0.1, 0.0], "force": [-9000.0, -4000.0, -2500.0, 0.0]}
MOUNT = {"displacement": [-0.008, -0.004, 0.0, 0.004], "force": [-8000.0, -3200.0, 0.0, 3200.0]}


def bent_car(**damper: Any) -> Car:
    """The car with tables in the front axle; mounts that do not resist turning, for which the laws differ by sin."""
    table = read_table(FOCUS_FILE)
    for one in table["front"]["bushings"].values():
        one["rotational_stiffness"] = 0.0
    table["front"]["damper"] |= damper
    if damper:
        table["front"]["main_spring"]["table"] = SPRING
        table["front"]["bushings"]["suspension_mount"]["table_z"] = MOUNT
    return Car(vehicle_of(table, FOCUS_FILE.parent), folder=FOCUS_FILE.parent)


def axle(car: Car) -> AxleStatics:
    return AxleStatics(car.model.model, car.model.static.preload, wheels=car.vehicle.composition.wheels, standing=True)


@pytest.fixture(scope="module")
def bent() -> Car:
    return bent_car(stop=STOP, gas_force=250.0)


def unbalanced(car: Car, statics: AxleStatics, loads: list[float]) -> npt.NDArray[np.float64]:
    """What the laws of the time simulation leave on the coordinates of the axle with these loads under the wheels."""
    model, static = car.model.model, car.model.static.preload.copy()
    rows = Rows(model, static)
    own = rows.layout.bushings
    for tyre, load in zip(rows.layout.tyres, loads, strict=True):
        own.stiffness[tyre], static[own.rows[tyre, 2]] = 0.0, load
    data = mujoco.MjData(model)
    data.qpos[:] = statics.data.qpos
    with installed(rows):
        mujoco.mj_forward(model, data)
    force = data.qfrc_smooth.copy()
    dampers = rows.layout.dampers
    force[dampers.dofs] += dampers.laws["shift"] - dampers.laws["rest_force"]
    # What is left is carried by the ideal joints, or it is not.
    joints = data.efc_J.reshape(-1, model.nv)[rows.layout.joints.ravel()][:, statics.columns].T
    left = force[statics.columns]
    return np.asarray(left - joints @ np.linalg.lstsq(joints, left, rcond=None)[0])


@pytest.mark.parametrize("travel", [-0.06, -0.03, 0.0, 0.02, 0.04, 0.06])
def test_the_laws_of_the_time_simulation_are_in_equilibrium(bent, travel):
    statics = axle(bent)
    poses = statics.solve([travel, travel])
    left = unbalanced(bent, statics, [pose.load_n for pose in poses])
    assert np.max(np.abs(left)) < 1e-4
    # It can fail: a newton more under one wheel.
    more = unbalanced(bent, statics, [poses[0].load_n + 1.0, poses[1].load_n])
    assert np.max(np.abs(more)) > 0.1
