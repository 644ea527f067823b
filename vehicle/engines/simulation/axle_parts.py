"""What an axle consists of: the bodies that hang together with its wheels, what ties and springs them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.law_arrays import model_numbers
from vehicle.engines.simulation.row_layout import numeric
from vehicle.errors import ConfigurationError
from vehicle.model.laws.curve import Curve
from vehicle.model.laws.damper import unpack
from vehicle.names import AXES

Vector = npt.NDArray[np.float64]

HELD = ("world", "body")
"""Bodies that do not move; an axle is what hangs together with its wheels without passing through them."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bent:
    """A law over displacement that is a curve: -F(at + x) in place of preload - K x; `at` is where the car stands."""

    curve: Curve
    at: float

    def force(self, displacement: float) -> tuple[float, float]:
        """Force [N] of the element, and its stiffness there [N/m]."""
        x = self.at + displacement
        return -float(self.curve.force(x)), float(self.curve.slope(x))


@dataclass(frozen=True, kw_only=True, slots=True)
class Tie:
    """A bushing or a ball joint.

    Attributes:
        moving, carrier: sites of the moving part and of the carrier, in whose axes the law acts.
        stiffness: K [N/m], (3,); None where it is an ideal joint.
        preload: force in the design position [N], (3,).
        twist: rotational stiffness [N m/rad].
        torque: in the design position [N m], (3,).
        bent: axes whose law is a curve.
        directions: those of the law in the axes of the carrier, a row each, (3, 3); None where they are these.
    """

    moving: int
    carrier: int
    stiffness: Vector | None
    preload: Vector
    twist: float
    torque: Vector
    bent: Mapping[int, Bent]
    directions: Vector | None = None

    def pull(self, gap: Vector) -> tuple[Vector, Vector]:
        """Force [N] and stiffness [N/m] of a bushing at a displacement r [m], along its axes."""
        assert self.stiffness is not None
        force, stiffness = self.preload - self.stiffness * gap, self.stiffness.copy()
        for axis, law in self.bent.items():
            force[axis], stiffness[axis] = law.force(float(gap[axis]))
        return force, stiffness


@dataclass(frozen=True, kw_only=True, slots=True)
class Spring:
    """A spring between two sites: stiffness [N/m], length in the design position [m] and force there [N]."""

    lower: int
    upper: int
    stiffness: float
    length: float
    preload: float
    bent: Bent | None = None

    def pull(self, extension: float) -> tuple[float, float]:
        """Force [N] and stiffness [N/m] at an extension from the design position [m]."""
        if self.bent is not None:
            return self.bent.force(extension)
        return self.preload - self.stiffness * extension, self.stiffness


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Strut:
    """A damper at rest on its slide joint: constant force of gas and valves [N], extension positive, and its stop."""

    joint: int
    rest: float
    stop: Curve | None

    def pull(self, position: float) -> tuple[float, float]:
        """Force [N] on the joint and stiffness [N/m] at its position [m]."""
        if self.stop is None:
            return -self.rest, 0.0
        return -self.rest - float(self.stop.force(position)), float(self.stop.slope(position))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AxleParts:
    """The parts of an axle.

    Attributes:
        wheels: ids of the bodies of the wheels.
        bodies: ids of all its bodies.
        columns: velocity coordinates of these.
        ties: its bushings and ball joints, without those to the ground.
        springs: its springs between two points.
        joints: its joints with a spring.
        struts: its dampers.
        standing: force [N] and torque [N m] of the ground on each wheel in the design position, without the vertical
            load, (wheels, 6).
    """

    wheels: tuple[int, ...]
    bodies: frozenset[int]
    columns: npt.NDArray[np.intp]
    ties: tuple[Tie, ...]
    springs: tuple[Spring, ...]
    joints: tuple[int, ...]
    struts: tuple[Strut, ...]
    standing: Vector


