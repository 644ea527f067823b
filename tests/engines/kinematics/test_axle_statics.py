"""Kinematics and compliance of the axle against the geometry of a MacPherson strut and against the car's matrices."""

import numpy as np
import pytest

from tests.engines.kinematics.strut import camber_and_toe, strut_geometry
from tests.validation import validated
from vehicle.engines.kinematics.axle_statics import AxleStatics
from vehicle.errors import SimulationError


def axle(car, *, ideal=False):
    wheels = car.vehicle.composition.wheels
    assert [wheel.name for wheel in wheels] == ["fr", "fl"]
    return AxleStatics(car.model.model, car.model.static.preload, wheels=wheels, ideal=ideal, standing=True)


@pytest.mark.parametrize("travel", [-0.06, -0.02, 0.03, 0.06])
def test_ideal_kinematics_of_the_strut(car, travel):
    # Asked for: 1e-3 mm and 1e-4 degree.
    pose, other = axle(car, ideal=True).solve([travel, travel])
    moved, turn = strut_geometry(car.vehicle.points, travel)
    assert pose.wheel_travel_m == pytest.approx(travel, abs=1e-9)
    own = "second derivation: own solver of the rigid linkage"
    validated(
        "Suspension kinematics",
        f"MacPherson strut at {1e3 * travel:g} mm: longitudinal and lateral motion of the wheel",
        np.array([pose.longitudinal_m, pose.lateral_m]), moved[:2], abs=1e-6, unit="m", source=own,
    )  # fmt: skip
    validated(
        "Suspension kinematics", f"MacPherson strut at {1e3 * travel:g} mm: camber and toe",
        np.array([pose.camber_deg, pose.toe_deg]), np.array(camber_and_toe(turn)), abs=1e-4, unit="deg", source=own,
    )  # fmt: skip
    assert abs(pose.camber_deg) > 0.1 and abs(pose.lateral_m) > 1e-4
    for name in ("lateral_m", "longitudinal_m", "camber_deg", "toe_deg", "strut_length_m"):
        assert getattr(other, name) == pytest.approx(getattr(pose, name), abs=1e-8), name


def test_signs_of_camber_and_toe(car):
    """Top outwards and front inwards count positive, on both sides."""
    for index, wheel in enumerate(car.vehicle.composition.wheels):
        statics, load = axle(car), np.zeros((2, 6))
        # A moment about the upward axis that turns the front of the wheel towards the middle of the car.
        load[index, 5] = wheel.side * 50.0
        assert statics.solve([0.0, 0.0], load)[index].toe_deg > 0.01
        load[index] = [0.0, wheel.side * 2000.0, 0.0, 0.0, 0.0, 0.0]  # outwards at the ground: the top goes inwards
        assert statics.solve([0.0, 0.0], load)[index].camber_deg < -0.01


def test_in_the_design_position_nothing_moves_and_the_load_is_the_static_one(car):
    poses = axle(car).solve([0.0, 0.0])
    for pose, wheel in zip(poses, ("fr", "fl"), strict=True):
        assert max(abs(pose.lateral_m), abs(pose.longitudinal_m)) < 1e-9 and abs(pose.toe_deg) < 1e-6
        assert pose.load_n == pytest.approx(car.model.static.tyre_load[wheel], rel=1e-9)


def test_small_travel_and_load_are_those_of_the_matrices(car):
    """K and the joints of the linear car, body held; the tyre's hold in other directions than upwards taken off."""
    system, statics = car.matrices.system, axle(car)
    free = statics.columns
    bushing = next(one.law for one in car.vehicle.composition.connections if one.name.endswith("tyre_fr"))
    assert bushing is not None
    stiffness, joints = system.stiffness[np.ix_(free, free)].copy(), system.constraints[:, free]
    joints = joints[np.abs(joints).max(axis=1) > 0.0]
    for index, wheel in enumerate(statics.wheels):
        moved, turned = statics.jacobian(wheel, statics.places(index)[1])
        stiffness -= moved[:2].T @ np.diag(bushing.stiffness[:2]) @ moved[:2]
        stiffness -= bushing.rotational_stiffness * turned.T @ turned
    lift = 1e-4
    system_matrix = np.block([[stiffness, joints.T], [joints, np.zeros((len(joints), len(joints)))]])
    force = system.input_stiffness[free] @ (lift * np.ones(2))
    solved = np.linalg.solve(system_matrix, np.concatenate([force, np.zeros(len(joints))]))[: free.size]
    points = car.vehicle.points
    (center, turns), (patch, _) = (
        statics.jacobian(statics.wheels[0], np.array(points[f"{name}_fr"])) for name in ("wheel_center", "tyre_patch")
    )
    travel = float(center[2] @ solved)
    assert 0.2 < travel / lift < 1.0
    up, down = (statics.solve([sign * travel, sign * travel])[0] for sign in (1.0, -1.0))
    load = bushing.stiffness[2] * (lift - float(patch[2] @ solved))
    linear = {
        "toe_deg": np.degrees(turns[2] @ solved),
        "camber_deg": -np.degrees(turns[0] @ solved),
        "lateral_m": center[1] @ solved,
        "longitudinal_m": center[0] @ solved,
        "patch_lateral_m": patch[1] @ solved,
        "load_n": load,
    }
    for name, value in linear.items():
        # Half the difference: what bends the curves drops out.
        validated(
            "Suspension kinematics", f"compliance of the axle on its bushings at small travel, {name}",
            0.5 * (getattr(up, name) - getattr(down, name)), value, rel=1e-4,
            source="second derivation: K and joints of the linear car",
        )  # fmt: skip


def test_a_travel_that_the_linkage_does_not_reach_is_refused(car):
    with pytest.raises(SimulationError, match="axle: "):
        axle(car, ideal=True).solve([0.6, 0.6])
