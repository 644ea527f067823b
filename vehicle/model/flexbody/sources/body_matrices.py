"""Stiffness and mass of a free finite-element body, with what each degree of freedom is."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import ConfigurationError, DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.parameters.hardpoints import Point

IntArray = npt.NDArray[np.intp]

_RIGID_MOTION = 1e-3
"""Largest frequency of a rigid motion over the first elastic one. Entries with seven digits give 1e-4; ground springs,
or elements that resist a rotation, 0.01 and more."""

DIRECTIONS = 9
"""Directions of a node: three displacements, three rotations, three amplitudes inside an element."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyNodes:
    """Nodes of a body and what each degree of freedom of its vectors is.

    Attributes:
        nodes: names of the nodes; (n,).
        positions: of the nodes [m], shape (n, 3).
        node: node of each degree of freedom, an index; shape (dofs,).
        direction: 0 to 2 for displacements along x, y, z, 3 to 5 for rotations about them, 6 to 8 for amplitudes along
            x, y, z of shapes inside an element, which no rigid motion has; shape (dofs,).
        edges: lines of the picture, pairs of node indices; shape (m, 2).
        source: file, program and units, in words.
    """

    nodes: tuple[str, ...]
    positions: FloatArray
    node: IntArray
    direction: IntArray
    edges: IntArray
    source: str

    def displacements(self, vectors: FloatArray) -> FloatArray:
        """Displacements of all nodes by vectors (dofs, modes), shape (modes, n, 3)."""
        found = np.zeros((vectors.shape[1], len(self.nodes), 3))
        moving = self.direction < 3
        found[:, self.node[moving], self.direction[moving]] = vectors[moving].T
        return found

    def frame(self, axes: str, origin: Point) -> tuple[BodyNodes, FloatArray]:
        """The nodes in the vehicle frame.

        Args:
            axes: what the source calls the vehicle's x (to the rear), y (to the driver's right) and z (up), as
                "-x,-y,z" of a source with x forward and y to the left.
            origin: place of the source's origin in the vehicle frame [m].

        Returns:
            The nodes; the sign that each degree of freedom takes, shape (dofs,).

        Raises:
            ConfigurationError: no three different axes, or mirrored ones.
        """
        found = re.fullmatch(r" *([+-]?)([xyz]) *, *([+-]?)([xyz]) *, *([+-]?)([xyz]) *", axes)
        turn = np.zeros((3, 3))
        for i in range(3) if found else ():
            turn[i, "xyz".index(found[2 * i + 2])] = -1.0 if found[2 * i + 1] == "-" else 1.0  # type: ignore[index]
        if not np.linalg.det(turn) > 0.5:
            raise ConfigurationError(
                f"--axes {axes}: needed are three different axes that are not mirrored, the source's names of the "
                "vehicle's x (to the rear), y (to the driver's right), z (up), as -x,-y,z"
            )
        old = np.abs(turn).argmax(axis=0)  # the vehicle's axis of each axis of the source
        sign = turn.sum(axis=0)[self.direction % 3]
        return replace(
            BodyNodes(**{field.name: getattr(self, field.name) for field in fields(BodyNodes)}),
            positions=self.positions @ turn.T + np.array(origin),
            direction=old[self.direction % 3] + 3 * (self.direction // 3),
        ), sign


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BodyMatrices(BodyNodes):
    """K [N/m, N, N m] and M [kg, kg m, kg m2] of a body that nothing holds: sparse, symmetric, shape (dofs, dofs)."""

    stiffness: Any
    mass: Any

    def __post_init__(self) -> None:
        size = len(self.node)
        for name, matrix in (("stiffness", self.stiffness), ("mass", self.mass)):
            if matrix.shape != (size, size):
                raise DataError(
                    f"{name}: {matrix.shape[0]} rows and {matrix.shape[1]} columns for {size} degrees of freedom. Give "
                    "the list of degrees of freedom of these matrices, in their order."
                )
            if not np.all(np.isfinite(matrix.data)):
                raise DataError(f"{name}: holds {np.sum(~np.isfinite(matrix.data))} entries that are not finite.")
            largest = np.abs(matrix.data).max(initial=0.0)
            if largest == 0.0:
                raise DataError(f"{name}: all entries are zero.")
            if np.abs((matrix - matrix.T).data).max(initial=0.0) > 1e-6 * largest:
                raise DataError(
                    f"{name}: not symmetric. Give the whole matrix or one triangle of it; gyroscopic and follower "
                    "terms do not belong into a free body."
                )
        pairs = self.node * DIRECTIONS + self.direction
        values, counts = np.unique(pairs, return_counts=True)
        if counts.max(initial=1) > 1:
            node, direction = divmod(int(values[counts.argmax()]), DIRECTIONS)
            raise DataError(f"degree of freedom {direction + 1} of node {self.nodes[node]} is given twice.")
        loose = np.flatnonzero(np.asarray(abs(self.stiffness).sum(axis=1)).ravel() == 0.0)
        if loose.size:
            where = self.nodes[self.node[loose[0]]]
            raise DataError(
                f"stiffness: degree of freedom {self.direction[loose[0]] + 1} of node {where} has none, and "
                f"{loose.size - 1} others: nothing holds it. Leave it out, or connect the node."
            )

    def scaled(self, length: float, mass: float) -> BodyMatrices:
        """The same body in SI units.

        Args:
            length: unit of length of the source [m].
            mass: unit of mass of the source [kg]; the unit of time is the second.

        Returns:
            K e T'K T and M e T'M T with e = mass length^2, T = 1 of a rotation, else 1/length.
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
        """The same body in the vehicle frame, as of `BodyNodes.frame`."""
        moved, sign = self.frame(axes, origin)
        flip = scipy.sparse.diags(sign)
        stiffness, mass = (flip @ self.stiffness @ flip).tocsc(), (flip @ self.mass @ flip).tocsc()
        return replace(self, positions=moved.positions, direction=moved.direction, stiffness=stiffness, mass=mass)

    def rigid_motions(self, centre: FloatArray) -> FloatArray:
        """Unit translations and rotations about a point [m, rad], shape (dofs, 6)."""
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
        """Mass, CoG and inertia from R' M R.

        Raises:
            DataError: the mass differs by direction, or a rotation has no inertia.
        """
        origin = self.rigid_motions(np.zeros(3))
        total = origin.T @ (self.mass @ origin)
        masses = np.diag(total)[:3]
        mass = float(masses.mean())
        if mass <= 0.0 or np.ptp(masses) > 1e-6 * mass:
            raise DataError(
                f"mass: {masses.tolist()} kg along x, y and z; of a whole body they are the same and positive. Give "
                "the mass matrix of all nodes, without the degrees of freedom of a support left out."
            )
        moments = total[:3, 3:] / mass
        # Displacement by a rotation about the origin: w x r, so the block is -m [c]x.
        cog = 0.5 * np.array(
            [moments[1, 2] - moments[2, 1], moments[2, 0] - moments[0, 2], moments[0, 1] - moments[1, 0]]
        )
        central = self.rigid_motions(cog)
        inertia = (central.T @ (self.mass @ central))[3:, 3:]
        inertia = 0.5 * (inertia + inertia.T)
        lowest, highest = np.linalg.eigvalsh(inertia)[[0, -1]]
        if lowest <= 1e-9 * highest:
            raise DataError(
                f"mass: principal moments of inertia {lowest:.3g} to {highest:.3g} kg m2; all mass lies on one line. "
                "Point masses on a line need rotational inertia (or mass beside it)."
            )
        return MassProperties(mass=mass, cog=cog, inertia=inertia)

    def rigid_frequency(self, rigid: MassProperties) -> float:
        """Highest frequency that the stiffness gives to a rigid motion [Hz]: zero of a body that nothing holds."""
        motions = self.rigid_motions(rigid.cog)
        values = scipy.linalg.eigvalsh(motions.T @ (self.stiffness @ motions), motions.T @ (self.mass @ motions))
        return float(np.sqrt(max(0.0, values[-1], -values[0])) / (2.0 * np.pi))

    def require_free(self, rigid_frequency: float, first_elastic: float) -> None:
        """Refuse a stiffness that holds rigid motions.

        Raises:
            DataError: it does; with the frequency that it gives them.
        """
        if rigid_frequency > _RIGID_MOTION * first_elastic:
            raise DataError(
                f"stiffness: rigid motions are held, at {rigid_frequency:.3g} Hz, while the first elastic mode is at "
                f"{first_elastic:.4g} Hz: it holds a support, its nodes are in other axes or units than the matrices, "
                "or it has elements that resist rotations (CalculiX expands shells and beams to solids with such "
                "constraints). Export the matrices of the free body, of solid elements where CalculiX makes them."
            )
