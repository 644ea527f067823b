"""Loads of the linear car: the forces of all elements and the suspension travel as rows over its motion.

The law of an element in the axes of its carrier is f = p - K r - g - B r' - f2, with r = J u - z and the preload p. The
force of an ideal joint follows from the equation of motion,

    Jc' f = M u'' + C u' + K u + H' f_b - Bk z - Bc z' - S' phi + D' g - B e - L h,

with the nonlinear damper forces phi, the forces g of the laws over displacement that K lacks, the forces of rolling
tyres on the slope of the road that Bc z' lacks, and the histories h of applied forces. K contains the rotation of the
preloads, so this f is in world axes. In the axes of a carrier that rotates by theta it is f - theta x p. If joints
constrain a motion twice, f is the least-norm solution. A rolling tyre on the slope of the road has the force F_0/V (z'
+ e) along x beside that of its slip.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.displacement_laws import BUSHING, SPRING, STOP, law_rows
from vehicle.engines.linear.part_motions import cross_matrix
from vehicle.engines.simulation.callbacks import standing_data
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.force_differences import DIFFERENCE_STEP
from vehicle.engines.simulation.load_channels import LoadPlaces, spring_coordinates
from vehicle.engines.simulation.rows import Rows
from vehicle.model.laws.curve import Curve
from vehicle.model.parameters.force_elements import Damper


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LoadRows:
    """Loads w = static + rows times u, u', u'', f_b, z, z', damper forces phi, slope velocities e, applied forces h.

    Attributes:
        names: names of the l load channels.
        static: value of each at rest [N, N m or m]; (l,).
        displacement, velocity, acceleration: rows over u, u', u''; (l, n).
        branch: rows over f_b; (l, b).
        height, height_rate: rows over z and z'; (l, w).
        friction: rows over phi, with the sign of the equation of motion; (l, d).
        law: rows over the forces g of the laws over displacement (`displacement_laws`); (l, laws).
        slope: rows over e = F_z/F_0 V tan(beta) - z' of the plates, likewise; (l, w), (l, 0) for standing tyres.
        applied: rows over the histories h of the applied forces; (l, lines).
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
    law: Vector
    slope: Vector
    applied: Vector

    def __repr__(self) -> str:
        """One line."""
        return f"LoadRows({len(self.names)} loads over {self.displacement.shape[1]} coordinates)"

    def only(self, names: Sequence[str]) -> LoadRows:
        """Select the loads among the given channels, in their order."""
        selected = [self.names.index(name) for name in names if name in self.names]
        arrays = {name: getattr(self, name)[selected] for name in self.__slots__ if name != "names"}
        return LoadRows(names=tuple(self.names[index] for index in selected), **arrays)

    def __add__(self, other: LoadRows) -> LoadRows:
        """Return these loads followed by others."""
        arrays = {name: np.concatenate([getattr(self, name), getattr(other, name)]) for name in self.__slots__[1:]}
        return LoadRows(names=(*self.names, *other.names), **arrays)


