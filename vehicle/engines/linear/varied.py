"""Matrices of a car that differs from another one in numbers alone, from terms that are read once from that other one.

Where the places stay, so do the rows J, the shapes of all outputs, and how forces of given size turn with the parts:

    K = J' K_e J + sum of K_rot T' T + joint springs + stops + hold of the course + sum of p_i H_i + sum of m_b g G_b,
    C = J' B_e J + joint dampers + what rolling adds,    M = M0 + sum of J_b' (M_b - M_b0) J_b,

p_i being the preloads, H_i = -dg_i/du of the generalised force g_i of the preload i = 1, and G_b = dJ_bz'/du of the
centre of gravity of part b. K is that of the other car plus the difference of this sum: what the sum misses would show
in the other car itself, and it is compared there. A trimmed body of another mass or CoG has other modal coordinates and
another origin, on which all of this is carried over (`vehicle.engines.linear.body_change`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt
import scipy

from vehicle.engines.linear.body_change import BodyChange, body_change, same_body
from vehicle.engines.linear.matrices import DIFFERENCE_STEP, CarMatrices, differences, law_matrices
from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.force_curves import curve_of
from vehicle.engines.simulation.rows import Rows, joint_dampers, joint_springs
from vehicle.engines.simulation.standing import require_body_modes, require_standing
from vehicle.engines.simulation.static_trim import AtRest, StaticTrim, at_rest, settle, static_loads, unsolved
from vehicle.model.assembly.law_numbers import TURNING, Numbers, element_numbers
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.vehicle import Vehicle

Vector = npt.NDArray[np.float64]

AGREEMENT = 1e-9
"""Largest difference between the sum of terms and the stiffness matrix of the same car, over its largest entry: both
come from central differences, whose round-off is 1e-10 of it."""

CORNER = 10.0 * DIFFERENCE_STEP
"""Distance [m] from the corner of a curve within which the differences of a car that is built reach over it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class VariedCar:
    """A car from terms: its linear form and its static loads; the residual is that of the linear car."""

    matrices: CarMatrices
    static: StaticTrim


