"""The element laws in explicit loops: the same arithmetic as `ElementRows.__call__`, for numba.

One small function for each part, in the order of the numpy form, which explains them and stays as the reference.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from vehicle.simulation.native_arrays import Constants, Fields, Indices, State


def _modal_rows(d: Fields, e: Indices, c: Constants, s: State) -> None:
    """J -> J +- (R Phi_n, -[d]x), r -> r +- d, r' -> r' +- (R Phi_n q' + w x d) for the rows at flexible nodes."""
    body, modes, column, place = e.modal[0, 0], e.modal[1, 0], e.modal[2, 0], e.modal[3, 0]
    turn = d.xmat[body]
    nodes, count = e.node_rows.shape[1], c.mode_shapes.shape[1]
    t0, t1, t2, t3, t4 = turn[0], turn[1], turn[2], turn[3], turn[4]
    t5, t6, t7, t8 = turn[5], turn[6], turn[7], turn[8]
    moved, moving = s.deflection[0], s.deflection[1]
    moved[:], moving[:] = 0.0, 0.0
    # Deflections of all nodes in body axes, mode by mode: long loops without sums that wait for each other.
    for k in range(modes):
        q, v, shape = d.qpos[place + k, 0], d.qvel[column + k, 0], c.mode_shapes[k]
        for j in range(count):
            moved[j] += shape[j] * q
            moving[j] += shape[j] * v
    for node in range(nodes):
        at = node * modes
        r0, r1, r2 = e.node_rows[0, node], e.node_rows[1, node], e.node_rows[2, node]
        x, y, z = moved[node], moved[nodes + node], moved[2 * nodes + node]
        dx, dy, dz = t0 * x + t1 * y + t2 * z, t3 * x + t4 * y + t5 * z, t6 * x + t7 * y + t8 * z
        d.efc_pos[r0, 0] += dx
        d.efc_pos[r1, 0] += dy
        d.efc_pos[r2, 0] += dz
        x, y, z = moving[node], moving[nodes + node], moving[2 * nodes + node]
        vx, vy, vz = t0 * x + t1 * y + t2 * z, t3 * x + t4 * y + t5 * z, t6 * x + t7 * y + t8 * z
        for k in range(e.body_turns.shape[0]):
            dof = e.body_turns[k, 0]
            x, y, z = d.cdof[dof, 0], d.cdof[dof, 1], d.cdof[dof, 2]
            x, y, z = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
            d.efc_J[r0, dof] += x
            d.efc_J[r1, dof] += y
            d.efc_J[r2, dof] += z
            turning = d.qvel[dof, 0]
            vx, vy, vz = vx + x * turning, vy + y * turning, vz + z * turning
        d.efc_vel[r0, 0] += vx
        d.efc_vel[r1, 0] += vy
        d.efc_vel[r2, 0] += vz
        for k in range(modes):
            x, y, z = c.node_shapes[0, at + k], c.node_shapes[1, at + k], c.node_shapes[2, at + k]
            d.efc_J[r0, column + k] = t0 * x + t1 * y + t2 * z
            d.efc_J[r1, column + k] = t3 * x + t4 * y + t5 * z
            d.efc_J[r2, column + k] = t6 * x + t7 * y + t8 * z


def _springs(d: Fields, e: Indices, c: Constants, s: State) -> None:
    """Main springs: the line through the displaced seat, its derivatives, and the elastic force."""
    body, modes, column, place = e.modal[0, 0], e.modal[1, 0], e.modal[2, 0], e.modal[3, 0]
    turn = d.xmat[body]
    for spring in range(e.springs.shape[0]):
        row = e.springs[spring, 0]
        ends, line = s.ends[2 * spring : 2 * spring + 2], s.line[spring]
        for i in range(3):
            ends[0, i] = d.site_xpos[e.spring_sites[spring, 0], i]
            ends[1, i] = d.site_xpos[e.spring_sites[spring, 1], i]
            for j in range(3):
                for k in range(modes):
                    ends[1, i] += turn[3 * i + j] * c.spring_shapes[spring, j * modes + k] * d.qpos[place + k, 0]
            line[i] = ends[1, i] - ends[0, i]
        length = np.sqrt(line[0] * line[0] + line[1] * line[1] + line[2] * line[2])
        for i in range(3):
            line[i] /= length
        for dof in range(d.efc_J.shape[1]):
            d.efc_J[row, dof] = 0.0
        for j in range(3):
            along = line[0] * turn[j] + line[1] * turn[3 + j] + line[2] * turn[6 + j]
            for k in range(modes):
                d.efc_J[row, column + k] += along * c.spring_shapes[spring, j * modes + k]
        residual = length - c.spring_lengths[spring, 0]
        s.explicit[0, row] = c.spring_preload[spring, 0] - c.spring_stiffness[spring, 0] * residual
        d.efc_D[row, 0] = c.spring_impedance[spring, 0]
        d.efc_aref[row, 0] = 0.0
    for entry in range(e.spring_dofs.shape[0]):
        spring, end, dof, tree = e.spring_dofs[entry]
        line, point, centre, motion = s.line[spring], s.ends[2 * spring + end], d.subtree_com[tree], d.cdof[dof]
        x, y, z = point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]
        velocity = (
            line[0] * (motion[3] + motion[1] * z - motion[2] * y)
            + line[1] * (motion[4] + motion[2] * x - motion[0] * z)
            + line[2] * (motion[5] + motion[0] * y - motion[1] * x)
        )
        d.efc_J[e.springs[spring, 0], dof] += (2 * end - 1) * velocity


