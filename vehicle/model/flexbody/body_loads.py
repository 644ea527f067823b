"""Loads (cargo, equipment) on a flexible body: their mass and inertia in the modes of the body.

A load at a node has the displacement of the node. A load elsewhere follows the rigid motion with the best fit to its
six nearest nodes (`vehicle.model.flexbody.carried_nodes`); the rotation of a load with inertia always follows a fit.
N maps the node displacements u to displacement and rotation of the load; M + N' diag(m 1, I) N replaces M.
For a rigid motion of the body, N is exact at every position of the load.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.flexbody.attached_mass import with_added_mass
from vehicle.model.flexbody.carried_nodes import carried_by
from vehicle.model.flexbody.inertia_tensor import inertia_tensor
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.hardpoints import Point
from vehicle.model.parameters.vehicle import Vehicle


class BodyLoad(NamedTuple):
    """Load on the body: mass [kg], position [m], moments and products of inertia about its CoG as integrals [kg m2]."""

    mass: float
    at: Point
    moments: Point
    products: Point

    @property
    def matrix(self) -> Vector:
        """Mass and inertia tensor, diag(m 1, I) [kg, kg m2], shape (6, 6)."""
        (xx, yy, zz), (xy, zx, yz) = self.moments, self.products
        matrix = np.zeros((6, 6))
        matrix[:3, :3] = self.mass * np.eye(3)
        matrix[3:, 3:] = inertia_tensor(ixx=xx, iyy=yy, izz=zz, ixy=xy, izx=zx, iyz=yz)
        return matrix


def body_loads(vehicle: Vehicle) -> tuple[BodyLoad, ...]:
    """Return the loads on the body of a vehicle that have mass or inertia."""
    return tuple(
        BodyLoad(load.numbers.mass, load.cog, load.numbers.inertia or (0.0, 0.0, 0.0), load.numbers.products)
        for load in vehicle.composition.loads
        if load.parent == "body" and (load.numbers.mass > 0.0 or load.numbers.inertia is not None)
    )


def followed(positions: Vector, load: BodyLoad, tolerance: float) -> Vector:
    """Return N, which maps node displacements to displacement and rotation of a load; shape (6, n, 3).

    Args:
        positions: node positions [m], shape (n, 3).
        load: the load.
        tolerance: maximum distance from a node at which the load has the displacement of the node [m].
    """
    motion, point = np.zeros((6, len(positions), 3)), np.array(load.at)
    gap = np.linalg.norm(positions - point, axis=1)
    node = int(gap.argmin())
    if gap[node] > tolerance:
        carriers, carrier_motion = carried_by(positions, point)
        motion[:, carriers] = carrier_motion
        return motion
    motion[:3, node] = np.eye(3)
    if any(load.moments):
        others = np.delete(np.arange(len(positions)), node)
        carriers, carrier_motion = carried_by(positions[others], positions[node])
        motion[3:, others[carriers]] = carrier_motion[3:]
    return motion


def load_mass(positions: Vector, loads: Sequence[BodyLoad], tolerance: float) -> Vector:
    """Return the mass matrix of loads on the displacements of the nodes [kg], shape (3 n, 3 n); see `followed`."""
    mass = np.zeros((positions.size, positions.size))
    for load in loads:
        # (6, 3 n): N' diag(m 1, I) N.
        motion = followed(positions, load, tolerance).reshape(6, -1)
        mass += motion.T @ load.matrix @ motion
    return mass


def loaded_properties(rigid: MassProperties, loads: Sequence[BodyLoad]) -> MassProperties:
    """Return the mass properties of a body with loads."""
    if not loads:
        return rigid
    masses, positions = np.array([load.mass for load in loads]), np.array([load.at for load in loads])
    loaded = rigid.with_points(masses, positions)
    return replace(loaded, inertia=loaded.inertia + sum(load.matrix[3:, 3:] for load in loads))


def with_loads(body: Superelement, loads: Sequence[BodyLoad]) -> Superelement:
    """Add loads to a body model, within the space of its rigid motions and its modes.

    Returns:
        Body with the mass properties and modes including the loads; exact if `body` contains all its elastic modes.
    """
    if not loads:
        return body
    rigid, _ = body.rigid.rigid_motions(body.positions)
    motions = np.concatenate([rigid, body.shapes])  # (6 + modes, n, 3)
    added = np.zeros((len(motions), len(motions)))
    for load in loads:
        # Displacement and rotation of the load in each motion T of the body; (6 + modes, 6).
        motion = np.einsum("cnj,anj->ac", followed(body.positions, load, body.hardpoint_tolerance), motions)
        added += motion @ load.matrix @ motion.T
    return with_added_mass(body, added, loaded_properties(body.rigid, loads)).body
