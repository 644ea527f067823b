"""Laws of the connections: published constants, and the local stiffness of the body in series."""

from __future__ import annotations

import numpy as np
import pytest

from vehicle.assembly.connections import STRUCTURAL_LOSS_TIME, connections
from vehicle.parameters.paths import override
from vehicle.parameters.toml_file import build, read_table
from vehicle.parameters.vehicle import FOCUS_FILE, Vehicle

OMEGA = 2.0 * np.pi * np.array([0.01, 1.0, 7.0, 28.0, 50.0, 1e4])


def vehicle_with(*assignments):
    return build(Vehicle, override(read_table(FOCUS_FILE), assignments))


def found(vehicle, body):
    return {connection.name: connection for connection in connections(vehicle, body)}


def dynamic(law, axis):
    """K(jw) of an element law along an axis."""
    turn = 1j * OMEGA * law.branch_time[axis]
    return law.stiffness[axis] + 1j * OMEGA * law.damping[axis] + law.branch_stiffness[axis] * turn / (1.0 + turn)


def test_the_list_is_that_of_the_source(car):
    names = set(found(car.vehicle, car.trimmed_body))
    both = {"tyre", "suspension_mount", "arm_rear"}
    expected = {f"bushing/{name}_{wheel}" for name in both for wheel in ("fr", "fl")}
    expected |= {"bushing/rear_support_right", "bushing/rear_support_left", "bushing/linear_mount"}
    expected |= {"bushing/hydromount", "bushing/torque_arm_body", "bushing/torque_arm_engine"}
    balls = {"arm_front", "tie_inner", "stab_body", "stab_rod_top"}
    expected |= {f"ball/{name}_{wheel}" for name in balls for wheel in ("fr", "fl")}
    assert names == expected


def test_rigid_attachments_leave_the_published_laws(car):
    vehicle = vehicle_with("body.attachment_flexibility=false")
    laws = found(vehicle, car.trimmed_body)
    table = vehicle.bushings
    for name, parameters in [
        ("bushing/suspension_mount_fr", table.suspension_mount),
        ("bushing/arm_rear_fl", table.arm_rear),
        ("bushing/rear_support_left", table.rear_support),
        ("bushing/linear_mount", table.linear_mount),
        ("bushing/torque_arm_body", table.torque_arm_body),
    ]:
        law = laws[name].law
        np.testing.assert_array_equal(law.stiffness, parameters.stiffness)
        np.testing.assert_array_equal(law.damping, parameters.damping)
        assert not law.branch_stiffness.any() and law.rotational_stiffness == 100.0
    mount = laws["bushing/hydromount"].law
    np.testing.assert_array_equal(mount.branch_stiffness, [0.0, 0.0, 1e5])
    np.testing.assert_array_equal(mount.branch_time, [0.0, 0.0, 0.02])
    assert laws["ball/arm_front_fr"].law is None and laws["ball/stab_rod_top_fl"].law is None


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("name", ["suspension_mount_fr", "arm_rear_fl", "rear_support_right", "hydromount"])
def test_local_stiffness_in_series(car, name, axis):
    # 1/K'(jw) = 1/K0 + 1/K(jw): the body gives way behind the bushing.
    connection = found(car.vehicle, car.trimmed_body)[f"bushing/{name}"]
    parameters = getattr(car.vehicle.bushings, name.removesuffix("_fr").removesuffix("_fl").removesuffix("_right"))
    bushing = parameters.stiffness[axis] + 1j * OMEGA * parameters.damping[axis]
    if name == "hydromount" and axis == 2:
        k2, d2 = parameters.maxwell_stiffness, parameters.maxwell_damping
        bushing = parameters.stiffness[2] + k2 * d2 * 1j * OMEGA / (d2 * 1j * OMEGA + k2)
    local = car.trimmed_body.attachment_stiffness[connection.hardpoint][axis]
    exact = 1.0 / (1.0 / local + 1.0 / bushing)
    found_here = dynamic(connection.law, axis)
    if name == "hydromount" and axis < 2:
        assert parameters.damping[axis] > 0.0
    np.testing.assert_allclose(found_here, exact, rtol=1e-9)
    assert np.all(np.abs(found_here[:1]) < parameters.stiffness[axis])


def test_static_series_stiffness_by_hand(car):
    # Suspension mount z: 7e5 in series with the tower top.
    connection = found(car.vehicle, car.trimmed_body)["bushing/suspension_mount_fr"]
    tower = car.trimmed_body.attachment_stiffness["strut_top_fr"][2]
    assert connection.law.stiffness[2] == pytest.approx(7e5 * tower / (7e5 + tower), rel=1e-12)


def test_ball_joints_on_the_body_get_its_local_stiffness(car):
    law = found(car.vehicle, car.trimmed_body)["ball/tie_inner_fl"].law
    local = car.trimmed_body.attachment_stiffness["tie_inner_fl"]
    np.testing.assert_array_equal(law.stiffness, local)
    np.testing.assert_allclose(law.damping, STRUCTURAL_LOSS_TIME * local)
    assert law.averaged
    # Between stabilizer rod and damper housing there is no sheet metal: ideal.
    assert found(car.vehicle, car.trimmed_body)["ball/stab_rod_top_fr"].law is None


@pytest.mark.parametrize("absent", ["maxwell_damping", "maxwell_stiffness"])
def test_item_29_a_branch_without_damper_or_spring_is_absent(car, absent):
    vehicle = vehicle_with(f"bushings.hydromount.{absent}=0", "body.attachment_flexibility=false")
    law = found(vehicle, car.trimmed_body)["bushing/hydromount"].law
    assert not law.branch_stiffness.any() and not law.branch_time.any()
    np.testing.assert_array_equal(law.stiffness, vehicle.bushings.hydromount.stiffness)
    with_local = found(vehicle_with(f"bushings.hydromount.{absent}=0"), car.trimmed_body)["bushing/hydromount"].law
    assert with_local.branch_stiffness[2] == 0.0 and np.isfinite(with_local.branch_time).all()


def test_roles_and_signs(car):
    laws = found(car.vehicle, car.trimmed_body)
    support = laws["bushing/rear_support_right"]
    assert (support.moving, support.carrier, support.node_sign) == ("body", "world", 1)
    mount = laws["bushing/suspension_mount_fr"]
    assert (mount.moving, mount.carrier, mount.node, mount.node_sign) == ("damper_top_fr", "body", "strut_top_fr", -1)
    arm = laws["bushing/torque_arm_engine"]
    assert (arm.moving, arm.carrier, arm.node) == ("torque_arm", "engine", None)
    assert laws["bushing/tyre_fl"].carrier == "plate_fl"
