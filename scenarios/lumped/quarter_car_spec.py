"""Quarter car with the elements of the complete car: bushing rows, main spring, damper with friction row, plate."""

from typing import Literal

import mujoco
import numpy as np
import numpy.typing as npt

from scenarios.lumped.quarter_car_parameters import QuarterCar
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.element_builder import MIN_FRICTION
from vehicle.model.laws.damper import RECORD, actuator_parameters
from vehicle.model.laws.elastomer import Kelvin, Maxwell, in_series

WHEEL = "fr"
"""Name of the corner; elements have their names of the complete car."""

HEIGHTS = {"plate": 0.0, "wheel": 0.3, "strut_top": 0.8}
"""Heights [m] of the plate, of the wheel and of the upper mount, arbitrary on a vertical line."""

VERTICAL = (0.0, 0.0, 1.0)


def quarter_car_spec(
    car: QuarterCar, *, timestep: float, damper: Literal["slip", "stick", "friction"] = "friction"
) -> mujoco.MjSpec:
    """Return the quarter car for MuJoCo, with the names that the element rows of the complete car read.

    Masses slide vertically: `body`, `wheel`, and with friction `damper_top_fr` on the joint `damper_fr` of the wheel,
    whose coordinate is the travel of the damper. Elements: `main_spring_fr`, `bushing/tyre_fr` to the mocap plate
    `plate_fr`, and by the damper model

    | damper | elements | equation |
    |---|---|---|
    | friction | `bushing/suspension_mount_fr` (Kd), actuator, equality and friction `damper_fr` (D, Fd, eps) | 2.6 |
    | slip | `bushing/strut_fr`: damper D in series with the mount Kd, a Maxwell branch | 2.1 |
    | stick | `bushing/strut_fr`: the mount Kd alone | 2.2 |

    There is no gravity, as in the source: every element is free of force in the design position.

    Args:
        car: the parameters.
        timestep: time step [s].
        damper: model of the shock absorber.

    Returns:
        The specification, with an acceleration sensor `<place>_acc` for body, wheel and damper.

    Raises:
        ConfigurationError: an unknown damper model, or a step that is not a finite number above zero.

    Source: Bommer 2006, equations 2.1, 2.2, 2.6.
    """
    if damper not in ("slip", "stick", "friction"):
        raise ConfigurationError(f"damper: found {damper!r}, must be one of slip, stick, friction")
    if not (np.isfinite(timestep) and timestep > 0.0):
        raise ConfigurationError(f"timestep: found {timestep!r} s, must be finite and greater than 0.0")
    corner = _Corner(timestep)
    corner.add_mass("body", corner.spec.worldbody, "body", car.body.mass, HEIGHTS["strut_top"])
    wheel = corner.add_mass("wheel", corner.spec.worldbody, "wheel", car.wheel.mass, HEIGHTS["wheel"])
    corner.add_plate()
    corner.add_bushing(
        "tyre", "wheel", f"plate_{WHEEL}", "plate", Kelvin(stiffness=car.wheel.tyre_stiffness, damping=0)
    )
    corner.add_main_spring(car.spring.stiffness)
    mount = Kelvin(stiffness=car.mount.stiffness, damping=0.0)
    if damper == "friction":
        top = f"damper_top_{WHEEL}"
        corner.add_mass(top, wheel, f"damper_{WHEEL}", car.damper.mass, HEIGHTS["strut_top"] - HEIGHTS["wheel"])
        corner.add_bushing("suspension_mount", top, "body", "strut_top", mount)
        corner.add_damper(car)
    elif damper == "slip":
        series = in_series(car.mount.stiffness, Kelvin(stiffness=0.0, damping=car.damper.damping))
        corner.add_bushing("strut", "wheel", "body", "strut_top", series)
    else:
        corner.add_bushing("strut", "wheel", "body", "strut_top", mount)
    return corner.spec


