"""Trimmed body as a space frame: modes of a body design with the hardpoints and mass properties of a vehicle."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.beam import frame_stiffness
from vehicle.model.flexbody.body_design import BodyDesign
from vehicle.model.flexbody.body_loads import BodyLoad, load_mass, loaded_properties
from vehicle.model.flexbody.carried_nodes import with_carried_nodes
from vehicle.model.flexbody.frame_modes import condense_rotations, free_free_modes
from vehicle.model.flexbody.mode_names import mode_names
from vehicle.model.flexbody.node_masses import NodeProperties
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.parameters.body import TrimmedBody
from vehicle.model.parameters.hardpoints import COINCIDENT_M, Point


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyFrame:
    """Space frame of a body; its stiffness matrix is linear in one factor per member group."""

    design: BodyDesign
    """body design from which the frame was built"""
    skeleton: Superelement
    """nodes, masses and lines of the frame, without modes"""
    fixed_stiffness: Vector
    """stiffness independent of the factors [N/m, N, N m], shape (6 n, 6 n)"""
    group_stiffness: Mapping[str, Vector]
    """member group -> stiffness at factor 1 [N/m, N, N m], shape (6 n, 6 n)"""
    loads: tuple[BodyLoad, ...] = ()
    """loads on the body"""

    @property
    def node_mass(self) -> Vector:
        """Lumped masses [kg], shape (n,)."""
        assert self.skeleton.node_mass is not None
        return self.skeleton.node_mass

    def modes(self, factors: Mapping[str, float], count: int) -> tuple[Vector, Vector]:
        """Compute the lowest free modes: frequencies [Hz], (count,), mass-normalised shapes [kg^-1/2], (count, n, 3).

        Args:
            factors: factor of every member group [1].
            count: number of elastic modes.
        """
        condensed, _ = condense_rotations(self._stiffness(factors))
        skeleton = self.skeleton
        added = load_mass(skeleton.positions, self.loads, skeleton.hardpoint_tolerance) if self.loads else None
        return free_free_modes(condensed, self.node_mass, skeleton.positions, count, added)

    def _stiffness(self, factors: Mapping[str, float]) -> Vector:
        """Return the stiffness of all members [N/m, N, N m], shape (6 n, 6 n)."""
        stiffness = self.fixed_stiffness.copy()
        for group, matrix in self.group_stiffness.items():
            stiffness += factors[group] * matrix
        return stiffness

    def superelement(self) -> Superelement:
        """Return the modal superelement of the frame."""
        skeleton, count = self.skeleton, int(self.design.mode_count)
        factors = self.design.factors
        frequencies, shapes = self.modes(factors, count)
        rotations = {}
        if self.design.node_rotations:
            # Nodes have no rotational inertia, so the displacements determine the rotations statically.
            _, recovery = condense_rotations(self._stiffness(factors))
            rotation = (recovery @ shapes.reshape(count, -1).T).reshape(-1, 6, count)[:, 3:]
            rotations = {node: node_rotation.T for node, node_rotation in zip(skeleton.nodes, rotation, strict=True)}
        loaded = loaded_properties(skeleton.rigid, self.loads) if self.loads else None
        return replace(
            skeleton,
            node_mass=None if self.loads else skeleton.node_mass,
            mass_properties=loaded,
            frequencies=frequencies,
            damping_ratio=np.full(count, self.design.damping_ratio),
            shapes=shapes,
            rotations=rotations,
            mode_names=mode_names(shapes, skeleton.nodes, skeleton.positions, self.node_mass),
        )


def skeleton(design: BodyDesign, points: Mapping[str, Point]) -> Superelement:
    """Return a body without modes from a design on a car, with estimated masses: a rigid body, or the base of a frame.

    Args:
        design: members, joints of the shell, attachments.
        points: interface and output points of the car [m], by name.

    Raises:
        ConfigurationError: the design names an unknown hardpoint or node.
    """
    placed = design.placed(points)
    entries = {node: design.nodes[name] for name, nodes in placed.items() for node in nodes}
    positions = {node: np.array(position) for nodes in placed.values() for node, position in nodes.items()}
    index = {name: i for i, name in enumerate(positions)}
    tubes = [group for group, members in design.members.items() if members.area is None]  # struts stand for panels
    lines = [ends for group in tubes for ends in design.member_ends(group, placed)]
    return Superelement(
        name=design.name,
        nodes=tuple(positions),
        positions=np.array(list(positions.values())),
        edges=np.array([(index[a], index[b]) for a, b in lines]),
        node_mass=np.array([entry.mass for entry in entries.values()]),
        frequencies=np.zeros(0),
        damping_ratio=np.zeros(0),
        shapes=np.zeros((0, len(positions), 3)),
        mode_names=(),
        residual={
            node: np.diag(1.0 / np.array(entry.attachment))
            for node, entry in entries.items()
            if entry.attachment is not None
        },
        provenance=design.provenance,
    )


def body_frame(design: BodyDesign, points: Mapping[str, Point], properties: NodeProperties) -> BodyFrame:
    """Build the frame of a design on the hardpoints of a car, with its mass, centre of gravity and inertia.

    Args:
        design: body design.
        points: interface and output points of the car [m], by name.
        properties: mass properties of the body.

    Raises:
        ConfigurationError: see `skeleton`; a node without a tube, a member without length, fewer elastic modes than
            `mode_count`, or no positive node masses with the mass properties.
    """
    base, placed = skeleton(design, points), design.placed(points)
    count, positions = len(base.nodes), base.positions
    if design.mode_count > 3 * count - 6:
        raise ConfigurationError(
            f"mode_count: found {design.mode_count:g}, must be at most {3 * count - 6}, the elastic modes of {count} "
            "nodes"
        )
    loose = [name for i, name in enumerate(base.nodes) if i not in base.edges]
    if loose:
        raise ConfigurationError(
            f"nodes: {', '.join(loose)} could turn freely, because no tube ends there; add members with width and wall"
        )
    fixed = np.zeros((6 * count, 6 * count))
    groups: dict[str, Vector] = {}
    for group, members in design.members.items():
        ends = [(base.node_index(a), base.node_index(b)) for a, b in design.member_ends(group, placed)]
        for a, b in ends:
            if (distance := float(np.linalg.norm(positions[a] - positions[b]))) < COINCIDENT_M:
                raise ConfigurationError(
                    f"members.{group}: {base.nodes[a]} at {positions[a].tolist()} m and {base.nodes[b]} are "
                    f"{distance:.3g} m apart but must be at least {COINCIDENT_M:g} m. Move the hardpoint, or change "
                    "the place of the node in the body design"
                )
        scaled_section, fixed_section = members.sections(design.youngs_modulus, design.shear_modulus)
        groups[group] = frame_stiffness(positions, [(a, b, scaled_section) for a, b in ends])
        if fixed_section.axial > 0.0:
            fixed += frame_stiffness(positions, [(a, b, fixed_section) for a, b in ends])
    freedom = np.array([design.nodes[name].freedom for name, nodes in placed.items() for _ in nodes])
    assert base.node_mass is not None
    masses = properties.masses(base.node_mass, freedom, positions)
    loaded = replace(base, node_mass=masses)
    return BodyFrame(design=design, skeleton=loaded, fixed_stiffness=fixed, group_stiffness=groups)


def design_superelement(
    design: BodyDesign,
    points: Mapping[str, Point],
    attachments: Mapping[str, Point],
    body: TrimmedBody,
    loads: tuple[BodyLoad, ...] = (),
) -> Superelement:
    """Return the modal superelement of a design on a car, cached by points and mass properties.

    Args:
        design: body design.
        points: hardpoints of the car [m], by name.
        attachments: points with a force on the body or an output [m], by name; the body gets a node at each.
        body: mass properties of the body in the vehicle file.
        loads: loads on the body.

    Returns:
        Superelement; with loads, its masses are multiplied by `body.model_factor`.

    Raises:
        ConfigurationError: see `body_frame`.
    """
    properties = NodeProperties.of_body(body, design.least_ixx)
    point_sets = tuple(points.items()), tuple(attachments.items())
    if not loads:
        return _built(design, *point_sets, properties)
    return _built(design, *point_sets, properties, loads, body.model_factor)


NamedPoints = tuple[tuple[str, Point], ...]


@lru_cache(maxsize=32)
def _built(
    design: BodyDesign,
    points: NamedPoints,
    attachments: NamedPoints,
    properties: NodeProperties,
    loads: tuple[BodyLoad, ...] = (),
    factor: float = 1.0,
) -> Superelement:
    frame = body_frame(design, dict(points), properties)
    if loads:
        heavier = replace(frame.skeleton, node_mass=factor * frame.node_mass)
        frame = replace(frame, skeleton=heavier, loads=loads)
    return with_carried_nodes(frame.superelement(), dict(attachments))
