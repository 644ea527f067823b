"""Acceleration of a step, solved with the sparsity of the car, as the start of MuJoCo's solver.

MuJoCo minimises the Gauss function over the rows f_i = D_i (aref_i - J_i a), friction rows limited to f. With the rows
at their limits known, its minimum is the solution of

    H a = Q + sum_i J_i' (D_i aref_i) +- sum_k J_k' f_k,      H = M + sum_i J_i' D_i J_i,

i being the rows within their limits and k the friction rows at their limits. The limits of the last step hold in most
steps; otherwise the system is solved again with the new limits. MuJoCo evaluates the gradient at this acceleration, and
iterates from there if it exceeds the tolerance of the solver: the result is that of its own solver.

H = L' L is factorised from the last coordinate to the first, so that the body, which all parts act on, comes last.
H and L are stored in tiles of 4 x 4 numbers, and all tiles outside the pattern of the model are zero.
Source: George, Liu, Computer Solution of Large Sparse Positive Definite Systems (1981), chapter 5.
"""

from __future__ import annotations

import numpy as np

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout, Table, Vector, copy_row
from vehicle.engines.simulation.kernel import damper_force
from vehicle.engines.simulation.step_records import Efc, Fields, Solution, State

TILE = 4
"""Rows and columns of a tile: a vector of AVX2."""

ATTEMPTS = 4
"""Largest number of solutions with changed limits; MuJoCo continues from the last one."""


@jitable
def start_of(tile: int) -> int:
    """Return the first coordinate of a tile, unsigned, which saves the check for negative indices."""
    return np.uint64(4) * np.uint64(tile)  # type: ignore[return-value]


@jitable
def add_rows(line: Vector, at: int, x: float, u: Vector, y: float, v: Vector, z: float, w: Vector) -> None:
    """Add x u + y v + z w to a row in a tile: all four sums before the first is stored, for SIMD."""
    unit = np.uint64(1)
    b, c, d = at + unit, at + unit + unit, at + unit + unit + unit
    p = line[at] + (x * u[at] + y * v[at] + z * w[at])
    q = line[b] + (x * u[b] + y * v[b] + z * w[b])
    r = line[c] + (x * u[c] + y * v[c] + z * w[c])
    s = line[d] + (x * u[d] + y * v[d] + z * w[d])
    line[at], line[b], line[c], line[d] = p, q, r, s


@jitable
def take_rows(
    line: Vector, at: int, f: tuple[float, float, float, float], u: tuple[Vector, Vector, Vector, Vector]
) -> None:
    """Subtract the sum of f_i u_i over four rows from a row in a tile."""
    unit = np.uint64(1)
    b, c, d = at + unit, at + unit + unit, at + unit + unit + unit
    p = line[at] - (f[0] * u[0][at] + f[1] * u[1][at] + f[2] * u[2][at] + f[3] * u[3][at])
    q = line[b] - (f[0] * u[0][b] + f[1] * u[1][b] + f[2] * u[2][b] + f[3] * u[3][b])
    r = line[c] - (f[0] * u[0][c] + f[1] * u[1][c] + f[2] * u[2][c] + f[3] * u[3][c])
    s = line[d] - (f[0] * u[0][d] + f[1] * u[1][d] + f[2] * u[2][d] + f[3] * u[3][d])
    line[at], line[b], line[c], line[d] = p, q, r, s


@jitable
def clear_tiles(h: Table, s: Solution) -> None:
    """Set the tiles of the matrix to zero, and its diagonal beyond the coordinates of the car to one."""
    for block in range(s.starts.shape[0] - 1):
        for tile in range(s.starts[block], s.starts[block + 1]):
            row, at = start_of(block), start_of(s.tiles[tile])
            for i in range(np.uint64(TILE)):
                for k in range(np.uint64(TILE)):
                    h[row + i, at + k] = 0.0
    for k in range(s.size, h.shape[0]):
        h[k, k] = 1.0