def _local_axes(d: Fields, e: Indices, s: State) -> None:
    """Residual and rate of every element in its own axes, with the velocity of the plates taken off."""
    for n in range(e.rows.shape[0]):
        frame, row = d.xmat[e.carriers[n, 0]], e.rows[n]
        x, y, z = d.efc_pos[row[0], 0], d.efc_pos[row[1], 0], d.efc_pos[row[2], 0]
        for i in range(3):
            s.residual[n, i] = frame[i] * x + frame[3 + i] * y + frame[6 + i] * z
            s.force[n, i] = d.efc_vel[row[i], 0]
    for tyre in range(e.tyres.shape[0]):
        for i in range(3):
            s.force[e.tyres[tyre, 0], i] -= s.plate_velocity[tyre, i]
    for n in range(e.rows.shape[0]):
        frame = d.xmat[e.carriers[n, 0]]
        x, y, z = s.force[n, 0], s.force[n, 1], s.force[n, 2]
        for i in range(3):
            s.rate[n, i] = frame[i] * x + frame[3 + i] * y + frame[6 + i] * z


def _advance_branches(time: float, c: Constants, s: State) -> None:
    """Carry the Maxwell branches over the step that has just been completed."""
    last = s.last_time[0, 0]
    if time == last:
        return
    for n in range(s.rate.shape[0]):
        for i in range(3):
            rate = s.rate[n, i]
            if last >= 0.0:
                acceleration = (rate - s.last_rate[n, i]) / c.scalars[0, 0]
                s.branch_force[n, i] = s.branch_past[n, i] + c.branch_slope[n, i] * acceleration
                s.branch_past[n, i] = c.decay[n, i] * s.branch_force[n, i] + c.branch_gain[n, i] * rate
            s.last_rate[n, i] = rate
    s.last_time[0, 0] = time


def _elements(d: Fields, e: Indices, c: Constants, s: State) -> None:
    """f0 = preload - K r - B r' - f2, turned into world axes; impedance and reference of the rows."""
    for n in range(e.rows.shape[0]):
        for i in range(3):
            rate, past = s.rate[n, i], s.branch_past[n, i]
            curvature = (c.decay[n, i] - 2.0) * past + c.branch_gain[n, i] * rate + s.branch_force[n, i]
            branch = past + c.branch_average[n, i] * curvature
            s.force[n, i] = (
                c.element_preload[n, i] - c.stiffness[n, i] * s.residual[n, i] - c.damping[n, i] * rate - branch
            )
    for tyre in range(e.tyres.shape[0]):
        for i in range(3):
            s.force[e.tyres[tyre, 0], i] += c.inertial[tyre, i] * s.plate_acceleration[tyre, i]
    for n in range(e.rows.shape[0]):
        frame = d.xmat[e.carriers[n, 0]]
        x, y, z = s.force[n, 0], s.force[n, 1], s.force[n, 2]
        for i in range(3):
            row = e.rows[n, i]
            s.explicit[0, row] = frame[3 * i] * x + frame[3 * i + 1] * y + frame[3 * i + 2] * z
            d.efc_D[row, 0] = c.impedance[n, i]
            d.efc_aref[row, 0] = 0.0


def _rotations(d: Fields, e: Indices, c: Constants, s: State) -> None:
    """Torques of the mounts, T = R p - K_rot sin(angle) n, on the coordinates; after the forces of the rows."""
    for n in range(c.rotation_stiffness.shape[0]):
        moving, carrier = d.site_xmat[e.rotation_sites[n, 0]], d.site_xmat[e.rotation_sites[n, 1]]
        half = 0.5 * c.rotation_stiffness[n, 0]
        p = c.rotation_preload[n]
        x, y, z = 0.0, 0.0, 0.0
        for axis in range(3):
            cx, cy, cz = carrier[axis], carrier[3 + axis], carrier[6 + axis]
            mx, my, mz = moving[axis], moving[3 + axis], moving[6 + axis]
            x += p[axis] * cx - half * (cy * mz - cz * my)
            y += p[axis] * cy - half * (cz * mx - cx * mz)
            z += p[axis] * cz - half * (cx * my - cy * mx)
        s.torque[n, 0], s.torque[n, 1], s.torque[n, 2] = x, y, z
    for entry in range(e.turning.shape[0]):
        n, dof, sign = e.turning[entry, 0], e.turning[entry, 1], e.turning[entry, 2]
        turning = d.cdof[dof, 0] * s.torque[n, 0] + d.cdof[dof, 1] * s.torque[n, 1] + d.cdof[dof, 2] * s.torque[n, 2]
        d.qfrc_applied[0, dof] += sign * turning


