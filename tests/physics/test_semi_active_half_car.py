"""Semi-active dampers of both engines against the lumped half car with rider, every law, with delay and rate."""

import dataclasses

import mujoco
import numpy as np
import pytest

from scenarios.lumped.bump_response import bump_passage
from scenarios.lumped.half_car_rider_parameters import half_car_rider_parameters
from scenarios.lumped.semi_active_half_car import simulate_bump
from tests.physics.controlled_half_car import half_car_spec
from tests.physics.written_control import use_written_control
from tests.validation import validated
from vehicle.engines.linear.car_matrices import car_matrices
from vehicle.engines.reduced.pole_model import pole_model
from vehicle.engines.reduced.reduced_run import simulate_reduced
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.plate_arrays import PlateArrays
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.model.parameters.semi_active_damper import LAWS
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.signals.excitation.signal import Signal, uniform_time

STEP, DURATION, SPEED = 1e-3, 0.8, 30.0 / 3.6
CAR = half_car_rider_parameters()
# A small bump: turns of the body are small angles, and all laws are homogeneous. A long one: its corners are blunt.
CAR = dataclasses.replace(CAR, bump=dataclasses.replace(CAR.bump, height=1e-3, length=2.0))
PASSAGE = bump_passage(CAR.bump, SPEED, CAR.body.front_arm + CAR.body.rear_arm)
TIME = uniform_time(samples=round(DURATION / STEP) + 1, timestep=STEP)
ROAD = Signal(time=TIME, displacement=dict(zip(("fr", "rr"), PASSAGE.heights(TIME), strict=True)))
SOURCE = "second derivation: lumped half car with control laws written for the test"
REAL = {"delay": 0.012, "rate": 1e5}


def with_control(**changes):
    return dataclasses.replace(CAR, semi_active=dataclasses.replace(CAR.semi_active, **changes))


def damper_of(car):
    """Return a damper of the complete car without friction under the control of a half car."""
    return dataclasses.replace(
        load_vehicle().damper, coulomb_friction=0.0, stribeck_friction=0.0, control=car.semi_active
    )


def lumped(car):
    """Velocities at every step of the engines."""
    (history,) = simulate_bump([car], [SPEED], law=car.semi_active.law, duration=DURATION, largest_step=5e-4)
    names = {"heave": "heave", "upper limb": "upper_limb", "damper_fr": "front_travel", "damper_rr": "rear_travel"}
    every = round(STEP / history.time[1])
    return {name: history.velocity(output)[::every] for name, output in names.items()}


def in_mujoco(car):
    """Velocities at every step, and the coefficients of the rows."""
    model = half_car_spec(car, damper_of(car), STEP).compile()
    prepare_model(model)
    data, rows = mujoco.MjData(model), Rows(model)
    plates = PlateArrays.of(ROAD, STEP, TIME.size - 1, ("fr", "rr"))
    velocity, coefficient = np.zeros((TIME.size, model.nv)), np.zeros((TIME.size, 2))
    with installed(rows):
        for index in range(TIME.size):
            data.mocap_pos[:, 2] = 1.0 + plates.displacement[index]
            rows.state.plate_velocity[:, 2] = plates.row_velocity[index]
            rows.state.plate_acceleration[:, 2] = plates.acceleration[index]
            mujoco.mj_step(model, data)
            velocity[index] = data.qvel - 0.5 * STEP * data.qacc
            coefficient[index] = rows.state.coefficient
    joint_velocity = {model.joint(joint).name: velocity[:, model.jnt_dofadr[joint]] for joint in range(model.njnt)}
    base = joint_velocity["heave"] - CAR.body.seat_arm * joint_velocity["pitch"]
    return {
        "heave": joint_velocity["heave"],
        "upper limb": base + joint_velocity["seat"] + joint_velocity["upper_limb"],
        "damper_fr": -joint_velocity["damper_fr"],
        "damper_rr": -joint_velocity["damper_rr"],
    }, coefficient


def reduced(car):
    """The reduced engine on the matrices of the same MuJoCo model."""
    model = half_car_spec(car, damper_of(car), STEP).compile()
    loads = {"fr": 1e6, "rr": 1e6}
    still = StaticTrim(
        preload=np.zeros(Rows(model).weights.preload.size), tyre_load=loads, support_load={}, residual=0.0
    )
    names = [f"damper_{wheel}_{quantity}" for wheel in loads for quantity in ("velocity", "force", "coefficient")]
    return simulate_reduced(
        pole_model(car_matrices(model, still)), ROAD, dampers=[damper_of(car)] * 2, record_rate=1.0 / STEP,
        tyre_load=loads, channels=names,
    )  # fmt: skip


def gap(values, expected):
    return float(np.std(values - expected) / np.std(expected))


@pytest.mark.parametrize("law", LAWS)
def test_both_engines_are_the_lumped_half_car(law, monkeypatch):
    use_written_control(monkeypatch)
    car = with_control(law=law, **(REAL if law in ("hybrid", "skyhook_on_off") else {}))
    expected, (stepped, coefficient), run = lumped(car), in_mujoco(car), reduced(car)
    # Point by point. MuJoCo at 1 ms knows the instant of a switch from velocities half a step old: it may be one late.
    for name, values in expected.items():
        validated(
            "Semi-active dampers", f"half car under {law} in MuJoCo, RMS error of the velocity of {name}",
            gap(stepped[name], values), 0.0, abs=1e-2 if "on_off" in law else 4e-3,
            source=SOURCE,
        )  # fmt: skip
    for number, wheel in enumerate(("fr", "rr")):
        velocity, setting = -run[f"damper_{wheel}_velocity"], run[f"damper_{wheel}_coefficient"]
        validated(
            "Semi-active dampers", f"half car under {law}, reduced engine, RMS error of the velocity of damper {wheel}",
            gap(velocity, expected[f"damper_{wheel}"]), 0.0, abs=4e-3, source=SOURCE,
        )  # fmt: skip
        # Passive at every sample: the force is a coefficient of the damper times its velocity.
        force = -run[f"damper_{wheel}_force"]
        np.testing.assert_allclose(force, setting * velocity, atol=1e-9 * np.max(np.abs(force)))
        for history in (setting, coefficient[:, number]):
            assert 300.0 - 1e-9 <= history.min() < history.max() <= 3000.0 + 1e-9
