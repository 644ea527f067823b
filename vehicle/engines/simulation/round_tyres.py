"""Round tyres at rest: the vertical force acts on the lowest point of the tread, horizontal forces on the patch.

A wheel that stands on a plate with its axle fixed to the hub carries the patch with it. If the hub pitches by theta,
a patch fixed to the wheel moves along x by R theta, and the vertical force F would turn the hub on: a stiffness of -F R
about the axle, which takes a fifth off the wheel rate of a trailing arm. A round tread does not do so: its height over
the plate depends on the wheel centre c and the axle e alone. The vertical row of the tyre becomes that of the point
below the centre, c - R d with d the component of the vertical normal to e (`rolling_tyres`),

    z -> z + R (d_wheel z - d z),   J_z -> J_z + (w x (c - R d - p))_z,

with the point p = c - R d_wheel of the wheel. Rows along x and y and the rotational stiffness stay with the wheel: the
tread sticks to the plate.
"""

from __future__ import annotations

import numpy as np

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import Efc, Fields


@jitable
def round_rows(d: Fields, efc: Efc, e: Layout) -> None:
    """Move the vertical rows of round tyres at rest to the lowest points of the treads."""
    tyres = e.round
    for entry in range(tyres.dofs.shape[0]):
        n, dof = tyres.dofs[entry, 0], tyres.dofs[entry, 1]
        frame, row, radius, motion = d.xmat[tyres.hubs[n]], e.bushings.rows[tyres.tyres[n], 2], tyres.radii[n], d.cdof
        level = np.sqrt(1.0 - frame[7] * frame[7])
        x = radius * (frame[2] + frame[7] * frame[1] / level)
        y = radius * (frame[5] + frame[7] * frame[4] / level)
        change = motion[dof, 0] * y - motion[dof, 1] * x
        efc.J[row, dof] += change
        efc.vel[row] += change * d.qvel[dof]
    for n in range(tyres.tyres.shape[0]):
        frame, row = d.xmat[tyres.hubs[n]], e.bushings.rows[tyres.tyres[n], 2]
        efc.pos[row] += tyres.radii[n] * (frame[8] - np.sqrt(1.0 - frame[7] * frame[7]))
