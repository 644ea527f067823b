"""Control of dampers in the march over the poles.

The sensors are sums over the poles, as channels are. A controlled damper has its softest setting among the poles; what
is set beyond it, e = c - cmin, acts on the mean velocity of a step, f = -e (v + v+) / 2: second order, dissipative at
any step. For the solution of a step that is a curve of one piece, (e/2) v+ + (e/2) v.
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
"""Places in what is kept of a damper at a sample, each for the step that ends and for the step that begins there."""


class Control(NamedTuple):
    """The k controlled dampers of a run.

    Attributes:
        dampers: which they are; (k,).
        laws: records of `vehicle.model.laws.control_laws`; (k,).
        states, plates, forces: rows of the sensors, wheel and body by turns, over the state of the poles without the
            forces of the last step, the plates and those forces; (2 k, 2 p + q), (2 k, m), (2 k, d).
        past: what the dampers remember; (k, ...).
        step: number of the present step; (1,).
        kept: coefficients [N s/m] and forces beyond the softest setting [N] at the samples; (samples, k, 4).
    """

    dampers: npt.NDArray[np.int64]
    laws: npt.NDArray[Any]
    states: Vector
    plates: Vector
    forces: Vector
    past: Vector
    step: npt.NDArray[np.int64]
    kept: Vector


def control_of(model: PoleModel, factors: StepFactors, dampers: Sequence[Damper], columns: Sequence[int]) -> Control:
    """The controlled dampers at rest.

    Args:
        model, factors, columns: as of `Readout`.
        dampers: laws of all dampers.
    """
    chosen = [index for index, damper in enumerate(dampers) if damper.controlled is not None]
    laws = in_steps(np.reshape([pack(damper.controlled) for damper in dampers if damper.controlled], (-1, 8)),
                    factors.timestep)  # fmt: skip
    # Displacements at the sensors; their velocities are no sum with the plates.
    rows = np.zeros((0, len(model.poles)), dtype=np.complex128)
    if chosen:
        rows = model.matrices.sensors @ (model.modal * model.poles)
    still = np.zeros((len(rows), len(model.matrices.system.inputs)))
    sensors = Readout(Outputs(poles=rows, height=still, velocity=still), factors, model.pairs, columns)
    past = np.zeros((len(chosen), RING + 1 + int(np.max(laws["lag"], initial=0.0))))
    past[:] = laws["softest"][:, None]
    return Control(
        dampers=np.array(chosen, dtype=np.int64),
        laws=laws,
        states=np.ascontiguousarray(sensors.rows),
        plates=np.ascontiguousarray(sensors.by_plate),
        forces=np.ascontiguousarray(sensors.by_step),
        past=past,
        step=np.zeros(1, dtype=np.int64),
        kept=np.zeros((1, len(chosen), 4)),
    )


@jitable
def sensed(row: int, pair: Any, real: Any, plates: Any, force: Any, c: Control) -> float:
    """Velocity at a sensor [m/s] at the end of the last step."""
    found, pairs = 0.0, pair.shape[1]
    for p in range(pairs):
        found += c.states[row, p] * pair[0, p] + c.states[row, pairs + p] * pair[1, p]
    for q in range(real.shape[0]):
        found += c.states[row, 2 * pairs + q] * real[q]
    for k in range(plates.shape[0]):
        found += c.plates[row, k] * plates[k]
    for i in range(c.forces.shape[1]):
        found += c.forces[row, i] * force[i]
    return found


@jitable
def control(pair: Any, real: Any, plates: Any, force: Any, gain: Any, velocity: Any, curves: Any, c: Control) -> None:
    """Set the coefficients of the step that begins.

    Args:
        pair, real: state of the poles without the forces of the last step.
        plates: (z, z') of the driven plates now.
        force: damper forces of the last step.
        gain: of the damper forces of a step.
        velocity: of the dampers now.
        curves: pieces of the dampers as of `solve_damper`; those of controlled ones are changed in place.
        c: changed in place.
    """
    for k in range(c.dampers.shape[0]):
        wheel = body = 0.0
        if c.step[0] % int(c.laws[k]["period"]) == 0:
            wheel = sensed(2 * k, pair, real, plates, force, c)
            body = sensed(2 * k + 1, pair, real, plates, force, c)
        act(c.laws[k], c.step[0], body, wheel, c.past[k])
        i, half = c.dampers[k], 0.5 * (c.past[k, PRESENT] - c.laws[k]["softest"])
        curves[i, 1, 0], curves[i, 2, 0] = half, half * velocity[i]
        curves[i, 3, 0] = 1.0 / (1.0 + gain[i, i] * half)
    c.step[0] += 1


@jitable
def keep(sample: int, after: int, velocity: Any, curves: Any, c: Control) -> None:
    """Keep a step that ends (after 0) or has begun (after 1) at a sample; `velocity` is that at its end."""
    for k in range(c.dampers.shape[0]):
        i = c.dampers[k]
        c.kept[sample, k, COEFFICIENT + after] = c.past[k, PRESENT]
        c.kept[sample, k, FORCE + after] = -(curves[i, 1, 0] * velocity[i] + curves[i, 2, 0])
