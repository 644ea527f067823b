"""The modal superelement: a flexible body as mass properties, free-free modes at nodes, and residual flexibility.

A displacement of a node is that of the rigid body plus Phi_n q, with q'' + 2 zeta w q' + w^2 q = Phi_n' f. What the
modes above those that are kept give way to a force is the residual flexibility of its node, G_n = sum of phi phi' / w^2
[m/N], in series with what is fixed there. So no mass matrix is needed: mass properties, modal masses of one, shapes.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement_checks import LARGEST_TOLERANCE, check_superelement
from vehicle.model.parameters.hardpoints import Point

ARRAYS = ("positions", "node_mass", "frequencies", "damping_ratio", "shapes")


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
    edges: npt.NDArray[np.intp] | FloatArray
    """wireframe lines as pairs of node indices, shape (m, 2), integers"""
    node_mass: FloatArray | None = None
    """lumped translational masses, where the body is nothing else [kg], shape (n,); the checks are exact with them"""
    mass_properties: MassProperties | None = None
    """mass, CoG and inertia, where no masses of nodes are known"""
    frequencies: FloatArray
    """natural frequencies of the free body, ascending [Hz], shape (modes,); none of a rigid body"""
    damping_ratio: FloatArray
    """share of critical damping of each mode [1], shape (modes,)"""
    shapes: FloatArray
    """mass-normalised mode shapes, translations in the vehicle frame [kg^-1/2], shape (modes, n, 3)"""
    rotations: Mapping[str, FloatArray] = field(default_factory=dict)
    """node -> its rotation in the same modes, where it is known [rad m^-1 kg^-1/2], shape (modes, 3)"""
    residual: Mapping[str, FloatArray] = field(default_factory=dict)
    """node -> residual flexibility, symmetric [m/N], shape (3, 3)"""
    mode_names: tuple[str, ...]
    """one name for each mode"""
    provenance: str
    """where the numbers come from, in words: program, units and frame of the source, what was scaled"""
    hardpoint_tolerance: float = 1e-3
    """largest distance of a node from the hardpoint that it is measured for [m]"""
    derived: bool = field(default=False, repr=False)
    """made from a body that has been checked, which is not repeated for every car of a sweep"""

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
                    f"superelement {self.name!r}, {name}: not a regular array of numbers ({error}). "
                    "Give one row of three numbers for every node."
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
        """Mass, CoG and inertia: those of the node masses, or those given."""
        if self.node_mass is not None:
            return MassProperties.of_points(self.node_mass, self.positions)
        assert self.mass_properties is not None
        return self.mass_properties

    @property
    def mass(self) -> float:
        """Mass of the body [kg]."""
        return self.rigid.mass

    @property
    def cog(self) -> FloatArray:
        """Centre of gravity [m], shape (3,)."""
        return self.rigid.cog

    @property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the CoG [kg m2], shape (3, 3)."""
        return self.rigid.inertia

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
        return replace(
            self,
            frequencies=none,
            damping_ratio=none,
            shapes=np.zeros((0, len(self.nodes), 3)),
            rotations={},
            mode_names=(),
            derived=True,
        )

    def scaled(self, factor: float) -> Superelement:
        """Return the body with all its masses times a factor and its stiffness as it is.

        (K - w^2 f M) phi = 0 has the shapes of M, so that w goes with f^-1/2, and so do mass-normalised shapes.
        Residual flexibility is static and stays; each damping ratio stays.

        Args:
            factor: f [1].
        """
        if factor == 1.0:
            return self
        root, own = factor**-0.5, self.mass_properties
        return replace(
            self,
            node_mass=None if self.node_mass is None else factor * self.node_mass,
            mass_properties=None
            if own is None
            else MassProperties(mass=factor * own.mass, cog=own.cog, inertia=factor * own.inertia),
            frequencies=root * self.frequencies,
            shapes=root * self.shapes,
            rotations={node: root * turns for node, turns in self.rotations.items()},
            derived=True,
        )

    def up_to(self, frequency: float, kept: Collection[str]) -> Superelement:
        """The body with its modes up to a frequency; the others as residual flexibility of the nodes that are used.

        A mode at f_i that answers statically is wrong by (f/f_i)^2 / (1 - (f/f_i)^2) of its own share at f.

        Args:
            frequency: modes above are left out [Hz].
            kept: names of the nodes where something acts on the body.
        """
        count = int(np.searchsorted(self.frequencies, frequency, side="right"))
        if count == len(self.frequencies):
            return self
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

    def combined(self, spread: FloatArray, kept: Collection[str]) -> Superelement:
        """The body in combinations of its modes, without springs, at the nodes that are kept.

        Args:
            spread: modal coordinates by the new ones, shape (modes, new).
            kept: names of these nodes.
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
