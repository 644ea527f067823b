"""Moving picture of the bench: modes, road and moved points on the nodes of a real server; no browser."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from vehicle import Car, road
from vehicle.drawing.rendering.mode_motion import FARTHEST, ModeMotion
from vehicle.drawing.rendering.motion import coil_seats
from vehicle.drawing.rendering.wireframe import car_wireframe, unit_factor
from vehicle.errors import ConfigurationError
from vehicle.handover.bench.drive import bench_drive
from vehicle.handover.bench.guard import Guard
from vehicle.handover.bench.motion import SECONDS, car_motion, mode_motion
from vehicle.signals.analysis.modal_assurance import mac

viser = pytest.importorskip("viser", reason="viser is missing: pip install 'vehicle-on-shaker[bench]'")

from vehicle.handover.bench.car_scene import CarScene  # noqa: E402
from vehicle.handover.bench.server import close_server, open_server  # noqa: E402
from vehicle.handover.bench.stage import CYCLE, Stage  # noqa: E402
from vehicle.handover.bench.view import RUN, STATES, View  # noqa: E402

TOP = "front.hardpoints.strut_top.z"


@pytest.fixture
def server():
    server = open_server(Guard(), 8750)
    yield server
    close_server(server)


@pytest.fixture
def stage(server, car, drive):
    stage = Stage(server, car, drive)
    stage.playing = False
    yield stage
    stage.stop()


@pytest.fixture(scope="module")
def cleat(road_car):
    return bench_drive(road_car, road("cleat:20x50", 30))


def node(server, name):
    return server.scene._handle_from_node_name[name]


def test_a_mode_moves_the_parts_as_the_jacobians_of_mujoco(car, server, stage):
    mode = car.modes("stuck")[5]
    motion = mode_motion(stage.car_scene.wire, mode.shape, mode.frequency)
    stage.show(car, motion, slower=1.0, larger=100.0)
    model, compiled = car.model.model, ModeMotion(car.model.model, mode.shape)
    scale = FARTHEST * unit_factor(car_wireframe(car.model).displacement(mode.shape))
    for phase in (0.0, 1.0):
        stage.frame(phase / (2.0 * np.pi * mode.frequency))
        amplitude = compiled.amplitude * scale * np.exp(1j * phase)
        for name in ("body", "knuckle_fr", "tyre_fl", "engine"):
            translation, rotation = 100.0 * amplitude[model.body(name).id].real
            arm = car.matrices.body_centres[name] - compiled.position[model.body(name).id]
            expected = compiled.position[model.body(name).id] + arm + translation + np.cross(rotation, arm)
            # Linear between the samples of a cycle: 0.2 % of 100 mm.
            np.testing.assert_allclose(node(server, f"/{name}").position, expected, atol=3e-4)
            turn = Rotation.from_quat(node(server, f"/{name}").wxyz, scalar_first=True).as_rotvec()
            np.testing.assert_allclose(turn, rotation, atol=3e-4)
    size = np.linalg.norm(stage.car_scene.wire.motion @ motion.coordinates, axis=1)
    # Other components of a complex shape are not at their maximum together with the largest.
    assert size.max() == pytest.approx(FARTHEST, rel=1e-2)


def test_a_car_of_another_mass_moves_as_a_car_built_with_it(car):
    changes = {"body.mass": 1.5 * car["body.mass"].value}
    varied, built = car.with_(changes), Car.load(None, changes)
    assert varied.geometry is car and built.geometry is built
    wire, own = car_wireframe(car.model), car_wireframe(built.model)
    for one, other in zip(varied.modes("stuck")[:20], built.modes("stuck")[:20], strict=True):
        shapes = wire.displacement(varied.geometry_motion(one.shape)), own.displacement(other.shape)
        assert mac([shapes[0]], [shapes[1]])[0, 0] == pytest.approx(1.0, abs=1e-6)


def test_a_moved_point_moves_its_parts_alone(car, server):
    scene = CarScene(server, car, rig=True)
    before = {name: mesh for name, (mesh, _) in scene._meshes.items()}
    assert not scene.update(car.with_({"damper.coulomb_friction": 60.0}))
    moved = car.with_({TOP: car[TOP.removesuffix(".z")].value[2] + 0.04})
    assert scene.update(moved)
    changed = {name for name, (mesh, _) in scene._meshes.items() if mesh is not before[name]}
    assert {"suspension_mount_fr", "damper_top_fl"} <= changed
    assert not {"tyre_fr", "body_shell", "shaker_fr"} & changed
    whole = CarScene(server, moved, rig=True)
    for name, (_, vertices) in whole._meshes.items():
        np.testing.assert_array_equal(scene._meshes[name][1], vertices, err_msg=name)
    assert scene.update(car)
    assert not {name for name, (mesh, _) in scene._meshes.items() if len(mesh.vertices) != len(before[name].vertices)}


def test_the_wheels_stand_on_the_road(road_car, server, cleat):
    car = road_car.with_(cleat.overrides)
    stage = Stage(server, car, cleat)
    stage.playing = False
    try:
        assert not any("shaker" in name for name in server.scene._handle_from_node_name)
        assert cleat.shown == pytest.approx(cleat.road["obstacle_s"][0] - 0.5, abs=1e-3)
        stage.show(car, car_motion(car, cleat), slower=1.0, larger=2.0)
        record, wheels = cleat.record, {wheel.name: wheel for wheel in car.vehicle.composition.wheels}
        # Times at which the front and the rear wheels are on the middle of the cleat of 50 mm.
        begin, end = cleat.road["obstacle_s"]
        crossed = [begin + 0.025 / cleat.speed, end - 0.025 / cleat.speed]
        for name, leader in (("fr", "fr"), ("rr", "fr"), ("fl", "fl"), ("rl", "fl")):
            for time in [*np.linspace(cleat.shown, cleat.shown + 1.5, 7), *crossed]:
                stage.frame(time - cleat.shown)
                assert node(server, "/road").position[0] == pytest.approx(cleat.speed * time)
                points = np.vstack([node(server, f"/road/{leader}_{shade}").vertices for shade in (0, 1)])
                scale = node(server, f"/road/{leader}_0").scale
                assert scale == (1.0, 1.0, 2.0)
                x = points[:, 0] + node(server, "/road").position[0]
                top = points[:, 2] > points[:, 2].min() + 0.005
                order = np.argsort(x[top])
                height = np.interp(wheels[name].patch[0], x[top][order], points[top][order, 2])
                # A steep edge of the cleat may lie between two samples.
                near = np.abs(record.time - time) <= 1.5 * record.timestep
                low, high = record.profile[name][near].min(), record.profile[name][near].max()
                assert low - 1e-6 <= height <= high + 1e-6
            assert height == pytest.approx(0.02 if name in ("rr", "rl") else 0.0, abs=1e-6)
        assert max(points[:, 2]) == pytest.approx(0.02, abs=1e-6)
        hub, rim, centre = node(server, "/tyre_fr"), node(server, "/tyre_fr/rim"), np.array(wheels["fr"].center)
        assert abs(Rotation.from_quat(hub.wxyz, scalar_first=True).magnitude()) < 0.2
        # The rotation vector is exaggerated, so the hub rotates a little less than linearly.
        np.testing.assert_allclose(hub.position - centre, moved_by(server, car, "knuckle_fr", centre), atol=1e-4)
        spin = cleat.speed * time / (wheels["fr"].center[2] - wheels["fr"].patch[2])
        turned = Rotation.from_quat(rim.wxyz, scalar_first=True).as_matrix()
        np.testing.assert_allclose(turned, Rotation.from_euler("y", -spin).as_matrix(), atol=1e-6)
        # Front wheels moved by 40 mm: the road is drawn again, and they are on the cleat at their time.
        longer = car.with_({"front.hardpoints.wheel_center.x": 0.81, "front.hardpoints.tyre_patch.x": 0.81})
        moved = cleat.under(longer)
        stage.show(longer, car_motion(longer, cleat), slower=1.0, larger=2.0)
        times = moved.road["obstacle_s"]
        stage.frame(times[0] + 0.025 / moved.speed - moved.shown)
        strip = np.vstack([node(server, f"/road/fr_{shade}").vertices for shade in (0, 1)])
        below = strip[strip[:, 2] > 0.019, 0] + node(server, "/road").position[0]
        assert below.min() < 0.81 < below.max()
        # Centre of the cleat: 0.81 m, before 0.85 m.
        assert 0.5 * (below.min() + below.max()) == pytest.approx(0.81, abs=0.005)
    finally:
        stage.stop()


def test_plates_and_springs_follow_the_run(car, server, stage, drive):
    motion = car_motion(car, drive)
    assert motion.coordinates.shape[1] == round(SECONDS * motion.rate) + 1
    factor = stage.show(car, motion, slower=20.0)
    assert factor > 5.0 and stage.slower == 20.0
    stage.frame(1.0)
    z = drive.record.displacement["fr"][1000]
    np.testing.assert_allclose(node(server, "/plate_fr").position, (0.0, 0.0, factor * z), rtol=1e-6)
    (spring,) = (spring for spring in car.vehicle.composition.springs if spring.name == "main_spring_fr")
    coil, (rest, share, _) = node(server, "/still/main_spring_fr"), stage.car_scene._coils[spring.name]
    ends = np.array([rest[share[:, 0] == end][0] for end in (0.0, 1.0)])
    shown = np.array([coil.vertices[share[:, 0] == end][0] for end in (0.0, 1.0)])
    expected = [
        end + moved_by(server, car, seat, end)
        for seat, end in zip(coil_seats(car.vehicle.composition, spring), ends, strict=True)
    ]
    np.testing.assert_allclose(shown, expected, atol=1e-6)
    assert np.linalg.norm((shown - ends)[1] - (shown - ends)[0]) > 1e-3


def moved_by(server, car, part, point):
    """Displacement of a point of a part, from the frame of the part."""
    frame, centre = node(server, f"/{part}"), car.matrices.body_centres[part]
    arm = point - centre
    return frame.position + Rotation.from_quat(frame.wxyz, scalar_first=True).apply(arm) - point


class Gui:
    """GUI without a browser."""

    def add_dropdown(self, label, options, **more):
        return SimpleNamespace(value=options[0], options=options, visible=True)

    def add_slider(self, label, low, high, step, value, **more):
        return SimpleNamespace(value=value, min=low, max=high, visible=True)

    def add_checkbox(self, label, value):
        return SimpleNamespace(value=value)


def test_modes_are_chosen_kept_and_left_again(car, stage, drive):
    view = View(Gui(), stage, drive)
    acts: dict[int, Any] = {}
    view.connect(lambda handle, act: acts.__setitem__(id(handle), act), lambda: view.show(car))
    view.show(car)
    exaggeration = view.larger.value
    assert view.slower.visible and not view.mode.visible and view.modes == []
    for kind, state in STATES.items():
        view.kind.value = kind
        acts[id(view.kind)]()
        listed = [mode for mode in car.modes(state) if mode.frequency > 0.0]
        assert [mode.frequency for mode in view.modes] == [mode.frequency for mode in listed]
        first = listed[0]
        start = f"1: {first.frequency:.2f} Hz, {100.0 * first.damping_ratio:.1f} %, {first.description}"
        assert view.mode.options[0] == start
    hop = next(option for option in view.mode.options if "wheel hop" in option)
    view.mode.value = hop
    acts[id(view.mode)]()
    mode = view.modes[view.mode.options.index(hop)]
    assert stage.slower == pytest.approx(CYCLE * mode.frequency) and stage.larger == 100.0
    view.show(car.with_({"front.bushings.tyre.stiffness": [250e3, 250e3, 320e3], "body.mass": 700.0}))
    kept = view.modes[view.mode.options.index(view.mode.value)]
    assert "wheel hop" in kept.description and kept.frequency > mode.frequency
    view.amplitude.value = 30.0
    acts[id(view.amplitude)]()
    assert stage.larger == 30.0
    view.kind.value = RUN
    acts[id(view.kind)]()
    assert stage.larger == view.larger.value == exaggeration and stage.slower == view.slower.value


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300, 0.0])
def test_absurd_values_of_the_picture_are_limited(car, stage, drive, value):
    view = View(Gui(), stage, drive)
    acts: dict[int, Any] = {}
    view.connect(lambda handle, act: acts.__setitem__(id(handle), act), lambda: view.show(car))
    view.show(car)
    for slider in (view.slower, view.larger, view.amplitude):
        slider.value = value
        acts[id(slider)]()
        assert 1.0 <= stage.slower <= 100.0 and 1.0 <= stage.larger <= 200.0
    view.mode.value, view.kind.value = "no mode", "x" * 1000
    for handle in (view.mode, view.kind):
        with pytest.raises(ConfigurationError, match="must be"):
            acts[id(handle)]()