@jitable
def assemble_matrix(h: Table, mass: Vector, jacobian: Table, weight: Vector, s: Solution) -> None:
    """Write the lower triangle of M + J' D J in its tiles.

    Args:
        h: the matrix; (n, n), n being a multiple of 4.
        mass: numbers of M in MuJoCo's order.
        jacobian: all columns of the rows; (rows, n).
        weight: D of each row, zero for rows at their limits; (rows,).
        s: pattern of the matrix.
    """
    clear_tiles(h, s)
    for k in range(mass.shape[0]):
        h[s.inertia[k, 0], s.inertia[k, 1]] = mass[k]
    for group in range(s.groups.shape[0]):
        row, rows, first, last = s.groups[group, 0], s.groups[group, 1], s.groups[group, 2], s.groups[group, 3]
        d0, d1, d2, j0, j1, j2 = weight[row], 0.0, 0.0, jacobian[row], jacobian[row], jacobian[row]
        if rows == 3:
            d1, d2, j1, j2 = weight[row + 1], weight[row + 2], jacobian[row + 1], jacobian[row + 2]
        for a in range(first, last):
            start = start_of(s.columns[a])
            for i in range(start, start + np.uint64(TILE)):
                x, y, z, line = d0 * j0[i], d1 * j1[i], d2 * j2[i], h[i]
                for b in range(first, a + 1):
                    add_rows(line, start_of(s.columns[b]), x, j0, y, j1, z, j2)
    for k in range(s.singles.shape[0]):
        row, dof = s.singles[k, 0], s.singles[k, 1]
        h[dof, dof] += weight[row] * jacobian[row, dof] * jacobian[row, dof]


@jitable
def factorise_matrix(h: Table, s: Solution) -> None:
    """Replace the lower triangle of H by D L of H = L' D L, L with a unit diagonal; the last row comes first."""
    for block in range(s.starts.shape[0] - 2, -1, -1):
        row, first, last = TILE * block, s.starts[block], s.starts[block + 1]
        u0, u1, u2, u3 = h[row], h[row + 1], h[row + 2], h[row + 3]
        f32, f31, f30 = u3[row + 2] / u3[row + 3], u3[row + 1] / u3[row + 3], u3[row] / u3[row + 3]
        u2[row + 2] -= f32 * u3[row + 2]
        u2[row + 1] -= f32 * u3[row + 1]
        u2[row] -= f32 * u3[row]
        u1[row + 1] -= f31 * u3[row + 1]
        u1[row] -= f31 * u3[row]
        u0[row] -= f30 * u3[row]
        f21, f20 = u2[row + 1] / u2[row + 2], u2[row] / u2[row + 2]
        u1[row + 1] -= f21 * u2[row + 1]
        u1[row] -= f21 * u2[row]
        u0[row] -= f20 * u2[row]
        f10 = u1[row] / u1[row + 1]
        u0[row] -= f10 * u1[row]
        i0, i1, i2, i3 = 1.0 / u0[row], 1.0 / u1[row + 1], 1.0 / u2[row + 2], 1.0 / u3[row + 3]
        # The last tile of a row of tiles is on the diagonal.
        for a in range(first, last - 1):
            start = start_of(s.tiles[a])
            for i in range(start, start + np.uint64(TILE)):
                u2[i] -= f32 * u3[i]
                u1[i] -= f31 * u3[i] + f21 * u2[i]
                u0[i] -= f30 * u3[i] + f20 * u2[i] + f10 * u1[i]
            for i in range(start, start + np.uint64(TILE)):
                line, factors = h[i], (i0 * u0[i], i1 * u1[i], i2 * u2[i], i3 * u3[i])
                for b in range(first, a + 1):
                    take_rows(line, start_of(s.tiles[b]), factors, (u0, u1, u2, u3))


