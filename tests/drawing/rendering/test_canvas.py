"""Pictures of a stage: floor, horizon, and the frame that does not move."""

from contextlib import closing

import mujoco
import numpy as np
import pytest

from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.cameras import whole_car
from vehicle.drawing.rendering.canvas import Canvas
from vehicle.drawing.rendering.stage import frame_at_rest


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_the_floor_fades_into_the_sky(car, stage):
    data = mujoco.MjData(stage)
    for place in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_camlight):
        place(stage, data)
    with closing(Canvas(stage, (320, 180), choose_backend())) as canvas:
        canvas.update(data, whole_car(car.vehicle))
        canvas.render((0, 0, 320, 180))
        column = canvas.read()[:, 3].astype(int)  # left of the car
    steps = np.abs(np.diff(column, axis=0)).max(axis=1)
    # The sky is six grey levels lighter than the floor, which is an edge where there is no haze.
    assert np.abs(column[0] - column[-1]).max() > 4 and steps.max() <= 3


def test_the_frame_at_rest_is_the_members_in_the_design_position(car):
    (shape,) = frame_at_rest(car).values()
    element = car.superelement
    ends = np.asarray(element.positions)[np.asarray(element.edges)]
    # Hexagonal prisms of 5 mm, 3/2 sqrt(3) r^2 each.
    volume = 1.5 * np.sqrt(3.0) * 0.005**2 * np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum()
    assert shape.part == "world"
    assert shape.mesh.volume == pytest.approx(volume, rel=1e-9)
    np.testing.assert_allclose(shape.mesh.bounds, [ends.min((0, 1)), ends.max((0, 1))], atol=0.005)