def axle_parts(model: mujoco.MjModel, preload: Vector, wheels: Sequence[str], *, ideal: bool = False) -> AxleParts:
    """Find the parts of an axle in a compiled and trimmed car.

    Args:
        model: the car.
        preload: force of every constraint row [N], torques of the rotations behind them [N m], as of the trim.
        wheels: bodies of the wheels of the axle.
        ideal: every connection to be an ideal ball joint.

    Returns:
        The parts.

    Raises:
        ConfigurationError: nothing ties a wheel to the body.
    """
    kinds = [mujoco.mjtEq(kind) for kind in model.eq_type]
    connect, tendon = mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_TENDON
    rows = np.cumsum([0, *(3 if kind == connect else 1 for kind in kinds)])
    names = [str(model.equality(index).name) for index in range(model.neq)]
    laws = {name: _law(model, name) for name in names}
    ends = {
        name: (int(model.eq_obj1id[index]), int(model.eq_obj2id[index]))
        for index, name in enumerate(names)
        if kinds[index] == connect
    }
    turning = [name for name in ends if laws[name].size and laws[name][12] > 0.0]
    torques = dict(zip(turning, preload[preload.size - 3 * len(turning) :].reshape(-1, 3), strict=True))
    numbers = [model.body(name).id for name in wheels]
    bodies = _hanging_together(model, numbers, list(ends.values()))
    standing, ties, springs = np.zeros((len(numbers), 6)), [], []
    for index, name in enumerate(names):
        law = laws[name]
        if kinds[index] == connect:
            moving, carrier = (int(model.site_bodyid[site]) for site in ends[name])
            force, torque = preload[rows[index] : rows[index] + 3], torques.get(name, np.zeros(3))
            if not bodies & {moving, carrier}:
                continue
            if model.body_mocapid[carrier] >= 0:
                # A tyre on its plate: the horizontal force and the torque with which the car was set down stay.
                standing[numbers.index(moving)] = [*force[:2], 0.0, *torque]
                continue
            soft = law.size > 0 and not ideal
            curves = {axis: _curve(model, f"{name}/{letter}") for axis, letter in enumerate(AXES)} if soft else {}
            one, other = ends[name]
            way = numeric(model, f"directions/{name}") if soft else None
            ties.append(
                Tie(
                    moving=one,
                    carrier=other,
                    stiffness=law[:3] if soft else None,
                    preload=force,
                    twist=float(law[12]) if soft else 0.0,
                    torque=torque,
                    bent={axis: _standing(one, force[axis]) for axis, one in curves.items() if one is not None},
                    directions=None if way is None else way.reshape(3, 3),
                )
            )
        elif kinds[index] == tendon and law.size:
            lower, upper = (model.site(f"{name}/{end}").id for end in ("lower", "upper"))
            if bodies & {int(model.site_bodyid[lower]), int(model.site_bodyid[upper])}:
                length = float(model.tendon_length0[model.eq_obj1id[index]])
                pull = float(preload[rows[index]])
                curve = _curve(model, name)
                springs.append(
                    Spring(
                        lower=lower,
                        upper=upper,
                        stiffness=float(law[0]),
                        length=length,
                        preload=pull,
                        bent=None if curve is None else _standing(curve, pull),
                    )
                )
    if not ties:
        raise ConfigurationError(f"axle of {', '.join(wheels)}: nothing ties its wheels to the body")
    return AxleParts(
        wheels=tuple(numbers),
        bodies=frozenset(bodies),
        columns=np.flatnonzero(np.isin(model.dof_bodyid, sorted(bodies))),
        ties=tuple(ties),
        springs=tuple(springs),
        joints=tuple(
            joint
            for joint in range(model.njnt)
            if np.max(model.jnt_stiffness[joint]) > 0.0 and int(model.jnt_bodyid[joint]) in bodies
        ),
        struts=tuple(one for one in _struts(model) if int(model.jnt_bodyid[one.joint]) in bodies),
        standing=standing,
    )


def _curve(model: mujoco.MjModel, name: str) -> Curve | None:
    """The curve of an element; None of a linear one."""
    points = numeric(model, f"table/{name}")
    return None if points is None else Curve.through(*points.reshape(2, -1))


def _standing(curve: Curve, preload: float) -> Bent:
    """A curve where it carries a static force [N]."""
    return Bent(curve=curve, at=curve.position(-preload))


def _struts(model: mujoco.MjModel) -> list[Strut]:
    dampers = [index for index in range(model.nu) if model.actuator_biastype[index] == mujoco.mjtBias.mjBIAS_USER]
    numbers = model_numbers(model)
    rest = unpack([numbers[f"actuator/{model.actuator(index).name}"] for index in dampers])["rest_force"]
    return [
        Strut(
            joint=int(model.actuator_trnid[index, 0]),
            rest=float(force),
            stop=_curve(model, str(model.actuator(index).name)),
        )
        for index, force in zip(dampers, rest, strict=True)
    ]


def _law(model: mujoco.MjModel, name: str) -> Vector:
    """Numbers of a law; empty where the connection is ideal."""
    found = numeric(model, f"law/{name}")
    return np.zeros(0) if found is None else found


def _hanging_together(model: mujoco.MjModel, wheels: Sequence[int], ends: Sequence[tuple[int, int]]) -> set[int]:
    """Bodies that hang together with the wheels by joints and connections, without the held ones."""
    links = [(body, int(model.body_parentid[body])) for body in range(1, model.nbody)]
    links += [(int(model.site_bodyid[one]), int(model.site_bodyid[other])) for one, other in ends]
    stop = {model.body(name).id for name in HELD} | {b for b in range(model.nbody) if model.body_mocapid[b] >= 0}
    found, new = set(wheels), set(wheels)
    while new:
        new = {b for link in links for a, b in (link, link[::-1]) if a in found and b not in found | stop}
        found |= new
    return found
