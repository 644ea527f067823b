"""Linear system M, C, K with Maxwell branches, sliding pairs and joints: the form of every model of this package.

    M x'' + C x' + K x + sum_b h_b' f_b + sum_p s_p' phi_p = Bc z' + Bk z + l F,    Jc x = 0
    f_b' = K2 (e_b x' + g_b x + r_b z') - f_b / tau_b,    v_p = s_p x' + d_p z'

x are the coordinates, z the driven displacements, f_b the forces of Maxwell branches, phi_p the forces of sliding pairs
(friction and other forces that depend on their velocity v_p only), F an applied force, Jc the ideal joints. Leading
axes "..." denote a stack of systems. Most branches have g_b = 0 and h_b = e_b; a rolling tyre also slips sideways by
its heading, and its side force acts behind its centre. No force depends on the value of a cyclic coordinate, for
example the angle of a free wheel: only its velocity is a state.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.model.laws.law import ForceLaw, Numbers

Row = Mapping[str, Numbers]
"""Linear form: name of a coordinate or an input -> coefficient [-]; arrays for a stack of systems."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Slide:
    """Sliding pair along one direction with the velocity row . (x', z')."""

    row: Row
    friction: ForceLaw
    viscous: ForceLaw | None = None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LinearSystem:
    """Matrices of the equations above; n coordinates, w inputs, b branches, p sliding pairs, k joints.

    Attributes:
        coordinates: names of the coordinates, may be empty.
        inputs: names of the driven displacements.
        mass, damping, stiffness: M, C, K; (..., n, n).
        input_damping, input_stiffness: Bc, Bk; (..., n, w).
        branch_rows, branch_inputs: e_b and r_b; (..., b, n), (..., b, w).
        branch_stiffness, branch_time: K2 [N/m] and tau [s]; (..., b).
        slide_rows, slide_inputs: s_p and d_p; (..., p, n), (..., p, w).
        branch_drifts, branch_effects: g_b and h_b, (b, n); None for 0 and e_b.
        cyclic: positions of the cyclic coordinates; (c,).
        constraints: Jc; (k, n).
        load: l, direction of the applied force; (..., n).
        outputs: name -> coefficients of the coordinates, then of the inputs; (..., n + w).
        slides: laws of the sliding pairs; empty if their forces are given from outside.
    """

    coordinates: tuple[str, ...]
    inputs: tuple[str, ...]
    mass: Vector
    damping: Vector
    stiffness: Vector
    input_damping: Vector
    input_stiffness: Vector
    branch_rows: Vector
    branch_inputs: Vector
    branch_stiffness: Vector
    branch_time: Vector
    slide_rows: Vector
    slide_inputs: Vector
    constraints: Vector
    load: Vector
    outputs: Mapping[str, Vector]
    slides: tuple[Slide, ...] = ()
    branch_drifts: Vector | None = None
    branch_effects: Vector | None = None
    cyclic: tuple[int, ...] = ()

    @property
    def size(self) -> int:
        """Return the number of coordinates n."""
        return int(self.mass.shape[-1])

    @property
    def effects(self) -> Vector:
        """Return h_b; (..., b, n)."""
        return self.branch_rows if self.branch_effects is None else self.branch_effects

    def output(self, name: str) -> tuple[Vector, Vector]:
        """Return the coefficients of an output on the coordinates (..., n) and on the inputs (..., w).

        Raises:
            ConfigurationError: the output is unknown.
        """
        if name not in self.outputs:
            raise ConfigurationError(f"output {name!r}: unknown; choose from {', '.join(self.outputs)}")
        row = self.outputs[name]
        return row[..., : self.size], row[..., self.size :]

    def with_slide(self, slide: Slide) -> LinearSystem:
        """Add a sliding pair between any coordinates and inputs; raises the errors of `form_row`."""
        row = self.row(slide.row)[..., None, :]
        return replace(
            self,
            slide_rows=np.concatenate([self.slide_rows, row[..., : self.size]], axis=-2),
            slide_inputs=np.concatenate([self.slide_inputs, row[..., self.size :]], axis=-2),
            slides=(*self.slides, slide),
        )

    def row(self, form: Row) -> Vector:
        """Return the coefficients of a linear form, (..., n + w); raises the errors of `form_row`."""
        return form_row(form, (*self.coordinates, *self.inputs), self.mass.shape[:-2])


def form_row(form: Row, names: tuple[str, ...], shape: tuple[int, ...] = ()) -> Vector:
    """Convert a linear form to an array of coefficients; (*shape, len(names)).

    Args:
        form: name -> coefficient.
        names: names of the columns.
        shape: shape of the stack of systems.

    Raises:
        ConfigurationError: the form contains an unknown name.
    """
    row = np.zeros((*shape, len(names)))
    for name, coefficient in form.items():
        if name not in names:
            raise ConfigurationError(f"linear form: must be one of {', '.join(names)}, not {name!r}")
        row[..., names.index(name)] = coefficient
    return row
