"""Rolling tyres: contact point on the road, slip, and explicit forces without a constraint row.

The wheel turns at -V/R + theta' about its axle e, the car driving along -x; theta is a coordinate of the model, the
steady part is not. The lowest point of the tread is at r = -a_y e - R d from the centre c, with d the component of
the vertical normal to e. It is a point of the wheel, so its velocity has the column e x r of the spin; pitch of the
hub about e leaves it at rest. The rows of a tyre at the point of the hub become those of this point,

    J -> J + w x (c + r - p_hub),   J_spin = e x r,

and their branches along x and y represent the slip (`docs/theory/rolling-tyre.md`). The input of the branch
along y is v_y + V psi, psi being the heading of the axle, in the middle of the past step. The known part of

- the slope of the road, F_z tan(beta) along x at the wheel centre, with the present load; tan(beta) is that of the
  cams of the tyre, or w'/V;
- the aligning moment, trail times side force, on the hub;
- the gyroscopic moment -omega x (H e) on the hub, H = -I V/R, carried to the present by the last two velocities;
- the course control on the body: along x, along y at the front axle, where a driver steers, and in yaw,

acts explicitly on the coordinates, as `push`. Source: Pacejka, Tire and Vehicle Dynamics, 3rd ed., chapters 7 to 9.
"""

from __future__ import annotations

import numpy as np

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import Efc, Fields, State, Weights


@jitable
def rolling_rows(d: Fields, efc: Efc, e: Layout) -> None:
    """Move rows, residuals and rates of the rolling tyres to the lowest point of the tread."""
    rolling = e.rolling
    for entry in range(rolling.dofs.shape[0]):
        n, dof = rolling.dofs[entry, 0], rolling.dofs[entry, 1]
        frame, row, radius, motion = (
            d.xmat[rolling.hubs[n]],
            e.bushings.rows[rolling.tyres[n], 0],
            rolling.arms[n, 2],
            d.cdof[dof],
        )
        level = np.sqrt(1.0 - frame[7] * frame[7])
        x = radius * (frame[2] + frame[7] * frame[1] / level)
        y = radius * (frame[5] + frame[7] * frame[4] / level)
        z = radius * (frame[8] - level)
        u, v, w = motion[1] * z - motion[2] * y, motion[2] * x - motion[0] * z, motion[0] * y - motion[1] * x
        efc.J[row, dof] += u
        efc.J[row + 1, dof] += v
        efc.J[row + 2, dof] += w
        efc.vel[row] += u * d.qvel[dof]
        efc.vel[row + 1] += v * d.qvel[dof]
        efc.vel[row + 2] += w * d.qvel[dof]
    for n in range(rolling.tyres.shape[0]):
        frame, row, radius, spin = (
            d.xmat[rolling.hubs[n]],
            e.bushings.rows[rolling.tyres[n], 0],
            rolling.arms[n, 2],
            rolling.spins[n],
        )
        level = np.sqrt(1.0 - frame[7] * frame[7])
        efc.pos[row] += radius * (frame[2] + frame[7] * frame[1] / level)
        efc.pos[row + 1] += radius * (frame[5] + frame[7] * frame[4] / level)
        efc.pos[row + 2] += radius * (frame[8] - level)
        # e x r = -R e x d, which is level.
        efc.J[row, spin] = -radius * frame[4] / level
        efc.J[row + 1, spin] = radius * frame[1] / level
        efc.J[row + 2, spin] = 0.0
        efc.vel[row] += efc.J[row, spin] * d.qvel[spin]
        efc.vel[row + 1] += efc.J[row + 1, spin] * d.qvel[spin]


