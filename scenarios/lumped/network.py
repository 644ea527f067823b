"""Network of masses, springs, bushings, elastomers and sliding pairs, assembled to a linear system.

    T = 1/2 sum m (row . x')^2,   V = 1/2 sum k (e . x + r . z)^2,   D = 1/2 sum c (e . x' + r . z')^2

Lagrange's equations d/dt(dT/dx') + dD/dx' + dV/dx = 0 give K = sum k e' e and Bk = -sum k e' r, and C, Bc likewise, so
that a wrong sign cannot break the symmetry.
"""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import FirstOrder, first_order
from vehicle.engines.linear.system import LinearSystem, Row, Slide, form_row
from vehicle.errors import ConfigurationError
from vehicle.model.laws.elastomer import Kelvin, Maxwell
from vehicle.model.laws.law import Numbers, Parallel

ROAD = "road"
"""Name of the input of a model with a single road."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Mass:
    """Point mass, or moment of inertia: T = m/2 sum over the axes of (row . x')^2."""

    mass: Numbers
    axes: tuple[Row, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class Link:
    """Linear element along one direction with the extension row . (x, z)."""

    row: Row
    law: Kelvin | Maxwell


@dataclass(frozen=True, kw_only=True, slots=True)
class Network:
    """Lumped model: coordinates, parts, and further outputs in addition to the coordinates.

    Arrays in the masses, laws and rows must broadcast together; they describe a stack of models.
    """

    coordinates: tuple[str, ...]
    masses: tuple[Mass, ...]
    links: tuple[Link, ...]
    outputs: Mapping[str, Row] = field(default_factory=dict)
    slides: tuple[Slide, ...] = ()
    inputs: tuple[str, ...] = (ROAD,)
    force: Row = field(default_factory=dict)  # Direction of an applied force F: the generalised force is row times F

    def system(self) -> LinearSystem:
        """Assemble the matrices of the model.

        Raises:
            ConfigurationError: a row has an unknown coordinate, parameters do not broadcast together, a coordinate
                carries no mass, or a Maxwell branch has no stiffness or no damping.
        """
        shape, n, w = self._stack(), len(self.coordinates), len(self.inputs)
        mass = np.zeros((*shape, n, n))
        for part in self.masses:
            for axis in part.axes:
                row = form_row(axis, self.coordinates, shape)
                mass += _each(part.mass, 2) * row[..., :, None] * row[..., None, :]
        if not (np.linalg.matrix_rank(mass) == n).all():
            raise ConfigurationError(f"network: a coordinate of {', '.join(self.coordinates)} carries no mass")
        joint_stiffness, joint_damping = np.zeros((2, *shape, n + w, n + w))  # Hessians of V and D over (x, z)
        branches: list[tuple[Vector, Maxwell]] = []
        for link in self.links:
            row = self._row(link.row, shape)
            square = row[..., :, None] * row[..., None, :]
            joint_stiffness += _each(link.law.stiffness, 2) * square
            if isinstance(link.law, Kelvin):
                joint_damping += _each(link.law.damping, 2) * square
                continue
            if not (np.asarray(link.law.relaxation_time) > 0.0).all():
                raise ConfigurationError(
                    "network: branch_stiffness and branch_damping of a Maxwell branch must be above 0.0"
                )
            branches.append((row, link.law))
        branch_rows = _stacked([row for row, _ in branches], (*shape, 0, n + w), axis=-2)

        def stacked_values(values: Sequence[Numbers]) -> Vector:
            return _stacked([np.broadcast_to(value, shape) for value in values], (*shape, 0), axis=-1)

        coordinate_outputs = ((name, {name: 1.0}) for name in self.coordinates)
        system = LinearSystem(
            coordinates=self.coordinates,
            inputs=self.inputs,
            mass=mass,
            damping=joint_damping[..., :n, :n],
            stiffness=joint_stiffness[..., :n, :n],
            input_damping=-joint_damping[..., :n, n:],
            input_stiffness=-joint_stiffness[..., :n, n:],
            branch_rows=branch_rows[..., :n],
            branch_inputs=branch_rows[..., n:],
            branch_stiffness=stacked_values([law.branch_stiffness for _, law in branches]),
            branch_time=stacked_values([law.relaxation_time for _, law in branches]),
            slide_rows=np.zeros((*shape, 0, n)),
            slide_inputs=np.zeros((*shape, 0, w)),
            constraints=np.zeros((0, n)),
            load=form_row(self.force, self.coordinates, shape),
            outputs={name: self._row(form, shape) for name, form in (*coordinate_outputs, *self.outputs.items())},
        )
        for slide in self.slides:
            system = system.with_slide(slide)
        return system

    def first_order(self) -> FirstOrder:
        """Return the first-order form of the model with free sliding pairs; raises the errors of `system`."""
        return first_order(self.system())

    def _row(self, form: Row, shape: tuple[int, ...]) -> Vector:
        return form_row(form, (*self.coordinates, *self.inputs), shape)

    def _stack(self) -> tuple[int, ...]:
        """Return the common shape of all masses, coefficients and law parameters."""
        rows = [axis for part in self.masses for axis in part.axes]
        rows += [link.row for link in self.links] + [slide.row for slide in self.slides] + list(self.outputs.values())
        shapes = [np.shape(part.mass) for part in self.masses]
        shapes += [np.shape(value) for row in rows for value in row.values()]
        for law in (*(link.law for link in self.links), *(law for s in self.slides for law in (s.friction, s.viscous))):
            shapes += _law_shapes(law)
        try:
            return np.broadcast_shapes(*shapes)
        except ValueError:
            listed = ", ".join(sorted({str(shape) for shape in shapes}))
            raise ConfigurationError(f"network: parameters of shapes {listed} do not broadcast together") from None


def masses_of(masses: Mapping[str, Numbers]) -> tuple[Mass, ...]:
    """Return the masses of coordinates: name -> mass [kg] or moment of inertia [kg m2]."""
    return tuple(Mass(mass=mass, axes=({name: 1.0},)) for name, mass in masses.items())


def spring_damper(row: Row, stiffness: Numbers, damping: Numbers) -> Link:
    """Return a spring k [N/m] and a damper c [N s/m] in parallel along a linear form of coordinates and inputs."""
    return Link(row=row, law=Kelvin(stiffness=stiffness, damping=damping))


def _law_shapes(law: Any) -> list[tuple[int, ...]]:
    """Return the shapes of the law parameters, which also define the stack of models."""
    if isinstance(law, Parallel):
        return [shape for member in law.laws for shape in _law_shapes(member)]
    if not dataclasses.is_dataclass(law):
        return []
    return [np.shape(getattr(law, entry.name)) for entry in dataclasses.fields(law)]


def _each(value: Numbers, axes: int) -> Vector:
    """Return a parameter with further axes of length one, for products with vectors or matrices."""
    array = np.asarray(value, dtype=float)
    return array.reshape(array.shape + (1,) * axes)


def _stacked(rows: Sequence[Vector], empty: tuple[int, ...], axis: int) -> Vector:
    return np.stack(rows, axis=axis) if rows else np.zeros(empty)
