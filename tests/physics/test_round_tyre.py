"""Round tyres at rest: lowest point of the tread at any attitude, and the stiffness that a fixed patch takes off."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.physics.rolling_car import RADIUS, rolling_car
from tests.validation import validated
from vehicle.engines.kinematics.axle_curves import design_slopes
from vehicle.engines.simulation.rows import Rows
from vehicle.runs.car import Car
from vehicle.runs.car.axle import axle_statics


def test_height_is_that_of_the_lowest_point_of_the_rim(tmp_path: Path) -> None:
    """Rows of a car with hubs at large attitudes against a search along the rim of a thin disc."""
    car = rolling_car(tmp_path, 0.0)
    model = car.model.model
    rows, data, rng = Rows(model, car.static.preload), mujoco.MjData(model), np.random.default_rng(3)
    angle = np.linspace(0.0, 2.0 * np.pi, 100_001)
    rim = RADIUS * np.column_stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)])
    heights, lowest, rates, gradients = [], [], [], []
    way = rng.normal(size=model.nv)
    for _ in range(5):
        ends = []
        start = model.qpos0.copy()
        mujoco.mj_integratePos(model, start, rng.uniform(-0.3, 0.3, model.nv), 1.0)
        for step in (0.0, 1e-6, -1e-6):
            data.qpos[:], data.qvel[:] = start, way
            mujoco.mj_integratePos(model, data.qpos, way, step)
            mujoco.mj_fwdPosition(model, data)
            mujoco.mj_fwdVelocity(model, data)
            rows(model, data)
            row = rows.layout.bushings.rows[rows.layout.round.tyres, 2]
            ends.append((data.efc_pos[row].copy(), data.efc_vel[row].copy()))
        heights.append(ends[0][0])
        rates.append(ends[0][1])
        gradients.append((ends[1][0] - ends[2][0]) / 2e-6)
        lowest.append(
            [data.xpos[hub][2] + np.min(rim @ data.xmat[hub].reshape(3, 3)[2]) for hub in rows.layout.round.hubs]
        )
    validated(
        "Tyres", "height of round tyres at rest over their plates, hubs rotated by up to 0.3 rad",
        np.array(heights), np.array(lowest), abs=1e-5, unit="m",
        source="closed form: lowest of 100 000 points of a circle",
    )  # fmt: skip
    assert np.array(rates) == pytest.approx(np.array(gradients), abs=1e-7)


def test_patch_fixed_to_the_wheel_takes_load_times_radius_off_the_pitch_stiffness(tmp_path: Path) -> None:
    """Difference of the stiffness matrices of both contacts: F R about the axle of each hub."""
    cars = [rolling_car(tmp_path, 0.0, gravity=9.81, tyre={"round": contact}) for contact in (True, False)]
    difference = cars[0].matrices.system.stiffness - cars[1].matrices.system.stiffness
    expected = np.zeros_like(difference)
    for wheel in cars[0].vehicle.wheels:
        pitch = cars[0].matrices.body_rows[f"knuckle_{wheel}"][4]
        expected += cars[0].static.tyre_load[wheel] * RADIUS * np.outer(pitch, pitch)
    validated(
        "Tyres", "stiffness that a patch fixed to the wheel takes off the pitch of the hubs",
        difference[expected != 0.0], expected[expected != 0.0], rel=1e-5, unit="N m/rad",
        source="closed form: static load times loaded radius",
    )  # fmt: skip
    assert np.max(np.abs(difference - expected)) < 1e-5 * np.max(expected)


def test_standing_round_tyres_have_the_wheel_rate_of_rolling_tyres() -> None:
    """A trailing arm; the small rest is the horizontal force and the torque of the tyres at rest."""
    rates = {}
    for contact in ("true", "false"):
        car = Car.load("sedan", [f"*.bushings.tyre.round={contact}"])
        for standing in (True, False):
            slopes = design_slopes(axle_statics(car, "rear", ideal=False, standing=standing))
            rate = slopes["wheel_rate_n_per_m"]
            assert rate is not None
            rates[contact, standing] = rate
    assert rates["true", True] == pytest.approx(rates["true", False], rel=5e-3)
    assert rates["false", True] < 0.85 * rates["false", False]


def test_spin_moves_the_lowest_point_along_the_road(tmp_path: Path) -> None:
    """Rows over the spins of wheels with camber: e x r, e the axle and r the lowest point of a disc."""
    car = rolling_car(tmp_path, 20.0)
    model = car.model.model
    rows, data, rng = Rows(model, car.static.preload), mujoco.MjData(model), np.random.default_rng(5)
    tyres = rows.layout.rolling
    mujoco.mj_integratePos(model, data.qpos, rng.uniform(-0.3, 0.3, model.nv), 1.0)
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_fwdVelocity(model, data)
    rows(model, data)
    angle = np.linspace(0.0, 2.0 * np.pi, 100_001)
    rim = RADIUS * np.column_stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)])
    jacobian = data.efc_J.reshape(-1, model.nv)
    expected, computed = [], []
    for tyre, hub, spin in zip(tyres.tyres, tyres.hubs, tyres.spins, strict=True):
        turned = data.xmat[hub].reshape(3, 3)
        lowest = turned @ rim[np.argmin(rim @ turned[2])]
        expected.append(np.cross(turned[:, 1], lowest))
        computed.append(jacobian[rows.layout.bushings.rows[tyre], spin])
        assert abs(turned[2, 1]) > 0.02, "no camber: the test would see nothing"
    np.testing.assert_allclose(computed, expected, atol=1e-4)  # of the angle between two points of the rim
