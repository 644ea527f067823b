"""The trimmed body as a space frame: geometry, sections and masses in, modes out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.flexbody.beam import FloatArray, frame_stiffness
from vehicle.flexbody.modes import condense_rotations, free_free_modes
from vehicle.flexbody.node_masses import body_masses
from vehicle.flexbody.sections import SECTIONS
from vehicle.flexbody.wireframe import MEMBERS, member_ends, node_positions


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyFrame:
    """Matrices of the frame; the stiffness is linear in one factor for each member group."""

    nodes: tuple[str, ...]
    """node names"""
    positions: FloatArray
    """[m], shape (n, 3)"""
    node_mass: FloatArray
    """[kg], shape (n,)"""
    edges: FloatArray
    """wireframe lines as node indices, shape (m, 2)"""
    fixed_stiffness: FloatArray
    """what no factor scales [N/m, N, N m], shape (6 n, 6 n)"""
    group_stiffness: Mapping[str, FloatArray]
    """member group -> stiffness at factor 1, shape (6 n, 6 n)"""

    def modes(self, factors: Mapping[str, float], count: int) -> tuple[FloatArray, FloatArray]:
        """Free-free modes.

        Args:
            factors: factor of every member group [1].
            count: number of elastic modes.

        Returns:
            Frequencies [Hz], shape (count,); mass-normalised shapes [kg^-1/2], shape (count, n, 3).
        """
        stiffness = self.fixed_stiffness.copy()
        for group, matrix in self.group_stiffness.items():
            stiffness += factors[group] * matrix
        condensed, _ = condense_rotations(stiffness)
        return free_free_modes(condensed, self.node_mass, self.positions, count)


def trimmed_body_frame() -> BodyFrame:
    """The frame of the estate car of `wireframe.py` with the sections of `sections.py` and the masses of the thesis."""
    points = node_positions()
    nodes = tuple(points)
    positions = np.array(list(points.values()))
    index = {name: i for i, name in enumerate(nodes)}
    fixed = np.zeros((6 * len(nodes), 6 * len(nodes)))
    groups: dict[str, FloatArray] = {}
    edges: list[tuple[int, int]] = []
    for group in MEMBERS:
        ends = [(index[first], index[second]) for first, second in member_ends(group)]
        section = SECTIONS[group]
        groups[group] = frame_stiffness(positions, [(a, b, section.scaled) for a, b in ends])
        fixed += frame_stiffness(positions, [(a, b, section.fixed) for a, b in ends])
        if section.fixed.axial > 0.0:  # panel struts are no lines of the picture
            edges += ends
    return BodyFrame(
        nodes=nodes,
        positions=positions,
        node_mass=body_masses(nodes, positions),
        edges=np.array(edges),
        fixed_stiffness=fixed,
        group_stiffness=groups,
    )
