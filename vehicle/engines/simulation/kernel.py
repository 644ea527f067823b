"""Element laws as constraint rows, written by `mjcb_control` before MuJoCo solves.

The force of a quadratic row of MuJoCo is f = D (aref - J a). The callback rewrites each row of an element so that, with
the explicit part f0 given to the generalised forces,

    f = f0 - D J a,    f0 = preload - K r - B r' - f2,    D = B h/2 + beta K h2 + branch,

r' being the rate at the middle of the past step: B (r' + h a/2) is the damping at the present time (centred, second
order), and beta = 1/12 makes the step of a linear system fourth order in its frequencies (Fox and Goodwin, Numerov);
stiff local springs take up to beta = 1/4, which is stable at any step (Newmark; see `step_weights`). The friction
row of a damper is f = -clamp(c (v + h a)): D = c h, aref = -v/h, its limit the friction force: set-valued in effect,
sticking is exact. With c = (2/pi) Fd eps it is a line through zero, clamped at the limit Fd: the slope at rest of the
published Fd (2/pi) atan(eps v), without its tail (`vehicle.model.laws.friction`).
Every steeper piece of the curve of a damper, clamp(e (v - m), e w), is a friction row too (`vehicle.model.laws.curve`).
It has no jump, so that it is centred like the viscous one: D = e h/2, aref = -2 (v - m)/h, second order, at any slope.
A Jenkins element of presliding friction, t = clamp(t + k dx, L), acts with the mean (t(-h) + 2 t + t(+h))/4: its last
term is a friction row with D = k h2/4, aref = -v/h - t/(k h2) and the limit L/4. That is Newmark's average
acceleration, which never adds energy: second order, stable at any stiffness.
The two forces of a bushing are opposite and act at the points of their parts, in the axes of the carrier; the
moment r x f of their distance r is neglected, which changes no frequency by more than 0.05 %.
Rotations need no rows: their torques are given explicitly (`vehicle.engines.simulation.rotations`).

Modal coordinates q of the flexible body move node n by d = R Phi_n q, R being the rotation of the body. They enter a
row there as r -> r +- d, and its derivative by the coordinates as J -> J +- (R Phi_n, -[d]x on what turns the body):
without the second part the body would miss the torque d x F of every force at a node. The line of a main spring goes
through the displaced seat: n = (x_up + d - x_low) / length, r = length - L0, J = n' (J_up + R Phi - [d]x - J_low).
Without d in n, the transverse stiffness F / length of a loaded spring would not act on the modes.

The functions are compiled for runs (`vehicle.engines.simulation.compiled`). Single states of trim and linearisation are
evaluated in Python: that takes less time than loading the compiler.
"""

from __future__ import annotations

import numpy as np

from vehicle.compiler import jitable
from vehicle.engines.simulation.damper_control import control
from vehicle.engines.simulation.element_records import Layout, Tables
from vehicle.engines.simulation.fluid_rows import fluid_rows
from vehicle.engines.simulation.modal_rows import modal_rows
from vehicle.engines.simulation.modal_space import advance_modes, modal_forces
from vehicle.engines.simulation.rolling_tyres import headings, rolling_forces, rolling_rows
from vehicle.engines.simulation.rotations import rotations
from vehicle.engines.simulation.round_tyres import round_rows
from vehicle.engines.simulation.rubber_friction import advance_rubber, rubber_forces
from vehicle.engines.simulation.step_records import Efc, Fields, State, Weights
from vehicle.model.laws.curve import curve_force
from vehicle.model.laws.damper import friction_limit
from vehicle.model.laws.friction import clamp, slope_at_rest

EMPTY_ROW = 1e-9
"""Impedance [kg] of a row without damping and stiffness: nonzero, and small against every mass."""


@jitable
def bent(k: int, displacement: float, stiffness: float, t: Tables, s: State) -> float:
    """Return the difference of a curve from the tangent at its operating point, F(at + x) - F(at) - K x [N]."""
    s.stretch[k] = t.at[k] + displacement
    force: float = curve_force(s.stretch[k], t.edges[k], t.slopes[k], t.offsets[k])
    force -= curve_force(t.at[k], t.edges[k], t.slopes[k], t.offsets[k])
    return force - stiffness * displacement