def load_rows(car: CarModel, matrices: CarMatrices) -> LoadRows:
    """Return the rows of all load channels of a car, in the order of `LoadPlaces.names`."""
    model, system = car.model, matrices.system
    rows = Rows(model, car.static.preload)
    data = standing_data(rows)
    jacobian = data.efc_J.reshape(-1, model.nv).copy()
    load_places, bushings, preload = LoadPlaces(car, rows), rows.layout.bushings, car.static.preload
    joint_forces = _joint_forces(matrices)
    widths = _widths(matrices)
    terms_of: dict[str, tuple[float, dict[str, Vector]]] = {}
    with_law = {int(row_indices[0]): index for index, row_indices in enumerate(bushings.rows)}
    # (element, axis) to the number of its Maxwell branch.
    branches = np.cumsum(bushings.branch_stiffness.ravel() > 0.0).reshape(bushings.rows.shape) - 1
    tyres = {int(index): plate for plate, index in enumerate(rows.layout.tyres)}
    for name, row_indices, carrier in load_places.connections:
        frame = data.xmat[carrier].reshape(3, 3)
        if row_indices[0] not in with_law:
            # An ideal joint: three rows of the least-norm solution.
            first = 3 * [int(joint[0]) for joint in rows.layout.joints].index(int(row_indices[0]))
            terms = {key: frame.T @ rows_[first : first + 3] for key, rows_ in joint_forces.items()}
            rotation = np.zeros((3, model.nv))
            mujoco.mj_jacBody(model, data, None, rotation, carrier)
            # f - theta x p = f + [p]x theta.
            terms["displacement"] = terms["displacement"] + frame.T @ cross_matrix(preload[row_indices]) @ rotation
            static = frame.T @ preload[row_indices]
        else:
            index = with_law[int(row_indices[0])]
            oblique_axes = load_places.oblique.get(int(row_indices[0]))
            element_rows = frame.T @ jacobian[row_indices] if oblique_axes is None else jacobian[row_indices]
            terms = {
                "displacement": -bushings.stiffness[index][:, None] * element_rows,
                "velocity": -bushings.damping[index][:, None] * element_rows,
                **{field: np.zeros((3, widths[field])) for field in ("branch", "height", "height_rate")},
                "law": np.reshape(
                    [-(law.element[:2] == (BUSHING, index)) * np.eye(3)[law.element[2]] for law in matrices.laws],
                    (-1, 3),
                ).T,
            }
            for axis in np.flatnonzero(bushings.branch_stiffness[index] > 0.0).tolist():
                terms["branch"][axis, branches[index, axis]] = -1.0
            if index in tyres:
                # r = J u - z: the plate adds k z + c z'.
                terms["height"][2, tyres[index]] = bushings.stiffness[index, 2]
                terms["height_rate"][2, tyres[index]] = bushings.damping[index, 2]
            static = preload[row_indices]
            if oblique_axes is not None:
                # From the directions of the law to those of the carrier.
                static, terms = oblique_axes.T @ static, {key: oblique_axes.T @ term for key, term in terms.items()}
        for axis, letter in enumerate("xyz"):
            # A hydromount has the forces of rubber and fluid.
            channel = f"{name}_force_{letter}"
            static_sum, others = terms_of.get(channel, (0.0, {}))
            terms_of[channel] = (
                static_sum + float(static[axis]),
                {key: term[axis] + others.get(key, 0.0) for key, term in terms.items()},
            )
    for tyre, plate, speed in zip(
        rows.layout.rolling.tyres, rows.layout.rolling.plates, rows.layout.rolling.speeds, strict=True
    ):
        wheel, on_plate = system.inputs[plate], np.eye(len(system.inputs))[plate]
        # F_0/V of (z' + e).
        along = on_plate * (preload[bushings.rows[tyre, 2]] / speed)
        static, slip = terms_of[f"tyre_{wheel}_force_x"]
        terms_of[f"tyre_{wheel}_slip_force_x"] = static, slip
        terms_of[f"tyre_{wheel}_slope_force_x"] = 0.0, {"height_rate": along, "slope": along}
        terms_of[f"tyre_{wheel}_force_x"] = static, {**slip, "height_rate": along, "slope": along}
    stops = stop_rows(matrices, [damper.law for damper in car.vehicle.composition.dampers])
    for index, name in enumerate(stops.names):
        terms_of[name] = float(stops.static[index]), {field: getattr(stops, field)[index] for field in widths}
    for index, ((name, row), stiffness) in enumerate(
        zip(load_places.springs, rows.layout.springs.stiffness, strict=True)
    ):
        terms_of[f"{name}_force"] = (
            float(preload[row]),
            {
                "displacement": -stiffness * jacobian[row],
                "law": np.array([-float(law.element[:2] == (SPRING, index)) for law in matrices.laws]),
            },
        )
    coordinates = spring_coordinates(car, model)
    for (name, spring, damping, unstrained), (qpos_index, dof) in zip(load_places.joints, coordinates, strict=True):
        unit = np.eye(model.nv)[dof]
        # The force of a joint spring counts from its unstrained position.
        strain = float(model.qpos0[qpos_index]) - unstrained
        terms_of[name] = -spring * strain, {"displacement": -spring * unit, "velocity": -damping * unit}
    body = int(load_places.bodies[0])
    upwards = data.xmat[body].reshape(3, 3)[:, 2]
    for name, part, offset, height in load_places.wheels:
        centre = data.xpos[part] + data.xmat[part].reshape(3, 3) @ offset
        part_motion, body_motion = np.zeros((2, 3, model.nv))
        # Travel: height of the wheel centre in the axes of the body, less the height of the same point on the body.
        mujoco.mj_jac(model, data, part_motion, None, centre, part)
        mujoco.mj_jac(model, data, body_motion, None, centre, body)
        travel = float(upwards @ (centre - data.xpos[body])) - height if car.moved else 0.0
        terms_of[name] = travel, {"displacement": upwards @ (part_motion - body_motion)}
    selected = [terms_of[name] for name in load_places.names]
    arrays = {
        field: np.array([terms.get(field, np.zeros(width)) for _, terms in selected]).reshape(len(selected), width)
        for field, width in widths.items()
    }
    return LoadRows(names=load_places.names, static=np.array([static for static, _ in selected]), **arrays)