class _Corner:
    """Builder of the masses and elements of a quarter car."""

    def __init__(self, timestep: float) -> None:
        self.spec = mujoco.MjSpec()
        self.spec.modelname = "quarter_car"
        option, disable = self.spec.option, mujoco.mjtDisableBit
        option.timestep = timestep
        option.gravity = [0.0, 0.0, 0.0]
        option.integrator = mujoco.mjtIntegrator.mjINT_EULER
        option.solver = mujoco.mjtSolver.mjSOL_NEWTON
        option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
        option.iterations = 50
        option.tolerance = 1e-12
        option.disableflags |= int(
            disable.mjDSBL_ISLAND | disable.mjDSBL_CONTACT | disable.mjDSBL_EULERDAMP | disable.mjDSBL_AUTORESET
        )
        self.heights: dict[str, float] = {}

    def add_mass(self, name: str, parent: mujoco.MjsBody, joint: str, mass: float, height: float) -> mujoco.MjsBody:
        """Add a point mass on a vertical slide joint, and its acceleration sensor."""
        body = parent.add_body(name=name, pos=[0.0, 0.0, height])
        body.explicitinertial = True
        body.mass, body.ipos, body.inertia = mass, np.zeros(3), np.full(3, mass)
        body.add_joint(name=joint, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=VERTICAL)
        output = "damper" if joint == f"damper_{WHEEL}" else name
        body.add_site(name=f"place/{output}")
        self.spec.add_sensor(
            name=f"{output}_acc",
            type=mujoco.mjtSensor.mjSENS_FRAMELINACC,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            objname=f"place/{output}",
        )
        self.heights[name] = height + self.heights.get(parent.name, 0.0)
        return body

    def add_plate(self) -> None:
        """Add the shaker plate under the tyre."""
        self.spec.worldbody.add_body(name=f"plate_{WHEEL}", pos=[0.0, 0.0, HEIGHTS["plate"]], mocap=True)
        self.heights[f"plate_{WHEEL}"] = HEIGHTS["plate"]

    def add_bushing(self, name: str, moving: str, carrier: str, height: str, law: Kelvin | Maxwell) -> None:
        """Add a vertical element as a connect row, because no body rotates."""
        name = f"bushing/{name}_{WHEEL}"
        self._site(f"{name}/moving", moving, height)
        self._site(f"{name}/carrier", carrier, height)
        self.spec.add_equality(
            name=name,
            type=mujoco.mjtEq.mjEQ_CONNECT,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            name1=f"{name}/moving",
            name2=f"{name}/carrier",
        )
        constants = np.zeros(14)
        if isinstance(law, Maxwell):
            constants[[2, 8, 11]] = law.stiffness, law.branch_stiffness, law.branch_damping
        else:
            constants[[2, 5]] = law.stiffness, law.damping
        self._numeric(f"law/{name}", constants)

    def add_main_spring(self, stiffness: float) -> None:
        """Add the main spring as a tendon between wheel and body, with an equality row."""
        name = f"main_spring_{WHEEL}"
        self._site(f"{name}/lower", "wheel", "wheel")
        self._site(f"{name}/upper", "body", "strut_top")
        tendon = self.spec.add_tendon(name=name)
        tendon.wrap_site(f"{name}/lower")
        tendon.wrap_site(f"{name}/upper")
        self.spec.add_equality(name=name, type=mujoco.mjtEq.mjEQ_TENDON, objtype=mujoco.mjtObj.mjOBJ_TENDON, name1=name)
        self._numeric(f"law/{name}", [stiffness])

    def add_damper(self, car: QuarterCar) -> None:
        """Add the damper as a user actuator on its slide joint, whose friction row has the set-valued part."""
        name, limit = f"damper_{WHEEL}", car.friction.limit
        # MuJoCo makes no friction row for a joint without friction; the callback sets the limit anyway.
        self.spec.joint(name).frictionloss = max(limit, MIN_FRICTION)
        self.spec.add_equality(name=name, type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT, name1=name)
        actuator = self.spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=name)
        actuator.gaintype, actuator.biastype = mujoco.mjtGain.mjGAIN_USER, mujoco.mjtBias.mjBIAS_USER
        # Static limit equal to the sliding one: no Stribeck curve; its velocity and exponent are then not used.
        laws = (car.damper.damping, car.friction.steepness, limit, limit, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0)
        actuator.biasprm = actuator_parameters(np.array(laws, dtype=RECORD))

    def _site(self, name: str, body: str, height: str) -> None:
        owner = self.spec.body(body)
        owner.add_site(name=name, pos=[0.0, 0.0, HEIGHTS[height] - self.heights[body]])

    def _numeric(self, name: str, data: npt.ArrayLike) -> None:
        self.spec.add_numeric(name=name, data=np.asarray(data, dtype=float))
