"""What every march of a linear system with forces of its own gives: its states at sample times, by named outputs."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.first_order import FirstOrder

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class History:
    """Sampled solution of x' = A x + b0 z + b1 z' + bF F - N phi; T samples, axes "..." of the models behind the time.

    Attributes:
        model: the first-order form.
        time: [s], (T,).
        state: x, (T, ..., s).
        inputs, input_rates: z [m] and z' [m/s], (T, ..., w); axes of one where all models have the same.
        sliding_force: phi of each sliding pair [N], (T, ..., p).
        force: applied force F [N], (T,); 0 where there is none.
        state_rate: x', (T, ..., s), where the solver knows it better than the equations: it holds z' over a step.
    """

    model: FirstOrder
    time: Array
    state: Array
    inputs: Array
    input_rates: Array
    sliding_force: Array
    force: Array | float = 0.0
    state_rate: Array | None = None

    def during(self, start: float, end: float = np.inf) -> History:
        """The samples of a stretch of time [s], both ends included."""
        kept = (self.time >= start) & (self.time <= end)
        whole = {entry.name: getattr(self, entry.name) for entry in dataclasses.fields(self)}
        part: dict[str, Any] = {name: x[kept] for name, x in whole.items() if isinstance(x, np.ndarray)}
        return dataclasses.replace(self, **part)

    def of(self, output: str, quantity: Literal["displacement", "velocity", "acceleration"] = "displacement") -> Array:
        """An output by the name of the quantity [m, m/s, m/s2; rad, ...], (T, ...)."""
        found: Array = getattr(self, quantity)(output)
        return found

    def displacement(self, output: str) -> Array:
        """Displacement [m] of an output, (T, ...)."""
        return self._moved(output, self.state[..., : self._free], self.inputs)

    def velocity(self, output: str) -> Array:
        """Velocity [m/s] of an output, (T, ...)."""
        return self._moved(output, self.state[..., self._free : 2 * self._free], self.input_rates)

    def acceleration(self, output: str) -> Array:
        """Acceleration [m/s2] of an output that does not move with an input by itself, (T, ...)."""
        row, _ = self.model.output(output)
        form, speed = self.model, slice(self._free, 2 * self._free)
        if self.state_rate is not None:
            return _along(row, self.state_rate[..., speed])
        parts = ((form.state, self.state), (form.input, self.inputs), (form.input_rate, self.input_rates))
        total: Array = sum(_along(_through(row, effect[..., speed, :]), cause) for effect, cause in parts)  # type: ignore[assignment]
        total = total + np.einsum("...i,...i->...", row, form.load[..., speed]) * self._stacked(np.asarray(self.force))
        return np.asarray(total - _along(_through(row, form.friction[..., speed, :]), self.sliding_force))

    def sliding_velocity(self, pair: int = 0) -> Array:
        """Velocity [m/s] of a sliding pair, (T, ...)."""
        form = self.model
        return _along(form.slide[..., pair, :], self.state) + _along(form.slide_rate[..., pair, :], self.input_rates)

    @property
    def _free(self) -> int:
        """Number of free motions m."""
        return int(self.model.basis.shape[1])

    def _moved(self, output: str, own: Array, driven: Array) -> Array:
        row, inputs = self.model.output(output)
        return _along(row, own) + _along(inputs, driven)

    def _stacked(self, values: Array) -> Array:
        """Values over time with as many axes as the stack of models."""
        return values.reshape(values.shape + (1,) * (len(self.model.models) if values.ndim else 0))


def _along(row: Array, values: Array) -> Array:
    """Row (..., i) times values (T, ..., i), (T, ...)."""
    return np.asarray(np.einsum("...i,t...i->t...", row, values))


def _through(row: Array, effect: Array) -> Array:
    """Row (..., i) times matrix (..., i, j), (..., j)."""
    return np.asarray(np.einsum("...i,...ij->...j", row, effect))