def _ideal_joints(d: Fields, e: Indices, c: Constants, s: State) -> None:
    """Ball joints without a law: MuJoCo's own reference, with the modal coordinates."""
    for n in range(e.hard_rows.shape[0]):
        for i in range(3):
            row = e.hard_rows[n, i]
            s.explicit[0, row] = c.hard_preload[n, i]
            law = d.efc_KBIP[row]
            d.efc_aref[row, 0] = -law[1] * d.efc_vel[row, 0] - law[0] * law[2] * d.efc_pos[row, 0]


def _dampers(d: Fields, e: Indices, c: Constants, s: State) -> None:
    """Viscous, friction and valve rows of the dampers."""
    for n in range(e.dampers.shape[0]):
        row = e.dampers[n, 0]
        d.efc_D[row, 0] = c.damper_impedance[n, 0]
        d.efc_aref[row, 0] = 0.0
    step, empty, stribeck = c.scalars[0, 0], c.scalars[1, 0], c.scalars[2, 0]
    for n in range(e.frictions.shape[0]):
        row = e.frictions[n, 0]
        sliding = d.qvel[e.damper_dofs[n, 0], 0]
        if stribeck != 0.0:
            weight = np.exp(-(np.abs(sliding / c.stribeck_velocity[n, 0]) ** c.exponent[n, 0]))
            s.limits[0, n] = c.sliding_limit[n, 0] + (c.static_limit[n, 0] - c.sliding_limit[n, 0]) * weight
        limit = s.limits[0, n]
        slope = (2.0 / np.pi) * limit * c.smoothing[n, 0]
        d.efc_D[row, 0] = max(slope * step, empty)
        d.efc_aref[row, 0] = -sliding / step
        d.efc_frictionloss[row, 0] = limit
    for n in range(e.valves.shape[0]):
        row = e.valves[n, 0]
        d.efc_D[row, 0] = c.valve_impedance[n, 0]
        d.efc_aref[row, 0] = -2.0 * d.qvel[e.damper_dofs[n, 0], 0] / step
        d.efc_frictionloss[row, 0] = c.valve_limit[n, 0]


def _generalised_forces(d: Fields, e: Indices, s: State) -> None:
    """R = 1 / D, and the explicit forces of the rows on the coordinates that they reach, J' f0."""
    count, dofs = d.efc_J.shape
    total = d.qfrc_applied[0]
    for j in range(dofs):
        total[j] = 0.0
    for row in range(count):
        d.efc_R[row, 0] = 1.0 / d.efc_D[row, 0]
    for entry in range(e.reach.shape[0]):
        row, rows, first, last = e.reach[entry, 0], e.reach[entry, 1], e.reach[entry, 2], e.reach[entry, 3]
        if rows == 3:
            x, y, z = s.explicit[0, row], s.explicit[0, row + 1], s.explicit[0, row + 2]
            # Views spare the inner loop the look for negative indices.
            jx, jy, jz = d.efc_J[row, first:last], d.efc_J[row + 1, first:last], d.efc_J[row + 2, first:last]
            part = total[first:last]
            for j in range(last - first):
                part[j] += x * jx[j] + y * jy[j] + z * jz[j]
        else:
            force = s.explicit[0, row]
            for j in range(first, last):
                total[j] += force * d.efc_J[row, j]


def _rewrite(time: float, d: Fields, e: Indices, c: Constants, s: State) -> None:
    """Rewrite the rows of one state."""
    if e.modal[1, 0] > 0:
        modal_rows(d, e, c, s)
    local_axes(d, e, s)
    advance_branches(time, c, s)
    elements(d, e, c, s)
    springs(d, e, c, s)
    ideal_joints(d, e, c, s)
    dampers(d, e, c, s)
    generalised_forces(d, e, s)
    rotations(d, e, c, s)


LOOSENED = {"reassoc", "contract", "nsz"}
"""Sums in any order, with fused products, so that they fill the vector units: round-off, and nothing else."""


def _compiled(function: Any) -> Any:
    """A function for the compiled callback; division as numpy has it."""
    return numba.njit(fastmath=LOOSENED, boundscheck=False, error_model="numpy", inline="always")(function)


modal_rows, springs, local_axes = _compiled(_modal_rows), _compiled(_springs), _compiled(_local_axes)
advance_branches, elements, rotations = _compiled(_advance_branches), _compiled(_elements), _compiled(_rotations)
ideal_joints, dampers = _compiled(_ideal_joints), _compiled(_dampers)
generalised_forces, rewrite = _compiled(_generalised_forces), _compiled(_rewrite)
