"""Terms of rolling tyres and of the course hold in the matrices of a car.

The side slip of a rolling tyre drifts with the heading of its hub, g = V t_z. By its trail, the side force also acts on
the heading, h = e + trail t_z. The rows t are the rotations of the hub over the coordinates. The moment H e_y x omega
of the wheel, H = -I V/R, is -C u' with C = -H t' [e_y]x t, skew. The slope of the road z'/V exerts a force on the wheel
centre along x, proportional to the static load.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.rows import Rows

Vector = npt.NDArray[np.float64]

ACROSS = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
"""Matrix of the cross product e_y x a."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RollingTerms:
    """Terms of r rolling tyres; n coordinates, w plates.

    Attributes:
        elements: indices of the tyres among the bushings; (r,).
        drift, arm: V t_z and trail t_z; (r, n).
        damping: gyroscopic moments, and damping of the course hold; (n, n).
        slope: generalised forces per velocity of a plate; (n, w).
    """

    elements: npt.NDArray[np.int64]
    drift: Vector
    arm: Vector
    damping: Vector
    slope: Vector

    def branches(self, rows: Vector, present: npt.NDArray[np.bool_]) -> dict[str, Vector]:
        """Return drifts and effects of the Maxwell branches of a car.

        Args:
            rows: rows e_b of the branches; (b, n).
            present: True for the axes of bushings with a branch; (bushings, 3).
        """
        drifts, effects = np.zeros_like(rows), rows.copy()
        numbers = np.cumsum(present.ravel()).reshape(present.shape) - 1
        drifts[numbers[self.elements, 1]] = self.drift
        effects[numbers[self.elements, 1]] += self.arm
        return {"branch_drifts": drifts, "branch_effects": effects}


def rolling_terms(rows: Rows, preload: Vector) -> RollingTerms:
    """Return the damping and stiffness terms that rolling wheels add to the linear car in its design position.

    Args:
        rows: constraint rows of all elements of the car, with its rolling tyres.
        preload: static forces of the rows [N].
    """
    model, e, rolling = rows.model, rows.layout, rows.layout.rolling
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    rotations, centres = np.zeros((len(rolling.hubs), 3, model.nv)), np.zeros((len(rolling.hubs), 3, model.nv))
    for rotation, centre, hub, site, arm in zip(
        rotations, centres, rolling.hubs, rolling.sites, rolling.arms, strict=True
    ):
        mujoco.mj_jac(model, data, centre, rotation, data.site_xpos[site] + arm, int(hub))
    damping = np.zeros((model.nv, model.nv))
    for rotation, momentum in zip(rotations, -rolling.inertias * rolling.speeds / rolling.arms[:, 2], strict=True):
        damping -= momentum * rotation.T @ ACROSS @ rotation
    course = rolling.course_rows(model.nv)
    damping += course.T @ (rolling.hold[3:6, None] * course)
    slope = np.zeros((model.nv, len(e.tyres)))
    slope[:, rolling.plates] = (
        centres[:, 0] * (preload[e.bushings.rows[rolling.tyres, 2]] / rolling.speeds)[:, None]
    ).T
    return RollingTerms(
        elements=rolling.tyres,
        drift=rolling.speeds[:, None] * rotations[:, 2],
        arm=rolling.trails[:, None] * rotations[:, 2],
        damping=damping,
        slope=slope,
    )