def stop_rows(matrices: CarMatrices, dampers: Sequence[Damper]) -> LoadRows:
    """Return the forces F + k d + g of the stops of dampers, positive in extension, as rows of loads.

    Args:
        matrices: matrices of the car.
        dampers: laws of the dampers, in the order of `matrices.damper_names`.
    """
    names, static, displacement, law = [], [], [], []
    for index, (name, damper) in enumerate(zip(matrices.damper_names, dampers, strict=True)):
        if damper.stop is None:
            continue
        curve = Curve.through(damper.stop.displacement, damper.stop.force)
        # F at rest, and the tangent that K contains, by the same difference.
        ends = np.array([-DIFFERENCE_STEP, 0.0, DIFFERENCE_STEP])
        below, force, above = curve.force(ends if matrices.strokes is None else matrices.strokes[index] + ends)
        names.append(f"{name}_stop_force")
        static.append(force)
        displacement.append((above - below) / (2.0 * DIFFERENCE_STEP) * matrices.system.slide_rows[index])
        law.append([float(element_law.element[:2] == (STOP, index)) for element_law in matrices.laws])
    size = matrices.system.size
    rows = displacement_rows(matrices, np.reshape(displacement, (len(names), size)))
    by_law = np.reshape(law, (len(names), len(matrices.laws)))
    return replace(rows, names=tuple(names), static=np.array(static), law=by_law)


def displacement_rows(matrices: CarMatrices, rows: Vector) -> LoadRows:
    """Return combinations of the displacements u as rows of loads, named "coordinate_0", "coordinate_1" ...

    Args:
        matrices: matrices of the car.
        rows: rows over u; (l, n).
    """
    count = len(rows)
    names = tuple(f"coordinate_{index}" for index in range(count))
    none = {field: np.zeros((count, width)) for field, width in _widths(matrices).items()}
    return LoadRows(names=names, static=np.zeros(count), **{**none, "displacement": rows})


def _widths(matrices: CarMatrices) -> dict[str, int]:
    """Return the numbers of columns of the rows of loads."""
    system, wheels = matrices.system, len(matrices.system.inputs)
    widths = dict.fromkeys(("displacement", "velocity", "acceleration"), len(system.mass))
    widths |= {"branch": len(system.branch_time), "height": wheels, "height_rate": wheels}
    return widths | {
        "friction": len(matrices.dampers),
        "law": len(matrices.laws),
        "slope": matrices.slope.shape[1],
        "applied": matrices.coefficients.shape[1],
    }


def _joint_forces(matrices: CarMatrices) -> dict[str, Vector]:
    """Return the forces of the ideal joints in world axes as rows over the motion; (3 k, ...) each."""
    system = matrices.system
    # Least-norm f of Jc' f = ..., see the module.
    split = np.linalg.pinv(system.constraints.T)
    return {
        "displacement": split @ system.stiffness,
        "velocity": split @ system.damping,
        "acceleration": split @ system.mass,
        "branch": split @ system.effects.T,
        "height": -split @ system.input_stiffness,
        "height_rate": -split @ system.input_damping,
        "friction": -split @ system.slide_rows.T,
        "law": split @ law_rows(matrices.laws, system.size).T,
        "slope": -split @ matrices.slope,
        "applied": -split @ matrices.applied,
    }
