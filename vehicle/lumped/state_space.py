"""A network as first-order equations: x' = A x + b0 w + b1 w' + bF F - N f(v), v = V x + d w'."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.laws.law import Parallel
from vehicle.laws.maxwell import Maxwell
from vehicle.lumped.network import ROAD, Network, Row, Slide

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StateSpace:
    """First-order form of a network; x = (q, q', one force for each Maxwell branch).

    Leading axes "..." stand for many models at once; s states, k sliding pairs.
    """

    coordinates: tuple[str, ...]
    outputs: Mapping[str, Row]
    slides: tuple[Slide, ...]
    state: Array
    """A, shape (..., s, s)."""
    road: Array
    """b0, effect of the road displacement w [m], shape (..., s)."""
    road_rate: Array
    """b1, effect of the road velocity w' [m/s], shape (..., s)."""
    force: Array
    """bF, effect of the applied force F [N], shape (..., s)."""
    friction: Array
    """N, effect of the sliding forces f [N], shape (..., s, k)."""
    slide: Array
    """V, sliding velocities from the state, shape (..., k, s)."""
    slide_road_rate: Array
    """d, sliding velocities from the road velocity, shape (..., k)."""

    @property
    def models(self) -> tuple[int, ...]:
        """Shape of the stack of models; empty for a single one."""
        return self.state.shape[:-2]

    def row(self, output: str) -> tuple[Array, Array]:
        """Row of an output on the coordinates, shape (..., n), and its road coefficient, shape (...)."""
        if output not in self.outputs:
            raise ConfigurationError(f"output {output!r}: unknown; this model has {', '.join(self.outputs)}")
        return _vector(self.outputs[output], self.coordinates, self.models)


def state_space(network: Network) -> StateSpace:
    """Equations of a network from its parts.

    M q'' = -sum r (K (r.q + g w) + B (r.q' + g w') + F2) - sum r_f f + r_F F, F2' = K2 (r.q' + g w') - (K2/D2) F2, with
    r the row of a part on the coordinates and g its coefficient of the road: Lagrange's equations of point masses and
    elements along constant directions.

    Args:
        network: the model.

    Returns:
        The first-order form.

    Raises:
        ConfigurationError: an unknown coordinate in a row, or a mass matrix that is singular.
    """
    shape = _models(network)
    n = len(network.coordinates)
    branches = [link for link in network.links if isinstance(link.law, Maxwell)]
    size, k = 2 * n + len(branches), len(network.slides)
    mass = np.zeros((*shape, n, n))
    for part in network.masses:
        for axis in part.axes:
            r, _ = _vector(axis, network.coordinates, shape)
            mass += _each(part.mass, 2) * r[..., :, None] * r[..., None, :]
    if not (np.linalg.matrix_rank(mass) == n).all():
        raise ConfigurationError(f"network: a coordinate of {', '.join(network.coordinates)} carries no mass")
    inverse = np.linalg.inv(mass)
    state = np.zeros((*shape, size, size))
    road, road_rate, force = np.zeros((*shape, size)), np.zeros((*shape, size)), np.zeros((*shape, size))
    friction, slide = np.zeros((*shape, size, k)), np.zeros((*shape, k, size))
    slide_road_rate = np.zeros((*shape, k))
    state[..., :n, n : 2 * n] = np.eye(n)
    position, speed = slice(0, n), slice(n, 2 * n)
    branch = 2 * n
    for link in network.links:
        r, g = _vector(link.row, network.coordinates, shape)
        reaction = np.einsum("...ij,...j->...i", inverse, r)
        stiffness = _each(link.law.stiffness, 1)
        state[..., speed, position] -= reaction[..., :, None] * (stiffness * r)[..., None, :]
        road[..., speed] -= reaction * stiffness * g[..., None]
        if isinstance(link.law, Maxwell):
            tau = np.asarray(link.law.relaxation_time)
            if not (tau > 0.0).all():
                raise ConfigurationError(
                    "network: a Maxwell branch needs branch_stiffness and branch_damping above 0.0"
                )
            k2 = _each(link.law.branch_stiffness, 1)
            state[..., speed, branch] -= reaction
            state[..., branch, speed] = k2 * r
            road_rate[..., branch] = (k2 * g[..., None])[..., 0]
            state[..., branch, branch] = -1.0 / tau
            branch += 1
        else:
            damping = _each(link.law.damping, 1)
            state[..., speed, speed] -= reaction[..., :, None] * (damping * r)[..., None, :]
            road_rate[..., speed] -= reaction * damping * g[..., None]
    for index, pair in enumerate(network.slides):
        r, g = _vector(pair.row, network.coordinates, shape)
        friction[..., speed, index] = np.einsum("...ij,...j->...i", inverse, r)
        slide[..., index, speed] = r
        slide_road_rate[..., index] = g
    if network.force:
        r, _ = _vector(network.force, network.coordinates, shape)
        force[..., speed] = np.einsum("...ij,...j->...i", inverse, r)
    return StateSpace(
        coordinates=network.coordinates,
        outputs=network.outputs,
        slides=network.slides,
        state=state,
        road=road,
        road_rate=road_rate,
        force=force,
        friction=friction,
        slide=slide,
        slide_road_rate=slide_road_rate,
    )


def _models(network: Network) -> tuple[int, ...]:
    """Common shape of all masses, coefficients and parameters of laws."""
    shapes = [np.shape(part.mass) for part in network.masses]
    rows = [axis for part in network.masses for axis in part.axes]
    rows += [link.row for link in network.links] + [pair.row for pair in network.slides]
    shapes += [np.shape(value) for row in rows for value in row.values()]
    for link in network.links:
        if isinstance(link.law, Maxwell):
            shapes += [np.shape(v) for v in (link.law.stiffness, link.law.branch_stiffness, link.law.branch_damping)]
        else:
            shapes += [np.shape(v) for v in (link.law.stiffness, link.law.damping)]
    for pair in network.slides:
        shapes += [*_law_shapes(pair.friction), *_law_shapes(pair.viscous)]
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        found = sorted({str(shape) for shape in shapes})
        raise ConfigurationError(
            f"network: parameters of shapes {', '.join(found)} do not broadcast together"
        ) from None


def _law_shapes(law: Any) -> list[tuple[int, ...]]:
    """Shapes of the parameters of a sliding law: many laws on equal masses are many models too."""
    if isinstance(law, Parallel):
        return [shape for member in law.laws for shape in _law_shapes(member)]
    if not dataclasses.is_dataclass(law):
        return []
    return [np.shape(getattr(law, entry.name)) for entry in dataclasses.fields(law)]


def _vector(row: Row, coordinates: tuple[str, ...], shape: tuple[int, ...]) -> tuple[Array, Array]:
    """A row as coefficients of the coordinates, shape (..., n), and of the road, shape (...)."""
    vector, road = np.zeros((*shape, len(coordinates))), np.zeros(shape)
    for name, coefficient in row.items():
        if name == ROAD:
            road = np.broadcast_to(np.asarray(coefficient, dtype=float), shape)
        elif name in coordinates:
            vector[..., coordinates.index(name)] = coefficient
        else:
            known = ", ".join(itertools.chain(coordinates, (ROAD,)))
            raise ConfigurationError(f"network: a row names {name!r}; the coordinates are {known}")
    return vector, road


def _each(value: float | Array, axes: int) -> Array:
    """A parameter with trailing axes of length one, so that it multiplies vectors or matrices."""
    array = np.asarray(value, dtype=float)
    return array.reshape(array.shape + (1,) * axes)
