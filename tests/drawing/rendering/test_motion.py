"""Pose mathematics of the film against MuJoCo's own kinematics."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.drawing.rendering.conftest import fabricated
from vehicle.drawing.rendering.motion import RecordedMotion
from vehicle.drawing.rendering.rounding import round_factor, round_up

EXACT = 1e-9
"""[m], [1]: a spline passes through its knots; what remains is rounding through a rotation vector and back."""


@pytest.fixture(scope="module")
def motion(stage, run):
    return RecordedMotion(stage, run.recording, 0.0, 0.3)


def kinematics(stage, recording, index):
    data = mujoco.MjData(stage)
    data.qpos[:] = recording.poses[index]
    for wheel in ("fr", "fl"):
        plate = stage.body_mocapid[stage.body(f"plate_{wheel}").id]
        now = recording.pose_time[index]
        data.mocap_pos[plate, 2] += np.interp(now, recording.time, recording[f"plate_{wheel}_displacement"])
    mujoco.mj_kinematics(stage, data)
    return data


@pytest.mark.parametrize("index", [0, 7, 30])
def test_factor_one_is_the_kinematics_of_mujoco(stage, run, motion, index):
    data = kinematics(stage, run.recording, index)
    position, orientation = motion.geoms(motion.at(run.recording.pose_time[index]), 1.0)
    np.testing.assert_allclose(position, data.geom_xpos, atol=EXACT)
    np.testing.assert_allclose(orientation, data.geom_xmat, atol=EXACT)


def test_factor_multiplies_displacement_and_angle(stage, run, motion):
    data = kinematics(stage, run.recording, 7)
    rest = mujoco.MjData(stage)
    mujoco.mj_kinematics(stage, rest)
    position, orientation = motion.poses(motion.at(run.recording.pose_time[7]), 5.0)
    np.testing.assert_allclose(position - rest.xpos, 5.0 * (data.xpos - rest.xpos), atol=5 * EXACT)
    moved, start = data.xmat.reshape(-1, 3, 3), rest.xmat.reshape(-1, 3, 3)
    angle = Rotation.from_matrix(moved @ start.transpose(0, 2, 1)).magnitude()
    shown = Rotation.from_matrix(orientation @ start.transpose(0, 2, 1)).magnitude()
    assert angle.max() > 1e-4  # something turns
    np.testing.assert_allclose(shown, 5.0 * angle, atol=1e-7)  # arccos near 1 keeps half of the digits


def test_points_of_a_part_move_with_it(stage, run, motion):
    data = kinematics(stage, run.recording, 7)
    rest = mujoco.MjData(stage)
    mujoco.mj_kinematics(stage, rest)
    site = stage.site("place/knuckle_fr").id
    body = stage.site_bodyid[site]
    shown = motion.moved(motion.at(run.recording.pose_time[7]), 1.0, body, rest.site_xpos[[site]])
    np.testing.assert_allclose(shown[0], data.site_xpos[site], atol=EXACT)


def test_between_poses_the_motion_is_smooth(stage, motion):
    body = stage.body("body").id
    time = 0.1234
    exact = 1e-3 * np.cos(2) * np.sin(2 * np.pi * 2.0 * time)  # translation along z is the third coordinate
    # Cubic spline of 2 Hz at 100 Hz: (w h)^4 / 384 = 6e-7 of the amplitude.
    assert motion.at(time).translation[body, 2] == pytest.approx(exact, abs=1e-3 * 1e-6)


def test_an_open_shutter_averages(stage, car):
    motion = RecordedMotion(stage, fabricated(car, 2.0), 0.0, 2.0)
    body = stage.body("body").id
    instant = motion.at(1.1).translation[body, 2]
    # The mean of sin over T is sin(w T/2)/(w T/2) of its value in the middle, here with w T = pi/2 ...
    quarter = motion.at(1.1, 0.125).translation[body, 2]
    assert quarter / instant == pytest.approx(np.sin(np.pi / 4) / (np.pi / 4), rel=1e-5)  # the spline's error
    # ... and nothing at all over a whole period.
    assert abs(motion.at(1.1, 0.5).translation[body, 2]) < 1e-5 * abs(instant)


def test_factors_are_rounded_down_and_scales_up():
    factors = {0.2: 1.0, 1.0: 1.0, 1.49: 1.0, 1.5: 1.5, 24.0: 20.0, 99.0: 70.0, 300.0: 300.0}
    assert {value: round_factor(value) for value in factors} == factors
    scales = {0.0: 1.0, 0.93: 1.0, 1.0: 1.0, 1.01: 1.5, 0.034: 0.04}
    assert {value: round_up(value) for value in scales} == pytest.approx(scales)