@jitable
def stops(d: Fields, e: Layout, s: State) -> None:
    """Add the forces of bump stops and decoupler seats on their joints; call this after `generalised_forces`."""
    t = e.tables
    for k in range(t.kinds.shape[0]):
        if t.kinds[k] >= 2:
            if t.kinds[k] == 2:
                dof, position = e.dampers.dofs[t.elements[k]], e.dampers.places[t.elements[k]]
            else:
                dof, position = e.fluids.dofs[t.elements[k]], e.fluids.places[t.elements[k]]
            s.stretch[k] = d.qpos[position]
            d.qfrc_applied[dof] -= curve_force(s.stretch[k], t.edges[k], t.slopes[k], t.offsets[k])


@jitable
def springs(d: Fields, efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Write the rows of the main springs: direction through the displaced seat, its derivatives, elastic force."""
    main_springs, m = e.springs, e.modes
    modes, column, position, turn = m.size, m.first_velocity, m.first_position, d.xmat[m.body]
    for spring in range(main_springs.rows.shape[0]):
        row = main_springs.rows[spring]
        ends, line = s.ends[2 * spring : 2 * spring + 2], s.line[spring]
        for i in range(3):
            ends[0, i] = d.site_xpos[main_springs.sites[spring, 0], i]
            ends[1, i] = d.site_xpos[main_springs.sites[spring, 1], i]
            for j in range(3):
                for k in range(modes):
                    ends[1, i] += turn[3 * i + j] * main_springs.shapes[spring, j * modes + k] * d.qpos[position + k]
            line[i] = ends[1, i] - ends[0, i]
        length = np.sqrt(line[0] * line[0] + line[1] * line[1] + line[2] * line[2])
        for i in range(3):
            line[i] /= length
        for dof in range(efc.J.shape[1]):
            efc.J[row, dof] = 0.0
        for j in range(3):
            along = line[0] * turn[j] + line[1] * turn[3 + j] + line[2] * turn[6 + j]
            for k in range(modes):
                efc.J[row, column + k] += along * main_springs.shapes[spring, j * modes + k]
        s.explicit[row] = c.preload[row] - main_springs.stiffness[spring] * (length - main_springs.lengths[spring])
        for k in range(e.tables.kinds.shape[0]):
            if e.tables.kinds[k] == 1 and e.tables.elements[k] == spring:
                s.explicit[row] -= bent(
                    k, length - main_springs.lengths[spring], main_springs.stiffness[spring], e.tables, s
                )
        efc.D[row] = c.spring_impedance[spring]
        efc.aref[row] = 0.0
    for entry in range(main_springs.dofs.shape[0]):
        spring, end, dof, tree = (
            main_springs.dofs[entry, 0],
            main_springs.dofs[entry, 1],
            main_springs.dofs[entry, 2],
            main_springs.dofs[entry, 3],
        )
        line, point, centre, motion = s.line[spring], s.ends[2 * spring + end], d.subtree_com[tree], d.cdof[dof]
        # `cdof` is relative to the centre of mass of the tree.
        x, y, z = point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]
        velocity = (
            line[0] * (motion[3] + motion[1] * z - motion[2] * y)
            + line[1] * (motion[4] + motion[2] * x - motion[0] * z)
            + line[2] * (motion[5] + motion[0] * y - motion[1] * x)
        )
        efc.J[main_springs.rows[spring], dof] += (2 * end - 1) * velocity


@jitable
def oblique_rows(d: Fields, efc: Efc, e: Layout) -> None:
    """Rotate the rows of oblique elements from world axes into their directions: P R' (J, r, r')."""
    b = e.bushings
    for k in range(b.oblique.shape[0]):
        n = b.oblique[k]
        frame, way, row = d.xmat[b.carriers[n]], b.directions[k], b.rows[n, 0]
        for column in range(efc.J.shape[1] + 2):
            if column < efc.J.shape[1]:
                x, y, z = efc.J[row, column], efc.J[row + 1, column], efc.J[row + 2, column]
            elif column == efc.J.shape[1]:
                x, y, z = efc.pos[row], efc.pos[row + 1], efc.pos[row + 2]
            else:
                x, y, z = efc.vel[row], efc.vel[row + 1], efc.vel[row + 2]
            u = frame[0] * x + frame[3] * y + frame[6] * z
            v = frame[1] * x + frame[4] * y + frame[7] * z
            w = frame[2] * x + frame[5] * y + frame[8] * z
            for i in range(3):
                along = way[3 * i] * u + way[3 * i + 1] * v + way[3 * i + 2] * w
                if column < efc.J.shape[1]:
                    efc.J[row + i, column] = along
                elif column == efc.J.shape[1]:
                    efc.pos[row + i] = along
                else:
                    efc.vel[row + i] = along


@jitable
def local_axes(d: Fields, efc: Efc, e: Layout, s: State) -> None:
    """Compute residual and rate of every element in element axes, relative to the velocity of the plates."""
    b = e.bushings
    for n in range(b.rows.shape[0]):
        for i in range(3):
            s.force[n, i] = efc.vel[b.rows[n, i]]
    for tyre in range(e.tyres.shape[0]):
        for i in range(3):
            s.force[e.tyres[tyre], i] -= s.plate_velocity[tyre, i]
    for n in range(b.rows.shape[0]):
        frame = d.xmat[b.carriers[n]]
        x, y, z = efc.pos[b.rows[n, 0]], efc.pos[b.rows[n, 1]], efc.pos[b.rows[n, 2]]
        u, v, w = s.force[n, 0], s.force[n, 1], s.force[n, 2]
        for i in range(3):
            s.residual[n, i] = frame[i] * x + frame[3 + i] * y + frame[6 + i] * z
            s.rate[n, i] = frame[i] * u + frame[3 + i] * v + frame[6 + i] * w
    for k in range(b.oblique.shape[0]):
        n = b.oblique[k]
        for i in range(3):
            s.residual[n, i], s.rate[n, i] = efc.pos[b.rows[n, i]], efc.vel[b.rows[n, i]]


@jitable
def advance_branches(time: float, c: Weights, s: State) -> None:
    """Advance the Maxwell branches over the completed step."""
    last = s.last_time[0]
    if time == last:
        return
    for n in range(s.rate.shape[0]):
        for i in range(3):
            rate = s.rate[n, i]
            if last >= 0.0:
                acceleration = (rate - s.last_rate[n, i]) / c.timestep
                s.branch_force[n, i] = s.branch_past[n, i] + c.slope[n, i] * acceleration
                s.branch_past[n, i] = c.decay[n, i] * s.branch_force[n, i] + c.gain[n, i] * rate
            s.last_rate[n, i] = rate
    s.last_time[0] = time


@jitable
def elements(d: Fields, efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Write f0 = preload - K r - B r' - f2 in world axes, and impedance and reference of the rows.

    The explicit part of the branch force is f2 + beta (f2(+h) - 2 f2 + f2(-h)) without the share of the acceleration.
    """
    b = e.bushings
    for n in range(b.rows.shape[0]):
        for i in range(3):
            rate, past = s.rate[n, i], s.branch_past[n, i]
            curvature = (c.decay[n, i] - 2.0) * past + c.gain[n, i] * rate + s.branch_force[n, i]
            branch = past + c.average[n, i] * curvature
            elastic = b.stiffness[n, i] * s.residual[n, i]
            s.force[n, i] = c.preload[b.rows[n, i]] - elastic - b.damping[n, i] * rate - branch
    t = e.tables
    for k in range(t.kinds.shape[0]):
        if t.kinds[k] == 0:
            n, i = t.elements[k], t.axes[k]
            s.force[n, i] -= bent(k, s.residual[n, i], b.stiffness[n, i], t, s)
    rubber_forces(e, s)
    for k in range(b.one_sided.shape[0]):
        n = b.one_sided[k]
        s.contact[0, k] = max(0.0, s.force[n, 2] + b.damping[n, 2] * s.rate[n, 2])
    for tyre in range(e.tyres.shape[0]):
        for i in range(3):
            s.force[e.tyres[tyre], i] += c.inertial[tyre, i] * s.plate_acceleration[tyre, i]
    for n in range(b.rows.shape[0]):
        frame = d.xmat[b.carriers[n]]
        x, y, z = s.force[n, 0], s.force[n, 1], s.force[n, 2]
        for i in range(3):
            row = b.rows[n, i]
            s.explicit[row] = frame[3 * i] * x + frame[3 * i + 1] * y + frame[3 * i + 2] * z
            efc.D[row] = c.impedance[n, i]
            efc.aref[row] = 0.0
    for k in range(b.oblique.shape[0]):
        n = b.oblique[k]
        for i in range(3):
            s.explicit[b.rows[n, i]] = s.force[n, i]
    lift_off(efc, e, c, s)


