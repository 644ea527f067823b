"""The part with the largest motion in a mode, and the parameter of the most strained element, for error messages."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Complex, Vector
from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.linear.displacement_laws import STOP
from vehicle.engines.simulation.callbacks import standing_data
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.force_curves import curve_of
from vehicle.engines.simulation.force_differences import DIFFERENCE_STEP
from vehicle.engines.simulation.row_layout import numeric
from vehicle.engines.simulation.rows import Rows, joint_springs
from vehicle.engines.simulation.standing import element_parameter
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.paths import value_of
from vehicle.names import AXES


def moving_part(matrices: CarMatrices, shape: Complex) -> str:
    """Return the name of the rigid part, or "flexible body", with the largest kinetic energy in a shape (n,)."""
    energy = {
        body: float(np.real(np.vdot(rows @ shape, matrices.body_masses[body] @ (rows @ shape))))
        for body, rows in matrices.body_rows.items()
    }
    energy["flexible body"] = float(np.sum(np.abs(shape[matrices.modal]) ** 2))
    return max(energy, key=lambda name: energy[name])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Strained:
    """Elements with a common parameter, strained by a motion.

    Attributes:
        path: path of the parameter.
        work: largest work of one of them in the motion.
        rows: their displacements over the velocity coordinates; (k, n).
        stiffness, damping: of each along its row [N/m, N s/m]; (k,).
        constraints: constraint row of each, -1 for an element without; (k,).
        branches: index of the Maxwell branch of each, -1 without; (k,).
    """

    path: str
    work: float
    rows: Vector
    stiffness: Vector
    damping: Vector
    constraints: npt.NDArray[np.int64]
    branches: npt.NDArray[np.int64]

    def __add__(self, other: Strained) -> Strained:
        """Return the union of two groups of elements with the same parameter."""
        names = ("rows", "stiffness", "damping", "constraints", "branches")
        joined = {name: np.concatenate([getattr(self, name), getattr(other, name)]) for name in names}
        return Strained(path=self.path, work=max(self.work, other.work), **joined)


def strained_elements(car: CarModel, pole: complex, shape: Complex) -> list[Strained]:
    """Return the elements of a car by their parameters, those with the largest work K |r|2 or |s| B |r|2 first.

    Args:
        car: compiled and trimmed car.
        pole: pole s of the mode [rad/s].
        shape: displacements of the mode; (n,).
    """
    rows = Rows(car.model, car.static.preload)
    data = standing_data(rows)
    e, b, dampers = rows.layout, rows.layout.bushings, rows.layout.dampers
    jacobian = rows.element_jacobian(data)
    speed, unit = abs(pole), np.eye(car.model.nv)
    elements: dict[str, Strained] = {}

    def add(
        path: str,
        row: Vector,
        stiffness: float,
        damping: float,
        constraint: int = -1,
        branch: int = -1,
        fast: float = 0.0,
    ) -> None:
        each = np.ones(len(np.atleast_2d(row)))
        element = Strained(
            path=path,
            # The larger of the elastic and of the damping force at the pole, times the displacement.
            work=float(np.sum(np.abs(row @ shape) ** 2)) * max(stiffness + fast, speed * damping),
            rows=np.atleast_2d(row),
            stiffness=stiffness * each,
            damping=damping * each,
            constraints=constraint * each.astype(np.int64),
            branches=branch * each.astype(np.int64),
        )
        elements[path] = elements[path] + element if path in elements else element

    # (element, axis) in a flat array to the number of its Maxwell branch, -1 without.
    branches = np.where(b.branch_stiffness.ravel() > 0.0, np.cumsum(b.branch_stiffness.ravel() > 0.0) - 1, -1)
    friction = np.zeros_like(b.stiffness)
    # Several elements of one axis add up.
    np.add.at(friction, (e.rubber.elements, e.rubber.axes), e.rubber.stiffness)
    for index, name in enumerate(rows.names):
        for axis, letter in enumerate(AXES):
            row, k, c = int(b.rows[index, axis]), float(b.stiffness[index, axis]), float(b.damping[index, axis])
            fast = float(b.branch_stiffness[index, axis])  # a branch is in the matrices by its force
            parameter = "damping" if speed * c > k + fast else "stiffness"
            # The tangent at rest of rubber friction is Fmax over the stroke.
            if parameter == "stiffness" and friction[index, axis] > 0.5 * (k + fast):
                parameter = "friction_stroke"
            path = element_parameter(car.vehicle, name, parameter, letter)
            add(path, jacobian[row], k, c, row, int(branches[3 * index + axis]), fast)
    rotations = rows.rotation_jacobian(data)
    resisting = [name for name in rows.names if numeric(car.model, f"law/{name}")[12] > 0.0]  # type: ignore[index]
    for name, stiffness, turn in zip(resisting, e.rotations.stiffness.tolist(), rotations, strict=True):
        add(element_parameter(car.vehicle, name, "rotational_stiffness", ""), turn, stiffness, 0.0)
    composition = car.vehicle.composition
    for spring, row, stiffness in zip(
        composition.springs, e.springs.rows.tolist(), e.springs.stiffness.tolist(), strict=True
    ):
        add(f"{spring.path}.stiffness", jacobian[row], stiffness, 0.0, row)
    for damper, dof, viscous in zip(
        composition.dampers, dampers.dofs.tolist(), dampers.laws["viscous_damping"].tolist(), strict=True
    ):
        add(f"{damper.path}.viscous", unit[dof], 0.0, viscous)
    for table in np.flatnonzero(e.tables.kinds == STOP).tolist():
        damper_index = int(e.tables.elements[table])
        ends = curve_of(e.tables, table).force(e.tables.at[table] + np.array([-DIFFERENCE_STEP, DIFFERENCE_STEP]))
        tangent = float(np.diff(ends)[0]) / (2.0 * DIFFERENCE_STEP)
        add(f"{composition.dampers[damper_index].path}.stop", unit[dampers.dofs[damper_index]], tangent, 0.0)
    inside = joint_springs(car.model)
    # The stiffness of unscaled modes is that of their file.
    scaled = car.vehicle.body.frequency_scale != 1.0
    modes = "body.frequency_scale" if scaled else f"the modes of body.superelement = {car.vehicle.body.superelement}"
    for dof in range(car.model.nv)[slice(e.modes.first_velocity, e.modes.first_velocity + e.modes.size)]:
        add(modes, unit[dof], float(inside[dof]), 0.0)
    for joint_spring in composition.joint_springs:
        dof = int(car.model.joint(joint_spring.joint).dofadr[0])
        add(f"{joint_spring.path}.{joint_spring.parameter}", unit[dof], float(inside[dof]), 0.0)
    return sorted(elements.values(), key=lambda element: -element.work)


def parameter_text(car: CarModel, path: str) -> str:
    """Return path and value of a parameter, for example "bushings.suspension_mount.stiffness.z (3e+07)"."""
    try:
        return f"{path} ({value_of(car.vehicle, path):g})"
    except ConfigurationError:
        return path
