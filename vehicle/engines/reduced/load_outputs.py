"""Load channels as outputs of the poles.

u = Re(modal xi), u' = Re(modal s xi), u'' = Re(modal s xi') with xi' of the poles.

xi' = s xi + b_z z + b_c z' + e f + b_F F: plates, forces f, forces on slopes and applied forces F act directly on xi'
and hence on u'', and on no other part of a load.
"""

from collections.abc import Mapping

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.signals.excitation.signal import Signal


def load_outputs(model: PoleModel, loads: LoadRows) -> Outputs:
    """Return the rows of loads over the poles and the plates, without static values and `direct_forces`."""
    rate = model.modal * model.poles
    return Outputs(
        poles=loads.displacement @ model.modal
        + loads.velocity @ rate
        + loads.acceleration @ (rate * model.poles)
        + loads.branch @ model.branch,
        # u'' contains b_z z and b_c z' of xi'.
        height=loads.height + (loads.acceleration @ (rate @ model.height)).real,
        velocity=loads.height_rate + (loads.acceleration @ (rate @ model.velocity)).real,
    )


def direct_forces(model: PoleModel, loads: LoadRows) -> Vector:
    """Return the rows of loads over the nonlinear damper forces at the same instant; (loads, d)."""
    return np.asarray(loads.friction + (loads.acceleration @ (model.modal * model.poles @ model.force)).real)


def direct_laws(model: PoleModel, loads: LoadRows) -> Vector:
    """Return the rows of loads over the forces g of the laws over displacement at the same instant; (loads, laws)."""
    rate = model.modal * model.poles
    # The law adds the force -g.
    return np.asarray(loads.law - (loads.acceleration @ (rate @ model.scalar_force[:, model.groups :])).real)


def direct_applied(model: PoleModel, loads: LoadRows) -> Vector:
    """Return the rows of loads over the histories of applied forces at the same instant; (loads, lines)."""
    return np.asarray(loads.applied + (loads.acceleration @ (model.modal * model.poles @ model.applied)).real)


def direct_slopes(model: PoleModel, loads: LoadRows) -> Vector:
    """Return the rows of loads over the slope velocities e of rolling tyres at the same instant; (loads, w)."""
    return np.asarray(loads.slope + (loads.acceleration @ (model.modal * model.poles @ model.slope)).real)


def slope_loads(
    model: PoleModel,
    loads: LoadRows,
    signal: Signal,
    time: Vector,
    tyre_forces: Mapping[str, Vector],
    tyre_load: Mapping[str, float],
) -> Vector:
    """Return the loads by forces of rolling tyres on slopes, beyond the static load and z'; (l, n).

    Args:
        model: pole model of the car.
        loads: rows of the l loads.
        signal: motion of the plates.
        time: times of the n samples [s].
        tyre_forces: vertical tyre forces by wheel [N], (n,) each.
        tyre_load: static tyre loads by wheel [N].
    """
    rows = direct_slopes(model, loads)
    total, inputs = np.zeros((len(rows), len(time))), model.matrices.system.inputs
    for wheel in signal.wheels:
        rate = signal.spline(wheel, float(time[0]), float(time[-1]))(time, 1)
        slope = rate
        if signal.slope_velocity:
            slope = signal.slope_spline(wheel, float(time[0]), float(time[-1]))(time)
        share = np.maximum(tyre_forces[wheel], 0.0) / tyre_load[wheel]
        total += rows[:, [inputs.index(wheel)]] * (share * slope - rate)
    return total
