"""Modal superelement: a flexible body as mass properties, free-free modes at nodes, and residual flexibility.

The displacement of a node is the rigid-body displacement plus Phi_n q, with q'' + 2 zeta w q' + w^2 q = Phi_n' f. The
static deflection of the truncated higher modes under a force is the residual flexibility of the node,
G_n = sum of phi phi' / w^2 [m/N], in series with the attached element. No mass matrix is needed: mass properties,
modal masses of 1 kg and shapes suffice.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from vehicle.arrays import Indices, Vector
from vehicle.errors import DataError
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement_checks import LARGEST_TOLERANCE, check_superelement
from vehicle.model.parameters.hardpoints import Point

ARRAYS = ("positions", "node_mass", "frequencies", "damping_ratio", "shapes")


def _frozen(array: object, dtype: type = float) -> Vector:
    copy: Vector = np.array(array, dtype=dtype)
    copy.setflags(write=False)
    return copy


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Superelement:
    """Flexible body: rigid motion about its CoG plus mass-normalised elastic modes.

    Raises:
        DataError: the data violate a check of `check_superelement`.
    """

    name: str
    """name of the body"""
    nodes: tuple[str, ...]
    """node names, unique"""
    positions: Vector
    """node positions in the vehicle frame [m], shape (n, 3)"""
    edges: Indices | Vector
    """wireframe lines as pairs of node indices, shape (m, 2), integers"""
    node_mass: Vector | None = None
    """lumped translational masses if these are the whole mass [kg], shape (n,); they allow exact checks of the modes"""
    mass_properties: MassProperties | None = None
    """mass, CoG and inertia if `node_mass` is unknown"""
    frequencies: Vector
    """natural frequencies of the free body, ascending [Hz], shape (modes,); empty for a rigid body"""
    damping_ratio: Vector
    """modal damping ratio [1], shape (modes,)"""
    shapes: Vector
    """mass-normalised mode shapes, translations in the vehicle frame [kg^-1/2], shape (modes, n, 3)"""
    rotations: Mapping[str, Vector] = field(default_factory=dict)
    """node name -> rotation of the node in each mode, if known [rad m^-1 kg^-1/2], shape (modes, 3)"""
    residual: Mapping[str, Vector] = field(default_factory=dict)
    """node name -> residual flexibility, symmetric [m/N], shape (3, 3)"""
    mode_names: tuple[str, ...]
    """name of each mode"""
    provenance: str
    """origin of the values, as text: program, units and frame of the source, scaling"""
    hardpoint_tolerance: float = 1e-3
    """maximum distance of a node from its hardpoint [m]"""
    derived: bool = field(default=False, repr=False)
    """true: derived from a checked body; skips the checks, which would cost time for every car of a sweep"""

    def __repr__(self) -> str:
        """One line."""
        return f"Superelement({self.name}, {len(self.nodes)} nodes, {len(self.mode_names)} modes)"

    def __post_init__(self) -> None:
        def put(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        for name in ARRAYS:
            if getattr(self, name) is None:
                continue
            try:
                put(name, _frozen(getattr(self, name)))
            except (TypeError, ValueError) as error:
                raise DataError(
                    f"superelement {self.name!r}, {name}: is not a regular array of numbers ({error}). Give one "
                    "row of three numbers for every node."
                ) from error
        put("edges", _frozen(np.asarray(self.edges, dtype=int).reshape(-1, 2), int))
        put("nodes", tuple(self.nodes))
        put("mode_names", tuple(self.mode_names))
        for name in ("rotations", "residual"):
            put(name, MappingProxyType({node: _frozen(value) for node, value in getattr(self, name).items()}))
        if not self.derived:
            check_superelement(self)

    @property
    def rigid(self) -> MassProperties:
        """Mass, CoG and inertia, computed from `node_mass` or taken from `mass_properties`."""
        if self.node_mass is not None:
            return MassProperties.of_points(self.node_mass, self.positions)
        assert self.mass_properties is not None
        return self.mass_properties

    @property
    def mass(self) -> float:
        """Mass of the body [kg]."""
        return self.rigid.mass

    @property
    def cog(self) -> Vector:
        """Centre of gravity [m], shape (3,)."""
        return self.rigid.cog

    @property
    def inertia(self) -> Vector:
        """Inertia tensor about the CoG [kg m2], shape (3, 3)."""
        return self.rigid.inertia

    def node_index(self, name: str) -> int:
        """Return the index of a node.

        Raises:
            DataError: no node has this name; the message lists the existing names.
        """
        try:
            return self.nodes.index(name)
        except ValueError:
            raise DataError(
                f"superelement {self.name!r} has no node {name!r}. Its nodes are: {', '.join(self.nodes)}."
            ) from None

    def shape_at(self, node: str) -> Vector:
        """Return the mode shapes at a node [kg^-1/2], shape (3, modes): elastic displacement = shape @ q."""
        return np.asarray(self.shapes[:, self.node_index(node), :].T)

    def without_modes(self) -> Superelement:
        """Return the body without elastic modes."""
        no_modes = np.zeros(0)
        return replace(
            self,
            frequencies=no_modes,
            damping_ratio=no_modes,
            shapes=np.zeros((0, len(self.nodes), 3)),
            rotations={},
            mode_names=(),
            derived=True,
        )

    def scaled(self, factor: float) -> Superelement:
        """Return the body with all masses multiplied by a factor f and unchanged stiffness.

        (K - w^2 f M) phi = 0 has the same shapes for every f; w and the mass-normalised shapes scale with f^-1/2.
        Residual flexibility, being static, and damping ratios do not change.

        Args:
            factor: f [1].
        """
        if factor == 1.0:
            return self
        root, properties = factor**-0.5, self.mass_properties
        return replace(
            self,
            node_mass=None if self.node_mass is None else factor * self.node_mass,
            mass_properties=None
            if properties is None
            else MassProperties(mass=factor * properties.mass, cog=properties.cog, inertia=factor * properties.inertia),
            frequencies=root * self.frequencies,
            shapes=root * self.shapes,
            rotations={node: root * turns for node, turns in self.rotations.items()},
            derived=True,
        )

    def up_to(self, frequency: float, kept: Collection[str]) -> Superelement:
        """Truncate the modes above a frequency and add their static share to the residual flexibility of loaded nodes.

        At f, the static share of a mode at f_i is too small by (f/f_i)^2 / (1 - (f/f_i)^2) of the static share.

        Args:
            frequency: highest frequency of the remaining modes [Hz].
            kept: names of the nodes at which forces act on the body.
        """
        count = int(np.searchsorted(self.frequencies, frequency, side="right"))
        if count == len(self.frequencies):
            return self
        # Static share of the truncated modes: sum of phi phi'/w^2.
        compliance = 1.0 / (2.0 * np.pi * self.frequencies[count:]) ** 2
        residual = dict(self.residual)
        for node in kept:
            shape = self.shapes[count:, self.node_index(node)]
            residual[node] = residual.get(node, np.zeros((3, 3))) + (shape.T * compliance) @ shape
        return replace(
            self,
            frequencies=self.frequencies[:count],
            damping_ratio=self.damping_ratio[:count],
            shapes=self.shapes[:count],
            rotations={node: turns[:count] for node, turns in self.rotations.items()},
            mode_names=self.mode_names[:count],
            residual=residual,
            derived=True,
        )

    def combined(self, spread: Vector, kept: Collection[str]) -> Superelement:
        """Return the body with linear combinations of its modes as shapes, without modal stiffness, at some nodes.

        Args:
            spread: modal coordinates as a function of the new coordinates, shape (modes, new).
            kept: names of the remaining nodes.
        """
        where = [self.node_index(node) for node in kept]
        count = spread.shape[1]
        return replace(
            self,
            nodes=tuple(kept),
            positions=self.positions[where],
            edges=np.zeros((0, 2)),
            node_mass=None,
            mass_properties=self.rigid,
            frequencies=np.zeros(count),
            damping_ratio=np.zeros(count),
            shapes=np.tensordot(spread.T, self.shapes[:, where], 1),
            rotations={node: spread.T @ turns for node, turns in self.rotations.items() if node in kept},
            residual={node: value for node, value in self.residual.items() if node in kept},
            mode_names=tuple(f"combination {number}" for number in range(1, count + 1)),
            derived=True,
        )


def attached_nodes(body: Superelement, points: Mapping[str, Point]) -> dict[Point, str]:
    """Find the node of a body model at each attachment point by its position; node names are not used.

    Args:
        body: the body model; its `hardpoint_tolerance` is the maximum distance of a node from its point.
        points: points of the car in the vehicle frame [m], by name.

    Returns:
        Point -> name of its node. For a rigid body, which needs only the local stiffness, points without a node within
        `LARGEST_TOLERANCE` are omitted.

    Raises:
        DataError: no node of a flexible body is near enough; the message contains the nearest node and its distance.
    """
    nodes: dict[Point, str] = {}
    for name, point in points.items():
        gap = np.linalg.norm(body.positions - np.array(point), axis=1)
        best = int(np.argmin(gap))
        distance, tolerance = float(gap[best]), body.hardpoint_tolerance
        if not body.frequencies.size:
            if distance <= LARGEST_TOLERANCE:
                nodes[point] = body.nodes[best]
            continue
        if not distance <= tolerance:
            raise DataError(
                f"superelement {body.name!r}: no node at the attachment {name} of the car, {list(point)} m; the "
                f"nearest is {body.nodes[best]!r} at {body.positions[best].tolist()} m, {distance * 1e3:.4g} mm "
                f"away but must be at most {tolerance * 1e3:g} mm. Choose the car of this body (--vehicle), move the "
                "hardpoint, use a body model with a node there, or compute the body from the hardpoints "
                "(body.superelement = body_design.toml)."
            )
        nodes[point] = body.nodes[best]
    return nodes
