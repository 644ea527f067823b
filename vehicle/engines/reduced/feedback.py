"""Inputs of a step that depend on the motion at its beginning: loads of rolling tyres on slopes, controlled dampers.

A rolling tyre pushes its wheel centre along x by F_z z'/V (`vehicle.engines.simulation.rolling_tyres`). The poles
contain the effect of the static load F_0, as a force b z' of the velocity of the plate. The current load adds

    b (max(0, F_z) / F_0 - 1) z',

a product of two motions, as a force that is constant over a step: F_z is extrapolated to the middle of the step from
the beginnings of this step and of the last one, z' is the mean over the step. Both are of second order.

The poles contain the softest setting of a controlled damper. The excess e = c - cmin acts on the mean velocity of a
step, f = -e (v + v+)/2: second order, and dissipative at any step. This is the damper curve F_c = e v.

Tyre loads and the velocities that controlled dampers measure are sums over the poles, like damper velocities. This is
possible for one car in double precision.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.compiler import jitable
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.step_factors import CarFactors
from vehicle.engines.reduced.table_layout import TableRows
from vehicle.engines.reduced.validity import tyre_outputs
from vehicle.model.laws.control_laws import PRESENT, RING, act, in_steps, pack
from vehicle.model.parameters.force_elements import Damper

Vector = npt.NDArray[np.float64]


class Feedback(NamedTuple):
    """Sensors of a car, and what acts by them: r rolling tyres, k controlled dampers.

    Attributes:
        direct: weights of mean damper forces, their slopes, z' and z in the sensors; (r + 2 k, 2 d + 2 m).
        values: sensors at the beginning of the next step: F_z/F_0 - 1 of the tyres, then velocities of wheel and body
            at each controlled damper [m/s]; (r + 2 k,).
        past: F_z/F_0 - 1 when the last step began; (r,).
        heights: number of plates whose z is an input; m for a car with slow poles, else 0.
        dampers: indices of the controlled dampers; (k,).
        laws: their records of `vehicle.model.laws.control_laws`; (k,).
        memory: states of their laws, with delayed settings; (k, ...).
        step: index of the next step; (1,).
    """

    direct: Vector
    values: Vector
    past: Vector
    heights: int
    dampers: npt.NDArray[np.int64]
    laws: npt.NDArray[Any]
    memory: Vector
    step: npt.NDArray[np.int64]


def sensor_outputs(
    model: PoleModel, dampers: Sequence[Damper], columns: Sequence[int], tyre_load: Mapping[str, float] | None
) -> Outputs:
    """Return the sensors of a car as outputs.

    Args:
        model: pole model of the car.
        dampers: laws of all dampers.
        columns: indices of the driven plates.
        tyre_load: static tyre loads [N] by wheel; None if the static loads act on the slopes.
    """
    inputs, loads = model.matrices.system.inputs, tyre_outputs(model)
    tyres = list(columns) if model.slope.shape[1] and tyre_load else []
    static = np.array([tyre_load[inputs[tyre]] for tyre in tyres] if tyre_load else [])[:, None]
    rates = np.zeros((0, len(model.poles)))
    if any(damper.controlled for damper in dampers):
        rates = model.matrices.sensors @ (model.modal * model.poles)
    no_plates = np.zeros((len(rates), len(inputs)))
    return Outputs(poles=loads.poles[tyres] / static, height=loads.height[tyres] / static,
                   velocity=loads.velocity[tyres] / static) + Outputs(
        poles=rates, height=no_plates, velocity=no_plates
    )  # fmt: skip


def feedback_at_rest(
    factors: CarFactors, dampers: Sequence[Damper], sensors: Outputs, start: Vector, timestep: float
) -> Feedback:
    """Return the feedback of a car at rest.

    Args:
        factors: factors of the car.
        dampers: laws of all dampers.
        sensors: see `sensor_outputs`.
        start: (z, z') of the driven plates at the first instant; (2, m).
        timestep: time step [s].
    """
    controlled = [index for index, damper in enumerate(dampers) if damper.controlled]
    laws = in_steps(np.reshape([pack(damper.controlled) for damper in dampers if damper.controlled], (-1, 8)), timestep)
    memory = np.zeros((len(controlled), RING + 1 + int(np.max(laws["lag"], initial=0.0))))
    memory[:] = laws["softest"][:, None]
    tyres, columns = len(sensors.poles) - 2 * len(controlled), factors.columns
    return Feedback(
        direct=np.ascontiguousarray(factors.weights_of(sensors)[:, factors.states :]),
        values=sensors.height[:, columns] @ start[0] + sensors.velocity[:, columns] @ start[1],
        past=np.zeros(tyres),
        heights=factors.heights,
        dampers=np.array(controlled, dtype=np.int64),
        laws=laws,
        memory=memory,
        step=np.zeros(1, dtype=np.int64),
    )


@jitable
def slope_force(feedback: Feedback, tyre: int, rate: float) -> float:
    """Return the slope force of a tyre over its row b in the next step, at a mean z' [m/s]."""
    load = feedback.values[tyre]
    middle = 1.5 * load - 0.5 * feedback.past[tyre]
    feedback.past[tyre] = load
    return max(-1.0, middle) * rate


@jitable
def demanded_excess(feedback: Feedback, k: int) -> float:
    """Return the mean coefficient of a controlled damper in the next step, less the softest one [N s/m]."""
    sensor = feedback.past.shape[0] + 2 * k
    law, memory = feedback.laws[k], feedback.memory[k]
    act(law, feedback.step[0], feedback.values[sensor + 1], feedback.values[sensor], memory)
    excess: float = memory[PRESENT] - law["softest"]
    return excess


@jitable
def read_sensors(t: Any, r: TableRows, feedback: Feedback, rates: Any, row: int, count: int) -> None:
    """Read the sensors at the end of a step.

    Args:
        t, r, rates: see `vehicle.engines.reduced.time_stepping.step_cars`.
        feedback: changed in place.
        row: row of the end of the step in `rates`.
        count: number of dampers.
    """
    feedback.step[0] += 1
    plates = rates.shape[1] // 3
    for i in range(feedback.values.shape[0]):
        value = t[r.sensors + i, 0] + 0.0
        for k in range(2 * count):
            value += feedback.direct[i, k] * t[r.inputs + k, 0]
        for k in range(plates):
            value += feedback.direct[i, 2 * count + k] * rates[row, k]
            value += feedback.direct[i, 2 * count + plates + k] * rates[row, 2 * plates + k]
        feedback.values[i] = value
