"""The one linear system that every model of the house makes: quarter car, half car, engine on mounts, complete car.

    M x'' + C x' + K x + sum_b h_b' f_b + sum_p s_p' phi_p = Bc z' + Bk z + l F,    Jc x = 0
    f_b' = K2 (e_b x' + g_b x + r_b z') - f_b / tau_b,    v_p = s_p x' + d_p z'

x are the coordinates, z the driven displacements, f_b the forces of Maxwell branches, phi_p those of sliding pairs
(friction, and what else depends on their velocity v_p alone), F an applied force, Jc the ideal joints. Leading axes
"..." stand for many systems at once. Of most branches g_b = 0 and h_b = e_b; a tyre that rolls slips sideways by its
heading too, and its side force acts behind its middle. No force depends on the place of a cyclic coordinate, as the
angle of a free wheel: its velocity alone is a state.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.model.laws.law import ForceLaw, Numbers

Array = npt.NDArray[np.float64]
Row = Mapping[str, Numbers]
"""Linear form: name of a coordinate or an input -> coefficient [-]; arrays of coefficients stand for many systems."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Slide:
    """Sliding pair along one direction; its velocity is row . (x', z')."""

    row: Row
    friction: ForceLaw
    viscous: ForceLaw | None = None


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LinearSystem:
    """Matrices of the equations above; n coordinates, w inputs, b branches, p sliding pairs, k joints.

    Attributes:
        coordinates: names, or empty where they have none; inputs: names of the driven displacements.
        mass, damping, stiffness: M, C, K; (..., n, n).
        input_damping, input_stiffness: Bc, Bk; (..., n, w).
        branch_rows, branch_inputs: e_b and r_b; (..., b, n), (..., b, w).
        branch_stiffness, branch_time: K2 [N/m] and tau [s]; (..., b).
        slide_rows, slide_inputs: s_p and d_p; (..., p, n), (..., p, w).
        branch_drifts, branch_effects: g_b and h_b, (b, n); None for 0 and e_b.
        cyclic: positions of the cyclic coordinates; (c,).
        constraints: Jc; (k, n).
        load: l, where the applied force acts; (..., n).
        outputs: name -> coefficients of the coordinates and behind them those of the inputs; (..., n + w).
        slides: laws of the sliding pairs; empty where somebody else gives their forces.
    """

    coordinates: tuple[str, ...]
    inputs: tuple[str, ...]
    mass: Array
    damping: Array
    stiffness: Array
    input_damping: Array
    input_stiffness: Array
    branch_rows: Array
    branch_inputs: Array
    branch_stiffness: Array
    branch_time: Array
    slide_rows: Array
    slide_inputs: Array
    constraints: Array
    load: Array
    outputs: Mapping[str, Array]
    slides: tuple[Slide, ...] = ()
    branch_drifts: Array | None = None
    branch_effects: Array | None = None
    cyclic: tuple[int, ...] = ()

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return int(self.mass.shape[-1])

    @property
    def effects(self) -> Array:
        """h_b; (..., b, n)."""
        return self.branch_rows if self.branch_effects is None else self.branch_effects

    def output(self, name: str) -> tuple[Array, Array]:
        """Coefficients of an output on the coordinates (..., n) and on the inputs (..., w).

        Raises:
            ConfigurationError: there is no such output.
        """
        if name not in self.outputs:
            raise ConfigurationError(f"output {name!r}: unknown; this model has {', '.join(self.outputs)}")
        row = self.outputs[name]
        return row[..., : self.size], row[..., self.size :]

    def with_slide(self, slide: Slide) -> LinearSystem:
        """The system with one more sliding pair: a law between any coordinates and inputs; errors as of `form_row`."""
        row = self.row(slide.row)[..., None, :]
        return replace(
            self,
            slide_rows=np.concatenate([self.slide_rows, row[..., : self.size]], axis=-2),
            slide_inputs=np.concatenate([self.slide_inputs, row[..., self.size :]], axis=-2),
            slides=(*self.slides, slide),
        )

    def row(self, form: Row) -> Array:
        """Coefficients of a linear form of coordinates and inputs, (..., n + w); errors as of `form_row`."""
        return form_row(form, (*self.coordinates, *self.inputs), self.mass.shape[:-2])


def form_row(form: Row, names: tuple[str, ...], shape: tuple[int, ...] = ()) -> Array:
    """A linear form as an array over names.

    Args:
        form: name -> coefficient.
        names: what the columns stand for.
        shape: of the stack of systems.

    Returns:
        (*shape, len(names)).

    Raises:
        ConfigurationError: the form names what does not exist.
    """
    row = np.zeros((*shape, len(names)))
    for name, coefficient in form.items():
        if name not in names:
            raise ConfigurationError(f"linear form: found {name!r}, allowed are {', '.join(names)}")
        row[..., names.index(name)] = coefficient
    return row
