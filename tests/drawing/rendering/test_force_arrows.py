"""Arrows of forces in a film: their lengths, signs and points, and their length in the picture."""

import dataclasses
from contextlib import closing

import mujoco
import numpy as np
import pytest

from vehicle.drawing.rendering.added_geom import add_geom
from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.cameras import whole_car
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.force_arrows import LENGTH, TYRE, ForceArrows
from vehicle.drawing.rendering.motion import Motion, State


def arrows(car, run, stage, **forces):
    """Arrows of the fabricated run with given forces [N]."""
    time = run.recording.time
    channels = run.recording.channels | {name: force + 0.0 * time for name, force in forces.items()}
    recording = dataclasses.replace(run.recording, channels=channels)
    return ForceArrows(Motion(stage), car.vehicle.composition, recording, 0.0, float(time[-1]))


def test_a_force_has_its_length_and_sign(car, run, stage):
    time = run.recording.time
    # The tyre gains 300 N in the second half; the damper in extension takes 150 N, which pulls the body down.
    later = np.where(time > 0.15, 1.0, 0.0)
    made = arrows(car, run, stage, tyre_fr_force_z=3400.0 + 300.0 * later, damper_fr_force=150.0 * later)
    assert made.top == 300.0 and made.words.endswith("40 cm is 300 N")
    right, left, damper, _ = made.vectors(0.2, 0.03)
    np.testing.assert_allclose(right, [0.0, 0.0, LENGTH])
    np.testing.assert_allclose(left, 0.0, atol=1e-5)
    assert np.linalg.norm(damper) == pytest.approx(0.5 * LENGTH)
    top, below = (np.array(point) for point in ((0.877, 0.548, 1.23), (0.845, 0.7, 0.595)))  # strut of the car
    assert np.dot(damper, top - below) < 0.0
    # Half of the frame lies before the step.
    np.testing.assert_allclose(made.vectors(0.15, 0.1)[0], [0.0, 0.0, 0.5 * LENGTH], rtol=0.02)


def test_a_car_at_rest_has_no_arrows(car, run, stage):
    assert arrows(car, run, stage, tyre_fr_force_z=3400.0).words == ""


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_an_arrow_is_drawn_as_long_as_a_rod_of_its_length(car, run, stage):
    made = arrows(car, run, stage, tyre_fr_force_z=3400.0 + np.where(run.recording.time > 0.0, 300.0, 0.0))
    still = State(
        translation=np.zeros((stage.nbody, 3)), rotation=np.zeros((stage.nbody, 3)), modal=np.zeros(stage.njnt)
    )
    data = mujoco.MjData(stage)
    for place in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_camlight):
        place(stage, data)
    (arrow,) = (one for one in made.arrows if one.force[-1] > 100.0)
    middle = arrow.point[0] + 0.5 * LENGTH * arrow.direction

    def rod(scene):
        size = (0.018, 0.018, 0.5 * LENGTH)
        add_geom(scene, mujoco.mjtGeom.mjGEOM_BOX, size, middle, TYRE)

    heights = []
    for draw in (rod, lambda scene: made.draw(scene, still, 1.0, 0.2, 0.01)):
        with closing(Canvas(stage, (320, 180), choose_backend())) as canvas:
            pictures = []
            for added in (False, True):
                canvas.update(data, whole_car(car.vehicle))
                if added:
                    draw(canvas.scene)
                canvas.render((0, 0, 320, 180))
                pictures.append(canvas.read().astype(int))
            rows = np.flatnonzero(np.abs(pictures[1] - pictures[0]).max(axis=(1, 2)) > 40)
            heights.append(np.ptp(rows))
    assert heights[0] > 10, "the rod is hidden"
    assert heights[1] == pytest.approx(heights[0], abs=2)