@jitable
def headings(time: float, d: Fields, e: Layout, s: State) -> None:
    """Update heading and angular velocity of the hubs once for each time, and add the heading to the side slip.

    At t = 0, where the car is linearised, the side slip has no heading.
    """
    rolling = e.rolling
    if rolling.tyres.shape[0] == 0:
        return
    if time != s.last_time[0]:
        for n in range(rolling.tyres.shape[0]):
            frame = d.xmat[rolling.hubs[n]]
            s.heading[1, n], s.heading[0, n] = s.heading[0, n], np.arctan2(-frame[1], frame[4])
            for i in range(3):
                s.turning[n, 3 + i], s.turning[n, i] = s.turning[n, i], 0.0
        for entry in range(rolling.dofs.shape[0]):
            n, dof = rolling.dofs[entry, 0], rolling.dofs[entry, 1]
            for i in range(3):
                s.turning[n, i] += d.cdof[dof, i] * d.qvel[dof]
    if time > 0.0:
        for n in range(rolling.tyres.shape[0]):
            s.rate[rolling.tyres[n], 1] += rolling.speeds[n] * 0.5 * (s.heading[0, n] + s.heading[1, n])


@jitable
def rolling_forces(d: Fields, efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Apply road slope, aligning and gyroscopic moments on the hubs, and the course control.

    The static horizontal tyre forces, mN from `SLIDING_SHARE` of the trim, act on the hub and rotate no wheel.
    """
    rolling, push = e.rolling, s.push
    for dof in range(push.shape[0]):
        push[dof] = 0.0
    for n in range(rolling.tyres.shape[0]):
        tyre, frame, t = rolling.tyres[n], d.xmat[rolling.hubs[n]], s.turning[n]
        row, spin = e.bushings.rows[tyre, 0], rolling.spins[n]
        push[spin] = -c.preload[row] * efc.J[row, spin] - c.preload[row + 1] * efc.J[row + 1, spin]
        s.slope[n, 0] = max(0.0, s.force[tyre, 2]) * s.slope_velocity[rolling.plates[n]] / rolling.speeds[n]
        # -omega x (H e) = H e x omega
        momentum = -rolling.inertias[n] * rolling.speeds[n] / rolling.arms[n, 2]
        x, y, z = 1.5 * t[0] - 0.5 * t[3], 1.5 * t[1] - 0.5 * t[4], 1.5 * t[2] - 0.5 * t[5]
        s.slope[n, 1] = momentum * (frame[4] * z - frame[7] * y)
        s.slope[n, 2] = momentum * (frame[7] * x - frame[1] * z)
        s.slope[n, 3] = momentum * (frame[1] * y - frame[4] * x) - rolling.trails[n] * s.branch_past[tyre, 1]
    for entry in range(rolling.dofs.shape[0]):
        n, dof, tree = rolling.dofs[entry, 0], rolling.dofs[entry, 1], rolling.dofs[entry, 2]
        frame, arm, motion, load = d.xmat[rolling.hubs[n]], rolling.arms[n], d.cdof[dof], s.slope[n]
        point, centre = d.site_xpos[rolling.sites[n]], d.subtree_com[tree]
        y = point[1] + frame[3] * arm[0] + frame[4] * arm[1] + frame[5] * arm[2] - centre[1]
        z = point[2] + frame[6] * arm[0] + frame[7] * arm[1] + frame[8] * arm[2] - centre[2]
        push[dof] += load[0] * (motion[3] + motion[1] * z - motion[2] * y)
        push[dof] += load[1] * motion[0] + load[2] * motion[1] + load[3] * motion[2]
    if rolling.course.shape[0] > 0:
        frame, hold, ahead = d.xmat[e.modes.body], rolling.hold, rolling.hold[6]
        away, yaw_rate = np.arctan2(frame[3], frame[0]), d.qvel[rolling.course[2]]
        x, y = d.qpos[rolling.course[3]] - rolling.rest[0], d.qpos[rolling.course[4]] - rolling.rest[1] + ahead * away
        side = hold[1] * y + hold[4] * (d.qvel[rolling.course[1]] + ahead * yaw_rate)
        push[rolling.course[0]] -= hold[0] * x + hold[3] * d.qvel[rolling.course[0]]
        push[rolling.course[1]] -= side
        push[rolling.course[2]] -= hold[2] * away + hold[5] * yaw_rate + ahead * side
    for dof in range(push.shape[0]):
        d.qfrc_applied[dof] += push[dof]
