"""The modal superelement: a flexible body as nodes with lumped masses and mass-normalised free-free modes.

Nodes carry translational masses only; rotations of the frame behind them are massless and condensed exactly. So the
mass matrix is diagonal in the file, and any reader can check mass, CoG, inertia and normalisation without the model
behind it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from vehicle.errors import DataError
from vehicle.flexbody.beam import FloatArray
from vehicle.flexbody.superelement_checks import LARGEST_TOLERANCE, check_superelement
from vehicle.parameters.hardpoints import Point


def _frozen(array: object, dtype: type = float) -> FloatArray:
    copy: FloatArray = np.array(array, dtype=dtype)
    copy.setflags(write=False)
    return copy


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Superelement:
    """A flexible body: rigid motion about its CoG plus mass-normalised elastic modes.

    Raises:
        DataError: anything that `check_superelement` refuses.
    """

    name: str
    """name of the body"""
    nodes: tuple[str, ...]
    """node names, all different"""
    positions: FloatArray
    """node positions in the vehicle frame [m], shape (n, 3)"""
    edges: FloatArray
    """wireframe lines as pairs of node indices, shape (m, 2), integers"""
    node_mass: FloatArray
    """lumped translational masses [kg], shape (n,)"""
    frequencies: FloatArray
    """natural frequencies of the free body, ascending [Hz], shape (modes,); none of a rigid body"""
    damping_ratio: FloatArray
    """share of critical damping of each mode [1], shape (modes,)"""
    shapes: FloatArray
    """mass-normalised mode shapes, translations in the vehicle frame [kg^-1/2], shape (modes, n, 3)"""
    attachment_stiffness: Mapping[str, FloatArray] = field(default_factory=dict)
    """node -> local stiffness in series with what is fixed there, along x, y, z [N/m], shape (3,)"""
    mode_names: tuple[str, ...]
    """one name for each mode"""
    provenance: str
    """where the numbers come from, in words"""
    hardpoint_tolerance: float = 1e-3
    """largest distance of a node from the hardpoint that it is measured for [m]"""

    def __post_init__(self) -> None:
        def put(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        for name in ("positions", "node_mass", "frequencies", "damping_ratio", "shapes"):
            try:
                put(name, _frozen(getattr(self, name)))
            except (TypeError, ValueError) as error:
                raise DataError(
                    f"superelement {self.name!r}, {name}: not a regular array of numbers ({error}). "
                    "Give one row of three numbers for every node."
                ) from error
        put("edges", _frozen(np.asarray(self.edges, dtype=int).reshape(-1, 2), int))
        put("nodes", tuple(self.nodes))
        put("mode_names", tuple(self.mode_names))
        stiffness = {node: _frozen(value) for node, value in self.attachment_stiffness.items()}
        put("attachment_stiffness", MappingProxyType(stiffness))
        check_superelement(self)

    @property
    def mass(self) -> float:
        """Mass of the body, sum of m [kg]."""
        return float(self.node_mass.sum())

    @property
    def cog(self) -> FloatArray:
        """Centre of gravity, sum of m r / m [m], shape (3,)."""
        return np.asarray(self.node_mass @ self.positions / self.mass)

    @property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the CoG, sum of m (|r|^2 1 - r r^T) [kg m2], shape (3, 3)."""
        arm = self.positions - self.cog
        moments = (arm.T * self.node_mass) @ arm
        return np.asarray(np.trace(moments) * np.eye(3) - moments)

    def node_index(self, name: str) -> int:
        """Index of a node.

        Raises:
            DataError: no node of this name; the message lists the names that exist.
        """
        try:
            return self.nodes.index(name)
        except ValueError:
            raise DataError(
                f"superelement {self.name!r} has no node {name!r}. Its nodes are: {', '.join(self.nodes)}."
            ) from None

    def shape_at(self, node: str) -> FloatArray:
        """Mode shapes at one node: displacement = shape @ q [kg^-1/2], shape (3, modes)."""
        return np.asarray(self.shapes[:, self.node_index(node), :].T)

    def without_modes(self) -> Superelement:
        """The same body, rigid."""
        none = np.zeros(0)
        shapes = np.zeros((0, len(self.nodes), 3))
        return replace(self, frequencies=none, damping_ratio=none, shapes=shapes, mode_names=())


def attached_nodes(body: Superelement, places: Mapping[str, Point]) -> dict[Point, str]:
    """The node of a body model at each point where something acts on it: found by its place, never by its name.

    Args:
        body: the body model; says how far a node may be from a point of the car.
        places: points of the car in the vehicle frame [m], by name.

    Returns:
        Point to the name of its node. What is rigid reaches everywhere: there a node is only needed for its local
        stiffness, and may be as far as that of a body that is measured.

    Raises:
        DataError: no node is near enough; names the nearest, the distance and both positions.
    """
    found: dict[Point, str] = {}
    for name, place in places.items():
        gap = np.linalg.norm(body.positions - np.array(place), axis=1)
        best = int(np.argmin(gap))
        distance, tolerance = float(gap[best]), body.hardpoint_tolerance
        if not body.frequencies.size:
            if distance <= LARGEST_TOLERANCE:
                found[place] = body.nodes[best]
            continue
        if not distance <= tolerance:
            raise DataError(
                f"superelement {body.name!r}: no node at {name} {list(place)} m, where the car is fixed to it: node "
                f"{body.nodes[best]!r} at {body.positions[best].tolist()} m is {distance * 1e3:.4g} mm away; "
                f"{tolerance * 1e3:g} mm is allowed. Move the hardpoint or use a body model measured at it, or one "
                "that is computed from the hardpoints (body.superelement = body_design.toml)."
            )
        found[place] = body.nodes[best]
    return found
