"""A car on four wheels on the road: what passes under it is what its plates did."""

import dataclasses
from pathlib import Path

import mujoco
import numpy as np
import pytest

from tests.drawing.rendering.conftest import FakeCar, FakeRun, fabricated
from vehicle.drawing.rendering.backend import choose_backend
from vehicle.drawing.rendering.layout import Layout
from vehicle.drawing.rendering.motion import RecordedMotion
from vehicle.drawing.rendering.recorded_run import hub_channel
from vehicle.drawing.rendering.road_strip import RoadStrip
from vehicle.drawing.rendering.rolling import RollingWheel
from vehicle.drawing.rendering.shot import Shot, Take
from vehicle.drawing.rendering.stage import stage_model
from vehicle.names import side_of, wheel_words
from vehicle.runs.car import Car

SPEED = 26.15
"""[m/s]: the wheelbase of 2.615 m is 0.1 s."""


@pytest.fixture(scope="module")
def road_car():
    return Car.load(Path("focus_road")).model


@pytest.fixture(scope="module")
def road_run(road_car):
    """Plates on a wave of 2 m under the right wheels, of 3 m under the left ones."""
    recording = fabricated(road_car, 1.0)
    channels = dict(recording.channels)
    for wheel in road_car.vehicle.composition.wheels:
        late = (wheel.patch[0] - 0.85) / SPEED
        length = 2.0 if wheel.side > 0.0 else 3.0
        channels[f"plate_{wheel.name}_displacement"] = 0.02 * np.sin(
            2.0 * np.pi * SPEED / length * (recording.time - late)
        )
    return FakeRun(car=FakeCar(model=road_car), recording=dataclasses.replace(recording, channels=channels))


def test_every_wheel_stands_on_the_strip_of_its_track(road_car, road_run):
    wheels = road_car.vehicle.composition.wheels
    strip = RoadStrip(wheels, road_run.recording, SPEED, 1.0 / 30.0)
    assert [leader.name for leader in strip.leaders] == ["fl", "fr"]
    for number in (200, 437, 800):
        time = float(road_run.recording.time[number])
        for wheel in wheels:
            track = 1 if wheel.side > 0.0 else 0
            (height,) = strip.height(track, np.array([wheel.patch[0]]), time, 0.0)
            # A quarter of both neighbours and a half of the sample: (w h)^2 / 4 of 2 cm less, 13.1 Hz at 1 kHz.
            assert height == pytest.approx(road_run.recording[f"plate_{wheel.name}_displacement"][number], abs=3.5e-5)
    # Half a metre before the foremost wheel lies what it meets half a metre later.
    ahead = strip.height(1, np.array([0.85 - 0.523]), 0.4, 0.0)
    assert ahead == pytest.approx(road_run.recording["plate_fr_displacement"][420], abs=3.5e-5)


def test_the_strip_is_the_road_itself_where_it_is_known(road_car, road_run):
    """A cleat of 50 mm, which the tyre takes as a longer and lower bump."""
    wheels, time = road_car.vehicle.composition.wheels, road_run.recording.time
    profile = {
        wheel.name: np.where(np.abs(SPEED * time - 10.0 - (wheel.patch[0] - 0.85)) < 0.025, 0.02, 0.0)
        for wheel in wheels
    }
    strip = RoadStrip(wheels, road_run.recording, SPEED, 1e-3, (time, profile))
    moment = float(time[400])
    under = np.array([0.85 + SPEED * moment - 10.0])
    assert strip.height(1, under, moment, 0.0) == pytest.approx(0.02, abs=2e-3)
    np.testing.assert_array_equal(strip.height(1, under + np.array([-0.1, 0.1]), moment, 0.0), 0.0)
    scene = mujoco.MjvScene(road_car.model, maxgeom=2000)
    strip.draw(scene, moment, 0.0, 2.0)
    boxes = scene.geoms[: scene.ngeom]
    top = max(box.pos[2] for box in boxes)
    assert top == pytest.approx(wheels[0].patch[2] + 0.04 - 0.015, abs=5e-3)
    # Short pieces at the cleat only.
    short = [box for box in boxes if box.size[0] < 0.02]
    assert 8 <= len(short) <= 32 and all(abs(box.pos[0] - under[0]) < 0.1 for box in short)


def test_the_road_under_a_car_at_rest_has_one_height(road_car, road_run):
    strip = RoadStrip(road_car.vehicle.composition.wheels, road_run.recording, 0.0, 1.0 / 30.0)
    plate = float(road_run.recording["plate_fr_displacement"][400])
    heights = strip.height(1, np.array([-1.0, 0.85, 4.0]), float(road_run.recording.time[400]), 0.0)
    np.testing.assert_allclose(heights, plate, atol=3.5e-5)  # as at a wheel of the moving car
    scene = mujoco.MjvScene(road_car.model, maxgeom=2000)
    strip.draw(scene, 0.4, 0.0, 1.0)
    assert scene.ngeom > 0 and np.isfinite([geom.pos for geom in scene.geoms[: scene.ngeom]]).all()


