"""Total force of the dampers: one sum for the channels of a run and for the sensors in MuJoCo's data.

A damper acts by several forces of MuJoCo: its actuator (coefficient times velocity, gas force), its equality row (half
a step of the viscous part), its friction row, and those of the steeper segments of its curve and of its Jenkins
elements; and by its stop, a force on its joint. The channel `<damper>_force` is minus the sum of them all, positive in
extension; `<damper>_stop_force` is the part of the stop.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.force_curves import curve_of

if TYPE_CHECKING:
    from vehicle.engines.simulation.rows import Rows


STOP = 2
"""Kind of a bump and rebound stop, see `vehicle.engines.simulation.element_records.Tables`."""


def damper_forces(actuator: Vector, rows: Vector, layout: Layout) -> Vector:
    """Return the force of each damper without its stop [N], positive in extension; (..., dampers).

    Args:
        actuator: forces of the actuators [N]; (..., dampers).
        rows: total forces of the constraint rows, explicit part included [N]; (..., rows).
        layout: elements of the model.
    """
    dampers, presliding = layout.dampers, layout.presliding
    force = -(actuator + rows[..., dampers.rows] + rows[..., dampers.frictions])
    for row, damper in dampers.valves:
        force[..., damper] -= rows[..., row]
    for row, damper in zip(presliding.rows, presliding.dampers, strict=True):
        if row != dampers.frictions[damper]:
            force[..., damper] -= rows[..., row]
    return force


def has_stops(layout: Layout) -> bool:
    """Return True if a damper has a stop."""
    return STOP in layout.tables.kinds


def stop_forces(positions: Vector, layout: Layout) -> Vector:
    """Return the force of the stop of each damper [N], positive in extension; (..., dampers).

    Args:
        positions: displacements of the dampers from the design position, extension positive [m]; (..., dampers).
        layout: elements of the model.
    """
    force = np.zeros_like(positions)
    for index in np.flatnonzero(layout.tables.kinds == STOP).tolist():
        damper = layout.tables.elements[index]
        force[..., damper] += curve_of(layout.tables, index).force(positions[..., damper])
    return force


def fill_sensors(rows: Rows, data: mujoco.MjData, stage: int) -> None:
    """Write the total forces of the dampers to their user sensors, as `mjcb_sensor`.

    Args:
        rows: rows of the model, evaluated for this state.
        data: state, after the solution for its accelerations.
        stage: stage of the computation; the forces belong to the last one, mjSTAGE_ACC.
    """
    if stage != mujoco.mjtStage.mjSTAGE_ACC:
        return
    forces = np.full(len(rows.laws.dampers), np.nan)
    if data.nefc == rows.layout.row_count:  # else the state is no longer that of the rows
        forces = damper_forces(data.actuator_force, data.efc_force + rows.state.explicit, rows.layout)
        forces += stop_forces(data.qpos[rows.layout.dampers.places], rows.layout)
    for name, force in zip(rows.laws.dampers, forces, strict=True):
        data.sensor(f"{name}_force").data[0] = force