@jitable
def solve_factorised(h: Table, b: Vector, s: Solution) -> None:
    """Replace the right-hand side b, (n,), by the solution of H x = b; `h` contains the factor."""
    for block in range(s.starts.shape[0] - 2, -1, -1):
        row = TILE * block
        u0, u1, u2, u3 = h[row], h[row + 1], h[row + 2], h[row + 3]
        w = b[row + 3] / u3[row + 3]
        b[row + 2] -= u3[row + 2] * w
        z = b[row + 2] / u2[row + 2]
        b[row + 1] -= u3[row + 1] * w + u2[row + 1] * z
        y = b[row + 1] / u1[row + 1]
        b[row] -= u3[row] * w + u2[row] * z + u1[row] * y
        x = b[row] / u0[row]
        for a in range(s.starts[block], s.starts[block + 1] - 1):
            take_rows(b, start_of(s.tiles[a]), (x, y, z, w), (u0, u1, u2, u3))
    for block in range(s.starts.shape[0] - 1):
        row = TILE * block
        u0, u1, u2, u3 = h[row], h[row + 1], h[row + 2], h[row + 3]
        x, y, z, w = b[row], b[row + 1], b[row + 2], b[row + 3]
        for a in range(s.starts[block], s.starts[block + 1] - 1):
            start = start_of(s.tiles[a])
            for k in range(start, start + np.uint64(TILE)):
                x -= u0[k] * b[k]
                y -= u1[k] * b[k]
                z -= u2[k] * b[k]
                w -= u3[k] * b[k]
        x /= u0[row]
        y = (y - u1[row] * x) / u1[row + 1]
        z = (z - u2[row] * x - u2[row + 1] * y) / u2[row + 2]
        w = (w - u3[row] * x - u3[row + 1] * y - u3[row + 2] * z) / u3[row + 3]
        b[row], b[row + 1], b[row + 2], b[row + 3] = x, y, z, w


@jitable
def right_side(d: Fields, efc: Efc, e: Layout, c: State, s: Solution) -> None:
    """Write Q + J' D aref of the equality rows: the explicit forces."""
    total = s.right
    total[:] = 0.0
    for dof in range(s.size):
        total[dof] = d.qfrc_passive[dof] - d.qfrc_bias[dof] + d.qfrc_applied[dof]
    for damper in range(e.dampers.dofs.shape[0]):
        total[e.dampers.dofs[damper]] += damper_force(damper, d, e, c)
    for group in range(s.groups.shape[0]):
        row, rows, first, last = s.groups[group, 0], s.groups[group, 1], s.groups[group, 2], s.groups[group, 3]
        for i in range(row, row + rows):
            force, line = efc.D[i] * efc.aref[i], efc.J[i]
            if force != 0.0:
                for a in range(first, last):
                    start = TILE * s.columns[a]
                    for k in range(start, start + TILE):
                        total[k] += force * line[k]


@jitable
def predict_acceleration(d: Fields, efc: Efc, e: Layout, c: State, s: Solution) -> None:
    """Write the acceleration of the step where MuJoCo's solver starts; call this after `rewrite`."""
    h, a, weight = s.matrix, s.acceleration, s.weight
    right_side(d, efc, e, c, s)
    for _ in range(ATTEMPTS):
        copy_row(a, s.right)
        copy_row(weight, efc.D)
        for k in range(s.frictions.shape[0]):
            row, dof = s.frictions[k, 0], s.frictions[k, 1]
            if s.limited[k] == 0.0:
                a[dof] += efc.J[row, dof] * weight[row] * efc.aref[row]
            else:
                weight[row] = 0.0
                a[dof] += efc.J[row, dof] * s.limited[k] * efc.frictionloss[row]
        assemble_matrix(h, d.M, efc.J, weight, s)
        factorise_matrix(h, s)
        solve_factorised(h, a, s)
        changed = False
        for k in range(s.frictions.shape[0]):
            row, dof = s.frictions[k, 0], s.frictions[k, 1]
            beyond, force = efc.J[row, dof] * a[dof] - efc.aref[row], 0.0
            if beyond <= -efc.R[row] * efc.frictionloss[row]:
                force = 1.0
            elif beyond >= efc.R[row] * efc.frictionloss[row]:
                force = -1.0
            # From one limit to the other by way of none: a damper that comes to rest would alternate between them.
            if force * s.limited[k] < 0.0:
                force = 0.0
            changed = changed or force != s.limited[k]
            s.limited[k] = force
        if not changed:
            break
    for dof in range(s.size):
        d.qacc_warmstart[dof] = a[dof]
