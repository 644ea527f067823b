"""Longitudinal forces of the current wheel loads on the slope of a road, constant over a step.

A rolling tyre pushes its wheel centre along x by F_z z'/V (`vehicle.engines.simulation.rolling_tyres`). The poles
contain the effect of the static load F_0, as a force b z' of the velocity of the plate. The current load adds

    b (max(0, F_z) / F_0 - 1) z',

a product of two motions. It acts as a force that is constant over a step: z' is the mean of both ends, F_z the value in
the middle, extrapolated from the beginnings of this step and of the last step. Both are of second order in the step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.compiler import jitable
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.readout import Readout
from vehicle.engines.reduced.step_factors import StepFactors
from vehicle.engines.reduced.validity import tyre_outputs

Vector = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]


class SlopeForces(NamedTuple):
    """Slope forces of the r rolling tyres on driven plates, padded by an idle tyre to an even number.

    Attributes:
        states, plates, forces: rows of F_z/F_0 - 1 over the state of the poles without the forces of the last step, the
            plates and those forces; (r, 2 p + q), (r, m), (r, d).
        past: F_z/F_0 - 1 when the last step began; (r,).
    """

    states: Vector
    plates: Vector
    forces: Vector
    past: Vector


def slope_forces_at_rest(
    model: PoleModel, factors: StepFactors, columns: Sequence[int], tyre_load: Mapping[str, float] | None
) -> tuple[SlopeForces, Complex]:
    """Return the slope forces of a car at rest, and the factors of these forces on the poles.

    Args:
        model, factors, columns: see `Readout`.
        tyre_load: static tyre loads [N] by wheel; None for no tyres, so that the static loads act on the slope.

    Returns:
        The slope forces, and their factors (p, r).
    """
    inputs = model.matrices.system.inputs
    tyres = list(columns[::2]) if model.slope.shape[1] and tyre_load else []
    static = np.array([tyre_load[inputs[tyre]] for tyre in tyres] if tyre_load else [])[:, None]
    readout = Readout(tyre_outputs(model), factors, model.pairs, columns)
    idle = ((0, len(tyres) % 2), (0, 0))
    rows = [np.pad(part[tyres] / static, idle) for part in (readout.rows, readout.by_plate, readout.by_step)]
    return SlopeForces(rows[0], rows[1], rows[2], np.zeros(len(rows[0]))), np.pad(factors.slope[:, tyres], idle[::-1])


@jitable
def set_slope_forces(
    pair: Any, real: Any, plates: Any, step: int, force: Any, inputs: Any, first: int, s: SlopeForces
) -> None:
    """Set the inputs of the tyres for the next step.

    Args:
        pair, real: state of the poles without the forces of the last step.
        plates: (z, z') of the driven plates at the ends of the steps; (steps + 1, m).
        step: row of the beginning of the step.
        force: damper forces of the last step.
        inputs: inputs of the step; changed in place from `first` on.
        first: index of the input of the first tyre.
        s: slope forces; changed in place.
    """
    pairs = pair.shape[1]
    for i in range(s.past.shape[0]):
        row, load = s.states[i], 0.0
        for p in range(pairs):
            load += row[p] * pair[0, p] + row[pairs + p] * pair[1, p]
        for q in range(real.shape[0]):
            load += row[2 * pairs + q] * real[q]
        for k in range(plates.shape[1]):
            load += s.plates[i, k] * plates[step, k]
        for k in range(s.forces.shape[1]):
            load += s.forces[i, k] * force[k]
        middle, s.past[i] = 1.5 * load - 0.5 * s.past[i], load
        inputs[first + i] = 0.0
        # An idle tyre has no plate.
        if 2 * i < plates.shape[1]:
            inputs[first + i] = max(-1.0, middle) * 0.5 * (plates[step, 2 * i + 1] + plates[step + 1, 2 * i + 1])
