"""Explicit torques of the elements with a rotational stiffness, after the forces of the rows.

The torque on the moving part is T = C p - K_rot sin(angle) n with sin(angle) n = half the sum of c_k x m_k over the
axes of the carrier's frame C and of the moving part's: K_rot is soft compared with every inertia and undamped, so it
needs no rows.

With rotational mode shapes of a node, theta = R Psi_n q rotates the frame of that side: c_k + theta x c_k. The preload
p rotates with the node too. The torque acts on the modes by +-Psi_n' R' T and on the rigid body by +-T. Without
rotational shapes, the side rotates as a rigid body. Only torques depend on theta. The axes of the forces of a bushing
rotate with the rigid body: the neglected theta x f0 is of the order of the neglected moment r x f
(`vehicle.engines.simulation.kernel`).
"""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout, Vector
from vehicle.engines.simulation.step_records import Fields, State, Weights


@jitable
def torque(n: int, moving: Vector, carrier: Vector, e: Layout, c: Weights, s: State) -> None:
    """Compute the torque of an element between two frames, given row by row, in world axes."""
    half = 0.5 * e.rotations.stiffness[n]
    first = c.preload.shape[0] - 3 * e.rotations.sites.shape[0]
    x, y, z = 0.0, 0.0, 0.0
    for axis in range(3):
        p = c.preload[first + 3 * n + axis]
        cx, cy, cz = carrier[axis], carrier[3 + axis], carrier[6 + axis]
        mx, my, mz = moving[axis], moving[3 + axis], moving[6 + axis]
        x += p * cx - half * (cy * mz - cz * my)
        y += p * cy - half * (cz * mx - cx * mz)
        z += p * cz - half * (cx * my - cy * mx)
    s.torque[n, 0], s.torque[n, 1], s.torque[n, 2] = x, y, z


@jitable
def node_torque(k: int, d: Fields, e: Layout, c: Weights, s: State) -> None:
    """Compute the torque of an element at a node with rotational mode shapes, and apply it to the modes."""
    elements, m = e.rotations, e.modes
    n, side, shape, turn, frame = (
        elements.nodes[k, 0],
        elements.nodes[k, 1],
        elements.shapes[k],
        d.xmat[m.body],
        s.frame[k],
    )
    x, y, z = 0.0, 0.0, 0.0
    for mode in range(m.size):
        q = d.qpos[m.first_position + mode]
        x += shape[mode] * q
        y += shape[m.size + mode] * q
        z += shape[2 * m.size + mode] * q
    tx = turn[0] * x + turn[1] * y + turn[2] * z
    ty = turn[3] * x + turn[4] * y + turn[5] * z
    tz = turn[6] * x + turn[7] * y + turn[8] * z
    rigid = d.site_xmat[elements.sites[n, side]]
    for axis in range(3):
        x, y, z = rigid[axis], rigid[3 + axis], rigid[6 + axis]
        frame[axis], frame[3 + axis], frame[6 + axis] = x + ty * z - tz * y, y + tz * x - tx * z, z + tx * y - ty * x
    if side == 0:
        torque(n, frame, d.site_xmat[elements.sites[n, 1]], e, c, s)
    else:
        torque(n, d.site_xmat[elements.sites[n, 0]], frame, e, c, s)
    x, y, z = s.torque[n, 0], s.torque[n, 1], s.torque[n, 2]
    sign = 1.0 - 2.0 * side
    along_x = sign * (turn[0] * x + turn[3] * y + turn[6] * z)
    along_y = sign * (turn[1] * x + turn[4] * y + turn[7] * z)
    along_z = sign * (turn[2] * x + turn[5] * y + turn[8] * z)
    for mode in range(m.size):
        force = shape[mode] * along_x + shape[m.size + mode] * along_y + shape[2 * m.size + mode] * along_z
        d.qfrc_applied[m.first_velocity + mode] += force


@jitable
def rotations(d: Fields, e: Layout, c: Weights, s: State) -> None:
    """Apply the torques of all elements to the coordinates."""
    elements = e.rotations
    for n in range(elements.sites.shape[0]):
        torque(n, d.site_xmat[elements.sites[n, 0]], d.site_xmat[elements.sites[n, 1]], e, c, s)
    for k in range(elements.nodes.shape[0]):
        node_torque(k, d, e, c, s)
    for entry in range(elements.turning.shape[0]):
        n, dof, sign = elements.turning[entry, 0], elements.turning[entry, 1], elements.turning[entry, 2]
        along = d.cdof[dof, 0] * s.torque[n, 0] + d.cdof[dof, 1] * s.torque[n, 1] + d.cdof[dof, 2] * s.torque[n, 2]
        d.qfrc_applied[dof] += sign * along
