"""Load channels as outputs of the poles.

u = Re(modal xi), u' = Re(modal s xi), u'' = Re(modal s xi') with xi' of the poles.

xi' = s xi + b_z z + b_c z' + e f: plates and damper forces act directly on xi' and hence on u'', and on no other part
of a load.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.pole_model import Outputs, PoleModel

Vector = npt.NDArray[np.float64]


def load_outputs(model: PoleModel, loads: LoadRows) -> Outputs:
    """Return the rows of loads over the poles and the plates, without static values and `direct_forces`.

    Args:
        model: pole model of the car.
        loads: rows of the loads over the motion.
    """
    rate = model.modal * model.poles
    return Outputs(
        poles=loads.displacement @ model.modal
        + loads.velocity @ rate
        + loads.acceleration @ (rate * model.poles)
        + loads.branch @ model.branch,
        height=loads.height + (loads.acceleration @ (rate @ model.height)).real,
        velocity=loads.height_rate + (loads.acceleration @ (rate @ model.velocity)).real,
    )


def direct_forces(model: PoleModel, loads: LoadRows) -> Vector:
    """Return the rows of loads over the nonlinear damper forces at the same instant; (loads, d)."""
    return np.asarray(loads.friction + (loads.acceleration @ (model.modal * model.poles @ model.force)).real)
