"""Computation of channels from the states of the poles at the samples of a run."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.pole_model import Outputs
from vehicle.engines.reduced.step_factors import StepFactors

Vector = npt.NDArray[np.float64]


class Readout:
    """Outputs w = Re(rows xi) + ..., xi = eta + ahead (z, z') + step force f, as one product with the real states.

    Args:
        outputs: rows of the channels.
        factors: factors of the step.
        pairs: number of complex poles.
        columns: columns of (z, z') of all plates that are in the plate samples.
    """

    def __init__(self, outputs: Outputs, factors: StepFactors, pairs: int, columns: Sequence[int]) -> None:
        rows, driven = outputs.poles, list(columns)
        self.rows = np.hstack([rows[:, :pairs].real, -rows[:, :pairs].imag, rows[:, pairs:].real])
        direct = np.hstack([outputs.height, outputs.velocity])
        self.by_plate = ((rows @ factors.ahead).real + direct)[:, driven]
        self.by_step = (rows @ factors.force).real

    def at(self, states: Vector, plates: Vector, before: Vector) -> Vector:
        """Return the outputs at samples.

        Args:
            states: eta without the forces of the last step; (samples, 2 p + q).
            plates: (z, z') of the driven plates; (samples, m).
            before: damper forces of the last step [N]; (samples, w).

        Returns:
            Outputs, (outputs, samples).
        """
        table = np.asarray(self.rows @ states.T)
        table += self.by_plate @ plates.T
        table += self.by_step @ before.T
        return table
