"""What rolling tyres and the hold of the course add to the matrices of a car.

The side slip of a rolling tyre drifts with the heading of its hub, g = V t_z, and its side force acts by its trail on
the heading too, h = e + trail t_z; t are the rotations of the hub over the coordinates. The moment H e_y x omega of the
wheel, H = -I V/R, is -C u' with C = -H t' [e_y]x t, skew. The slope of the road z'/V pushes the wheel centre along x by
the static load.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.rows import Rows

Vector = npt.NDArray[np.float64]

ACROSS = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
"""Matrix of e_y x a."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RollingTerms:
    """Terms of r rolling tyres; n coordinates, w plates.

    Attributes:
        elements: their positions among the bushings; (r,).
        drift, arm: V t_z and trail t_z; (r, n).
        damping: gyroscopic moments, and damping of the hold; (n, n).
        slope: force of a plate's velocity; (n, w).
    """

    elements: npt.NDArray[np.int64]
    drift: Vector
    arm: Vector
    damping: Vector
    slope: Vector

    def branches(self, rows: Vector, present: npt.NDArray[np.bool_]) -> dict[str, Vector]:
        """Drifts and effects of the Maxwell branches of a car.

        Args:
            rows: of the branches; (b, n).
            present: which axes of which bushings have one; (bushings, 3).
        """
        drifts, effects = np.zeros_like(rows), rows.copy()
        numbers = np.cumsum(present.ravel()).reshape(present.shape) - 1
        drifts[numbers[self.elements, 1]] = self.drift
        effects[numbers[self.elements, 1]] += self.arm
        return {"branch_drifts": drifts, "branch_effects": effects}


def rolling_terms(rows: Rows, preload: Vector) -> RollingTerms:
    """Terms of a car in its design position.

    Args:
        rows: of the car, with its rolling tyres.
        preload: static forces of the rows.
    """
    model, e, own = rows.model, rows.layout, rows.layout.rolling
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    turns, centres = np.zeros((len(own.hubs), 3, model.nv)), np.zeros((len(own.hubs), 3, model.nv))
    for turn, centre, hub, site, arm in zip(turns, centres, own.hubs, own.sites, own.arms, strict=True):
        mujoco.mj_jac(model, data, centre, turn, data.site_xpos[site] + arm, int(hub))
    damping = np.zeros((model.nv, model.nv))
    for turn, momentum in zip(turns, -own.inertias * own.speeds / own.arms[:, 2], strict=True):
        damping -= momentum * turn.T @ ACROSS @ turn
    course = own.course_rows(model.nv)
    damping += course.T @ (own.hold[3:6, None] * course)
    slope = np.zeros((model.nv, len(e.tyres)))
    slope[:, own.plates] = (centres[:, 0] * (preload[e.bushings.rows[own.tyres, 2]] / own.speeds)[:, None]).T
    return RollingTerms(
        elements=own.tyres,
        drift=own.speeds[:, None] * turns[:, 2],
        arm=own.trails[:, None] * turns[:, 2],
        damping=damping,
        slope=slope,
    )
