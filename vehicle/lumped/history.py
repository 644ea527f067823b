"""Time histories of a lumped model, one model or a stack of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.linear.first_order import FirstOrder

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class History:
    """Sampled solution; T samples, leading axes of the model behind the time axis."""

    model: FirstOrder
    time: Array
    """[s], shape (T,)."""
    state: Array
    """x, shape (T, ..., s)."""
    sliding_force: Array
    """Force of each sliding pair [N], shape (T, ..., k)."""
    road: Array
    """Road displacement w [m], shape (T,) or (T, ...)."""
    road_rate: Array
    """Road velocity w' [m/s], of the shape of the road."""
    force: Array
    """Applied force F [N], of the shape of the road."""
    evaluations: int
    """Evaluations of the right-hand side, or steps taken."""
    method: str
    """Solver and tolerances, or scheme and step, in words."""

    def displacement(self, output: str) -> Array:
        """Displacement [m] of an output, shape (T, ...)."""
        row, road = self._row(output)
        n = row.shape[-1]
        return np.asarray(np.einsum("...i,t...i->t...", row, self.state[..., :n]) + road * self._stacked(self.road))

    def velocity(self, output: str) -> Array:
        """Velocity [m/s] of an output, shape (T, ...)."""
        row, road = self._row(output)
        n = row.shape[-1]
        motion = np.einsum("...i,t...i->t...", row, self.state[..., n : 2 * n])
        return np.asarray(motion + road * self._stacked(self.road_rate))

    def acceleration(self, output: str) -> Array:
        """Acceleration [m/s2] of an output that does not move with the road by itself, shape (T, ...)."""
        row, _ = self._row(output)
        n, m = row.shape[-1], self.model
        speed = slice(n, 2 * n)
        total = np.einsum("...i,...ij,t...j->t...", row, m.state[..., speed, :], self.state)
        total += np.einsum("...i,...i->...", row, m.input[..., speed, 0]) * self._stacked(self.road)
        total += np.einsum("...i,...i->...", row, m.input_rate[..., speed, 0]) * self._stacked(self.road_rate)
        total += np.einsum("...i,...i->...", row, m.load[..., speed]) * self._stacked(self.force)
        total -= np.einsum("...i,...ik,t...k->t...", row, m.friction[..., speed, :], self.sliding_force)
        return np.asarray(total)

    def sliding_velocity(self, pair: int = 0) -> Array:
        """Velocity [m/s] of a sliding pair, shape (T, ...)."""
        motion = np.einsum("...i,t...i->t...", self.model.slide[..., pair, :], self.state)
        return np.asarray(motion + self.model.slide_rate[..., pair, 0] * self._stacked(self.road_rate))

    def _row(self, output: str) -> tuple[Array, Array]:
        """Coefficients of an output on the coordinates and on the road."""
        row, inputs = self.model.output(output)
        return row, inputs[..., 0]

    def _stacked(self, values: Array) -> Array:
        """Road quantities with as many axes as the stack of models."""
        return values.reshape(values.shape + (1,) * (1 + len(self.model.models) - values.ndim))
