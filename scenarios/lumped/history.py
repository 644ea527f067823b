"""History of a lumped model: states at sample times, evaluated as displacements, velocities and accelerations."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import FirstOrder


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class History:
    """Sampled solution of x' = A x + b0 z + b1 z' + bF F - N phi, for T samples and a stack "..." of models."""

    model: FirstOrder  # the first-order form
    time: Vector  # sample times [s], (T,)
    state: Vector  # states x, (T, ..., s)
    # inputs, input_rates: z [m] and z' [m/s], (T, ..., w); axes of length one for inputs common to all models
    inputs: Vector
    input_rates: Vector
    sliding_force: Vector  # phi of each sliding pair [N], (T, ..., p)
    force: Vector | float = 0.0  # applied force F [N], (T,); 0 without a force
    # x', (T, ..., s), if the solver provides it; with z' constant over a step, x' of the solver differs from the
    # equations at the samples
    state_rate: Vector | None = None

    def during(self, start: float, end: float = np.inf) -> History:
        """Return the samples in a time interval [s], both ends included."""
        inside = (self.time >= start) & (self.time <= end)
        fields = {entry.name: getattr(self, entry.name) for entry in dataclasses.fields(self)}
        selected: dict[str, Any] = {name: x[inside] for name, x in fields.items() if isinstance(x, np.ndarray)}
        return dataclasses.replace(self, **selected)

    def motion(
        self, output: str, quantity: Literal["displacement", "velocity", "acceleration"] = "displacement"
    ) -> Vector:
        """Return displacement, velocity or acceleration of an output [m, m/s, m/s2; rad, ...], (T, ...)."""
        values: Vector = getattr(self, quantity)(output)
        return values

    def displacement(self, output: str) -> Vector:
        """Return the displacement [m] of an output, (T, ...)."""
        return self._moved(output, self.state[..., : self._free], self.inputs)

    def velocity(self, output: str) -> Vector:
        """Return the velocity [m/s] of an output, (T, ...)."""
        return self._moved(output, self.state[..., self._free : 2 * self._free], self.input_rates)

    def acceleration(self, output: str) -> Vector:
        """Return the acceleration [m/s2] of an output that does not depend directly on an input, (T, ...)."""
        row, _ = self.model.output(output)
        form, speed = self.model, slice(self._free, 2 * self._free)
        if self.state_rate is not None:
            return _along(row, self.state_rate[..., speed])
        parts = ((form.state, self.state), (form.input, self.inputs), (form.input_rate, self.input_rates))
        total: Vector = sum(_along(_through(row, effect[..., speed, :]), cause) for effect, cause in parts)  # type: ignore[assignment]
        total = total + np.einsum("...i,...i->...", row, form.load[..., speed]) * self._stacked(np.asarray(self.force))
        return np.asarray(total - _along(_through(row, form.friction[..., speed, :]), self.sliding_force))

    def sliding_velocity(self, pair: int = 0) -> Vector:
        """Return the velocity [m/s] of a sliding pair, (T, ...)."""
        form = self.model
        return _along(form.slide[..., pair, :], self.state) + _along(form.slide_rate[..., pair, :], self.input_rates)

    @property
    def _free(self) -> int:
        """Return the number of free motions m."""
        return int(self.model.basis.shape[1])

    def _moved(self, output: str, motion: Vector, driven: Vector) -> Vector:
        row, inputs = self.model.output(output)
        return _along(row, motion) + _along(inputs, driven)

    def _stacked(self, values: Vector) -> Vector:
        """Return values over time with the axes of the stack of models."""
        return values.reshape(values.shape + (1,) * (len(self.model.models) if values.ndim else 0))


def _along(row: Vector, values: Vector) -> Vector:
    """Return row (..., i) times values (T, ..., i), (T, ...)."""
    return np.asarray(np.einsum("...i,t...i->t...", row, values))


def _through(row: Vector, effect: Vector) -> Vector:
    """Return row (..., i) times matrix (..., i, j), (..., j)."""
    return np.asarray(np.einsum("...i,...ij->...j", row, effect))
