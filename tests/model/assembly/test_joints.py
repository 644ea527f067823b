"""Joints, rows and constants of the compiled car against section 3.1.3 of Bommer 2006."""

import mujoco
import numpy as np
import pytest

from vehicle.engines.simulation import row_layout
from vehicle.model.assembly.spec import assemble
from vehicle.runs.car import Car

WHEELS = ("fr", "fl")
KIND = mujoco.mjtJoint


def numeric(model, name):
    """A custom field that must be there."""
    found = row_layout.numeric(model, name)
    assert found is not None, name
    return found


def joints_of(model, body):
    index = model.body(body).id
    first, count = model.body_jntadr[index], model.body_jntnum[index]
    return [(model.joint(j).name, KIND(model.jnt_type[j])) for j in range(first, first + count)]


def axis(model, name):
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return data.xaxis[model.joint(name).id].copy()


def test_fixed_parts_have_no_joint(car):
    model = car.model.model
    for wheel in WHEELS:
        for part in ("tyre", "brake_disc", "caliper", "damper_bottom", "main_spring_lower"):
            assert joints_of(model, f"{part}_{wheel}") == []
            parent = model.body_parentid[model.body(f"{part}_{wheel}").id]
            assert model.body(parent).name == f"knuckle_{wheel}"
        assert joints_of(model, f"suspension_mount_{wheel}") == []
        assert joints_of(model, f"main_spring_upper_{wheel}") == []


@pytest.mark.parametrize("wheel", WHEELS)
def test_kinds_of_joints(car, wheel):
    model = car.model.model
    assert joints_of(model, f"knuckle_{wheel}") == [(f"lower_ball_{wheel}", KIND.mjJNT_BALL)]
    assert joints_of(model, f"damper_top_{wheel}") == [(f"damper_{wheel}", KIND.mjJNT_SLIDE)]
    for rod in ("steering_rod", "stabilizer_rod"):
        assert [kind for _, kind in joints_of(model, f"{rod}_{wheel}")] == [KIND.mjJNT_HINGE] * 2
    found = {model.joint(j).name for j in range(model.njnt) if model.jnt_type[j] == KIND.mjJNT_FREE}
    assert found == {"body", "engine", "torque_arm", "a_arm_fr", "a_arm_fl", "stabilizer_half_fl"}


@pytest.mark.parametrize("wheel", WHEELS)
def test_the_damper_slides_along_the_strut(car, wheel):
    points = car.vehicle.points
    strut = np.subtract(points[f"strut_top_{wheel}"], points[f"damper_bottom_{wheel}"])
    found = axis(car.model.model, f"damper_{wheel}")
    np.testing.assert_allclose(np.cross(found, strut / np.linalg.norm(strut)), 0.0, atol=1e-12)
    assert found[2] > 0.0  # positive velocity draws the damper out


@pytest.mark.parametrize(
    ("rod", "near", "far"), [("steering_rod", "tie_outer", "tie_inner"), ("stabilizer_rod", "stab_end", "stab_rod_top")]
)
@pytest.mark.parametrize("wheel", WHEELS)
def test_cardan_axes_are_square(car, wheel, rod, near, far):
    model, points = car.model.model, car.vehicle.points
    line = np.subtract(points[f"{far}_{wheel}"], points[f"{near}_{wheel}"])
    first, second = (axis(model, f"{rod}_{wheel}_cardan_{number}") for number in (1, 2))
    assert abs(first @ second) < 1e-12 and abs(first @ line) < 1e-12 and abs(second @ line) < 1e-12


def test_the_stabilizer_is_cylindrical_with_a_torsion_spring(car):
    model = car.model.model
    assert joints_of(model, "stabilizer_half_fr") == [
        ("stabilizer_slide_front", KIND.mjJNT_SLIDE),
        ("stabilizer_torsion_front", KIND.mjJNT_HINGE),
    ]
    for name in ("stabilizer_slide_front", "stabilizer_torsion_front"):
        np.testing.assert_allclose(axis(model, name), [0.0, 1.0, 0.0], atol=1e-12)
    assert np.ravel(model.joint("stabilizer_torsion_front").stiffness)[0] == 5000.0
    assert np.ravel(model.joint("stabilizer_slide_front").stiffness)[0] == 0.0


