"""Stiffness and mass matrices of a free finite-element body, with the node and direction of each degree of freedom."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import scipy

from vehicle.arrays import Indices, Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.parameters.hardpoints import Point

_RIGID_MOTION = 1e-3
"""Maximum frequency of a rigid motion over that of the first elastic mode [1]. Matrix entries with seven digits give
1e-4; ground springs, or elements that resist a rotation, 0.01 and more."""

_LARGEST_ROUNDED = 0.05
"""Maximum frequency of a rigid motion that rounding explains, over that of the first elastic mode [1]: 0.25 % of its
stiffness."""

_FEWEST_DIGITS, _MOST_DIGITS = 7, 13
"""Digits of the entries of a file that are seen as rounded: fewer may be round numbers, more have no effect."""

DIRECTIONS = 9
"""Number of directions per node: three displacements, three rotations, three amplitudes inside an element."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyNodes:
    """Nodes of a body, with the node and direction of each degree of freedom.

    Attributes:
        nodes: node names, shape (n,).
        positions: node positions [m], shape (n, 3).
        node: index of the node of each degree of freedom, shape (dofs,).
        direction: 0 to 2 for displacements along x, y, z, 3 to 5 for rotations about x, y, z, 6 to 8 for amplitudes
            along x, y, z of shapes inside an element (zero in rigid motions); shape (dofs,).
        edges: wireframe lines as pairs of node indices, shape (m, 2).
        source: file, program and units, as text.
    """

    nodes: tuple[str, ...]
    positions: Vector
    node: Indices
    direction: Indices
    edges: Indices
    source: str

    def displacements(self, vectors: Vector) -> Vector:
        """Return the displacements of all nodes, shape (modes, n, 3), for vectors of shape (dofs, modes)."""
        displacements = np.zeros((vectors.shape[1], len(self.nodes), 3))
        moving = self.direction < 3
        displacements[:, self.node[moving], self.direction[moving]] = vectors[moving].T
        return displacements

    def frame(self, axes: str, origin: Point) -> tuple[BodyNodes, Vector]:
        """Transform the nodes to the vehicle frame.

        Args:
            axes: source axes along the vehicle axes x (to the rear), y (to the driver's right) and z (up), for example
                "-x,-y,z" for a source with x forward and y to the left.
            origin: position of the origin of the source in the vehicle frame [m].

        Returns:
            Nodes in the vehicle frame; sign change of each degree of freedom (1 or -1), shape (dofs,).

        Raises:
            ConfigurationError: the axes are not three different axes, or left-handed.
        """
        match = re.fullmatch(r" *([+-]?)([xyz]) *, *([+-]?)([xyz]) *, *([+-]?)([xyz]) *", axes)
        rotation = np.zeros((3, 3))
        for i in range(3) if match else ():
            rotation[i, "xyz".index(match[2 * i + 2])] = -1.0 if match[2 * i + 1] == "-" else 1.0  # type: ignore[index]
        if not np.linalg.det(rotation) > 0.5:
            raise ConfigurationError(
                f"--axes {axes}: must be three different, right-handed source axes along the vehicle axes x (to the "
                "rear), y (to the driver's right) and z (up), for example -x,-y,z"
            )
        old = np.abs(rotation).argmax(axis=0)  # vehicle axis of each source axis
        # A column of a signed permutation has one entry, its sign; rotations have the sign of their axis.
        sign = rotation.sum(axis=0)[self.direction % 3]
        return replace(
            BodyNodes(**{field.name: getattr(self, field.name) for field in fields(BodyNodes)}),
            positions=self.positions @ rotation.T + np.array(origin),
            direction=old[self.direction % 3] + 3 * (self.direction // 3),
        ), sign


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyMatrices(BodyNodes):
    """K [N/m, N, N m] and M [kg, kg m, kg m2] of a free body: sparse, symmetric, shape (dofs, dofs)."""

    stiffness: Any
    mass: Any
    rounding: float = 0.0
    """Largest relative rounding error of the entries of K in their file."""

    def __post_init__(self) -> None:
        size = len(self.node)
        for name, matrix in (("stiffness", self.stiffness), ("mass", self.mass)):
            if matrix.shape != (size, size):
                raise DataError(
                    f"{name}: has {matrix.shape[0]} rows and {matrix.shape[1]} columns but must have {size}, the "
                    "number of degrees of freedom. Use the list of degrees of freedom of these matrices, in the "
                    "same order."
                )
            if not np.all(np.isfinite(matrix.data)):
                raise DataError(
                    f"{name}: contains {np.sum(~np.isfinite(matrix.data))} entries that are not finite. Export it "
                    "again."
                )
            largest = np.abs(matrix.data).max(initial=0.0)
            if largest == 0.0:
                raise DataError(f"{name}: all entries are zero. Export it again, with the mass or stiffness.")
            if np.abs((matrix - matrix.T).data).max(initial=0.0) > 1e-6 * largest:
                raise DataError(
                    f"{name}: is not symmetric. Export the complete matrix or one triangle, without gyroscopic "
                    "and follower terms."
                )
        pairs = self.node * DIRECTIONS + self.direction
        values, counts = np.unique(pairs, return_counts=True)
        if counts.max(initial=1) > 1:
            node, direction = divmod(int(values[counts.argmax()]), DIRECTIONS)
            raise DataError(
                f"degree of freedom {direction + 1} of node {self.nodes[node]} occurs twice. Remove one of them."
            )
        loose = np.flatnonzero(np.asarray(abs(self.stiffness).sum(axis=1)).ravel() == 0.0)
        if loose.size:
            where = self.nodes[self.node[loose[0]]]
            raise DataError(
                f"stiffness: degree of freedom {self.direction[loose[0]] + 1} of node {where} has no stiffness, "
                f"nor have {loose.size - 1} others. Leave them out, or connect the node."
            )

    def scaled(self, length: float, mass: float) -> BodyMatrices:
        """Convert the body to SI units.

        Args:
            length: unit of length of the source [m].
            mass: unit of mass of the source [kg]; the unit of time is the second.

        Returns:
            Body with K = e T'K T and M = e T'M T, where e = mass length^2, T = 1 for a rotation, else 1/length.
        """
        turn = scipy.sparse.diags(np.where(self.direction // 3 == 1, 1.0, 1.0 / length))
        energy = mass * length**2
        return replace(
            self,
            stiffness=(energy * (turn @ self.stiffness @ turn)).tocsc(),
            mass=(energy * (turn @ self.mass @ turn)).tocsc(),
            positions=self.positions * length,
        )

    def placed(self, axes: str, origin: Point) -> BodyMatrices:
        """Transform the body to the vehicle frame; see `BodyNodes.frame`."""
        moved, sign = self.frame(axes, origin)
        flip = scipy.sparse.diags(sign)
        stiffness, mass = (flip @ self.stiffness @ flip).tocsc(), (flip @ self.mass @ flip).tocsc()
        return replace(self, positions=moved.positions, direction=moved.direction, stiffness=stiffness, mass=mass)

    def rigid_motions(self, centre: Vector) -> Vector:
        """Return unit translations, and unit rotations about a centre [m, rad], shape (dofs, 6)."""
        motions = np.zeros((len(self.node), 6))
        arm = self.positions[self.node] - centre
        for axis in range(3):
            turned = np.cross(np.eye(3)[axis], arm)
            moving = self.direction < 3
            motions[self.direction == axis, axis] = 1.0
            motions[moving, 3 + axis] = turned[moving, self.direction[moving]]
            motions[self.direction == 3 + axis, 3 + axis] = 1.0
        return motions

    def mass_properties(self) -> MassProperties:
        """Compute mass, CoG and inertia from R' M R with the rigid motions R.

        Raises:
            DataError: the masses along x, y and z differ, or a rotation has no inertia.
        """
        origin = self.rigid_motions(np.zeros(3))
        total = origin.T @ (self.mass @ origin)
        # R' M R is [m 1, -m [c]x; ., I] for rotations about the origin.
        masses = np.diag(total)[:3]
        mass = float(masses.mean())
        if mass <= 0.0 or np.ptp(masses) > 1e-6 * mass:
            raise DataError(
                f"mass: found {masses.tolist()} kg along x, y and z, must be equal and positive. Export the mass "
                "matrix of all nodes, including supported degrees of freedom."
            )
        moments = total[:3, 3:] / mass
        # A rotation w about the origin displaces by w x r, so the block is -m [c]x.
        cog = 0.5 * np.array(
            [moments[1, 2] - moments[2, 1], moments[2, 0] - moments[0, 2], moments[0, 1] - moments[1, 0]]
        )
        central = self.rigid_motions(cog)
        inertia = (central.T @ (self.mass @ central))[3:, 3:]
        inertia = 0.5 * (inertia + inertia.T)
        lowest, highest = np.linalg.eigvalsh(inertia)[[0, -1]]
        if lowest <= 1e-9 * highest:
            raise DataError(
                f"mass: all mass is on one axis (principal moments of inertia {lowest:.3g} to {highest:.3g} kg "
                "m2). Add rotational inertia to the point masses, or add mass at points that do not lie on this axis."
            )
        return MassProperties(mass=mass, cog=cog, inertia=inertia)

    def rigid_frequency(self, rigid: MassProperties) -> float:
        """Return the highest frequency of a rigid motion due to the stiffness [Hz]; zero for an ideal free body."""
        motions = self.rigid_motions(rigid.cog)
        values = scipy.linalg.eigvalsh(motions.T @ (self.stiffness @ motions), motions.T @ (self.mass @ motions))
        return float(np.sqrt(max(0.0, values[-1], -values[0])) / (2.0 * np.pi))

    def rounding_frequency(self, rigid: MassProperties) -> float:
        """Return the frequency that the rounded entries of K may give to a rigid motion [Hz].

        Errors of at most d |k_ij|, uniform and independent, give a motion r the stiffness r' E r of the standard
        deviation d (2/3 sum_ij (k_ij r_i r_j)^2)^0.5. Three of it, and twice as much for motions that combine
        the six, are the limit.
        """
        unit = self.rigid_motions(rigid.cog)
        # Mass-normalised: R = unit L^-T.
        motions = np.linalg.solve(np.linalg.cholesky(unit.T @ (self.mass @ unit)), unit.T).T
        squares = np.einsum("ij,ij->j", motions**2, self.stiffness.multiply(self.stiffness) @ motions**2)
        stiffness = 6.0 * self.rounding * float(np.sqrt(2.0 / 3.0 * squares.max()))
        return float(np.sqrt(stiffness) / (2.0 * np.pi))

    def require_free(self, rigid_frequency: float, first_elastic: float, rounding_frequency: float = 0.0) -> None:
        """Check that the stiffness does not resist rigid motions.

        Args:
            rigid_frequency: highest frequency of a rigid motion [Hz].
            first_elastic: frequency of the first elastic mode [Hz].
            rounding_frequency: frequency that the rounding of the entries explains [Hz], see the method.

        Raises:
            DataError: the stiffness resists rigid motions; the message contains their frequency.
        """
        rounded = min(rounding_frequency, _LARGEST_ROUNDED * first_elastic)
        if rigid_frequency > max(_RIGID_MOTION * first_elastic, rounded):
            raise DataError(
                f"stiffness: the body is not free: its rigid motions have {rigid_frequency:.3g} Hz instead of 0, "
                f"its first elastic mode {first_elastic:.4g} Hz. Either the body is held by supports, or the nodes "
                "and the matrices use different axes or units, or some elements resist rotation (as do the "
                "constraints with which CalculiX expands shells and beams into solids). Export the matrices of the "
                "free body; with "
                "CalculiX, use solid elements."
            )


def rounding_of(matrix: Any) -> float:
    """Return the largest relative rounding error of the entries of a matrix as written in its file; 0 if unknown.

    Entries of n decimal digits are whole multiples of 10^(1 - n) of their magnitude, with errors of half of that.
    """
    entries = np.abs(matrix.data[matrix.data != 0.0])
    magnitude = np.floor(np.log10(entries))
    for digits in range(1, _MOST_DIGITS + 1):
        whole = entries * 10.0 ** (digits - 1 - magnitude)
        if np.all(np.abs(whole - np.rint(whole)) <= 1e-6 + 1e-15 * whole):
            return 0.5 * 10.0 ** (1 - digits) if digits >= _FEWEST_DIGITS else 0.0
    return 0.0
