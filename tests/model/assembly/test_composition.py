"""A car of data: one table adds a bushing, one entry a channel; own templates; mirrored sides; messages by table."""

import re
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from scenarios.signals.random_road import random_road
from vehicle.arrays import Vector
from vehicle.model.flexbody.carried_nodes import carried_by, with_carried_nodes
from vehicle.model.flexbody.frame_modes import rigid_shapes
from vehicle.model.parameters.paths import value_of
from vehicle.model.parameters.shipped import FOCUS_FILE
from vehicle.model.parameters.template import SHIPPED
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car

TEXT = FOCUS_FILE.read_text(encoding="utf-8")
BRACE = (0.7, 0.1, 1.2)
ADDED = f"""
[connection.brace]
moving = "engine"
carrier = "body"
at = {list(BRACE)}
stiffness = [1e5, 2e5, 3e5]
damping = [100.0, 200.0, 300.0]
rotational_stiffness = 0.0
"""
SIDES = {"right": 1e7, "left": 2e7}
ROAD = random_road(rms=1e-3, seed=1, wheel="fr", duration=1.0)


def written(folder: Path, text: str) -> Path:
    (folder / "car.toml").write_text(text, encoding="utf-8")
    return folder / "car.toml"


@pytest.fixture(scope="module")
def braced(tmp_path_factory):
    return Car.load(written(tmp_path_factory.mktemp("braced"), TEXT + ADDED))


