"""The half car with rider, with controlled dampers in bodies and rows of MuJoCo, without the lumped model."""

import mujoco
import numpy as np

from tests.engines.simulation.row_model import add_bushing, add_mass, element_law, empty_spec
from vehicle.model.laws.control_laws import pack as control_numbers
from vehicle.model.laws.damper import actuator_parameters, pack

UP = [0.0, 0.0, 1.0]


def half_car_spec(car, damper, step):
    """Heave and pitch, wheels and seat on slides of the body, limbs on slides of the seat.

    All at the height of the centre of gravity, so that no pitch moves a mass along the car.

    Args:
        car: parameters of source 2.
        damper: controlled law of both dampers, as in the complete car.
        step: [s].
    """
    spec = empty_spec(step)
    body = add_mass(spec.worldbody, "body", car.body.mass, np.full(3, car.body.pitch_inertia), position=[0.0, 0.0, 1.0])
    body.add_joint(name="heave", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=UP)
    # The frame of cars: x to the rear, so that a nose that rises turns about +y.
    body.add_joint(name="pitch", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0.0, -1.0, 0.0])
    for name, axle, arm in (("fr", car.front, -car.body.front_arm), ("rr", car.rear, car.body.rear_arm)):
        wheel = add_mass(body, f"wheel_{name}", axle.unsprung_mass, np.full(3, 1e-9), position=[arm, 0.0, 0.0])
        wheel.add_joint(
            name=f"damper_{name}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=UP,
            stiffness=[axle.suspension_stiffness, 0.0, 0.0], frictionloss=1e-9,
        )  # fmt: skip
        plate = spec.worldbody.add_body(name=f"plate_{name}", pos=[arm, 0.0, 1.0], mocap=True)
        tyre = element_law([0, 0, axle.tyre_stiffness], [0, 0, axle.tyre_damping])
        add_bushing(spec, f"tyre_{name}", wheel, plate, tyre)
        _add_damper(spec, name, damper, wheel, body, [arm, 0.0, 0.0])
    seat = _limb(body, "seat", [-car.body.seat_arm, 0.0, 0.0], car.seat)
    _limb(seat, "lower_limb", [0.0, 0.0, 0.0], car.lower_limb)
    _limb(seat, "upper_limb", [0.0, 0.0, 0.0], car.upper_limb)
    return spec


def _limb(parent, name, position, limb):
    body = add_mass(parent, name, limb.mass, np.full(3, 1e-9), position=position)
    body.add_joint(
        name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=UP, stiffness=[limb.stiffness, 0.0, 0.0],
        damping=[limb.damping, 0.0, 0.0],
    )  # fmt: skip
    return body


def _add_damper(spec, wheel, law, lower, upper, at):
    name = f"damper_{wheel}"
    spec.add_equality(name=name, type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT, name1=name)
    actuator = spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=name)
    actuator.gaintype, actuator.biastype = mujoco.mjtGain.mjGAIN_USER, mujoco.mjtBias.mjBIAS_USER
    actuator.biasprm = actuator_parameters(pack(law))
    spec.add_numeric(name=f"control/{name}", data=control_numbers(law.control))
    lower.add_site(name=f"sensor/{name}/lower")
    upper.add_site(name=f"sensor/{name}/upper", pos=at)
