"""Time step of the cars in a vector: their poles, then their damper forces.

A pole is integrated as the difference y from its static value on the plates, xi = y - (b_z/s) z:

    y' = s y + (b_c + b_z/s) z' + e f.

The differences stay small even on hilly roads. A step adds (E - 1) y and its inputs to y. The accelerations of rolling
cars in single precision take these changes: round-off of y, amplified by a second difference, would be most of the
lateral acceleration above 100 Hz. z' is a quadratic over a step, given
by its ends and its mean. A damper force has the mean f_n over step n. If the damper is stuck in this step and the last,
the force is linear with the slope (f_n - f_(n-1))/h: third order in the step. In sliding it is constant, except for the
damper curve, which acts with the mean of both ends. The forces depend on the velocities at the end of the step. They
are solved by Gauss-Seidel iterations over the dampers, each by its inverse law (`vehicle.engines.reduced.car_table`).

Scalar elements over one displacement, see `vehicle.engines.reduced.scalar_elements`, are solved with the dampers.

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from vehicle.engines.reduced.feedback import Feedback, excess_coefficient
from vehicle.engines.reduced.inlining import inlined
from vehicle.engines.reduced.scalar_elements import (
    advance_group,
    advance_rubber,
    group_force,
    law_force,
    prepare_groups,
    rubber_change,
)
from vehicle.engines.reduced.simd_vector import (
    add_scaled,
    broadcast,
    filled,
    less,
    load,
    load_tuple,
    maximum,
    minimum,
    of_cars,
    store,
    weighted_sum,
)
from vehicle.engines.reduced.table_layout import TableRows
from vehicle.model.laws.damper import friction_limit


@inlined
def add_effects(t: Any, r: TableRows, count: int, force: int, change: Any, last: bool) -> None:
    """Add the effects of the change of a force to the velocities and displacements without their own forces.

    Args:
        t, r: table and sections; the work space begins with these velocities and displacements.
        count: number of dampers.
        force: index of the force.
        change: its change.
        last: last iteration, in which only the later forces need it: laws come first, then dampers and groups.
    """
    others = count + len(r.groups)
    sums = others + len(r.curves)
    is_law = force >= others
    for i in range(force + 1 if last and not is_law else 0, others):
        if i != force:
            effect = load(t, r.gain + i * sums + force)
            if force < count:
                effect = effect + load(t, r.stick + force) * load(t, r.ramp + i * count + force)
            store(t, r.work + i, load(t, r.work + i) + effect * change)
    for i in range((force + 1 if is_law else sums) if last else others, sums):
        if i != force:
            effect = load(t, r.gain + i * sums + force)
            if force < count:
                effect = effect + load(t, r.stick + force) * load(t, r.ramp + i * count + force)
            store(t, r.work + i, load(t, r.work + i) + effect * change)


@inlined
def solve_forces(t: Any, r: TableRows, owners: Any, dampers: Any) -> None:
    """Solve for the forces of a step, damper velocities and displacements of the scalar elements.

    The work space begins with the velocities and displacements without forces. The iterations begin with the forces of
    the last step; a force adds the effects of its change to all others.
    """
    count = len(dampers)
    groups, tables = len(r.groups), len(r.curves) - r.rubbers
    others = count + groups
    sums = others + len(r.curves)
    step, old = r.work + sums, r.inputs
    nodes = r.pieces + 1
    width = 3 * nodes
    kept = step + count  # forces of the last step
    work = kept + count  # nodes of each inverse law: velocity without forces, 1/length, force, rise of force
    corners, slider = work + 4 * nodes * count, old + 2 * count
    zeros, ones, half = filled(t, 0.0), filled(t, 1.0), filled(t, 0.5)
    prepare_groups(t, r, owners, count, corners)
    for i in range(sums):
        arriving = load(t, r.work + i)
        for j in range(count):
            if j != i:
                arriving = arriving + load(t, r.gain + i * sums + j) * load(t, old + j)
            else:
                arriving = arriving - load(t, r.stick + j) * load(t, r.ramp + i * count + j) * load(t, old + j)
        for j in range(count, sums):
            if j != i:
                arriving = arriving + load(t, r.gain + i * sums + j) * load(t, old + count + j)
        if count <= i < others:
            arriving = arriving - load(t, r.place + i - count)
        elif i >= others:
            effect = load(t, r.own + i - others) * load(t, r.excess + i - others)
            arriving = arriving - effect
            if i >= others + tables:
                arriving = arriving - effect
        store(t, r.work + i, arriving)
    for i in range(count):
        store(t, kept + i, load(t, old + i))
        diagonal = load(t, r.gain + i * sums + i) + load(t, r.stick + i) * load(t, r.ramp + i * count + i)
        store(t, step + i, diagonal)
        store(t, r.work + i, load(t, r.work + i) - diagonal * load(t, r.hold + i))
        limit = load(t, r.limit + i)
        at, law = work + 4 * nodes * i, r.law + width * i
        for j in range(nodes):
            node_force = load(t, law + 3 * j + 1) + load(t, law + 3 * j + 2) * limit
            store(t, at + 4 * j, load(t, law + 3 * j) + diagonal * node_force)
            store(t, at + 4 * j + 2, node_force)
        for j in range(r.pieces):
            store(t, at + 4 * j + 1, ones / (load(t, at + 4 * j + 4) - load(t, at + 4 * j)))
            store(t, at + 4 * j + 3, load(t, at + 4 * j + 6) - load(t, at + 4 * j + 2))
    for iteration in range(r.iterations):
        last = iteration == r.iterations - 1
        for curve in range(len(r.curves)):
            i, row = others + curve, slider + groups + curve
            value, excess = load(t, r.work + i), load(t, r.excess + curve)
            if curve < tables:
                at_end = law_force(t, r, curve, value)
                force = zeros - half * (excess + at_end)
                if last:
                    store(t, r.excess + curve, at_end)
            else:
                change = rubber_change(t, r, curve - tables, value)
                force = half * change - excess
                if last:
                    advance_rubber(t, r, curve - tables, value + load(t, r.own + curve) * change)
            add_effects(t, r, count, i, force - load(t, row), last)
            store(t, row, force)
        for i in range(count):
            arriving = load(t, r.work + i)
            at, law = work + 4 * nodes * i, r.law + width * i
            force, hold = load(t, at + 2), load(t, law + 1)
            for j in range(r.pieces):
                share = (arriving - load(t, at + 4 * j)) * load(t, at + 4 * j + 1)
                share = minimum(maximum(share, zeros), ones)
                force = force + load(t, at + 4 * j + 3) * share
                hold = hold + (load(t, law + 3 * j + 4) - load(t, law + 3 * j + 1)) * share
            store(t, r.velocity + i, arriving - load(t, step + i) * force)
            force = zeros - force - load(t, r.hold + i)
            add_effects(t, r, count, i, force - load(t, old + i), last)
            store(t, old + i, force)
            if last:
                store(t, step + i, hold)
        for group in range(groups):
            i, value = count + group, load(t, r.work + count + group)
            force = zeros - group_force(t, corners + (2 + 4 * r.elements) * group, 2 * r.elements, value)
            if last:
                advance_group(t, r, owners, group, value + load(t, r.gain + i * (sums + 1)) * force)
            add_effects(t, r, count, i, force - load(t, slider + group), last)
            store(t, slider + group, force)
    for i in range(count):
        stick = load(t, r.stick + i)
        store(t, old + count + i, stick * (load(t, old + i) - load(t, kept + i)))
        store(t, r.hold + i, load(t, step + i))
        speed = load(t, r.velocity + i)
        stuck = less(maximum(speed, zeros - speed), load(t, r.full + i))
        store(t, r.stick + i, stuck * load(t, r.stuck + i))
        store(t, r.stuck + i, stuck)


@inlined
def add_side_forces(t: Any, r: TableRows, feedback: Feedback, laws: Any) -> None:
    """Add the growth with the side force, extrapolated to the middle of the step, to the friction limits.

    Args:
        t, r, feedback, laws: see `vehicle.engines.reduced.time_stepping.step_cars`.
    """
    first, half = feedback.tyres + 2 * feedback.dampers.shape[0], filled(t, 0.5)
    for k in range(feedback.sides.shape[0]):
        for i in range(2 * k, 2 * k + 2):
            force = load(t, r.sensors + first + i)
            middle = load(t, r.static + i) + force + half * (force - load(t, r.past + first + i))
            store(t, r.past + first + i, force)
            store(t, r.work + i - 2 * k, middle)
        row = r.limit + feedback.sides[k]
        for lane in range(laws.shape[1]):
            x, y = t[r.work, lane], t[r.work + 1, lane]
            t[row, lane] += laws[feedback.sides[k], lane]["side_force"] * np.sqrt(x * x + y * y)


@inlined
def set_inputs(t: Any, r: TableRows, feedback: Feedback, rates: Any, laws: Any, step: int, dampers: Any) -> None:
    """Set the inputs of the next step, its friction limits and the coefficients of controlled dampers.

    Args:
        t, r, feedback, rates, laws, dampers: see `vehicle.engines.reduced.time_stepping.step_cars`.
        step: index of the step.
    """
    count, plates = len(dampers), rates.shape[1] // 4
    row = r.inputs + 2 * count + len(r.groups) + len(r.curves)
    for k in range(2 * plates):
        store(t, row + k, broadcast(rates[step, k]))
    row += 2 * plates
    for i in range(feedback.tyres):
        load_now = load(t, r.sensors + i)
        middle = load_now + filled(t, 0.5) * (load_now - load(t, r.past + i))
        store(t, r.past + i, load_now)
        excess = broadcast(rates[step, 3 * plates + i])
        change = maximum(middle, filled(t, -1.0))
        store(t, row + i, change * (broadcast(rates[step, plates + i]) + excess) + excess)
    for i in range(feedback.plate_inputs):
        store(t, row + feedback.tyres + i, broadcast(rates[step, 2 * plates + i]))
    for k in range(feedback.dampers.shape[0]):
        i, nodes, sensor = feedback.dampers[k], r.pieces + 1, r.sensors + feedback.tyres + 2 * k
        half = filled(t, 0.5 * excess_coefficient(feedback, k, t[sensor, 0], t[sensor + 1, 0]))
        store(t, r.hold + i, half * load(t, r.velocity + i))
        for j in range(3 * i * nodes, 3 * (i + 1) * nodes, 3):
            store(t, r.law + j + 1, half * load(t, r.law + j))
    for i in range(count):
        # Extrapolate the velocity to the middle of the step from both ends of the last step.
        now = load(t, r.velocity + i)
        if laws.shape[0] > 0:
            store(t, r.limit + i, now + filled(t, 0.5) * (now - load(t, r.earlier + i)))
            for lane in range(laws.shape[1]):
                t[r.limit + i, lane] = friction_limit(laws[i, lane], t[r.limit + i, lane])
        store(t, r.earlier + i, now)
    add_side_forces(t, r, feedback, laws)
    if laws.shape[1] == 1:
        for i in range(laws.shape[0]):
            store(t, r.limit + i, broadcast(t[r.limit + i, 0]))


@inlined
def read_sensors(t: Any, r: TableRows, rates: Any, end: int, count: int, sensors: int) -> None:
    """Add the terms of forces, plates and laws over displacement at the end of a step to the sums of the sensors.

    Args:
        t, r, rates: see `vehicle.engines.reduced.time_stepping.step_cars`.
        end: row of the end of the step in `rates`.
        count, sensors: numbers of dampers and of sensors.
    """
    plates = rates.shape[1] // 4
    row, forces, curves = r.direct, 2 * count + len(r.groups) + len(r.curves), len(r.curves)
    for i in range(sensors):
        value = load(t, r.sensors + i)
        for k in range(forces):
            value = value + load(t, row + k) * load(t, r.inputs + k)
        for k in range(plates):
            value = value + load(t, row + forces + k) * broadcast(rates[end, k])
            value = value + load(t, row + forces + plates + k) * broadcast(rates[end, 2 * plates + k])
        for k in range(curves):
            value = value + load(t, r.heard + i * curves + k) * load(t, r.excess + k)
        store(t, r.sensors + i, value)
        row += forces + 2 * plates


@inlined
def advance(
    t: Any,
    r: TableRows,
    x: Any,
    changes: Any,
    before: int,
    at: int,
    last: int,
    now: int,
    rates: Any,
    laws: Any,
    feedback: Feedback,
    step: int,
    inputs: Any,
    sums: Any,
    dampers: Any,
) -> None:
    """Advance the poles and damper forces of the cars by a step.

    Args:
        t, r, rates, laws, feedback, inputs, sums, dampers: see `vehicle.engines.reduced.time_stepping.step_cars`.
        x, changes: states of samples, and changes of the poles since the sample before; changed in place.
        before, at: first rows of the poles in `x` at the beginning and at the end of the step.
        last, now: first rows of the changes up to the beginning and up to the end of the step.
        step: index of the step.
    """
    count, plates = len(dampers), rates.shape[1] // 4
    size, width, kept = len(inputs), len(sums), changes.shape[0] > 0
    solved = count + len(r.groups) + len(r.curves)
    pair_rows, real_rows = 2 + 2 * size, 1 + size
    set_inputs(t, r, feedback, rates, laws, step, dampers)
    for i in range(width):
        arriving = filled(t, 0.0)
        if i < solved:
            for k in range(plates):
                arriving = arriving + load(t, r.slip + i * plates + k) * broadcast(rates[step + 1, k])
        if count <= i < solved:
            for k in range(plates):
                level = load(t, r.level + (i - count) * plates + k)
                arriving = arriving + level * broadcast(rates[step + 1, 2 * plates + k])
        store(t, r.work + i, arriving)
    u = load_tuple(t, r.inputs, inputs)
    for p in range(r.pairs):
        row = p * pair_rows
        a, b, decay, rotation = load(x, before + 2 * p), load(x, before + 2 * p + 1), load(t, row), load(t, row + 1)
        real_change = weighted_sum(t, row + 2, u, decay * a - rotation * b)
        imaginary_change = weighted_sum(t, row + 2 + size, u, decay * b + rotation * a)
        real, imaginary = a + real_change, b + imaginary_change
        store(x, at + 2 * p, real)
        store(x, at + 2 * p + 1, imaginary)
        if kept:
            store(changes, now + 2 * p, load(changes, last + 2 * p) + real_change)
            store(changes, now + 2 * p + 1, load(changes, last + 2 * p + 1) + imaginary_change)
    for q in range(r.reals):
        row, pole_row = r.real + q * real_rows, 2 * r.pairs + q
        a = load(x, before + pole_row)
        real_change = weighted_sum(t, row + 1, u, load(t, row) * a)
        real = a + real_change
        store(x, at + pole_row, real)
        if kept:
            store(changes, now + pole_row, load(changes, last + pole_row) + real_change)
    w = load_tuple(t, r.work, sums)
    for k in range(2 * r.pairs + r.reals):
        w = add_scaled(t, r.sum + k * width, load(x, at + k), w)
    for i in range(width):
        store(t, r.work + i if i < solved else r.sensors + i - solved, of_cars(w[i]))
    solve_forces(t, r, feedback.owners, dampers)
    read_sensors(t, r, rates, step + 1, count, width - solved)
    feedback.step[0] += 1
