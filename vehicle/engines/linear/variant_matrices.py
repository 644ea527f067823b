"""Matrices of a car that differs from a reference car in parameter values only, from terms read once from that car.

With unchanged geometry the rows J (but the share Kb/K0 of a fluid), the shapes of all outputs and the rotation of
forces with parts are unchanged:

    K = J' K_e J + sum of K_rot T' T + joint springs + stops + hold of the course + sum of p_i H_i + sum of m_b g G_b,
    C = J' B_e J + joint dampers + rolling terms,    M = M0 + sum of J_b' (M_b - M_b0) J_b,

with the preloads p_i, H_i = -dg_i/du for the generalised force g_i of a preload i = 1, and G_b = dJ_bz'/du for the
centre of gravity of part b. K is that of the reference car plus the difference of this sum. The sum is compared with
the stiffness matrix of the reference car, so that no missing term stays hidden. A trimmed body of another mass or CoG
has other modal coordinates and another origin; see `vehicle.engines.linear.body_change` for the transformation.
"""

from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import mujoco
import numpy as np
import scipy

from vehicle.arrays import Vector
from vehicle.engines.linear.body_change import BodyChange, body_change, same_body
from vehicle.engines.linear.car_matrices import CarMatrices, law_matrices
from vehicle.engines.simulation.applied_forces import force_lines
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.force_curves import curve_of
from vehicle.engines.simulation.force_differences import DIFFERENCE_STEP, differences
from vehicle.engines.simulation.rows import Rows, joint_dampers, joint_springs
from vehicle.engines.simulation.standing import require_body_modes, require_standing
from vehicle.engines.simulation.static_trim import AtRest, StaticTrim, at_rest, settle, static_loads, unsolved
from vehicle.model.assembly.element_numbers import TURNING, Numbers, element_numbers
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.laws.damper import unpack
from vehicle.model.parameters.vehicle import Vehicle

AGREEMENT = 1e-9
"""Maximum difference between the sum of terms and the stiffness matrix of the same car, over its largest entry: both
are central differences with a round-off of 1e-10 of that entry."""

FRICTION = ("smoothing", "friction_limit", "static_limit", "stribeck_velocity", "stribeck_exponent")
"""Numbers of a damper that enter neither the matrices nor the static forces."""

STORED = 16
"""Maximum number of stored variants: enough for grids of a few parameters beside friction or curves."""

