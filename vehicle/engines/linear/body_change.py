"""Transformation from the coordinates of a modified car to those of a reference car with another body mass or CoG.

The six rigid coordinates r of the body are displacement and rotation at its CoG. The modal coordinates q belong to the
body with the parts fixed to it. If the mass of the body alone is scaled by f, both cars move in the space of the same
rigid motions R and elastic modes Phi of the body alone: u = R r + (Phi X - R Y) q. The coordinates of the reference car
(index 0) are therefore

    q_0 = A q,  A = X_0^-1 X f^-1/2;    r_0 = r + D r + R (Y_0 A - Y f^-1/2) q,    D: v_0 = v + d x omega

with the displacement d of the CoG. Forces in the axes of the body rotate with r and not with q, so the geometric
stiffness of preloads differs by the rigid part of the modes: by 5e-11 of the largest entry of K and 4e-8 of a frequency
of the `focus` car with 2 % more mass, by 5e-10 and 4e-7 with 16 %. Without parts fixed to the body it does not differ.
"""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.engines.linear.part_motions import cross_matrix
from vehicle.engines.simulation.car_model import CarModel
from vehicle.model.assembly.spec import fixed_masses
from vehicle.model.flexbody.attached_mass import attached
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.body import MOMENTS, TrimmedBody
from vehicle.model.parameters.vehicle import Vehicle

SAME = 1e-12
"""Maximum relative difference of moments of inertia that counts as round-off of a factor."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyChange:
    """Transformation from the coordinates of a car to those of a reference car; the identity by default.

    Attributes:
        trimmed, body: body model alone and with the parts fixed to it.
        move: reference coordinates over the new ones for a displaced origin of the body alone; (n, n).
        whole: the same for a displaced origin and changed modes; (n, n).
        shift: displacement d of the CoG [m]; (3,).
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
        """Return True if both cars have the same coordinates."""
        return self.whole is None

    def reference_motion(self, coordinates: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Transform displacements over the new coordinates, (n, ...), to those over the reference coordinates."""
        return coordinates if self.whole is None else np.asarray(self.whole @ coordinates)

    def columns(self, rows: Vector) -> Vector:
        """Transform rows over the reference coordinates, (..., n) or (..., n + inputs), to rows over the new ones."""
        if self.whole is None:
            return rows
        size = len(self.whole)
        return np.concatenate([rows[..., :size] @ self.whole, rows[..., size:]], axis=-1)

    def rotations(self, rotation: Vector) -> Vector:
        """Transform rotations over the reference coordinates, (..., n), to rotations over the new ones.

        If a body model has no rotations of a node, an element there rotates with the rigid coordinates alone.
        """
        if self.whole is None or self.move is None:
            return rotation
        has_modes = np.any(rotation[..., self.modes] != 0.0, axis=-1, keepdims=True)
        return np.where(has_modes, rotation @ self.whole, rotation @ self.move)

    def weight_stiffness(self, weight: Vector) -> Vector:
        """Return the stiffness due to the rigid translations b in the new modes, which rotate with the body; (n, n).

        In r_0 they are along the world axes. V changes by -F (theta x b) q with the force F of all elements on the
        body, which balances the weight of the body and of the parts fixed to it.

        Args:
            weight: generalised force of gravity; (n,).
        """
        stiffness = np.zeros((len(weight), len(weight)))
        if self.whole is not None:
            displacements = self.whole[self.first : self.first + 3, self.modes]
            support_force = -weight[self.first : self.first + 3]
            stiffness[self.first + 3 : self.first + 6, self.modes] = -np.cross(displacements, support_force, axis=0)
        return stiffness + stiffness.T

    def displaced_matrix(self, matrix: Vector) -> Vector:
        """Transform a matrix A, (n, n), to T' A T for a displaced origin of the body.

        For terms that do not act on the modes of the body, which T leaves unchanged.
        """
        return matrix if self.move is None else self.move.T @ matrix @ self.move

    def displaced_rows(self, rows: Vector) -> Vector:
        """Transform rows over the reference coordinates, (..., n), for a displaced origin of the body."""
        return rows if self.move is None else rows @ self.move


def same_body(body: TrimmedBody, reference: TrimmedBody) -> bool:
    """Return True if two bodies differ only in rigid-body properties and in factors on their modes.

    A flexible body must have the same elastic model: only its mass may differ.
    """
    scalars = {name: getattr(reference, name) for name in ("mass", "cog", "inertia", "model_mass", "frequency_scale")}
    if replace(body, **scalars) != reference or not body.flexible:
        return replace(body, **scalars) == reference
    pairs = [
        (body.of_model.mass, reference.of_model.mass),
        *((getattr(body.of_model.inertia, name), getattr(reference.of_model.inertia, name)) for name in MOMENTS),
    ]
    same_point = body.inertia.about == reference.inertia.about
    return same_point and body.cog == reference.cog and all(math.isclose(*pair, rel_tol=SAME) for pair in pairs)


def body_change(vehicle: Vehicle, reference: CarModel, trimmed: Superelement, modes: slice) -> BodyChange:
    """Return the coordinate transformation between a car and a reference car with the same body model.

    Args:
        vehicle: the new car; `same_body` must be true.
        reference: the reference car.
        trimmed: body model of the reference car without the parts fixed to it.
        modes: velocity coordinates of its flexible modes.
    """
    body, reference_body = vehicle.body, reference.vehicle.body
    factor = body.model_factor / reference_body.model_factor if body.flexible else 1.0
    shift = np.array(body.cog) - np.array(reference_body.cog)
    if factor == 1.0 and not shift.any():
        return BodyChange(trimmed=trimmed, body=reference.superelement)
    size, model = reference.model.nv, reference.model
    first = int(model.joint("body").dofadr[0])
    move, hanging = np.eye(size), np.zeros((size, size))
    turns = slice(first + 3, first + 6)
    # v_0 = v + d x w.
    move[first : first + 3, turns] = cross_matrix(shift)
    up = np.array([0.0, 0.0, 1.0])
    hanging[turns, turns] = shift[2] * np.eye(3) - np.outer(up, shift)
    if factor == 1.0:
        return BodyChange(
            trimmed=trimmed, body=reference.superelement, move=move, whole=move, shift=shift, hanging=hanging
        )
    scaled = trimmed.scaled(factor)
    before, after = (attached(shape, fixed_masses(vehicle, shape)) for shape in (trimmed, scaled))
    # A = X_0^-1 X f^-1/2, and the rigid part Y_0 A - Y f^-1/2.
    elastic = np.linalg.solve(before.elastic, after.elastic) * factor**-0.5
    rigid = before.rigid @ elastic - after.rigid * factor**-0.5
    shapes, rotations = trimmed.rigid.rigid_motions(np.array([body.cog]))
    whole = move.copy()
    whole[modes, modes] = elastic
    # The rigid motions R at the new centre of gravity: translations, then rotations; (6, 6).
    whole[first : first + 6, modes] = np.vstack([shapes[:, 0].T, rotations.T]) @ rigid
    return BodyChange(
        trimmed=scaled, body=after.body, move=move, whole=whole, shift=shift, hanging=hanging, first=first, modes=modes
    )
