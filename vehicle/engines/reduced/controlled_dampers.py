"""Controlled dampers in the time stepping of the poles.

The sensor signals are sums over the poles, like channels. The poles contain the softest setting of a controlled damper.
The excess e = c - cmin acts on the mean velocity of a step, f = -e (v + v+) / 2: second order, and dissipative at any
step. In the solution of a step this is a curve with one segment, (e/2) v+ + (e/2) v.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.compiler import jitable
from vehicle.engines.reduced.pole_model import Outputs, PoleModel
from vehicle.engines.reduced.readout import Readout
from vehicle.engines.reduced.step_factors import StepFactors
from vehicle.model.laws.control_laws import PRESENT, RING, act, in_steps, pack
from vehicle.model.parameters.force_elements import Damper

Vector = npt.NDArray[np.float64]

COEFFICIENT, FORCE = 0, 2
"""First columns of coefficient and force in `Control.samples`: for the step that ends at a sample, then that begins."""


class Control(NamedTuple):
    """The k controlled dampers of a run.

    Attributes:
        dampers: indices of the dampers; (k,).
        laws: records of `vehicle.model.laws.control_laws`; (k,).
        states, plates, forces: rows of the sensors, wheel and body alternating, over the state of the poles without the
            forces of the last step, the plates and those forces; (2 k, 2 p + q), (2 k, m), (2 k, d).
        past: states of the control laws, with delayed settings; (k, ...).
        step: index of the current step; (1,).
        samples: coefficients [N s/m] and forces beyond the softest setting [N] at the samples; (samples, k, 4).
    """

    dampers: npt.NDArray[np.int64]
    laws: npt.NDArray[Any]
    states: Vector
    plates: Vector
    forces: Vector
    past: Vector
    step: npt.NDArray[np.int64]
    samples: Vector


def control_at_rest(
    model: PoleModel, factors: StepFactors, dampers: Sequence[Damper], columns: Sequence[int]
) -> Control:
    """Return the controlled dampers of a car at rest.

    Args:
        model, factors, columns: see `Readout`.
        dampers: laws of all dampers.
    """
    controlled = [index for index, damper in enumerate(dampers) if damper.controlled is not None]
    laws = in_steps(np.reshape([pack(damper.controlled) for damper in dampers if damper.controlled], (-1, 8)),
                    factors.timestep)  # fmt: skip
    # Rows of the sensor velocities over the poles; the plates do not contribute.
    rows = np.zeros((0, len(model.poles)), dtype=np.complex128)
    if controlled:
        rows = model.matrices.sensors @ (model.modal * model.poles)
    no_plates = np.zeros((len(rows), len(model.matrices.system.inputs)))
    sensors = Readout(Outputs(poles=rows, height=no_plates, velocity=no_plates), factors, model.pairs, columns)
    past = np.zeros((len(controlled), RING + 1 + int(np.max(laws["lag"], initial=0.0))))
    past[:] = laws["softest"][:, None]
    return Control(
        dampers=np.array(controlled, dtype=np.int64),
        laws=laws,
        states=np.ascontiguousarray(sensors.rows),
        plates=np.ascontiguousarray(sensors.by_plate),
        forces=np.ascontiguousarray(sensors.by_step),
        past=past,
        step=np.zeros(1, dtype=np.int64),
        samples=np.zeros((1, len(controlled), 4)),
    )


@jitable
def sensor_velocity(row: int, pair: Any, real: Any, plates: Any, force: Any, c: Control) -> float:
    """Return the velocity at a sensor [m/s] at the end of the last step."""
    velocity, pairs = 0.0, pair.shape[1]
    for p in range(pairs):
        velocity += c.states[row, p] * pair[0, p] + c.states[row, pairs + p] * pair[1, p]
    for q in range(real.shape[0]):
        velocity += c.states[row, 2 * pairs + q] * real[q]
    for k in range(plates.shape[0]):
        velocity += c.plates[row, k] * plates[k]
    for i in range(c.forces.shape[1]):
        velocity += c.forces[row, i] * force[i]
    return velocity


@jitable
def set_coefficients(
    pair: Any, real: Any, plates: Any, force: Any, gain: Any, velocity: Any, curves: Any, c: Control
) -> None:
    """Set the damper coefficients of the next step.

    Args:
        pair, real: state of the poles without the forces of the last step.
        plates: current (z, z') of the driven plates.
        force: damper forces of the last step.
        gain: G of the damper forces of a step.
        velocity: current velocities of the dampers.
        curves: segments of the damper curves, see `solve_damper`; changed in place for controlled dampers.
        c: controlled dampers; changed in place.
    """
    for k in range(c.dampers.shape[0]):
        wheel = body = 0.0
        if c.step[0] % int(c.laws[k]["period"]) == 0:
            wheel = sensor_velocity(2 * k, pair, real, plates, force, c)
            body = sensor_velocity(2 * k + 1, pair, real, plates, force, c)
        act(c.laws[k], c.step[0], body, wheel, c.past[k])
        i, half = c.dampers[k], 0.5 * (c.past[k, PRESENT] - c.laws[k]["softest"])
        curves[i, 1, 0], curves[i, 2, 0] = half, half * velocity[i]
        curves[i, 3, 0] = 1.0 / (1.0 + gain[i, i] * half)
    c.step[0] += 1


@jitable
def record_sample(sample: int, after: int, velocity: Any, curves: Any, c: Control) -> None:
    """Record coefficients and forces of the step that ends (after = 0) or begins (after = 1) at a sample.

    Args:
        sample: row in `Control.samples`.
        after: 0 or 1.
        velocity: damper velocities at the end of that step.
        curves: segments of the damper curves in that step.
        c: controlled dampers; `samples` is changed in place.
    """
    for k in range(c.dampers.shape[0]):
        i = c.dampers[k]
        c.samples[sample, k, COEFFICIENT + after] = c.past[k, PRESENT]
        c.samples[sample, k, FORCE + after] = -(curves[i, 1, 0] * velocity[i] + curves[i, 2, 0])