BREAKPOINT_MARGIN = 10.0 * DIFFERENCE_STEP
"""Distance [m] from a breakpoint of a curve within which the central differences of a built car cross it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarVariant:
    """Modified car from the terms.

    Attributes:
        matrices: its matrices.
        static: its static loads, with the residual of the linear car.
        change: coordinates of the reference car over the coordinates of the modified car.
    """

    matrices: CarMatrices
    static: StaticTrim
    change: BodyChange


class VariantTerms:
    """Terms of the matrices that all cars with the geometry of a reference car share.

    Args:
        car: compiled and trimmed reference car.
        matrices: matrices of the reference car.
        trimmed_body: its body without the parts fixed to it.
    """

    def __init__(self, car: CarModel, matrices: CarMatrices, trimmed_body: Superelement) -> None:
        self.car, self.matrices, self.trimmed_body = car, matrices, trimmed_body
        model = car.model
        self.rows = Rows(model)
        rows_at_rest = self.rows.anew(car.static.preload)
        self.numbers = element_numbers(car.vehicle, car.superelement)
        self.rest_state = at_rest(self.rows)
        geometric, self.by_preload = _geometric_stiffness(rows_at_rest)
        same = BodyChange(trimmed=trimmed_body, body=car.superelement)
        self.sum = self._stiffness(rows_at_rest, joint_springs(model), car.static.preload, self.rest_state, same)
        difference = self.sum + geometric - matrices.system.stiffness
        scale = float(np.max(np.abs(matrices.system.stiffness)))
        self.stored: dict[Hashable, CarVariant | None] = {}
        self.complete = bool(np.max(np.abs(difference)) <= AGREEMENT * scale)
        """True if the sum of the terms equals the stiffness matrix of the reference car"""

    @cached_property
    def weight_terms(self) -> dict[str, Vector]:
        """Return g G of each part: derivative of its weight force per kg over the coordinates; (n, n)."""
        model, names = self.car.model, list(self.matrices.body_masses)
        gravity = -float(model.opt.gravity[2])
        bodies = [model.body(name).id for name in names]

        def read(data: mujoco.MjData) -> Vector:
            jacobians = np.zeros((len(bodies), 3, model.nv))
            for jacobian, body in zip(jacobians, bodies, strict=True):
                mujoco.mj_jacBodyCom(model, data, jacobian, None, body)
            # Heights: d(J_z)/du is the weight force per kg that turns with the parts.
            return jacobians[:, 2]

        return dict(zip(names, gravity * differences(self.rows, read), strict=True))

    def variant(self, vehicle: Vehicle) -> CarVariant | None:
        """Return the car with other parameter values; None if more than laws and masses differ: build its model.

        Cars whose matrices have equal numbers, which may differ in friction and in steeper segments of the curves of
        dampers, are one variant, computed once.

        Raises:
            ConfigurationError, SimulationError: the car is invalid; see
                `vehicle.engines.simulation.car_model.build_model`.
        """
        if not self.complete or not same_geometry(vehicle, self.car.vehicle):
            return None
        change = body_change(vehicle, self.car, self.trimmed_body, self.rows.layout.modes.velocities)
        require_body_modes(vehicle, change.trimmed)
        element_values = element_numbers(vehicle, change.body, (self.car.vehicle, self.numbers))
        if not all(map(_same_fields, element_values, self.numbers)):
            return None
        key = (vehicle.body, vehicle.composition.forces, *self._entering(element_values))
        if key not in (stored := self.stored):
            # Another thread may store a variant at the same time.
            added = [*stored.items(), (key, self._variant(vehicle, element_values, change))]
            self.stored = stored = dict(added[-STORED:])
        return stored[key]

    def _entering(self, element_values: list[Numbers]) -> Iterator[Hashable]:
        """Return the numbers that enter matrices and static forces, of the elements that differ from the reference."""
        for index, (element, reference) in enumerate(zip(element_values, self.numbers, strict=True)):
            for name, value in element.items() if element is not reference else ():
                if name.startswith("actuator/"):
                    record = unpack(value)
                    record[list(FRICTION)] = 0.0
                    yield index, name, record.tobytes()
                elif not name.startswith("law/valve/"):
                    yield index, name, value.tobytes()

    def _variant(self, vehicle: Vehicle, element_values: list[Numbers], change: BodyChange) -> CarVariant | None:
        """Compute a variant, see `variant`."""
        values = {name: value for element in element_values for name, value in element.items()}
        rows = self.rows.with_laws(values)
        springs, dampers = joint_springs(rows.model), joint_dampers(rows.model).copy()
        for name, (stiffness, damping) in _fields(values, "joint/"):
            dof = rows.model.joint(name).dofadr[0]
            springs[dof], dampers[dof] = stiffness, damping
        to_new, (bodies, mass, weight, geometric) = change.columns, self._masses(element_values, change)
        # The rows of the fluids contain Kb/K0 of their mounts.
        fluids, jacobian = rows.layout.fluids, self.rest_state.jacobian.copy()
        jacobian[rows.layout.bushings.rows[fluids.elements, 2], fluids.dofs] = fluids.factors
        turned = change.rotations(self.rest_state.turned)
        rest_state = AtRest(jacobian=to_new(jacobian), turned=turned, weight=weight)
        # Operating points of the tables and preloads of this car.
        settled = settle(rows, rest_state, springs)
        tables = rows.layout.tables
        for index in np.flatnonzero(tables.kinds < 2).tolist():
            # So near to a breakpoint a law has no tangent.
            if np.any(np.abs(curve_of(tables, index).knots - tables.at[index]) < BREAKPOINT_MARGIN):
                return None
        preload, count = settled.preload, len(rest_state.jacobian)
        # Unbalanced part of the static forces: weight - k u of joint springs + J' p + T' p.
        residual = (
            unsolved(rows.layout, rest_state.weight)
            - springs * settled.displacement
            + rest_state.jacobian.T @ preload[:count]
        )
        residual += np.einsum("nij,ni->j", rest_state.turned, preload[count:].reshape(-1, 3))
        residual[rows.layout.rolling.spins] = 0.0
        static = static_loads(rows, settled, residual)
        require_standing(vehicle, rows, static)
        system_of_laws, car_of_laws = law_matrices(rows, rest_state.jacobian, dampers, preload)
        reference = self.matrices.system
        # Part of K that no term contains, terms of this car, and weight that rotates with new modes.
        stiffness = geometric + self._stiffness(rows, springs, preload, rest_state, change)
        stiffness += change.weight_stiffness(rest_state.weight)
        system = replace(
            reference,
            mass=mass,
            stiffness=stiffness,
            constraints=rest_state.jacobian[rows.layout.joints.ravel()],
            outputs={name: to_new(row) for name, row in reference.outputs.items()},
            **system_of_laws,
        )
        slips = self.matrices.force_slips
        present, before = (each.layout.bushings.branch_stiffness > 0.0 for each in (rows, self.rows))
        if not np.array_equal(present, before):
            if slips.any():  # the treads have other branches
                return None
            slips = np.zeros((len(slips), len(system.branch_stiffness)))
        lines, coefficients = force_lines(vehicle.composition.forces)
        matrices = replace(
            self.matrices,
            system=system,
            sensors=to_new(self.matrices.sensors),
            force_rows=to_new(self.matrices.force_rows),
            force_slips=slips,
            lines=lines,
            coefficients=coefficients,
            body_centres={**self.matrices.body_centres, "body": np.array(vehicle.body.cog)},
            **bodies,
            **car_of_laws,
        )
        return CarVariant(matrices=matrices, static=static, change=change)

    def _stiffness(
        self, rows: Rows, springs: Vector, preload: Vector, rest_state: AtRest, change: BodyChange
    ) -> Vector:
        """Return the part of K that depends on laws and preloads; (n, n)."""
        e, j = rows.layout, rest_state.jacobian
        # J' K_e J of bushings and springs.
        diagonal = np.zeros(e.row_count)
        diagonal[e.bushings.rows], diagonal[e.springs.rows] = e.bushings.stiffness, e.springs.stiffness
        stiffness: Vector = j.T @ (diagonal[:, None] * j)
        # sum of p_i H_i; H_i are those of the modes of the reference car.
        preloaded = (self.by_preload @ preload).reshape(j.shape[1], -1)
        stiffness += preloaded if change.whole is None else change.whole.T @ preloaded @ change.whole
        rotations = rest_state.turned.reshape(-1, j.shape[1])
        stiffness += rotations.T @ (np.repeat(e.rotations.stiffness, 3)[:, None] * rotations)
        stiffness[np.diag_indices(len(stiffness))] += springs
        if len(e.rolling.tyres):
            course = e.rolling.course_rows(len(stiffness))
            stiffness += course.T @ (e.rolling.hold[:3, None] * course)
        for index in np.flatnonzero(e.tables.kinds == 2).tolist():
            dof, curve = e.dampers.dofs[e.tables.elements[index]], curve_of(e.tables, index)
            # The tangent of a stop by the central difference with which K of a built car is computed.
            end_forces = curve.force(np.array([-DIFFERENCE_STEP, DIFFERENCE_STEP]))
            stiffness[dof, dof] += (end_forces[1] - end_forces[0]) / (2.0 * DIFFERENCE_STEP)
        return stiffness

    def _masses(
        self, element_values: list[Numbers], change: BodyChange
    ) -> tuple[dict[str, Any], Vector, Vector, Vector]:
        """Return the mass terms of a car with other masses of its parts.

        Rows and masses of the parts, M, generalised weight, and the geometric stiffness of the weight.
        """
        # `geometric` begins as K of the reference car less its sum of terms: weight, and what does not depend on the
        # car.
        masses, system = dict(self.matrices.body_masses), self.matrices.system
        mass, weight, geometric = system.mass, self.rest_state.weight, system.stiffness - self.sum
        gravity, body_rows = float(self.car.model.opt.gravity[2]), self.matrices.body_rows
        if change.shift.any():
            # Remove the trimmed body before its origin moves, and add it at the new origin.
            value, rows = masses["body"], body_rows["body"]
            # M_b and m_b g J_z' of the body alone.
            mass, weight = mass - rows.T @ value @ rows, weight - gravity * value[0, 0] * rows[2]
            mass, geometric = change.displaced_matrix(mass), change.displaced_matrix(geometric)
            weight = change.displaced_rows(weight)
            body_rows = {
                name: element if name == "body" else change.displaced_rows(element)
                for name, element in body_rows.items()
            }
            mass, weight = mass + rows.T @ value @ rows, weight + gravity * value[0, 0] * rows[2]
        for element, reference in zip(element_values, self.numbers, strict=True):
            for name, value in _fields({} if element is reference else element, "mass/"):
                rows, (body_mass, xx, yy, zz, xy, xz, yz) = body_rows[name], value
                tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
                new = np.asarray(scipy.linalg.block_diag(body_mass * np.eye(3), tensor))
                added, masses[name] = new - masses[name], new
                # J_b' (M_b - M_b0) J_b, and weight and geometric stiffness of the same difference.
                mass = mass + rows.T @ added @ rows
                weight = weight + gravity * added[0, 0] * rows[2]
                geometric = geometric + added[0, 0] * change.displaced_matrix(self.weight_terms[name])
        for values in element_values:
            for name, (inertia, _) in _fields(values, "inertia/"):
                dof = int(self.car.model.joint(name).dofadr[0])
                mass = mass.copy()
                mass[dof, dof] = inertia
        if change.hanging is not None:
            geometric = geometric + change.displaced_matrix(gravity * masses["body"][0, 0] * change.hanging)
        return {"body_rows": body_rows, "body_masses": masses}, mass, weight, geometric


def same_geometry(vehicle: Vehicle, other: Vehicle) -> bool:
    """Return True if two cars differ only in values of laws, in masses and in solver settings."""
    car, reference, body = vehicle.composition, other.composition, other.body
    if vehicle.driving.accelerates or other.driving.accelerates:
        # Every parameter moves the position of a car that accelerates.
        return False
    if vehicle.gravity != other.gravity or (car.points, car.outputs, car.wheels) != (
        reference.points,
        reference.outputs,
        reference.wheels,
    ):
        return False
    if not same_body(vehicle.body, body):
        return False
    spinning = {wheel.part for wheel in car.wheels} if vehicle.driving.rolling else set[str]()
    for part, other_part in zip(car.parts, reference.parts, strict=False):
        # The rolling terms read the inertia of a wheel about its axle from the model.
        if (part.name in spinning or part.parent in spinning) and part.numbers != other_part.numbers:
            return False
    if vehicle.body.flexible:
        # Parts fixed to a flexible body change its modes; a payload is in the body model, which is scaled as a whole.
        scaled = vehicle.body.model_factor != body.model_factor
        for part, other_part in zip(car.parts, reference.parts, strict=False):
            if part.parent == "body" and (part.numbers != other_part.numbers or (scaled and part.seat is None)):
                return False
    # The fields in which elements may differ.
    free = {"parts": ("numbers",), "connections": ("law", "rolling"), "forces": ("law", "speed", "given")}
    for name in ("parts", "connections", "springs", "joint_springs", "dampers", "forces"):
        elements, others = getattr(car, name), getattr(reference, name)
        if len(elements) != len(others):
            return False
        for element, other in zip(elements, others, strict=True):
            varied = {field: getattr(other, field) for field in free.get(name, ("law",))}
            if element is not other and replace(element, **varied) != other:
                return False
    return [force.mean for force in car.forces] == [force.mean for force in reference.forces]


def _same_fields(values: Numbers, reference: Numbers) -> bool:
    """Return True if an element has the same fields of the same lengths, and resists rotation in both cars or none."""
    if values is reference:
        return True
    if list(values) != list(reference) or any(values[name].shape != reference[name].shape for name in values):
        return False
    return all(
        (values[name][TURNING] > 0.0) == (reference[name][TURNING] > 0.0)
        for name in values
        if name.startswith("law/") and len(values[name]) > TURNING
    )


def _fields(values: Mapping[str, Vector], prefix: str) -> Iterator[tuple[str, Vector]]:
    """Return the fields whose name has a prefix, by the rest of their name."""
    return ((name.removeprefix(prefix), value) for name, value in values.items() if name.startswith(prefix))


def _geometric_stiffness(rows: Rows) -> tuple[Vector, Any]:
    """Return the geometric stiffness of the weight, (n, n), and sparse H with K = H p row by row, (n n, preloads)."""
    model, e = rows.model, rows.layout
    straight = np.setdiff1d(np.arange(len(e.bushings.rows)), e.bushings.oblique)
    # Oblique rows rotate with their carrier already; the others are in world axes and become R' J.
    bushing_rows, carriers = e.bushings.rows[straight], e.bushings.carriers[straight]

    def read(data: mujoco.MjData) -> Vector:
        """Return the generalised forces of the weight and of each unit preload, which rotates with its carrier."""
        forces = data.efc_J.reshape(e.row_count, model.nv).copy()
        forces[bushing_rows] = np.einsum("nki,nkj->nij", data.xmat[carriers].reshape(-1, 3, 3), forces[bushing_rows])
        # Torque rows of each element in the axes of its carrier; (n, 3, coordinates).
        moments = np.einsum("nki,nkj->nij", rows.rotation(data)[1], rows.rotation_jacobian(data))
        return np.concatenate([-data.qfrc_bias[None], forces, moments.reshape(-1, model.nv)])

    weight, *preloads = -differences(rows, read)
    # (preloads, n n) transposed: few entries of each H differ from zero.
    return weight, scipy.sparse.csr_array(np.reshape(preloads, (len(preloads), -1)).T)
