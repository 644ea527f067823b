"""Contribution of the body modes to the rows at flexible nodes; equations in `vehicle.engines.simulation.kernel`."""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import Efc, Fields, State


@jitable
def modal_rows(d: Fields, efc: Efc, e: Layout, s: State) -> None:
    """Add the modes to the rows at flexible nodes.

    J -> J +- (R Phi_n, -[d]x), r -> r +- d, r' -> r' +- (R Phi_n q' + w x d).
    """
    m = e.modes
    modes, column, position = m.size, m.first_velocity, m.first_position
    turn = d.xmat[m.body]
    nodes, count = m.rows.shape[1], m.mode_shapes.shape[1]
    t0, t1, t2, t3, t4 = turn[0], turn[1], turn[2], turn[3], turn[4]
    t5, t6, t7, t8 = turn[5], turn[6], turn[7], turn[8]
    moved, moving = s.deflection[0], s.deflection[1]
    moved[:], moving[:] = 0.0, 0.0
    # Deflections of all nodes in body axes, mode by mode: long loops without dependent sums.
    for k in range(modes):
        q, v, shape = d.qpos[position + k], d.qvel[column + k], m.mode_shapes[k]
        for j in range(count):
            moved[j] += shape[j] * q
            moving[j] += shape[j] * v
    for node in range(nodes):
        at = node * modes
        r0, r1, r2 = m.rows[0, node], m.rows[1, node], m.rows[2, node]
        x, y, z = moved[node], moved[nodes + node], moved[2 * nodes + node]
        dx, dy, dz = t0 * x + t1 * y + t2 * z, t3 * x + t4 * y + t5 * z, t6 * x + t7 * y + t8 * z
        efc.pos[r0] += dx
        efc.pos[r1] += dy
        efc.pos[r2] += dz
        x, y, z = moving[node], moving[nodes + node], moving[2 * nodes + node]
        vx, vy, vz = t0 * x + t1 * y + t2 * z, t3 * x + t4 * y + t5 * z, t6 * x + t7 * y + t8 * z
        for k in range(m.turns.shape[0]):
            dof = m.turns[k]
            x, y, z = d.cdof[dof, 0], d.cdof[dof, 1], d.cdof[dof, 2]
            x, y, z = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
            efc.J[r0, dof] += x
            efc.J[r1, dof] += y
            efc.J[r2, dof] += z
            rate = d.qvel[dof]
            vx, vy, vz = vx + x * rate, vy + y * rate, vz + z * rate
        efc.vel[r0] += vx
        efc.vel[r1] += vy
        efc.vel[r2] += vz
        for k in range(modes):
            x, y, z = m.node_shapes[0, at + k], m.node_shapes[1, at + k], m.node_shapes[2, at + k]
            efc.J[r0, column + k] = t0 * x + t1 * y + t2 * z
            efc.J[r1, column + k] = t3 * x + t4 * y + t5 * z
            efc.J[r2, column + k] = t6 * x + t7 * y + t8 * z
