"""Coordinates of a car whose trimmed body has another mass or centre of gravity, over those of a car that is known.

The six rigid coordinates r of the body are displacement and rotation at its CoG, the modal ones q are those of the body
with what is fixed to it. With the body alone scaled by f both cars move in the space of the same rigid motions R and
elastic modes Phi of the body alone: u = R r + (Phi X - R Y) q. So, of the known car (0) by the new one,

    q_0 = A q,  A = X_0^-1 X f^-1/2;    r_0 = r + D r + R (Y_0 A - Y f^-1/2) q,    D: v_0 = v + d x omega

with d the way of the CoG. Forces in the axes of the body turn with r and not with q, so that the geometric stiffness
of preloads differs by the rigid part of the modes: by 5e-11 of the largest entry of K and 4e-8 of a frequency of the
Focus with 2 % of mass, by 5e-10 and 4e-7 with 16 %. Without parts that are fixed to the body there is no such part.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.car_model import CarModel
from vehicle.engines.simulation.row_layout import read_layout
from vehicle.model.assembly.spec import fixed_masses
from vehicle.model.flexbody.attached_mass import attached
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.body import MOMENTS, TrimmedBody
from vehicle.model.parameters.vehicle import Vehicle

Vector = npt.NDArray[np.float64]

SAME = 1e-12
"""Relative difference of two moments of one body model that is round-off of a factor."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyChange:
    """Transformation from the coordinates of a car to those of a known one; by default they are the same.

    Attributes:
        trimmed, body: body model alone and with what is fixed to it.
        move: known coordinates over the new ones where only the origin of the body moves; (n, n).
        whole: the same with its modes; (n, n).
        shift: way of the CoG d [m]; (3,).
        first: first velocity coordinate of the body.
        modes: velocity coordinates of the flexible modes.
        hanging: d(torque)/d(rotation) of a unit force along z at the new CoG, about the old one; (n, n).
    """

    trimmed: Superelement
    body: Superelement
    move: Vector | None = None
    whole: Vector | None = None
    shift: Vector = field(default_factory=lambda: np.zeros(3))
    hanging: Vector | None = None
    first: int = 0
    modes: slice = field(default_factory=lambda: slice(0))

    @property
    def same(self) -> bool:
        """True if the coordinates are the same."""
        return self.whole is None

    def columns(self, rows: Vector) -> Vector:
        """Return rows over the known coordinates, (..., n), or with inputs behind them, as rows over the new ones."""
        if self.whole is None:
            return rows
        size = len(self.whole)
        return np.concatenate([rows[..., :size] @ self.whole, rows[..., size:]], axis=-1)

    def rotations(self, turned: Vector) -> Vector:
        """Return rotations over the known coordinates, (..., n), over the new ones.

        Where a body model has no rotation of a node, an element there turns with the rigid coordinates alone.
        """
        if self.whole is None or self.move is None:
            return turned
        known = np.any(turned[..., self.modes] != 0.0, axis=-1, keepdims=True)
        return np.where(known, turned @ self.whole, turned @ self.move)

    def carried(self, weight: Vector) -> Vector:
        """Return what K has of the rigid translations b in the new modes, which turn with the body, (n, n).

        In r_0 they are along the axes of the world. V changes by -F (theta x b) q, F being the force of all elements on
        the body, which is against its weight and that of what is fixed to it.

        Args:
            weight: generalised force of gravity; (n,).
        """
        found = np.zeros((len(weight), len(weight)))
        if self.whole is not None:
            ways = self.whole[self.first : self.first + 3, self.modes]
            held = -weight[self.first : self.first + 3]
            found[self.first + 3 : self.first + 6, self.modes] = -np.cross(ways, held, axis=0)
        return found + found.T

    def both(self, matrix: Vector) -> Vector:
        """Return T' A T of a matrix over the known coordinates, (n, n)."""
        return matrix if self.whole is None else self.whole.T @ matrix @ self.whole

    def frames(self, matrix: Vector) -> Vector:
        """Return T' A T where the origin of the body alone moves: of what does not act on its modes."""
        return matrix if self.move is None else self.move.T @ matrix @ self.move

    def shifted(self, rows: Vector) -> Vector:
        """Return rows over the known coordinates, (..., n), where the origin of the body alone moves."""
        return rows if self.move is None else rows @ self.move


def same_body(body: TrimmedBody, known: TrimmedBody) -> bool:
    """Return True if two bodies differ in rigid-body properties and in factors on their modes alone.

    A flexible body has to be that of the same elastic model: only its mass may be varied.
    """
    numbers = {name: getattr(known, name) for name in ("mass", "cog", "inertia", "model_mass", "frequency_scale")}
    if replace(body, **numbers) != known or not body.flexible:
        return replace(body, **numbers) == known
    pairs = [
        (body.of_model.mass, known.of_model.mass),
        *((getattr(body.of_model.inertia, name), getattr(known.of_model.inertia, name)) for name in MOMENTS),
    ]
    about = body.inertia.about == known.inertia.about
    return about and body.cog == known.cog and all(math.isclose(*pair, rel_tol=SAME) for pair in pairs)


def body_change(vehicle: Vehicle, known: CarModel, trimmed: Superelement) -> BodyChange:
    """Return the coordinates of a car over those of a known one with the same body model.

    Args:
        vehicle: the car; `same_body` holds.
        known: the known car.
        trimmed: its body model without what is fixed to it.
    """
    body, other = vehicle.body, known.vehicle.body
    factor = body.model_factor / other.model_factor if body.flexible else 1.0
    shift = np.array(body.cog) - np.array(other.cog)
    if factor == 1.0 and not shift.any():
        return BodyChange(trimmed=trimmed, body=known.superelement)
    size, model = known.model.nv, known.model
    first = int(model.joint("body").dofadr[0])
    move, hanging = np.eye(size), np.zeros((size, size))
    turns = slice(first + 3, first + 6)
    move[first : first + 3, turns] = _cross(shift)
    up = np.array([0.0, 0.0, 1.0])
    hanging[turns, turns] = shift[2] * np.eye(3) - np.outer(up, shift)
    if factor == 1.0:
        return BodyChange(trimmed=trimmed, body=known.superelement, move=move, whole=move, shift=shift, hanging=hanging)
    scaled, modes = trimmed.scaled(factor), read_layout(model).modes.velocities
    before, after = (attached(one, fixed_masses(vehicle, one)) for one in (trimmed, scaled))
    elastic = np.linalg.solve(before.elastic, after.elastic) * factor**-0.5
    rigid = before.rigid @ elastic - after.rigid * factor**-0.5
    shapes, rotations = trimmed.rigid.rigid_motions(np.array([body.cog]))
    whole = move.copy()
    whole[modes, modes] = elastic
    whole[first : first + 6, modes] = np.vstack([shapes[:, 0].T, rotations.T]) @ rigid
    return BodyChange(
        trimmed=scaled, body=after.body, move=move, whole=whole, shift=shift, hanging=hanging, first=first, modes=modes
    )


def _cross(d: Vector) -> Vector:
    """d x as a matrix, (3, 3)."""
    x, y, z = d
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
