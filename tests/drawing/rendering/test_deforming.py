"""What deforms in the film, against the sites of the recorded places and their modal shapes."""

import mujoco
import numpy as np
import pytest

from tests.drawing.rendering.test_palette import linear, oklab
from vehicle.drawing.rendering.body_wireframe import Wireframe
from vehicle.drawing.rendering.colour_scale import colours
from vehicle.drawing.rendering.motion import Coil, RecordedMotion
from vehicle.drawing.rendering.wireframe import COIL_RADIUS, _coil


@pytest.fixture(scope="module")
def motion(stage, run):
    return RecordedMotion(stage, run.recording, 0.0, 0.3)


@pytest.mark.parametrize(
    "place", ["seat_rail", "seat", "roof_left_rear", "body_front", "suspension_mount_fr", "suspension_mount_fl"]
)
def test_nodes_are_where_the_recorder_measures(car, stage, run, motion, place):
    data = mujoco.MjData(stage)
    data.qpos[:] = run.recording.poses[7]
    mujoco.mj_kinematics(stage, data)
    modal = np.array(
        [data.qpos[stage.joint(f"mode_{number}").qposadr[0]] for number in range(1, len(motion.modal) + 1)]
    )
    shape = stage.numeric(f"shape/place/{place}").data.reshape(3, -1)
    turn = data.xmat[stage.body("body").id].reshape(3, 3)
    measured = data.site(f"place/{place}").xpos + turn @ shape @ modal
    node = place.replace("suspension_mount", "strut_top")
    places = Wireframe(car, motion).positions(motion.at(run.recording.pose_time[7]), 1.0)
    assert len(motion.modal) == 9
    # Rounding only; the modal part is 1e-4 m here.
    np.testing.assert_allclose(places[car.superelement.node_index(node)], measured, atol=1e-9)


def test_the_factor_multiplies_the_elastic_part(car, run, motion):
    frame = Wireframe(car, motion)
    state = motion.at(run.recording.pose_time[7])
    elastic = type(state)(translation=0.0 * state.translation, rotation=0.0 * state.rotation, modal=state.modal)
    one, ten = frame.positions(elastic, 1.0) - frame.rest, frame.positions(elastic, 10.0) - frame.rest
    assert np.abs(one).max() > 1e-5
    np.testing.assert_allclose(ten, 10.0 * one, atol=1e-12)


def test_displacement_is_true_whatever_the_factor(car, run, motion):
    frame = Wireframe(car, motion)
    state = motion.at(run.recording.pose_time[7])
    expected = np.linalg.norm(frame.positions(state, 1.0) - car.superelement.positions, axis=1)
    np.testing.assert_allclose(frame.displacement(state), expected, atol=1e-15)


def test_colours_of_the_displacement_grow_lighter_in_equal_steps():
    """OKLab: lightness rises throughout, and no step between twenty shades is twice the mean one."""
    shades = np.array([oklab(linear(colour)) for colour in colours(np.linspace(0.0, 2.0, 21), 2.0)[:, :3]])
    steps = np.linalg.norm(np.diff(shades, axis=0), axis=1)
    assert np.all(np.diff(shades[:, 0]) > 0.0) and np.ptp(shades[:, 0]) > 0.5
    assert steps.max() < 1.5 * steps.mean() and steps.min() > 0.5 * steps.mean()
    np.testing.assert_array_equal(colours([5.0], 2.0), colours([2.0], 2.0))


def coil_of(car, motion, wheel):
    composition = car.vehicle.composition
    return Coil(motion, composition, next(one for one in composition.springs if one.name == f"main_spring_{wheel}"))


def test_the_coil_follows_both_seats(car, stage, run, motion):
    coil = coil_of(car, motion, "fr")
    state = motion.at(run.recording.pose_time[7])
    still = type(state)(translation=0.0 * state.translation, rotation=0.0 * state.rotation, modal=0.0 * state.modal)
    np.testing.assert_allclose(coil.positions(still, 500.0), coil.rest, atol=1e-12)
    places = coil.positions(state, 500.0)
    bottom, top = coil.share[:, 0] == 0.0, coil.share[:, 0] == 1.0
    assert bottom.any() and top.any()
    lower = motion.moved(state, 500.0, stage.body("damper_bottom_fr").id, coil.rest)
    upper = motion.moved(state, 500.0, stage.body("damper_top_fr").id, coil.rest)
    assert np.abs(lower - upper).max() > 0.01  # the seats part by more than the tolerance could hide
    np.testing.assert_allclose(places[bottom], lower[bottom], atol=1e-12)
    np.testing.assert_allclose(places[top], upper[top], atol=1e-12)


def test_the_coil_is_written_in_the_frame_of_its_mesh(car, stage, run, motion):
    coil = coil_of(car, motion, "fl")
    before = stage.mesh_vert[coil.rows].copy()
    data = mujoco.MjData(stage)
    try:
        coil.write(data, coil.rest + np.array([0.0, 0.0, 0.25]))
        shown = stage.mesh_vert[coil.rows] @ data.geom_xmat[coil.geom].reshape(3, 3).T + data.geom_xpos[coil.geom]
        np.testing.assert_allclose(shown, coil.rest + np.array([0.0, 0.0, 0.25]), atol=1e-6)  # single precision
    finally:
        stage.mesh_vert[coil.rows] = before


def test_a_coil_lies_on_a_line_of_any_direction():
    for direction in np.vstack([np.eye(3), -np.eye(3), [[0.9, 0.1, 0.3]]]):
        coil = _coil(np.zeros(3), 0.4 * direction)
        np.testing.assert_allclose(coil[[0, -1]], [np.zeros(3), 0.4 * direction], atol=1e-12)
        unit = direction / np.linalg.norm(direction)
        away = np.linalg.norm(coil - np.outer(coil @ unit, unit), axis=1)
        assert away.max() == pytest.approx(COIL_RADIUS) and np.all(away[10:-10] > 0.99 * COIL_RADIUS)
