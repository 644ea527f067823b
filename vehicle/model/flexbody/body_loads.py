"""Loads on a flexible body: their mass in the modes of the body, and not only in its rigid motion.

A load at a node moves with it. A load elsewhere follows the rigid motion that fits its six nearest nodes best
(`vehicle.model.flexbody.carried_nodes`), and so does every rotation of a load with an inertia of its own. With N,
displacement and rotation of the load by the displacements u of the nodes, M + N' diag(m 1, I) N takes the place of M.
In a rigid motion of the body N is exact wherever the load is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vehicle.model.flexbody.attached_mass import with_added_mass
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.carried_nodes import carried_by
from vehicle.model.flexbody.inertia_tensor import inertia_tensor
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.vehicle import Vehicle


class BodyLoad(NamedTuple):
    """Mass [kg], place [m], and moments and products as integrals [kg m2] of a load on the body."""

    mass: float
    at: Point
    moments: Point
    products: Point

    @property
    def matrix(self) -> FloatArray:
        """Mass and inertia tensor as a (6, 6) matrix."""
        (xx, yy, zz), (xy, zx, yz) = self.moments, self.products
        found = np.zeros((6, 6))
        found[:3, :3] = self.mass * np.eye(3)
        found[3:, 3:] = inertia_tensor(ixx=xx, iyy=yy, izz=zz, ixy=xy, izx=zx, iyz=yz)
        return found


def body_loads(vehicle: Vehicle) -> tuple[BodyLoad, ...]:
    """Return the loads on the trimmed body of a vehicle, those without mass and inertia left out."""
    return tuple(
        BodyLoad(one.numbers.mass, one.cog, one.numbers.inertia or (0.0, 0.0, 0.0), one.numbers.products)
        for one in vehicle.composition.loads
        if one.parent == "body" and (one.numbers.mass > 0.0 or one.numbers.inertia is not None)
    )


def followed(positions: FloatArray, load: BodyLoad, tolerance: float) -> FloatArray:
    """Return displacement and rotation of a load by the displacements of the nodes, N of shape (6, n, 3).

    Args:
        positions: of the nodes [m], shape (n, 3).
        load: the load.
        tolerance: largest distance from a node at which the load is at the node [m].
    """
    found, point = np.zeros((6, len(positions), 3)), np.array(load.at)
    gap = np.linalg.norm(positions - point, axis=1)
    node = int(gap.argmin())
    if gap[node] > tolerance:
        carriers, motion = carried_by(positions, point)
        found[:, carriers] = motion
        return found
    found[:3, node] = np.eye(3)
    if any(load.moments):
        others = np.delete(np.arange(len(positions)), node)
        carriers, motion = carried_by(positions[others], positions[node])
        found[3:, others[carriers]] = motion[3:]
    return found


def load_mass(positions: FloatArray, loads: Sequence[BodyLoad], tolerance: float) -> FloatArray:
    """Return the mass matrix of loads on the displacements of the nodes [kg], shape (3 n, 3 n); see `followed`."""
    found = np.zeros((positions.size, positions.size))
    for load in loads:
        motion = followed(positions, load, tolerance).reshape(6, -1)
        found += motion.T @ load.matrix @ motion
    return found


def loaded_properties(rigid: MassProperties, loads: Sequence[BodyLoad]) -> MassProperties:
    """Return the mass properties of a body with loads."""
    if not loads:
        return rigid
    masses, places = np.array([load.mass for load in loads]), np.array([load.at for load in loads])
    found = rigid.with_points(masses, places)
    return replace(found, inertia=found.inertia + sum(load.matrix[3:, 3:] for load in loads))


def with_loads(body: Superelement, loads: Sequence[BodyLoad]) -> Superelement:
    """Return a body model with loads, within the space of its rigid motions and of the modes that it has.

    Args:
        body: the body model.
        loads: on it.

    Returns:
        The body with the mass properties and modes that it has with the loads; exact where its modes are all modes.
    """
    if not loads:
        return body
    rigid, _ = body.rigid.rigid_motions(body.positions)
    every = np.concatenate([rigid, body.shapes])  # (6 + modes, n, 3)
    added = np.zeros((len(every), len(every)))
    for load in loads:
        motion = np.einsum("cnj,anj->ac", followed(body.positions, load, body.hardpoint_tolerance), every)
        added += motion @ load.matrix @ motion.T
    return with_added_mass(body, added, loaded_properties(body.rigid, loads)).body
