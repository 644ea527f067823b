"""Shapes on the car change what is seen, and nothing else."""

import mujoco
import numpy as np
import pytest

from vehicle.model.assembly.visuals import visible_shapes

SAME = (
    "body_mass", "body_inertia", "body_ipos", "body_iquat", "body_pos", "body_quat", "body_parentid", "jnt_type",
    "jnt_pos", "jnt_axis", "jnt_stiffness", "dof_damping", "dof_armature", "dof_frictionloss", "qpos0", "qpos_spring",
    "eq_type", "eq_data", "actuator_biasprm", "numeric_data",
)  # fmt: skip


def test_shapes_change_no_mechanical_quantity(car, stage):
    compiled = car.spec.compile()
    for field in SAME:
        assert getattr(compiled, field).size > 0
        np.testing.assert_array_equal(getattr(stage, field), getattr(compiled, field), field)


def test_mass_matrix_is_the_same(car, stage):
    matrices: list[np.ndarray] = []
    for model in (car.spec.compile(), stage):
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        full = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, full)
        matrices.append(full)
    np.testing.assert_array_equal(matrices[0], matrices[1])


def test_nothing_touches(stage):
    meshes = stage.geom_type == mujoco.mjtGeom.mjGEOM_MESH
    assert meshes.sum() > 50
    assert not stage.geom_contype[meshes].any() and not stage.geom_conaffinity[meshes].any()


@pytest.mark.parametrize(
    "name", ["body_shell", "engine_castings", "knuckle_fr", "rim_fl", "main_spring_fl", "plate_fr"]
)
def test_shapes_stand_in_their_design_place(car, stage, name):
    data = mujoco.MjData(stage)
    mujoco.mj_kinematics(stage, data)
    geom = stage.geom(name).id
    mesh = stage.geom_dataid[geom]
    first, count = stage.mesh_vertadr[mesh], stage.mesh_vertnum[mesh]
    vertices = stage.mesh_vert[first : first + count] @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
    expected = np.asarray(visible_shapes(car.vehicle)[name].mesh.vertices)
    # MuJoCo keeps vertices in single precision: 1e-6 of 4.5 m.
    np.testing.assert_allclose(vertices.min(axis=0), expected.min(axis=0), atol=5e-6)
    np.testing.assert_allclose(vertices.max(axis=0), expected.max(axis=0), atol=5e-6)
