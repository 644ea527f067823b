"""Parts of an axle: the bodies connected to its wheels, with their connections, springs and dampers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.engines.simulation.law_arrays import model_numbers
from vehicle.engines.simulation.row_layout import equality_rows
from vehicle.errors import ConfigurationError
from vehicle.model.assembly.element_numbers import FLUID, TURNING
from vehicle.model.laws.curve import Curve
from vehicle.model.laws.damper import unpack
from vehicle.model.parameters.air_spring import air_stiffness
from vehicle.names import AXES

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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Ties:
    """Bushings or ball joints as arrays, for an evaluation of all at once.

    Attributes:
        sites: sites of the moving part and of the carrier, in whose axes the law acts, (k, 2).
        bodies: bodies of the moving sites, then of the carriers, (2 k,).
        ways: directions of the laws as columns, (k, 3, 3).
        stiffness: K [N/m], (k, 3); 0 for ideal joints.
        preload, torque: force [N] and torque [N m] in the design position, (k, 3).
        twist: rotational stiffness [N m/rad], (k, 1).
        bent: row, axis and nonlinear law.
    """

    sites: Indices
    bodies: Indices
    ways: Vector
    stiffness: Vector
    preload: Vector
    torque: Vector
    twist: Vector
    bent: tuple[tuple[int, int, Bent], ...]

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
        soft, hard: bushings and ball joints, without the ground contacts.
        springs: springs between two points.
        joints: ids of the joints with a spring.
        struts: dampers.
        standing: force [N] and torque [N m] of the ground on each wheel in the design position, without the vertical
            load, (wheels, 6).
        round: ids of the wheels with a round tyre; see `vehicle/core/source/rows.h`.
    """

    wheels: tuple[int, ...]
    bodies: frozenset[int]
    columns: Indices
    soft: Ties
    hard: Ties
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

    Raises:
        ConfigurationError: the wheels have no connection.
    """
    rows, fields = equality_rows(model), model_numbers(model)
    # The law of an ideal connection is empty.
    laws = {name: fields.get(f"law/{name}", np.zeros(0)) for name in rows}
    ends = {
        name: (int(model.eq_obj1id[index]), int(model.eq_obj2id[index]))
        for index, (name, indices) in enumerate(rows.items())
        # A fluid carries no static force.
        if len(indices) == 3 and not name.startswith(FLUID)
    }
    rotational = [name for name in ends if laws[name].size and laws[name][TURNING] > 0.0]
    torques = dict(zip(rotational, preload[preload.size - 3 * len(rotational) :].reshape(-1, 3), strict=True))
    numbers = [model.body(name).id for name in wheels]
    links = [(body, int(model.body_parentid[body])) for body in range(1, model.nbody)]
    links += [(int(model.site_bodyid[first]), int(model.site_bodyid[second])) for first, second in ends.values()]
    stop = {model.body(name).id for name in HELD} | {b for b in range(model.nbody) if model.body_mocapid[b] >= 0}
    bodies, new = set(numbers), set(numbers)
    while new:
        # Neighbours of what was found last, over links in both directions, that are neither found nor held.
        new = {b for link in links for a, b in (link, link[::-1]) if a in bodies and b not in bodies | stop}
        bodies |= new
    standing, springs, treads = np.zeros((len(numbers), 6)), [], set()
    # Sites, directions, stiffness, preload, torque, rotational stiffness and nonlinear laws by axis.
    soft, hard = list[tuple[Any, ...]](), list[tuple[Any, ...]]()
    for index, (name, indices) in enumerate(rows.items()):
        law = laws[name]
        if name in ends:
            moving, carrier = (int(model.site_bodyid[site]) for site in ends[name])
            force, torque = preload[indices.start : indices.stop], torques.get(name, np.zeros(3))
            if not bodies & {moving, carrier}:
                continue
            if model.body_mocapid[carrier] >= 0:
                # A tyre on its plate keeps the horizontal force and the torque of the static trim.
                standing[numbers.index(moving)] = [*force[:2], 0.0, *torque]
                if f"round/{name}" in fields:
                    treads.add(moving)
                continue
            if not law.size or ideal:
                hard.append((ends[name], np.eye(3), np.zeros(3), force, torque, 0.0, {}))
                continue
            way = fields.get(f"directions/{name}", np.eye(3)).reshape(3, 3).T
            curves = {axis: _bent(fields, f"{name}/{letter}", force[axis]) for axis, letter in enumerate(AXES)}
            elastic = law[:3].copy()
            if (air := fields.get(f"air/{name}")) is not None:
                elastic[2] += air_stiffness(-float(force[2]), *air)[0]  # isothermal: the axle is lifted slowly
            soft.append((ends[name], way, elastic, force, torque, law[TURNING], curves))
        elif model.eq_type[index] == mujoco.mjtEq.mjEQ_TENDON and law.size:
            lower, upper = (model.site(f"{name}/{end}").id for end in ("lower", "upper"))
            if bodies & {int(model.site_bodyid[lower]), int(model.site_bodyid[upper])}:
                pull = float(preload[indices.start])
                springs.append(
                    Spring(
                        lower=lower,
                        upper=upper,
                        stiffness=float(law[0]),
                        length=float(model.tendon_length0[model.eq_obj1id[index]]),
                        preload=pull,
                        bent=_bent(fields, name, pull),
                    )
                )
    if not soft and not hard:
        raise ConfigurationError(
            f"axle of {', '.join(wheels)}: nothing connects the wheels to the body; add joints or bushings"
        )
    struts = []
    for index in np.flatnonzero(model.actuator_biastype == mujoco.mjtBias.mjBIAS_USER).tolist():
        joint, damper = int(model.actuator_trnid[index, 0]), str(model.actuator(index).name)
        if int(model.jnt_bodyid[joint]) in bodies:
            rest = float(unpack(fields[f"actuator/{damper}"])["rest_force"][0])
            struts.append(Strut(joint=joint, rest=rest, stop=_curve(fields, damper)))
    return AxleParts(
        wheels=tuple(numbers),
        bodies=frozenset(bodies),
        columns=np.flatnonzero(np.isin(model.dof_bodyid, sorted(bodies))),
        soft=_ties(model, soft),
        hard=_ties(model, hard),
        springs=tuple(springs),
        joints=tuple(
            joint
            for joint in range(model.njnt)
            if np.max(model.jnt_stiffness[joint]) > 0.0 and int(model.jnt_bodyid[joint]) in bodies
        ),
        struts=tuple(struts),
        standing=standing,
        round=frozenset(treads),
    )


def _ties(model: mujoco.MjModel, rows: Sequence[tuple[Any, ...]]) -> Ties:
    """Return bushings or ball joints as arrays from a tuple for each."""
    sites, ways, stiffness, preload, torque, twist, curves = zip(*rows, strict=True) if rows else ((),) * 7
    both = np.array(sites, dtype=np.intp).reshape(-1, 2)
    return Ties(
        sites=both,
        # Transposed: all moving sites, then all carriers.
        bodies=model.site_bodyid[both.T.ravel()].astype(np.intp),
        ways=np.reshape(ways, (-1, 3, 3)).astype(float),
        stiffness=np.reshape(stiffness, (-1, 3)).astype(float),
        preload=np.reshape(preload, (-1, 3)).astype(float),
        torque=np.reshape(torque, (-1, 3)).astype(float),
        twist=np.reshape(twist, (-1, 1)).astype(float),
        bent=tuple((row, axis, law) for row, bent in enumerate(curves) for axis, law in bent.items() if law),
    )


def _curve(fields: Mapping[str, Vector], name: str) -> Curve | None:
    """Return the force curve of an element; None for a linear law."""
    points = fields.get(f"table/{name}")
    return None if points is None else Curve.through(*points.reshape(2, -1))


def _bent(fields: Mapping[str, Vector], name: str, preload: float) -> Bent | None:
    """Return the force curve of an element with the operating point at which it carries a static force [N]."""
    curve = _curve(fields, name)
    return None if curve is None else Bent(curve=curve, at=curve.position(-preload))
