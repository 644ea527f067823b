"""The trimmed body as a space frame: a design on the hardpoints and with the masses of a vehicle, modes out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.flexbody.beam import FloatArray, frame_stiffness
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
    """Matrices of the frame; the stiffness is linear in one factor for each member group."""

    design: BodyDesign
    """what it was made from"""
    skeleton: Superelement
    """nodes, masses and lines of it, without modes"""
    fixed_stiffness: FloatArray
    """what no factor scales [N/m, N, N m], shape (6 n, 6 n)"""
    group_stiffness: Mapping[str, FloatArray]
    """member group -> stiffness at factor 1, shape (6 n, 6 n)"""
    loads: tuple[BodyLoad, ...] = ()
    """loads on it"""

    @property
    def node_mass(self) -> FloatArray:
        """Lumped masses [kg], shape (n,)."""
        assert self.skeleton.node_mass is not None
        return self.skeleton.node_mass

    def modes(self, factors: Mapping[str, float], count: int) -> tuple[FloatArray, FloatArray]:
        """Free-free modes.

        Args:
            factors: factor of every member group [1].
            count: number of elastic modes.

        Returns:
            Frequencies [Hz], shape (count,); mass-normalised shapes [kg^-1/2], shape (count, n, 3).
        """
        condensed, _ = condense_rotations(self._stiffness(factors))
        rest = self.skeleton
        added = load_mass(rest.positions, self.loads, rest.hardpoint_tolerance) if self.loads else None
        return free_free_modes(condensed, self.node_mass, rest.positions, count, added)

    def _stiffness(self, factors: Mapping[str, float]) -> FloatArray:
        """Stiffness of all members [N/m, N, N m], shape (6 n, 6 n)."""
        stiffness = self.fixed_stiffness.copy()
        for group, matrix in self.group_stiffness.items():
            stiffness += factors[group] * matrix
        return stiffness

    def superelement(self, factors: Mapping[str, float] | None = None) -> Superelement:
        """The modal superelement of the frame; factors of the member groups: by default those of the design."""
        rest, count = self.skeleton, int(self.design.mode_count)
        factors = self.design.factors if factors is None else factors
        frequencies, shapes = self.modes(factors, count)
        rotations = {}
        if self.design.node_rotations:
            # They follow the displacements, as nothing resists them but the members.
            _, recovery = condense_rotations(self._stiffness(factors))
            turns = (recovery @ shapes.reshape(count, -1).T).reshape(-1, 6, count)[:, 3:]
            rotations = {node: turn.T for node, turn in zip(rest.nodes, turns, strict=True)}
        loaded = loaded_properties(rest.rigid, self.loads) if self.loads else None
        return replace(
            rest,
            node_mass=None if self.loads else rest.node_mass,
            mass_properties=loaded,
            frequencies=frequencies,
            damping_ratio=np.full(count, self.design.damping_ratio),
            shapes=shapes,
            rotations=rotations,
            mode_names=mode_names(shapes, rest.nodes, rest.positions, self.node_mass),
        )


def skeleton(design: BodyDesign, points: Mapping[str, Point]) -> Superelement:
    """The body of a design on a car without modes, its masses as guessed: all of a rigid body, the start of a frame.

    Args:
        design: members, joints of the shell, attachments.
        points: interface and output points.

    Raises:
        ConfigurationError: a name of the design leads nowhere.
    """
    placed = design.placed(points)
    entries = {node: design.nodes[name] for name, made in placed.items() for node in made}
    places = {node: np.array(place) for made in placed.values() for node, place in made.items()}
    index = {name: i for i, name in enumerate(places)}
    tubes = [group for group, members in design.members.items() if members.area is None]  # struts stand for panels
    lines = [ends for group in tubes for ends in design.member_ends(group, placed)]
    return Superelement(
        name=design.name,
        nodes=tuple(places),
        positions=np.array(list(places.values())),
        edges=np.array([(index[a], index[b]) for a, b in lines]),
        node_mass=np.array([entry.mass for entry in entries.values()]),
        frequencies=np.zeros(0),
        damping_ratio=np.zeros(0),
        shapes=np.zeros((0, len(places), 3)),
        mode_names=(),
        residual={
            node: np.diag(1.0 / np.array(entry.attachment))
            for node, entry in entries.items()
            if entry.attachment is not None
        },
        provenance=design.provenance,
    )


def body_frame(design: BodyDesign, points: Mapping[str, Point], properties: NodeProperties) -> BodyFrame:
    """The frame of a design on the hardpoints of a car, with its mass, centre of gravity and inertia.

    Args:
        design: of the body.
        points: interface and output points of the car.
        properties: mass properties of the car.

    Returns:
        The frame.

    Raises:
        ConfigurationError: as of `skeleton`; a node without a tube, or a member without length; fewer elastic modes
            than wanted; no positive node masses with the mass properties.
    """
    rest, placed = skeleton(design, points), design.placed(points)
    count, positions = len(rest.nodes), rest.positions
    if design.mode_count > 3 * count - 6:
        raise ConfigurationError(
            f"mode_count: found {design.mode_count:g}, but {count} nodes have {3 * count - 6} elastic modes"
        )
    loose = [name for i, name in enumerate(rest.nodes) if i not in rest.edges]
    if loose:
        raise ConfigurationError(
            f"nodes: no tube ends at {', '.join(loose)}, which could turn freely; add members with width and wall"
        )
    fixed = np.zeros((6 * count, 6 * count))
    groups: dict[str, FloatArray] = {}
    for group, members in design.members.items():
        ends = [(rest.node_index(a), rest.node_index(b)) for a, b in design.member_ends(group, placed)]
        for a, b in ends:
            if (distance := float(np.linalg.norm(positions[a] - positions[b]))) < COINCIDENT_M:
                raise ConfigurationError(
                    f"members.{group}: {rest.nodes[a]} at {positions[a].tolist()} m and {rest.nodes[b]} are "
                    f"{distance:.3g} m apart; a member needs {COINCIDENT_M:g} m and more. Move the hardpoint, or the "
                    "place of a node in the body design"
                )
        scaled, stays = members.sections(design.youngs_modulus, design.shear_modulus)
        groups[group] = frame_stiffness(positions, [(a, b, scaled) for a, b in ends])
        if stays.axial > 0.0:
            fixed += frame_stiffness(positions, [(a, b, stays) for a, b in ends])
    freedom = np.array([design.nodes[name].freedom for name, made in placed.items() for _ in made])
    assert rest.node_mass is not None
    masses = properties.masses(rest.node_mass, freedom, positions)
    loaded = replace(rest, node_mass=masses)
    return BodyFrame(design=design, skeleton=loaded, fixed_stiffness=fixed, group_stiffness=groups)


def design_superelement(
    design: BodyDesign,
    points: Mapping[str, Point],
    attachments: Mapping[str, Point],
    body: TrimmedBody,
    loads: tuple[BodyLoad, ...] = (),
) -> Superelement:
    """The modal superelement of a design on a car, computed once for the same points and masses.

    Args:
        design: of the body.
        points: of the car.
        attachments: those at which something acts on the body, or is measured: it has a node at each.
        body: mass properties of the car.
        loads: on the body.

    Returns:
        The body; with loads, that with its masses times `body.model_factor`.

    Raises:
        ConfigurationError: as of `body_frame`.
    """
    properties = NodeProperties.of_body(body, design.least_ixx)
    places = tuple(points.items()), tuple(attachments.items())
    if not loads:
        return _built(design, *places, properties)
    return _built(design, *places, properties, loads, body.model_factor)


Places = tuple[tuple[str, Point], ...]


@lru_cache(maxsize=32)
def _built(
    design: BodyDesign,
    points: Places,
    attachments: Places,
    properties: NodeProperties,
    loads: tuple[BodyLoad, ...] = (),
    factor: float = 1.0,
) -> Superelement:
    frame = body_frame(design, dict(points), properties)
    if loads:
        heavier = replace(frame.skeleton, node_mass=factor * frame.node_mass)
        frame = replace(frame, skeleton=heavier, loads=loads)
    return with_carried_nodes(frame.superelement(), dict(attachments))
