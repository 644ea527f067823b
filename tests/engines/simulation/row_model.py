"""Small MuJoCo models in the naming convention of the generated car, and a stepper for them."""

from collections.abc import Callable

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.rows import Rows, prepare_model
from vehicle.model.parameters.force_elements import FRICTION_LAWS

QUARTER_TURN = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
"""Quaternion of 90 degrees about z."""

TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""Matrix of the same rotation."""


def empty_spec(step: float) -> mujoco.MjSpec:
    """The options of the generated car, without gravity."""
    spec = mujoco.MjSpec()
    option, disable = spec.option, mujoco.mjtDisableBit
    option.timestep = step
    option.gravity = [0.0, 0.0, 0.0]
    option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    option.tolerance = 1e-14
    option.disableflags |= int(
        disable.mjDSBL_ISLAND | disable.mjDSBL_CONTACT | disable.mjDSBL_EULERDAMP | disable.mjDSBL_AUTORESET
    )
    return spec


def add_mass(parent, name, mass, inertia=(1.0, 1.0, 1.0), *, position=(0.0, 0.0, 0.0)):
    """A body without a joint; `inertia` are its principal moments about its origin [kg m2]."""
    body = parent.add_body(name=name, pos=position)
    body.explicitinertial = True
    body.mass, body.inertia, body.ipos = mass, list(inertia), np.zeros(3)
    return body


def add_free_body(spec, name, mass, inertia, *, position=(0.0, 0.0, 0.0), turn=None):
    """The same with a free joint."""
    body = add_mass(spec.worldbody, name, mass, inertia, position=position)
    if turn is not None:
        body.quat = turn
    body.add_freejoint(name=name)
    return body


def add_flexible_body(spec, element, *, turned=False, ratio=0.0):
    """A free body with mass and inertia of a superelement, its CoG at the origin, and its modes; returns the body."""
    body = spec.worldbody.add_body(name="body")
    body.explicitinertial = True
    tensor = element.inertia
    body.mass, body.ipos = element.mass, np.zeros(3)
    body.fullinertia = [tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2]]
    if turned:
        body.quat = QUARTER_TURN
    body.add_freejoint(name="body")
    for number, frequency in enumerate(element.frequencies, start=1):
        add_mode(spec, number, 2.0 * np.pi * frequency, ratio)
    return body


def add_bushing(spec, name, moving, carrier, law, *, at=(0.0, 0.0, 0.0), on_carrier=(0.0, 0.0, 0.0)):
    """A bushing between the origin (or `at`) of two bodies; `law` is what `element_law` returns."""
    moving.add_site(name=f"bushing/{name}/moving", pos=at)
    carrier.add_site(name=f"bushing/{name}/carrier", pos=on_carrier)
    spec.add_equality(
        name=f"bushing/{name}", type=mujoco.mjtEq.mjEQ_CONNECT, objtype=mujoco.mjtObj.mjOBJ_SITE,
        name1=f"bushing/{name}/moving", name2=f"bushing/{name}/carrier",
    )  # fmt: skip
    spec.add_numeric(name=f"law/bushing/{name}", data=law)


def element_law(stiffness, damping=(0, 0, 0), branch=(0, 0, 0), time=(0, 0, 0), *, rotational=0.0, averaged=False):
    """The numeric field of an element law as the generator writes it."""
    branch_damping = np.multiply(branch, time)
    return np.concatenate([stiffness, damping, branch, branch_damping, [rotational, float(averaged)]]).astype(float)


def add_coordinate(spec, name, mass, stiffness, damping):
    """A scalar coordinate, as the generator writes it."""
    add_mass(spec.worldbody, name, 1e-9, [1e-9] * 3).add_joint(
        name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1.0, 0.0, 0.0], armature=mass - 1e-9, stiffness=stiffness,
        damping=damping,
    )  # fmt: skip


def add_mode(spec, number, omega, ratio=0.0):
    """A mass-normalised modal coordinate."""
    add_coordinate(spec, f"mode_{number}", 1.0, omega**2, 2.0 * ratio * omega)


def add_damper(spec, body, parameters, *, stiffness=0.0, pieces=(), rest=0.0, sliders=()):
    """Slide joint `damper_fr` along x with the user actuator of a damper.

    `parameters` are viscous, smoothing, sliding limit, static limit, Stribeck velocity and exponent; `pieces`
    are slope, middle and limit of the clamped lines beside it, `rest` is the whole force at rest, `sliders` are
    stiffness and share of the limit of the elements of presliding friction.
    """
    body.add_joint(
        name="damper_fr", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1.0, 0.0, 0.0], stiffness=stiffness,
        frictionloss=parameters[2],
    )  # fmt: skip
    spec.add_equality(
        name="damper_fr", type=mujoco.mjtEq.mjEQ_JOINT, objtype=mujoco.mjtObj.mjOBJ_JOINT, name1="damper_fr"
    )
    actuator = spec.add_actuator(name="damper_fr", trntype=mujoco.mjtTrn.mjTRN_JOINT, target="damper_fr")
    actuator.gaintype, actuator.biastype = mujoco.mjtGain.mjGAIN_USER, mujoco.mjtBias.mjBIAS_USER
    word = "coulomb" if parameters[3] == parameters[2] else "stribeck"
    law = FRICTION_LAWS.index("presliding" if len(sliders) else word)
    actuator.biasprm = [*parameters[:6], rest, rest - sum(np.clip(-e * m, -w, w) for e, m, w in pieces), law, 0.0]
    for number, piece in enumerate(pieces):
        tendon = spec.add_tendon(name=f"valve_{number}")
        tendon.wrap_joint("damper_fr", 1.0)
        tendon.frictionloss = piece[2]
        spec.add_numeric(name=f"law/valve_{number}", data=piece)
    if len(sliders):
        spec.add_numeric(name="presliding/damper_fr", data=np.ravel(sliders))
    for number, (_, share) in enumerate(sliders[1:], start=1):
        tendon = spec.add_tendon(name=f"presliding/damper_fr/{number}")
        tendon.wrap_joint("damper_fr", 1.0)
        tendon.frictionloss = share * parameters[2]


class Stepper:
    """A compiled small model with its element rows; `step` runs it and records what a function reads."""

    def __init__(self, spec: mujoco.MjSpec, preload: np.ndarray | None = None) -> None:
        self.model = spec.compile()
        prepare_model(self.model)
        self.data = mujoco.MjData(self.model)
        self.rows = Rows(self.model, preload)
        self.h = float(self.model.opt.timestep)

    def step(
        self, count: int, read: Callable[[], npt.ArrayLike], before: Callable[[float], None] | None = None
    ) -> np.ndarray:
        """Values of `read()` before each of `count` steps; `before(t)` sets forces or plates."""
        found = []
        with installed(self.rows):
            for index in range(count):
                if before is not None:
                    before(index * self.h)
                found.append(np.array(read(), dtype=float))
                mujoco.mj_step(self.model, self.data)
        return np.array(found)

    def position(self) -> np.ndarray:
        """Generalised positions."""
        return np.array(self.data.qpos)


def poles(samples: np.ndarray, step: float) -> np.ndarray:
    """Continuous poles of a sampled free vibration of one degree of freedom, from its two-step recurrence.

    x[n+1] = a x[n] + b x[n-1] holds exactly for any linear one-step scheme, so no window or fit of a decay blurs it.
    """
    a, b = np.linalg.lstsq(np.column_stack([samples[1:-1], samples[:-2]]), samples[2:], rcond=None)[0]
    return np.asarray(np.log(np.roots([1.0, -a, -b]).astype(complex)) / step)


def stiffness_and_damping(samples: np.ndarray, step: float, mass: float) -> tuple[float, float]:
    """K and B of m x'' + B x' + K x = 0 from a sampled free vibration."""
    first, second = poles(samples, step)
    return mass * float(np.real(first * second)), -mass * float(np.real(first + second))