@jitable
def lift_off(efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Limit one-sided contacts to max(0, f0 - D J a) along z: clear a row that would pull at the last J a.

    The force is continuous, so a row in the wrong state for a step changes a velocity by h2 at most: second order.
    Carriers are the ground and the plates, which do not rotate: rows are along element axes.
    """
    b = e.bushings
    for k in range(b.one_sided.shape[0]):
        n = b.one_sided[k]
        row, rate = b.rows[n, 2], s.rate[n, 2]
        if s.force[n, 2] - c.impedance[n, 2] * (rate - s.contact[1, k]) / c.timestep <= 0.0:
            s.explicit[row] = 0.0
            efc.D[row] = EMPTY_ROW
        s.contact[1, k] = rate


@jitable
def ideal_joints(efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Write the reference of ideal ball joints by MuJoCo's formula, from residuals that include the modes."""
    for n in range(e.joints.shape[0]):
        for i in range(3):
            row = e.joints[n, i]
            s.explicit[row] = c.preload[row]
            efc.aref[row] = -efc.KBIP[row, 1] * efc.vel[row] - efc.KBIP[row, 0] * efc.KBIP[row, 2] * efc.pos[row]


@jitable
def side_force(damper: int, d: Fields, e: Layout, s: State) -> float:
    """Return the force of the bushings of a rod across its slide [N]; call this after `elements`."""
    b, x, y, z = e.bushings, 0.0, 0.0, 0.0
    for k in range(e.sides.dampers.shape[0]):
        if e.sides.dampers[k] == damper:
            n, sign = e.sides.elements[k], e.sides.signs[k]
            f, g, h = s.explicit[b.rows[n, 0]], s.explicit[b.rows[n, 1]], s.explicit[b.rows[n, 2]]
            if e.sides.oblique[k] >= 0:
                way, frame = b.directions[e.sides.oblique[k]], d.xmat[b.carriers[n]]
                u = way[0] * f + way[3] * g + way[6] * h
                v = way[1] * f + way[4] * g + way[7] * h
                w = way[2] * f + way[5] * g + way[8] * h
                f = frame[0] * u + frame[1] * v + frame[2] * w
                g = frame[3] * u + frame[4] * v + frame[5] * w
                h = frame[6] * u + frame[7] * v + frame[8] * w
            x, y, z = x + sign * f, y + sign * g, z + sign * h
    # The axis of a slide is the linear part of its motion.
    axis = d.cdof[e.dampers.dofs[damper]]
    along = x * axis[3] + y * axis[4] + z * axis[5]
    force: float = np.sqrt(max(x * x + y * y + z * z - along * along, 0.0))
    return force


@jitable
def dampers(d: Fields, efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Write viscous, friction and valve rows of the dampers."""
    damper_rows = e.dampers
    for n in range(damper_rows.rows.shape[0]):
        efc.D[damper_rows.rows[n]] = c.damper_impedance[n]
        efc.aref[damper_rows.rows[n]] = 0.0
        row, sliding = damper_rows.frictions[n], d.qvel[damper_rows.dofs[n]]
        limit = friction_limit(damper_rows.laws[n], sliding)
        if damper_rows.laws[n]["side_force"] > 0.0:
            limit += damper_rows.laws[n]["side_force"] * side_force(n, d, e, s)
        efc.D[row] = max(slope_at_rest(limit, damper_rows.laws[n]["smoothing"]) * c.timestep, EMPTY_ROW)
        efc.aref[row] = -sliding / c.timestep
        efc.frictionloss[row] = s.limit[n] = limit
    for n in e.controls.dampers:
        efc.D[damper_rows.rows[n]] = max(0.5 * c.timestep * s.coefficient[n], EMPTY_ROW)
    for n in range(damper_rows.valves.shape[0]):
        row, damper = damper_rows.valves[n, 0], damper_rows.valves[n, 1]
        efc.D[row] = c.valve_impedance[n]
        efc.aref[row] = -2.0 * (d.qvel[damper_rows.dofs[damper]] - damper_rows.pieces[n, 1]) / c.timestep
        efc.frictionloss[row] = damper_rows.pieces[n, 2]
    p = e.presliding
    for k in range(p.rows.shape[0]):
        row, stiffness, sliding = p.rows[k], p.stiffness[k], d.qvel[damper_rows.dofs[p.dampers[k]]]
        efc.D[row] = 0.25 * stiffness * c.timestep**2
        efc.aref[row] = -(sliding + s.slider[0, k] / (stiffness * c.timestep)) / c.timestep
        efc.frictionloss[row] = 0.25 * p.share[k] * s.limit[p.dampers[k]]
        s.explicit[row] = -0.25 * (s.slider[1, k] + 2.0 * s.slider[0, k])


@jitable
def advance_sliders(time: float, d: Fields, e: Layout, s: State) -> None:
    """Advance the Jenkins elements of the dampers over the completed step, with the limits of its rows."""
    p, last = e.presliding, s.last_time[0]
    if time == last or p.rows.shape[0] == 0:
        return
    for k in range(p.rows.shape[0]):
        n = p.dampers[k]
        moved = d.qpos[e.dampers.places[n]] - s.stroke[n]
        s.slider[1, k] = s.slider[0, k]
        if last >= 0.0:
            s.slider[0, k] = clamp(s.slider[0, k] + p.stiffness[k] * moved, p.share[k] * s.limit[n])
    for n in range(s.stroke.shape[0]):
        s.stroke[n] = d.qpos[e.dampers.places[n]]


@jitable
def slider_forces(d: Fields, e: Layout, s: State) -> None:
    """Add the known part of the forces of the Jenkins elements of the dampers; call this after `generalised_forces`."""
    for k in range(e.presliding.rows.shape[0]):
        d.qfrc_applied[e.dampers.dofs[e.presliding.dampers[k]]] += s.explicit[e.presliding.rows[k]]


@jitable
def generalised_forces(d: Fields, efc: Efc, e: Layout, s: State) -> None:
    """Set R = 1 / D and the generalised force J' f0 of the explicit forces."""
    total = d.qfrc_applied
    total[:] = 0.0
    for row in range(efc.D.shape[0]):
        efc.R[row] = 1.0 / efc.D[row]
    for entry in range(e.reach.shape[0]):
        row, rows, first, last = e.reach[entry, 0], e.reach[entry, 1], e.reach[entry, 2], e.reach[entry, 3]
        # Views avoid the check for negative indices in the inner loop.
        part = total[first:last]
        if rows == 3:
            x, y, z = s.explicit[row], s.explicit[row + 1], s.explicit[row + 2]
            jx, jy, jz = efc.J[row, first:last], efc.J[row + 1, first:last], efc.J[row + 2, first:last]
            for j in range(last - first):
                part[j] += x * jx[j] + y * jy[j] + z * jz[j]
        else:
            force, along = s.explicit[row], efc.J[row, first:last]
            for j in range(last - first):
                part[j] += force * along[j]


@jitable
def rewrite(time: float, d: Fields, efc: Efc, e: Layout, c: Weights, s: State) -> None:
    """Rewrite all rows and applied forces of a state."""
    advance_modes(time, d, e, c, s)
    if e.modes.size > 0:
        modal_rows(d, efc, e, s)
    oblique_rows(d, efc, e)
    rolling_rows(d, efc, e)
    round_rows(d, efc, e)
    fluid_rows(d, efc, e)
    local_axes(d, efc, e, s)
    headings(time, d, e, s)
    control(time, d, e, s)
    advance_sliders(time, d, e, s)
    advance_rubber(time, e, s)
    advance_branches(time, c, s)
    elements(d, efc, e, c, s)
    springs(d, efc, e, c, s)
    ideal_joints(efc, e, c, s)
    dampers(d, efc, e, c, s)
    generalised_forces(d, efc, e, s)
    modal_forces(d, e, s)
    rotations(d, e, c, s)
    rolling_forces(d, efc, e, c, s)
    stops(d, e, s)
    slider_forces(d, e, s)


@jitable
def damper_force(damper: int, d: Fields, e: Layout, s: State) -> float:
    """Return the force -c v - F0 [N] of a damper, whose friction is a row; c is its coefficient at the velocity v.

    Args:
        damper: index of the damper.
    """
    force: float = -s.coefficient[damper] * d.actuator_velocity[damper] - e.dampers.laws[damper]["shift"]
    return force