def test_number_of_coordinates_and_rows(car):
    model = car.model.model
    # Six free bodies, per side a ball, a slide and two Cardan joints, the cylindrical joint, nine modes.
    assert model.nv == 6 * 6 + 2 * (3 + 1 + 4) + 2 + 9 == 63
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    # Two tyres, mounts, arm bushings and rear supports, four of the engine: twelve bushings, and eight balls, of three
    # rows each; two springs, two dampers, two friction rows.
    assert data.nefc == 12 * 3 + 8 * 3 + 2 + 2 + 2 == 66
    assert model.neq == 12 + 8 + 2 + 2
    assert model.nu == 2 and model.nmocap == 2


def test_the_constants_of_the_elements_are_in_the_model(car):
    model = car.model.model
    names = {model.numeric(index).name for index in range(model.nnumeric)}
    assert len(names) == 18 + 2 + 15 + 2 + 7  # laws, main springs; shapes of connections, springs, places
    for index in range(model.neq):
        name = model.equality(index).name
        if name.startswith("bushing/"):
            law = numeric(model, f"law/{name}")
            assert law.shape == (14,) and np.all(law >= 0.0) and law[12] == 100.0
    tyre = numeric(model, "law/bushing/tyre_fr")
    np.testing.assert_array_equal(tyre[:6], [1.5e5, 1.5e5, 2.5e5, 0.0, 0.0, 400.0])
    engine = numeric(model, "law/bushing/torque_arm_engine")
    np.testing.assert_array_equal(engine[:6], [5e5, 1.3e6, 6.5e5, 2000.0, 1000.0, 0.0])
    assert numeric(model, "law/main_spring_fl")[0] == 2.5e4
    # Every connection with the flexible body knows the shape of its node.
    body = model.body("body").id
    count = 0
    for index in range(model.neq):
        if model.eq_objtype[index] == mujoco.mjtObj.mjOBJ_SITE:
            ends = (model.eq_obj1id[index], model.eq_obj2id[index])
            touches = body in [model.site_bodyid[site] for site in ends]
            shape = row_layout.numeric(model, f"shape/{model.equality(index).name}")
            assert (shape is not None) == touches
            count += touches
    assert count == 15  # four mounts and arm bushings, two rear supports, three of the engine, six balls
    superelement = car.model.superelement
    np.testing.assert_array_equal(
        numeric(model, "shape/bushing/hydromount").reshape(3, 9), superelement.shape_at("hydromount")
    )


def test_the_damper_is_a_user_actuator(car):
    model, damper = car.model.model, car.vehicle.damper
    for wheel in WHEELS:
        actuator = model.actuator(f"damper_{wheel}")
        assert actuator.biastype[0] == mujoco.mjtBias.mjBIAS_USER
        assert actuator.gaintype[0] == mujoco.mjtGain.mjGAIN_USER
        np.testing.assert_array_equal(
            actuator.biasprm[:6],
            [damper.viscous, damper.smoothing, damper.coulomb_friction, damper.coulomb_friction, 0.03, 3.5],
        )
        assert np.ravel(model.joint(f"damper_{wheel}").frictionloss)[0] == damper.coulomb_friction


def test_stribeck_parameters_reach_the_actuator():
    car = Car.load(None, ["damper.friction_law=stribeck", "damper.coulomb_friction=65"])
    model = assemble(car.vehicle, car.trimmed_body).spec.compile()
    np.testing.assert_array_equal(model.actuator("damper_fl").biasprm[2:6], [65.0, 125.0, 0.03, 3.5])


def test_a_rigid_body_has_no_modes(car):
    rigid = Car.load(None, ["body.flexible=false"])
    model = assemble(rigid.vehicle, car.trimmed_body).spec.compile()
    assert model.nv == 54
    assert not any(model.numeric(index).name.startswith("shape/") for index in range(model.nnumeric))