def rows_at(model: mujoco.MjModel, shapes: Vector) -> Vector:
    """Displacement of the engine less that of the body at the new point, by plain jacobians; (3, nv)."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    engine, body = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, engine, None, np.array(BRACE), model.body("engine").id)
    mujoco.mj_jac(model, data, body, None, np.array(BRACE), model.body("body").id)
    modal = [int(model.joint(f"mode_{n}").dofadr[0]) for n in range(1, 10)]
    body[:, modal] += shapes
    return engine - body


def test_one_table_adds_a_bushing_at_a_new_point(car, braced):
    body, still = braced.model.superelement, car.model.superelement
    # The frame follows: a node without mass at the point, the modes as they were.
    np.testing.assert_array_equal(body.positions[-1], BRACE)
    assert body.node_mass[-1] == 0.0 and len(body.edges) == len(still.edges) + 3
    np.testing.assert_allclose(body.frequencies, still.frequencies, rtol=1e-12)
    # Matrices: K and C grow by J' k J and J' d J.
    jacobian = rows_at(car.model.model, body.shapes[:, -1].T)
    for name, added in (("stiffness", [1e5, 2e5, 3e5]), ("damping", [100.0, 200.0, 300.0])):
        before, after = (getattr(one.matrices.system, name) for one in (car, braced))
        expected = jacobian.T @ np.diag(added) @ jacobian
        # Preloads shift by the new spring: geometric stiffness of some newtons on arms of a metre.
        np.testing.assert_allclose(after - before, expected, atol=2e-3 * np.abs(expected).max())
    with_it = {engine: braced.run(ROAD, engine=engine)["engine_acc_z"] for engine in ("mujoco", "reduced")}
    size = np.sqrt(np.mean(with_it["mujoco"] ** 2))
    assert np.sqrt(np.mean((with_it["reduced"] - with_it["mujoco"]) ** 2)) < 0.01 * size
    assert np.sqrt(np.mean((car.run(ROAD)["engine_acc_z"] - with_it["mujoco"]) ** 2)) > 0.02 * size
    # Its numbers are parameters as all others.
    vehicle = load_vehicle(None, [])
    changed = Car.load(braced.origin["file"], ["connection.brace.stiffness.z=4e5"]).vehicle
    assert value_of(changed, "brace.stiffness.z") == 4e5
    assert changed.quantity_of("connection.brace.stiffness.z")["unit"] == "N/m"
    assert len(changed.composition.connections) == len(vehicle.composition.connections) + 1


def test_a_carried_node_moves_with_its_carriers(car):
    body = car.trimmed_body
    points = {"inside": (2.0, 0.1, 1.1), "outside": (4.6, 0.7, 0.5)}
    with_nodes = with_carried_nodes(body, points)
    assert with_nodes.nodes == (*body.nodes, *points) and with_carried_nodes(with_nodes, points) is with_nodes
    for place in points.values():
        # Of a rigid motion of all nodes it takes part.
        carriers, follow = carried_by(body.positions, np.array(place))
        moved = np.einsum("ckj,mkj->mc", follow, rigid_shapes(body.positions, body.cog)[:, carriers])
        rotations = np.vstack([np.zeros((3, 3)), np.eye(3)])
        want = np.hstack([rigid_shapes(np.array([place]), body.cog)[:, 0], rotations])
        np.testing.assert_allclose(moved, want, atol=1e-12)


def test_one_entry_adds_a_channel(tmp_path):
    text = TEXT.replace("[outputs]", '[outputs]\ndriver_head = { on = "body", at = [2.3, -0.37, 1.4] }')
    car = Car.load(written(tmp_path, text))
    assert "driver_head" in [output.name for output in car.vehicle.composition.outputs]
    assert car.model.model.sensor("driver_head_acc").id >= 0


def test_own_templates_lie_beside_the_vehicle_file(tmp_path):
    (tmp_path / "templates").mkdir()
    own = (SHIPPED / "blocks.toml").read_text(encoding="utf-8").replace("rear_support", "pad")
    (tmp_path / "templates" / "pads.toml").write_text(own, encoding="utf-8")
    rear = TEXT.replace('"blocks"', '"pads"').replace("rear_support", "pad")
    body = TEXT.index("[body]")
    assert rear.index("[body]") == body
    text = rear.replace("flexible = true", "flexible = false").replace('superelement = "body_design.toml"', "# none")
    vehicle = load_vehicle(written(tmp_path, text))
    assert {"pad_right", "pad_left"} < {one.name for one in vehicle.composition.connections}


def test_numbers_of_one_side_lie_over_those_of_both(tmp_path):
    own = "[front.left.bushings.arm_rear]\nstiffness = [3e5, 8e5, 8e5]\n"
    own += "[front.left.hardpoints]\ntie_inner = [0.985, -0.3, 0.66]\n"
    vehicle = load_vehicle(written(tmp_path, TEXT + own))
    laws: dict[str, Any] = {one.name: one.law for one in vehicle.composition.connections}
    assert laws["arm_rear_fl"].stiffness == (3e5, 8e5, 8e5) and laws["arm_rear_fr"].stiffness == (2.5e5, 8e5, 8e5)
    assert laws["arm_rear_fl"].damping == laws["arm_rear_fr"].damping
    # A point of one side is where it really is.
    assert vehicle.points["tie_inner_fl"] == (0.985, -0.3, 0.66) and vehicle.points["tie_inner_fr"][1] == 0.335


def test_two_tables_of_sides_without_one_of_the_instance_are_not_mixed_up(tmp_path):
    """Numbers of one side were those of the other where the instance itself had no table."""
    tables = {side: f"[front.{side}.bushings.arm_front]\nstiffness = [{k}, {k}, {k}]\n" for side, k in SIDES.items()}
    rest = "damping = [0.0, 0.0, 0.0]\nrotational_stiffness = 0.0\n"
    vehicle = load_vehicle(written(tmp_path, TEXT + "".join(table + rest for table in tables.values())))
    laws: dict[str, Any] = {one.name: one.law for one in vehicle.composition.connections}
    assert laws["arm_front_fr"].stiffness == (1e7,) * 3 and laws["arm_front_fl"].stiffness == (2e7,) * 3


def test_full_tensors_and_crooked_axes_are_mirrored(tmp_path):
    text = TEXT.replace("[front.parts.knuckle]", "[front.parts.knuckle]\nproducts = [0.03, -0.02, 0.05]")
    changes = ["parts.knuckle.inertia=[0.2, 0.22, 0.25]", "hardpoints.strut_top.y=0.52", "body.flexible=false"]
    model = Car.load(written(tmp_path, text), changes).model.model
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mirror = np.diag([1.0, -1.0, 1.0])
    kinds = {int(mujoco.mjtJoint.mjJNT_SLIDE): 1.0, int(mujoco.mjtJoint.mjJNT_HINGE): -1.0}
    compared = 0
    for joint in range(model.njnt):
        name, kind = model.joint(joint).name, int(model.jnt_type[joint])
        if kind in kinds and re.search(r"_fr(_|$)", name):
            other = model.joint(name.replace("_fr", "_fl")).id
            # A slide is a vector; an axis of turning a pseudovector: equal coordinates are mirrored motions.
            np.testing.assert_allclose(data.xaxis[other], kinds[kind] * mirror @ data.xaxis[joint], atol=1e-12)
            compared += 1
    assert compared == 5
    right, left = (tensor(model, data, f"knuckle_{wheel}") for wheel in ("fr", "fl"))
    np.testing.assert_allclose(right, [[0.2, -0.03, 0.02], [-0.03, 0.22, -0.05], [0.02, -0.05, 0.25]], atol=1e-12)
    np.testing.assert_allclose(left, mirror @ right @ mirror, atol=1e-12)


def tensor(model: mujoco.MjModel, data: mujoco.MjData, name: str) -> Vector:
    frame = data.ximat[model.body(name).id].reshape(3, 3)
    return np.asarray(frame @ np.diag(model.body_inertia[model.body(name).id]) @ frame.T)