class Terms:
    """What all cars share that have the places of one car.

    Args:
        car: compiled and trimmed car.
        matrices: of its linear form.
        trimmed_body: its body without what is fixed to it.
    """

    def __init__(self, car: CarModel, matrices: CarMatrices, trimmed_body: Superelement) -> None:
        self.car, self.matrices, self.trimmed_body = car, matrices, trimmed_body
        model = car.model
        self.rows = Rows(model)
        standing = self.rows.anew(car.static.preload)
        self.numbers = element_numbers(car.vehicle, car.superelement)
        self.rest = at_rest(self.rows)
        turning, self.by_preload = _turning_forces(standing)
        same = BodyChange(trimmed=trimmed_body, body=car.superelement)
        self.sum = self._stiffness(standing, joint_springs(model), car.static.preload, self.rest, same)
        difference = self.sum + turning - matrices.system.stiffness
        scale = float(np.max(np.abs(matrices.system.stiffness)))
        self.complete = bool(np.max(np.abs(difference)) <= AGREEMENT * scale)
        """whether the sum of the terms is the stiffness of the car"""

    @cached_property
    def weight_terms(self) -> dict[str, Vector]:
        """g G of each part: change of its weight per kg over the coordinates; (n, n)."""
        model, chosen = self.car.model, list(self.matrices.body_masses)
        gravity = -float(model.opt.gravity[2])
        bodies = [model.body(name).id for name in chosen]

        def read(data: mujoco.MjData) -> Vector:
            found = np.zeros((len(bodies), 3, model.nv))
            for own, body in zip(found, bodies, strict=True):
                mujoco.mj_jacBodyCom(model, data, own, None, body)
            return found[:, 2]

        return dict(zip(chosen, gravity * differences(self.rows, read), strict=True))

    def car_of(self, vehicle: Vehicle) -> VariedCar | None:
        """The car of other parameters.

        Args:
            vehicle: the parameters.

        Returns:
            The car; None where more than numbers differ, and it has to be built.

        Raises:
            ConfigurationError, SimulationError: no such car can be, as of
                `vehicle.engines.simulation.car_model.build_model`.
        """
        if not self.complete or not same_places(vehicle, self.car.vehicle):
            return None
        change = body_change(vehicle, self.car, self.trimmed_body)
        require_body_modes(vehicle, change.trimmed)
        every = element_numbers(vehicle, change.body, (self.car.vehicle, self.numbers))
        if not all(map(_same_kinds, every, self.numbers)):
            return None
        numbers = {name: own for one in every for name, own in one.items()}
        rows = self.rows.with_laws(numbers)
        springs, dampers = joint_springs(rows.model), joint_dampers(rows.model).copy()
        for name, (stiffness, damping) in _fields(numbers, "joint/"):
            dof = rows.model.joint(name).dofadr[0]
            springs[dof], dampers[dof] = stiffness, damping
        moved, parts = change.columns, self._masses(every, change)
        rest = AtRest(
            jacobian=moved(self.rest.jacobian), turned=change.rotations(self.rest.turned), weight=parts.weight
        )
        settled = settle(rows, rest, springs)
        if _on_a_corner(rows):
            return None
        preload, count = settled.preload, len(rest.jacobian)
        left = unsolved(rows.layout, rest.weight) - springs * settled.displacement + rest.jacobian.T @ preload[:count]
        left += np.einsum("nij,ni->j", rest.turned, preload[count:].reshape(-1, 3))
        left[rows.layout.rolling.spins] = 0.0
        static = static_loads(rows, settled, left)
        require_standing(vehicle, rows, static)
        laws, known = law_matrices(rows, rest.jacobian, dampers, preload), self.matrices.system
        stiffness = parts.turning + self._stiffness(rows, springs, preload, rest, change)
        stiffness += change.carried(rest.weight)
        system = replace(
            known,
            mass=parts.mass,
            stiffness=stiffness,
            constraints=rest.jacobian[rows.layout.joints.ravel()],
            outputs=known.outputs if change.same else {name: moved(row) for name, row in known.outputs.items()},
            **laws.system,
        )
        matrices = replace(
            self.matrices,
            system=system,
            sensors=moved(self.matrices.sensors),
            body_rows=parts.rows,
            body_masses=parts.masses,
            body_places={**self.matrices.body_places, "body": np.array(vehicle.body.cog)},
            **laws.car,
        )
        return VariedCar(matrices=matrices, static=static)

    def _stiffness(self, rows: Rows, springs: Vector, preload: Vector, rest: AtRest, change: BodyChange) -> Vector:
        """K of laws and preloads; (n, n)."""
        e, j = rows.layout, rest.jacobian
        diagonal = np.zeros(e.row_count)
        diagonal[e.bushings.rows], diagonal[e.springs.rows] = e.bushings.stiffness, e.springs.stiffness
        found: Vector = j.T @ (diagonal[:, None] * j)
        found += change.both((self.by_preload @ preload).reshape(j.shape[1], -1))
        turned = rest.turned.reshape(-1, j.shape[1])
        found += turned.T @ (np.repeat(e.rotations.stiffness, 3)[:, None] * turned)
        found[np.diag_indices(len(found))] += springs
        if len(e.rolling.tyres):
            course = e.rolling.course_rows(len(found))
            found += course.T @ (e.rolling.hold[:3, None] * course)
        for index in np.flatnonzero(e.tables.kinds == 2).tolist():
            dof, curve = e.dampers.dofs[e.tables.elements[index]], curve_of(e.tables, index)
            ends = curve.force(np.array([-DIFFERENCE_STEP, DIFFERENCE_STEP]))
            found[dof, dof] += (ends[1] - ends[0]) / (2.0 * DIFFERENCE_STEP)
        return found

    def _masses(self, every: list[Numbers], change: BodyChange) -> _Masses:
        """What the masses of the parts make of a car."""
        masses, system = dict(self.matrices.body_masses), self.matrices.system
        mass, weight, turning = system.mass, self.rest.weight, system.stiffness - self.sum
        gravity, body_rows = float(self.car.model.opt.gravity[2]), self.matrices.body_rows
        if change.shift.any():
            # The trimmed body is taken out before its origin moves, and comes back at the new one.
            own, rows = masses["body"], body_rows["body"]
            mass, weight = mass - rows.T @ own @ rows, weight - gravity * own[0, 0] * rows[2]
            mass, turning, weight = change.frames(mass), change.frames(turning), change.shifted(weight)
            body_rows = {name: one if name == "body" else change.shifted(one) for name, one in body_rows.items()}
            mass, weight = mass + rows.T @ own @ rows, weight + gravity * own[0, 0] * rows[2]
        for one, other in zip(every, self.numbers, strict=True):
            for name, own in _fields({} if one is other else one, "mass/"):
                before, rows = masses[name], body_rows[name]
                masses[name] = _mass_matrix(own)
                more = masses[name] - before
                mass = mass + rows.T @ more @ rows
                weight = weight + gravity * more[0, 0] * rows[2]
                turning = turning + more[0, 0] * change.frames(self.weight_terms[name])
        if change.hanging is not None:
            turning = turning + change.frames(gravity * masses["body"][0, 0] * change.hanging)
        return _Masses(masses=masses, rows=body_rows, mass=mass, weight=weight, turning=turning)


