"""Parts of an axle: the bodies connected to its wheels, with their connections, springs and dampers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.law_arrays import model_numbers
from vehicle.engines.simulation.row_layout import numeric
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.element_numbers import FLUID
from vehicle.model.laws.curve import Curve
from vehicle.model.laws.damper import unpack
from vehicle.names import AXES

Vector = npt.NDArray[np.float64]

HELD = ("world", "body")
"""Fixed bodies on the rig; an axle contains the bodies connected to its wheels by paths that avoid these."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Bent:
    """Nonlinear law over displacement: -F(at + x) in place of preload - K x; `at` is the operating point [m]."""

    curve: Curve
    at: float

    def force(self, displacement: float) -> tuple[float, float]:
        """Return the force [N] of the element and its tangent stiffness [N/m]."""
        x = self.at + displacement
        return -float(self.curve.force(x)), float(self.curve.slope(x))


@dataclass(frozen=True, kw_only=True, slots=True)
class Tie:
    """Bushing or ball joint.

    Attributes:
        moving, carrier: sites of the moving part and of the carrier, in whose axes the law acts.
        stiffness: K [N/m], (3,); None for an ideal joint.
        preload: force in the design position [N], (3,).
        twist: rotational stiffness [N m/rad].
        torque: torque in the design position [N m], (3,).
        bent: nonlinear laws by axis.
        directions: directions of the law in the axes of the carrier, a row each, (3, 3); None for these axes.
    """

    moving: int
    carrier: int
    stiffness: Vector | None
    preload: Vector
    twist: float
    torque: Vector
    bent: Mapping[int, Bent]
    directions: Vector | None = None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TieTable:
    """Several ties as arrays, for an evaluation of all at once.

    Attributes:
        moving, carrier: sites, (k,).
        bodies: bodies of the moving sites, then of the carriers, (2 k,).
        ways: directions of the laws as columns, (k, 3, 3).
        stiffness, preload, torque: see `Tie`, (k, 3); a stiffness of 0 for ideal joints.
        twist: rotational stiffness, (k, 1).
        bent: row, axis and nonlinear law.
    """

    moving: npt.NDArray[np.intp]
    carrier: npt.NDArray[np.intp]
    bodies: npt.NDArray[np.intp]
    ways: Vector
    stiffness: Vector
    preload: Vector
    torque: Vector
    twist: Vector
    bent: tuple[tuple[int, int, Bent], ...]

    @classmethod
    def of(cls, ties: Sequence[Tie], body_of_site: npt.NDArray[np.int32]) -> Self:
        """Return the table of some ties.

        Args:
            ties: the ties.
            body_of_site: body of each site of the model.
        """
        moving, carrier = (
            np.array([getattr(tie, end) for tie in ties], dtype=np.intp) for end in ("moving", "carrier")
        )

        def column(values: Sequence[npt.ArrayLike], *shape: int) -> Vector:
            """Return values with a row for each tie."""
            return np.array(values, dtype=np.float64).reshape(len(ties), *shape)

        return cls(
            moving=moving,
            carrier=carrier,
            bodies=body_of_site[np.concatenate([moving, carrier])].astype(np.intp),
            ways=column([np.eye(3) if tie.directions is None else tie.directions.T for tie in ties], 3, 3),
            stiffness=column([np.zeros(3) if tie.stiffness is None else tie.stiffness for tie in ties], 3),
            preload=column([tie.preload for tie in ties], 3),
            torque=column([tie.torque for tie in ties], 3),
            twist=column([tie.twist for tie in ties], 1),
            bent=tuple((row, axis, law) for row, tie in enumerate(ties) for axis, law in tie.bent.items()),
        )

    def pull(self, gaps: Vector) -> tuple[Vector, Vector]:
        """Return forces [N] and stiffnesses [N/m] of bushings at displacements r [m] along their axes, (k, 3) each."""
        force, stiffness = self.preload - self.stiffness * gaps, self.stiffness.copy()
        for row, axis, law in self.bent:
            force[row, axis], stiffness[row, axis] = law.force(float(gaps[row, axis]))
        return force, stiffness


@dataclass(frozen=True, kw_only=True, slots=True)
class Spring:
    """Spring between two sites: stiffness [N/m], length in the design position [m] and force there [N]."""

    lower: int
    upper: int
    stiffness: float
    length: float
    preload: float
    bent: Bent | None = None

    def pull(self, extension: float) -> tuple[float, float]:
        """Return the force [N] and stiffness [N/m] at an extension from the design position [m]."""
        if self.bent is not None:
            return self.bent.force(extension)
        return self.preload - self.stiffness * extension, self.stiffness


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Strut:
    """Damper at rest on its slide joint: constant force of gas and valves [N], extension positive, and bump stop."""

    joint: int
    rest: float
    stop: Curve | None

    def pull(self, position: float) -> tuple[float, float]:
        """Return the force [N] on the joint and the stiffness [N/m] at its position [m]."""
        if self.stop is None:
            return -self.rest, 0.0
        return -self.rest - float(self.stop.force(position)), float(self.stop.slope(position))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AxleParts:
    """Parts of an axle.

    Attributes:
        wheels: ids of the bodies of the wheels.
        bodies: ids of all bodies of the axle.
        columns: velocity coordinates of the bodies.
        ties: bushings and ball joints, without the ground contacts.
        springs: springs between two points.
        joints: ids of the joints with a spring.
        struts: dampers.
        standing: force [N] and torque [N m] of the ground on each wheel in the design position, without the vertical
            load, (wheels, 6).
        round: ids of the wheels with a round tyre; see `vehicle/core/source/rows.h`.
    """

    wheels: tuple[int, ...]
    bodies: frozenset[int]
    columns: npt.NDArray[np.intp]
    ties: tuple[Tie, ...]
    springs: tuple[Spring, ...]
    joints: tuple[int, ...]
    struts: tuple[Strut, ...]
    standing: Vector
    round: frozenset[int]


