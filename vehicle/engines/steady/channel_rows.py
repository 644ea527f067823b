"""Channels of a run as linear outputs of a car in its periodic state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Mask, Vector
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.load_outputs import (
    direct_applied,
    direct_forces,
    direct_laws,
    direct_slopes,
    load_outputs,
)
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.errors import ConfigurationError


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ChannelRows:
    """Rows of channels, without their values at rest.

    Attributes:
        outputs: rows over the poles and the plates; an acceleration has the row of its displacement.
        forces: rows over the forces p of the base columns at the same instant, as they act in y = Y0 z - Y p; (rows,
            base).
        slopes: rows over the slope velocities of rolling tyres at the same instant; (rows, w), (rows, 0).
        applied: rows over the histories of applied forces at the same instant; (rows, lines).
        accelerations: True for accelerations; (rows,).
    """

    outputs: Outputs
    forces: Vector
    slopes: Vector
    applied: Vector
    accelerations: Mask

    def __add__(self, other: ChannelRows) -> ChannelRows:
        """Return these rows followed by others."""
        arrays = {
            name: np.concatenate([getattr(self, name), getattr(other, name)])
            for name in ("forces", "slopes", "applied", "accelerations")
        }
        return ChannelRows(outputs=self.outputs + other.outputs, **arrays)


def plain_rows(model: PoleModel, outputs: Outputs) -> ChannelRows:
    """Return rows on which no force acts directly."""
    count = len(outputs.poles)
    return ChannelRows(
        outputs=outputs,
        forces=np.zeros((count, base_columns(model))),
        slopes=np.zeros((count, model.slope.shape[1])),
        applied=np.zeros((count, model.applied.shape[1])),
        accelerations=np.zeros(count, dtype=bool),
    )


def base_columns(model: PoleModel) -> int:
    """Return the number of base columns: dampers, groups of Jenkins elements, laws over displacement."""
    return int(model.force.shape[1] + model.scalar_force.shape[1])


def tyre_rows(model: PoleModel, wheels: Sequence[str]) -> ChannelRows:
    """Return the rows of dynamic tyre forces."""
    rows = plain_rows(model, model.outputs([f"tyre_{wheel}_force_z" for wheel in wheels]))
    for column, law in enumerate(model.laws, start=base_columns(model) - len(model.laws)):
        # A law over the deflection of a tyre changes the force of the tyre itself.
        if law.plate >= 0 and (wheel := model.matrices.system.inputs[law.plate]) in wheels:
            rows.forces[list(wheels).index(wheel), column] = 1.0
    return rows


def channel_rows(model: PoleModel, channels: Sequence[str], loads: LoadRows) -> ChannelRows:
    """Return the rows of channels.

    Args:
        model: pole model.
        channels: names of accelerations, tyre forces, velocities and forces of dampers, and loads.
        loads: rows of all loads.

    Raises:
        ConfigurationError: a channel that is no response of the car.
    """
    rows = plain_rows(model, model.outputs([]))
    for name in channels:
        rows = rows + _row(model, name, loads)
    return rows


def _row(model: PoleModel, name: str, loads: LoadRows) -> ChannelRows:
    wheels, dampers = model.matrices.system.inputs, model.matrices.damper_names
    if name in model.matrices.system.outputs:
        return replace(plain_rows(model, model.outputs([name])), accelerations=np.array([True]))
    if name in [f"tyre_{wheel}_force_z" for wheel in wheels]:
        return tyre_rows(model, [name.removeprefix("tyre_").removesuffix("_force_z")])
    damper, _, quantity = name.rpartition("_")
    if damper in dampers and quantity in ("velocity", "force"):
        return _damper_row(model, dampers.index(damper), quantity, loads)
    if name in loads.names:
        return _load_row(model, loads.only([name]))
    raise ConfigurationError(
        f"channel {name}: it is no response of the car to its plates; choose an acceleration, a velocity or a load"
    )


def _damper_row(model: PoleModel, index: int, quantity: str, loads: LoadRows) -> ChannelRows:
    """Return the row of v, or of D v + p with the forces of the Jenkins elements and of the stop."""
    none = np.zeros((1, model.height.shape[1]))
    factor = 1.0 if quantity == "velocity" else model.matrices.viscous[index]
    slip = factor * model.slip[[index]]
    rows = plain_rows(model, Outputs(poles=slip, height=none, velocity=none))
    if quantity == "velocity":
        return rows
    owners = np.concatenate([np.arange(len(model.slip)), model.matrices.sliders.dampers])
    rows.forces[0, : len(owners)] = -1.0 * (owners == index)
    stop = f"{model.matrices.damper_names[index]}_stop_force"
    if stop not in loads.names:
        return rows
    more = _load_row(model, loads.only([stop]))
    first, second = rows.outputs, more.outputs
    return replace(
        more,
        outputs=Outputs(
            poles=first.poles + second.poles,
            height=first.height + second.height,
            velocity=first.velocity + second.velocity,
        ),
        forces=rows.forces + more.forces,
    )


def _load_row(model: PoleModel, loads: LoadRows) -> ChannelRows:
    """Return the row of a load."""
    of_dampers = direct_forces(model, loads)
    groups = of_dampers[:, model.matrices.sliders.dampers]
    slopes = direct_slopes(model, loads) if model.slope.shape[1] else np.zeros((len(loads.names), 0))
    return ChannelRows(
        outputs=load_outputs(model, loads),
        forces=-np.hstack([-of_dampers, -groups, direct_laws(model, loads)]),
        slopes=slopes,
        applied=direct_applied(model, loads),
        accelerations=np.zeros(len(loads.names), dtype=bool),
    )
