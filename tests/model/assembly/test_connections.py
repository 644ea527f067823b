"""Laws of the connections: published constants, and the local stiffness of the body in series."""

import numpy as np
import pytest

from tests.validation import validated
from vehicle.model.assembly.connections import element_law
from vehicle.model.assembly.coupled_attachment import STRUCTURAL_LOSS_TIME
from vehicle.model.parameters.vehicle import load_vehicle

OMEGA = 2.0 * np.pi * np.array([0.01, 1.0, 7.0, 28.0, 50.0, 1e4])


def found(car, *changes):
    """Laws of the connections by their names."""
    vehicle = load_vehicle(None, changes)
    return {one.name: element_law(one, vehicle.body, car.trimmed_body) for one in vehicle.composition.connections}


def dynamic(law, axis):
    """K(jw) of an element law along an axis."""
    turn = 1j * OMEGA * law.branch_time[axis]
    return law.stiffness[axis] + 1j * OMEGA * law.damping[axis] + law.branch_stiffness[axis] * turn / (1.0 + turn)


def test_the_list_is_that_of_the_source(car):
    both = {"tyre", "suspension_mount", "arm_rear", "arm_front", "tie_inner", "stab_body", "stab_rod_top"}
    expected = {f"{name}_{wheel}" for name in both for wheel in ("fr", "fl")}
    expected |= {"rear_support_right", "rear_support_left", "linear_mount", "hydromount", "torque_arm_body"}
    assert set(found(car)) == expected | {"torque_arm_engine"}


def test_rigid_attachments_leave_the_published_laws(car):
    laws, vehicle = found(car, "body.attachment_flexibility=false"), car.vehicle
    for one in vehicle.composition.connections:
        law = laws[one.name]
        if one.law is None:
            assert law is None
            continue
        np.testing.assert_array_equal(law.stiffness, one.law.stiffness)
        np.testing.assert_array_equal(law.damping, one.law.damping)
        assert law.branch_stiffness.any() == (one.name == "hydromount") and law.rotational_stiffness == 100.0
    np.testing.assert_array_equal(laws["hydromount"].branch_stiffness, [0.0, 0.0, 1e5])
    np.testing.assert_array_equal(laws["hydromount"].branch_time, [0.0, 0.0, 0.02])


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("name", ["suspension_mount_fr", "arm_rear_fl", "rear_support_right", "hydromount"])
def test_local_stiffness_in_series(car, name, axis):
    # 1/K'(jw) = 1/K0 + 1/K(jw): the body gives way behind the bushing.
    placed = next(one for one in car.vehicle.composition.connections if one.name == name)
    parameters, law = placed.law, found(car)[name]
    bushing = parameters.stiffness[axis] + 1j * OMEGA * parameters.damping[axis]
    if name == "hydromount" and axis == 2:
        k2, d2 = parameters.maxwell_stiffness, parameters.maxwell_damping
        bushing = parameters.stiffness[2] + k2 * d2 * 1j * OMEGA / (d2 * 1j * OMEGA + k2)
    local = 1.0 / car.trimmed_body.residual[placed.point][axis, axis]
    exact = 1.0 / (1.0 / local + 1.0 / bushing)
    found_here = dynamic(law, axis)
    if name == "hydromount" and axis < 2:
        assert parameters.damping[axis] > 0.0
    validated(
        "Bushings, springs and stops", f"{name} in series with its local stiffness, axis {'xyz'[axis]}, 0.01 to 1e4 Hz",
        found_here, exact, rel=1e-9, unit="N/m", source="closed form: 1 / (1 / K0 + 1 / K(jw))",
    )  # fmt: skip
    assert np.all(np.abs(found_here[:1]) < parameters.stiffness[axis])


def test_ball_joints_on_the_body_get_its_local_stiffness(car):
    law = found(car)["tie_inner_fl"]
    local = 1.0 / np.diag(car.trimmed_body.residual["tie_inner_fl"])
    np.testing.assert_array_equal(law.stiffness, local)
    np.testing.assert_allclose(law.damping, STRUCTURAL_LOSS_TIME * local)
    assert law.averaged
    # Between stabilizer rod and damper housing there is no sheet metal: ideal.
    assert found(car)["stab_rod_top_fr"] is None


@pytest.mark.parametrize("absent", ["maxwell_damping", "maxwell_stiffness"])
def test_item_29_a_branch_without_damper_or_spring_is_absent(car, absent):
    law = found(car, f"bushings.hydromount.{absent}=0", "body.attachment_flexibility=false")["hydromount"]
    assert not law.branch_stiffness.any() and not law.branch_time.any()
    np.testing.assert_array_equal(law.stiffness, [4e5, 8e5, 4e5])
    with_local = found(car, f"bushings.hydromount.{absent}=0")["hydromount"]
    assert with_local.branch_stiffness[2] == 0.0 and np.isfinite(with_local.branch_time).all()


def test_roles_and_points(car):
    roles = {one.name: (one.moving, one.carrier, one.point) for one in car.vehicle.composition.connections}
    assert roles["rear_support_right"] == ("body", "world", "rear_support_right")
    assert roles["suspension_mount_fr"] == ("damper_top_fr", "body", "strut_top_fr")
    assert roles["torque_arm_engine"] == ("torque_arm", "engine", "bottom_engine")
    assert roles["tyre_fl"] == ("tyre_fl", "plate_fl", "tyre_patch_fl")