def axle_parts(model: mujoco.MjModel, preload: Vector, wheels: Sequence[str], *, ideal: bool = False) -> AxleParts:
    """Find the parts of an axle in a compiled car in static equilibrium.

    Args:
        model: the car.
        preload: static force of every constraint row [N], then the torques of the rotations [N m]; see `StaticTrim`.
        wheels: bodies of the wheels of the axle.
        ideal: True to replace every connection by an ideal ball joint.

    Returns:
        The parts.

    Raises:
        ConfigurationError: the wheels have no connection.
    """
    kinds = [mujoco.mjtEq(equality_type) for equality_type in model.eq_type]
    connect, tendon = mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_TENDON
    rows = np.cumsum([0, *(3 if equality_type == connect else 1 for equality_type in kinds)])
    names = [str(model.equality(index).name) for index in range(model.neq)]
    laws = {name: _law(model, name) for name in names}
    ends = {
        name: (int(model.eq_obj1id[index]), int(model.eq_obj2id[index]))
        for index, name in enumerate(names)
        # A fluid carries no static force.
        if kinds[index] == connect and not name.startswith(FLUID)
    }
    rotational = [name for name in ends if laws[name].size and laws[name][12] > 0.0]
    torques = dict(zip(rotational, preload[preload.size - 3 * len(rotational) :].reshape(-1, 3), strict=True))
    numbers = [model.body(name).id for name in wheels]
    bodies = _connected_bodies(model, numbers, list(ends.values()))
    standing, ties, springs, treads = np.zeros((len(numbers), 6)), [], [], set()
    for index, name in enumerate(names):
        law = laws[name]
        if name in ends:
            moving, carrier = (int(model.site_bodyid[site]) for site in ends[name])
            force, torque = preload[rows[index] : rows[index] + 3], torques.get(name, np.zeros(3))
            if not bodies & {moving, carrier}:
                continue
            if model.body_mocapid[carrier] >= 0:
                # A tyre on its plate keeps the horizontal force and the torque of the static trim.
                standing[numbers.index(moving)] = [*force[:2], 0.0, *torque]
                if numeric(model, f"round/{name}") is not None:
                    treads.add(moving)
                continue
            soft = law.size > 0 and not ideal
            curves = {axis: _curve(model, f"{name}/{letter}") for axis, letter in enumerate(AXES)} if soft else {}
            sites = ends[name]
            way = numeric(model, f"directions/{name}") if soft else None
            ties.append(
                Tie(
                    moving=sites[0],
                    carrier=sites[1],
                    stiffness=law[:3] if soft else None,
                    preload=force,
                    twist=float(law[12]) if soft else 0.0,
                    torque=torque,
                    bent={axis: _standing(curve, force[axis]) for axis, curve in curves.items() if curve is not None},
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
        raise ConfigurationError(
            f"axle of {', '.join(wheels)}: nothing ties its wheels to the body; add joints or bushings"
        )
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
        struts=tuple(strut for strut in _struts(model) if int(model.jnt_bodyid[strut.joint]) in bodies),
        standing=standing,
        round=frozenset(treads),
    )


def _curve(model: mujoco.MjModel, name: str) -> Curve | None:
    """Return the force curve of an element; None for a linear law."""
    points = numeric(model, f"table/{name}")
    return None if points is None else Curve.through(*points.reshape(2, -1))


def _standing(curve: Curve, preload: float) -> Bent:
    """Return a curve with the operating point at which it carries a static force [N]."""
    return Bent(curve=curve, at=curve.position(-preload))


def _struts(model: mujoco.MjModel) -> list[Strut]:
    """Return all dampers of the model."""
    dampers = [index for index in range(model.nu) if model.actuator_biastype[index] == mujoco.mjtBias.mjBIAS_USER]
    numbers = model_numbers(model)
    rest_forces = unpack([numbers[f"actuator/{model.actuator(index).name}"] for index in dampers])["rest_force"]
    return [
        Strut(
            joint=int(model.actuator_trnid[index, 0]),
            rest=float(force),
            stop=_curve(model, str(model.actuator(index).name)),
        )
        for index, force in zip(dampers, rest_forces, strict=True)
    ]


def _law(model: mujoco.MjModel, name: str) -> Vector:
    """Return the parameters of a law; an empty array for an ideal connection."""
    parameters = numeric(model, f"law/{name}")
    return np.zeros(0) if parameters is None else parameters


def _connected_bodies(model: mujoco.MjModel, wheels: Sequence[int], ends: Sequence[tuple[int, int]]) -> set[int]:
    """Return the bodies connected to the wheels by joints and connections, without the fixed bodies."""
    links = [(body, int(model.body_parentid[body])) for body in range(1, model.nbody)]
    links += [(int(model.site_bodyid[first]), int(model.site_bodyid[second])) for first, second in ends]
    stop = {model.body(name).id for name in HELD} | {b for b in range(model.nbody) if model.body_mocapid[b] >= 0}
    connected, new = set(wheels), set(wheels)
    while new:
        new = {b for link in links for a, b in (link, link[::-1]) if a in connected and b not in connected | stop}
        connected |= new
    return connected