class _Masses(NamedTuple):
    """Masses of the parts and their rows, M, weight on the coordinates, and what K has of the weight."""

    masses: dict[str, Vector]
    rows: dict[str, Vector]
    mass: Vector
    weight: Vector
    turning: Vector


def same_places(vehicle: Vehicle, other: Vehicle) -> bool:
    """Whether two cars differ in numbers of laws, in masses and in the numerics alone."""
    car, known, body = vehicle.composition, other.composition, other.body
    if vehicle.gravity != other.gravity or (car.points, car.outputs, car.wheels) != (
        known.points,
        known.outputs,
        known.wheels,
    ):
        return False
    if not same_body(vehicle.body, body):
        return False
    spinning = {wheel.part for wheel in car.wheels} if vehicle.driving.rolling else set[str]()
    for one, like in zip(car.parts, known.parts, strict=False):
        # The inertia of a wheel about its axle is read from the model.
        if (one.name in spinning or one.parent in spinning) and one.numbers != like.numbers:
            return False
    if vehicle.body.flexible:
        # What is fixed to a flexible body changes its modes; a load is in the body model, which is scaled whole.
        scaled = vehicle.body.model_factor != body.model_factor
        for one, like in zip(car.parts, known.parts, strict=False):
            if one.parent == "body" and (one.numbers != like.numbers or (scaled and one.seat is None)):
                return False
    return (
        _alike(car.parts, known.parts, "numbers")
        and _alike(car.connections, known.connections, "law", "rolling")
        and _alike(car.springs, known.springs, "stiffness", "table")
        and _alike(car.joint_springs, known.joint_springs, "stiffness", "damping")
        and _alike(car.dampers, known.dampers, "law")
    )


def _alike(own: tuple[Any, ...], known: tuple[Any, ...], *numbers: str) -> bool:
    """Whether elements differ in these fields alone."""
    return len(own) == len(known) and all(
        one is other or replace(one, **{name: getattr(other, name) for name in numbers}) == other
        for one, other in zip(own, known, strict=True)
    )


def _same_kinds(own: Numbers, known: Numbers) -> bool:
    """Whether an element has the same fields, of the same lengths, and turns what it turned."""
    if own is known:
        return True
    if list(own) != list(known) or any(own[name].shape != known[name].shape for name in own):
        return False
    return all(
        (own[name][TURNING] > 0.0) == (known[name][TURNING] > 0.0)
        for name in own
        if name.startswith("law/") and len(own[name]) > TURNING
    )


def _fields(numbers: Mapping[str, Vector], kind: str) -> Iterator[tuple[str, Vector]]:
    """Fields of a kind by what follows it."""
    return ((name.removeprefix(kind), own) for name, own in numbers.items() if name.startswith(kind))


def _on_a_corner(rows: Rows) -> bool:
    """Whether a law over displacement stands so near to a corner that it has no tangent."""
    t = rows.layout.tables
    return any(
        bool(np.any(np.abs(curve_of(t, index).knots - t.at[index]) < CORNER))
        for index in np.flatnonzero(t.kinds < 2).tolist()
    )


def _mass_matrix(numbers: Vector) -> Vector:
    """Mass [kg] and inertia tensor [kg m2] of a part, (6, 6), of the numbers of `mass_numbers`."""
    mass, xx, yy, zz, xy, xz, yz = numbers
    return np.asarray(scipy.linalg.block_diag(mass * np.eye(3), [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))


def _turning_forces(rows: Rows) -> tuple[Vector, Any]:
    """What K has of the weight, (n, n); H of every preload, sparse, K row by row = H p, (n n, preloads)."""
    model, e = rows.model, rows.layout
    straight = np.setdiff1d(np.arange(len(e.bushings.rows)), e.bushings.oblique)
    own, carriers = e.bushings.rows[straight], e.bushings.carriers[straight]

    def read(data: mujoco.MjData) -> Vector:
        """Forces on the coordinates, of the weight and of each preload of 1, which turns with its carrier."""
        along = data.efc_J.reshape(e.row_count, model.nv).copy()
        along[own] = np.einsum("nki,nkj->nij", data.xmat[carriers].reshape(-1, 3, 3), along[own])
        turned = np.einsum("nki,nkj->nij", rows.rotation(data)[1], rows.rotation_jacobian(data))
        return np.concatenate([-data.qfrc_bias[None], along, turned.reshape(-1, model.nv)])

    weight, *preloads = -differences(rows, read)
    return weight, scipy.sparse.csr_array(np.reshape(preloads, (len(preloads), -1)).T)
