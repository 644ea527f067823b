"""Loads of the linear car: every force of an element, and the suspension travel, as rows over its motion.

An element follows its law in the axes of its carrier, f = p - K r - B r' - f2, with r = J u - z and the preload p. What
an ideal joint carries follows from the equation of motion,

    Jc' f = M u'' + C u' + K u + H' f_b - Bk z - Bc z' - S' phi,

phi being the nonlinear damper forces; K holds the turning of the preloads, so that this f is in world axes. In the axes
of a carrier that turns by theta it is f - theta x p. Where joints hold one freedom twice, the split is the least one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.matrices import CarMatrices
from vehicle.engines.simulation.callbacks import installed
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.load_channels import LoadPlaces, spring_coordinates
from vehicle.engines.simulation.rows import Rows

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LoadRows:
    """Loads w = static + sum of a row each times u, u', u'', the branch forces f_b, z, z' and the damper forces phi.

    Attributes:
        names: of the l channels.
        static: value of each at rest [N, N m or m]; (l,).
        displacement, velocity, acceleration: rows over u, u', u''; (l, n).
        branch: over f_b; (l, b).
        height, height_rate: over z and z'; (l, w).
        friction: over phi, positive as it enters the equation of motion; (l, d).
    """

    names: tuple[str, ...]
    static: Vector
    displacement: Vector
    velocity: Vector
    acceleration: Vector
    branch: Vector
    height: Vector
    height_rate: Vector
    friction: Vector

    def only(self, names: Sequence[str]) -> LoadRows:
        """The loads among these channels, in the order there."""
        chosen = [self.names.index(name) for name in names if name in self.names]
        arrays = {name: getattr(self, name)[chosen] for name in self.__slots__ if name != "names"}
        return LoadRows(names=tuple(self.names[index] for index in chosen), **arrays)


def load_rows(car: CarModel, matrices: CarMatrices) -> LoadRows:
    """Rows of all load channels of a car.

    Args:
        car: compiled and trimmed car.
        matrices: of its linear form.

    Returns:
        The rows, in the order of `vehicle.load_channels`.
    """
    model, system = car.model, matrices.system
    rows, data = Rows(model, car.static.preload), mujoco.MjData(model)
    with installed(rows):
        mujoco.mj_forward(model, data)
    jacobian = data.efc_J.reshape(-1, model.nv).copy()
    places, bushings, preload = LoadPlaces(car, rows), rows.layout.bushings, car.static.preload
    joint_forces = _joint_forces(matrices)
    widths = [model.nv] * 3 + [len(system.branch_time)] + [len(system.inputs)] * 2 + [len(matrices.dampers)]
    fields = ("displacement", "velocity", "acceleration", "branch", "height", "height_rate", "friction")
    found: dict[str, tuple[float, dict[str, Vector]]] = {}
    with_law = {int(own[0]): index for index, own in enumerate(bushings.rows)}
    branches = np.cumsum(bushings.branch_stiffness.ravel() > 0.0).reshape(bushings.rows.shape) - 1
    tyres = {int(index): plate for plate, index in enumerate(rows.layout.tyres)}
    for name, own, carrier in places.connections:
        frame = data.xmat[carrier].reshape(3, 3)
        if own[0] not in with_law:
            first = 3 * [int(joint[0]) for joint in rows.layout.joints].index(int(own[0]))
            terms = {key: frame.T @ rows_[first : first + 3] for key, rows_ in joint_forces.items()}
            turn = np.zeros((3, model.nv))
            mujoco.mj_jacBody(model, data, None, turn, carrier)
            terms["displacement"] = terms["displacement"] + frame.T @ _cross(preload[own]) @ turn
            static = frame.T @ preload[own]
        else:
            index = with_law[int(own[0])]
            way = places.oblique.get(int(own[0]))
            along = frame.T @ jacobian[own] if way is None else jacobian[own]
            terms = {
                "displacement": -bushings.stiffness[index][:, None] * along,
                "velocity": -bushings.damping[index][:, None] * along,
                "branch": np.zeros((3, widths[3])),
                "height": np.zeros((3, widths[4])),
                "height_rate": np.zeros((3, widths[4])),
            }
            for axis in np.flatnonzero(bushings.branch_stiffness[index] > 0.0).tolist():
                terms["branch"][axis, branches[index, axis]] = -1.0
            if index in tyres:
                terms["height"][2, tyres[index]] = bushings.stiffness[index, 2]
                terms["height_rate"][2, tyres[index]] = bushings.damping[index, 2]
            static = preload[own]
            if way is not None:
                static, terms = way.T @ static, {key: way.T @ term for key, term in terms.items()}
        for axis, letter in enumerate("xyz"):
            found[f"{name}_force_{letter}"] = float(static[axis]), {key: term[axis] for key, term in terms.items()}
    for (name, row), stiffness in zip(places.springs, rows.layout.springs.stiffness, strict=True):
        found[f"{name}_force"] = float(preload[row]), {"displacement": -stiffness * jacobian[row]}
    coordinates = spring_coordinates(car, model)
    for (name, spring, damping, unstrained), (place, dof) in zip(places.joints, coordinates, strict=True):
        unit = np.eye(model.nv)[dof]
        strain = float(model.qpos0[place]) - unstrained
        found[name] = -spring * strain, {"displacement": -spring * unit, "velocity": -damping * unit}
    body = int(places.bodies[0])
    for name, part, offset, _ in places.wheels:
        centre, moving, still = data.xpos[part] + offset, np.zeros((3, model.nv)), np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, moving, None, centre, part)
        mujoco.mj_jac(model, data, still, None, centre, body)
        found[name] = 0.0, {"displacement": (moving - still)[2]}
    chosen = [found[name] for name in places.names]
    arrays = {
        field: np.array([terms.get(field, np.zeros(width)) for _, terms in chosen]).reshape(-1, width)
        for field, width in zip(fields, widths, strict=True)
    }
    return LoadRows(names=places.names, static=np.array([static for static, _ in chosen]), **arrays)


def _joint_forces(matrices: CarMatrices) -> dict[str, Vector]:
    """What the ideal joints carry, in world axes, as rows over the motion; (3 k, ...) each."""
    system = matrices.system
    split = np.linalg.pinv(system.constraints.T)
    return {
        "displacement": split @ system.stiffness,
        "velocity": split @ system.damping,
        "acceleration": split @ system.mass,
        "branch": split @ system.effects.T,
        "height": -split @ system.input_stiffness,
        "height_rate": -split @ system.input_damping,
        "friction": -split @ system.slide_rows.T,
    }


def _cross(vector: Vector) -> Vector:
    """Matrix [a]x of a x b."""
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
