"""Tyres that roll: where they touch the road, their slip, and the forces that no row has.

The wheel turns at -V/R + theta' about its axle e, the car driving along -x; theta is a coordinate of the model, the
steady part is not. The lowest point of the tread lies at r = -a_y e - R d below the centre c, d being the vertical
without its part along e. It is a point of the wheel, so its velocity has the column e x r of the spin, and not one of
the hub: a hub that pitches about e does not move it. The rows of a tyre at the point of the hub become those of it,

    J -> J + w x (c + r - p_hub),   J_spin = e x r,

and their branches along x and y are the slip (`docs/theory.md`, "The rolling tyre"): that along y is driven by
v_y + V psi, psi being the heading of the axle, in the middle of the past step like every rate. The known part of

- the slope of the road, F_z w'/V along x at the wheel centre, with the present load;
- the aligning moment, trail times side force, on the hub;
- the gyroscopic moment -omega x (H e) on the hub, H = -I V/R, carried to the present by the last two velocities;
- the hold of the course, on the trimmed body: along x, along y at the front axle, where a driver steers, and in yaw,

acts explicitly on the coordinates, as `push`. Source: Pacejka, Tire and Vehicle Dynamics, 3rd ed., chapters 7 to 9.
"""

from __future__ import annotations

import numpy as np

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import Efc, Fields, State, Weights


@jitable
def rolling_rows(d: Fields, efc: Efc, e: Layout) -> None:
    """Rows, residuals and rates of the rolling tyres at the lowest point of the tread."""
    own = e.rolling
    for entry in range(own.dofs.shape[0]):
        n, dof = own.dofs[entry, 0], own.dofs[entry, 1]
        frame, row, radius, motion = d.xmat[own.hubs[n]], e.bushings.rows[own.tyres[n], 0], own.arms[n, 2], d.cdof[dof]
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
    for n in range(own.tyres.shape[0]):
        frame, row, radius, spin = d.xmat[own.hubs[n]], e.bushings.rows[own.tyres[n], 0], own.arms[n, 2], own.spins[n]
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
    """Heading and angular velocity of the hubs, once for each time; the side slip that the heading makes.

    At the time 0 the car has not moved yet: its tangents are taken there.
    """
    own = e.rolling
    if own.tyres.shape[0] == 0:
        return
    if time != s.last_time[0]:
        for n in range(own.tyres.shape[0]):
            frame = d.xmat[own.hubs[n]]
            s.heading[1, n], s.heading[0, n] = s.heading[0, n], np.arctan2(-frame[1], frame[4])
            for i in range(3):
                s.turning[n, 3 + i], s.turning[n, i] = s.turning[n, i], 0.0
        for entry in range(own.dofs.shape[0]):
            n, dof = own.dofs[entry, 0], own.dofs[entry, 1]
            for i in range(3):
                s.turning[n, i] += d.cdof[dof, i] * d.qvel[dof]
    if time > 0.0:
        for n in range(own.tyres.shape[0]):
            s.rate[own.tyres[n], 1] += own.speeds[n] * 0.5 * (s.heading[0, n] + s.heading[1, n])


@jitable
def rolling_forces(d: Fields, efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Slope, aligning and gyroscopic moments on the hubs, and the hold of the course, on the coordinates.

    What the tyres hold level at rest, mN of the sliding share of the trim, is held by the hub and turns no wheel.
    """
    own, push = e.rolling, s.push
    for dof in range(push.shape[0]):
        push[dof] = 0.0
    for n in range(own.tyres.shape[0]):
        tyre, frame, t = own.tyres[n], d.xmat[own.hubs[n]], s.turning[n]
        row, spin = e.bushings.rows[tyre, 0], own.spins[n]
        push[spin] = -c.preload[row] * efc.J[row, spin] - c.preload[row + 1] * efc.J[row + 1, spin]
        s.slope[n, 0] = max(0.0, s.force[tyre, 2]) * s.plate_velocity[own.plates[n], 2] / own.speeds[n]
        # -omega x (H e) = H e x omega
        momentum = -own.inertias[n] * own.speeds[n] / own.arms[n, 2]
        x, y, z = 1.5 * t[0] - 0.5 * t[3], 1.5 * t[1] - 0.5 * t[4], 1.5 * t[2] - 0.5 * t[5]
        s.slope[n, 1] = momentum * (frame[4] * z - frame[7] * y)
        s.slope[n, 2] = momentum * (frame[7] * x - frame[1] * z)
        s.slope[n, 3] = momentum * (frame[1] * y - frame[4] * x) - own.trails[n] * s.branch_past[tyre, 1]
    for entry in range(own.dofs.shape[0]):
        n, dof, tree = own.dofs[entry, 0], own.dofs[entry, 1], own.dofs[entry, 2]
        frame, arm, motion, given = d.xmat[own.hubs[n]], own.arms[n], d.cdof[dof], s.slope[n]
        point, centre = d.site_xpos[own.sites[n]], d.subtree_com[tree]
        y = point[1] + frame[3] * arm[0] + frame[4] * arm[1] + frame[5] * arm[2] - centre[1]
        z = point[2] + frame[6] * arm[0] + frame[7] * arm[1] + frame[8] * arm[2] - centre[2]
        push[dof] += given[0] * (motion[3] + motion[1] * z - motion[2] * y)
        push[dof] += given[1] * motion[0] + given[2] * motion[1] + given[3] * motion[2]
    if own.course.shape[0] > 0:
        frame, hold, ahead = d.xmat[e.modes.body], own.hold, own.hold[6]
        away, turning = np.arctan2(frame[3], frame[0]), d.qvel[own.course[2]]
        x, y = d.qpos[own.course[3]] - own.rest[0], d.qpos[own.course[4]] - own.rest[1] + ahead * away
        side = hold[1] * y + hold[4] * (d.qvel[own.course[1]] + ahead * turning)
        push[own.course[0]] -= hold[0] * x + hold[3] * d.qvel[own.course[0]]
        push[own.course[1]] -= side
        push[own.course[2]] -= hold[2] * away + hold[5] * turning + ahead * side
    for dof in range(push.shape[0]):
        d.qfrc_applied[dof] += push[dof]