@pytest.mark.render
@pytest.mark.usefixtures("film_machine")
def test_the_road_passes_in_the_film(road_run):
    take = Take(start=0.3, duration=0.2, slow=4.0)
    layout = Layout(width=320, height=180)
    driving = Shot(road_run, layout, dataclasses.replace(take, speed=SPEED))
    first, second = (frame for frame, _ in zip(driving.frames(choose_backend()), range(2), strict=False))
    moved = np.abs(first[:142].astype(int) - second[:142].astype(int)).max(axis=2) > 30
    assert moved.sum() > 200  # stripes
    assert any(line.startswith("road passes at 94.14 km/h") for line in driving.overlay.heading)
    assert any(line.startswith("motion and road exaggerated") for line in driving.overlay.heading)
    # What moves the tyre is not the road itself: the record has the height that the tyre takes of it.
    assert any(line.endswith("heights in numbers: after averaging by the tyre") for line in driving.overlay.heading)
    names = {driving.scene.model.geom(number).name for number in range(driving.scene.model.ngeom)}
    standing = Shot(road_run, layout, take)
    rig = {standing.scene.model.geom(number).name for number in range(standing.scene.model.ngeom)} - names
    assert rig == {
        *("plate_fr", "plate_inserts_fr", "plate_fl", "plate_rr", "plate_inserts_rr", "plate_rl", "bed_plate"),
        *("shaker_fr", "shaker_frame_fr", "pedestal_fl", "shaker_rr", "shaker_frame_rr", "pedestal_rl"),
    }
    assert {"main_spring_rr", "damper_bottom_rl", "damper_top_rr", "knuckle_rr", "upper_link_rl"} <= names


def test_rims_roll_with_the_road(road_car, road_run):
    """The car drives towards -x: seen along y a rim turns by V t / r backwards about its moved centre."""
    model = stage_model(road_car, (320, 180), road=True)
    motion = RecordedMotion(model, road_run.recording, 0.0, 1.0)
    wheel = road_car.vehicle.composition.wheels[2]
    state, data = motion.at(0.4), mujoco.MjData(model)
    data.geom_xpos[:], data.geom_xmat[:] = motion.geoms(state, 1.0)
    before = data.geom_xmat.reshape(-1, 3, 3).copy()
    rolling = RollingWheel(motion, wheel, "knuckle_rr", SPEED)
    quarter = 0.5 * np.pi * 0.295 / SPEED
    rolling.turn(data, state, 1.0, quarter)
    assert {model.geom(geom).name for geom in rolling.rim} == {"rim_rr", "wheel_bolts_rr"}
    # The tyre goes with its hub, to which it is fixed where it stands.
    np.testing.assert_allclose(data.geom_xmat[rolling.tyre].reshape(-1, 3, 3), before[rolling.tyre], atol=1e-12)
    np.testing.assert_allclose(data.geom_xpos[rolling.tyre], motion.geoms(state, 1.0)[0][rolling.tyre], atol=1e-12)
    geom = model.geom("rim_rr").id
    across = motion.poses(state, 1.0)[1][model.body("tyre_rr").id]
    turned = across.T @ data.geom_xmat[geom].reshape(3, 3) @ before[geom].T @ across
    # What was on top (z) is now in front (-x).
    np.testing.assert_allclose(turned @ [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], atol=1e-12)


def test_the_spin_of_a_wheel_leaves_the_flat_of_its_tyre_below(road_car, road_run):
    model = stage_model(road_car, (320, 180), road=True)
    motion = RecordedMotion(model, road_run.recording, 0.0, 1.0)
    state, data = motion.at(0.4), mujoco.MjData(model)
    spun = dataclasses.replace(state, rotation=state.rotation.copy())
    spun.rotation[model.body("tyre_rr").id] += [0.0, 0.1, 0.0]
    rolling = RollingWheel(motion, road_car.vehicle.composition.wheels[2], "knuckle_rr", 0.0)
    rolling.turn(data, state, 2.0, 0.4)
    kept = data.geom_xmat[rolling.tyre].copy()
    rolling.turn(data, spun, 2.0, 0.4)
    np.testing.assert_array_equal(data.geom_xmat[rolling.tyre], kept)
    # At speed 0 the rim stands too.
    np.testing.assert_allclose(data.geom_xmat[rolling.rim], motion.geoms(state, 2.0)[1][rolling.rim], atol=1e-12)


def test_wheels_are_called_front_where_they_are():
    one, two = ("fr", "fl"), ("fr", "fl", "rr", "rl")
    assert [wheel_words("fr", one), wheel_words("fl", one)] == ["right front wheel", "left front wheel"]
    assert [wheel_words(wheel, two) for wheel in two[::2]] == ["front right wheel", "rear right wheel"]
    assert [side_of("rl", ("rr", "rl")), wheel_words("rl", ("rr", "rl"))] == ["left", "left wheel"]
    assert wheel_words("middle_r", (*two, "middle_r")) == "middle_r wheel"


def test_the_part_that_carries_a_wheel_tells_how_it_shakes(road_car):
    assert hub_channel(road_car.vehicle.composition, "rl") == "knuckle_rl_acc_z"
