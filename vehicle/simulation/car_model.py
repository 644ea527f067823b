"""A car ready to be stepped: assembled, compiled and trimmed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.assembly.spec import assemble
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.flexbody.superelement import Superelement
from vehicle.parameters.vehicle import Vehicle
from vehicle.simulation.rows import Rows, weights
from vehicle.simulation.standing import require_body_modes, require_standing
from vehicle.simulation.static_trim import StaticTrim, trim
from vehicle.simulation.tables import curve_of, standing_on

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CarModel:
    """Compiled model of a car with its preloads; the model is as generated, `prepare_model` comes with a run.

    Attributes:
        vehicle: parameters.
        superelement: flexible body with the masses that are fixed to it.
        spec: specification the model was compiled from.
        origins: where each body frame sits in the design position [m], by body name.
        model: compiled and trimmed model.
        static: its preloads and loads.
    """

    vehicle: Vehicle
    superelement: Superelement
    spec: mujoco.MjSpec
    origins: Mapping[str, Vector]
    model: mujoco.MjModel
    static: StaticTrim


MOST_TRIMS = 50
"""Trims in which the operating points of the curves settle; two, as a rule."""


def _trimmed(rows: Rows) -> StaticTrim:
    """Trim with every law over displacement as its tangent at the force that it carries.

    Raises:
        ConfigurationError: a curve that no point of carries its static force.
    """
    static = trim(rows)
    if not len(rows.layout.tables.at):
        return static
    for _ in range(MOST_TRIMS):
        layout, last = standing_on(rows.layout, static.preload), rows.layout
        rows.layout, rows.weights = layout, weights(rows.model, layout, rows.weights.preload)
        static = trim(rows)
        same = (layout.bushings.stiffness, layout.springs.stiffness, layout.tables.at)
        if all(map(np.allclose, same, (last.bushings.stiffness, last.springs.stiffness, last.tables.at))):
            break
    t = rows.layout.tables
    for index, (kind, element, axis, at) in enumerate(zip(t.kinds, t.elements, t.axes, t.at, strict=True)):
        if kind < 2:
            row = rows.layout.bushings.rows[element, axis] if kind == 0 else rows.layout.springs.rows[element]
            needed, found = -static.preload[row], float(curve_of(t, index).force(at))
            if abs(found - needed) > 1e-6 * max(abs(needed), 1.0):
                raise ConfigurationError(
                    f"the table of {_table_names(rows)[index]}: carries {found:.4g} N nearest to the {needed:.4g} N "
                    "with which the car stands in its design position; give it points up to that force"
                )
    return static


def _table_names(rows: Rows) -> list[str]:
    """Names of the elements whose laws are curves."""
    t, model = rows.layout.tables, rows.model
    springs = [model.equality(i).name for i in range(model.neq) if model.eq_type[i] == mujoco.mjtEq.mjEQ_TENDON]
    return [
        f"the stop of damper {element + 1}" if kind == 2 else springs[element] if kind == 1 else rows.names[element]
        for kind, element in zip(t.kinds, t.elements, strict=True)
    ]


def build_model(vehicle: Vehicle, trimmed_body: Superelement) -> CarModel:
    """Assemble, compile and trim a car.

    Args:
        vehicle: parameters.
        trimmed_body: superelement of its body.

    Returns:
        The car model.

    Raises:
        ConfigurationError: no such car can be; the message names the parameter.
        SimulationError: MuJoCo refuses the model, or the car is not held.
    """
    require_body_modes(vehicle, trimmed_body)
    assembly = assemble(vehicle, trimmed_body)
    try:
        model = assembly.spec.compile()
    except ValueError as error:
        raise SimulationError(f"MuJoCo refuses the generated car: {' '.join(str(error).split())}") from None
    rows = Rows(model)
    static = _trimmed(rows)
    require_standing(vehicle, rows, static)
    return CarModel(
        vehicle=vehicle,
        superelement=assembly.superelement,
        spec=assembly.spec,
        origins=assembly.origins,
        model=model,
        static=static,
    )
