"""Scalar elements of a time step: groups of Jenkins elements, laws over displacement, and rubber friction.

The Jenkins elements of a group act with the mean of their forces at both ends, t = clamp(t + k u, L) with the change u
of the displacement over the step: second order, and no work is added at any step and stiffness, because u is exact. The
equation u + G f(u) = r of a group is monotone and piecewise linear. Its solution lies between the corners with the
nearest values of the left side, in whatever order the corners are.

A law g over displacement (`vehicle.engines.linear.displacement_laws`) acts with the mean of both ends of the step, too:

    x+ = w - G (g_n + g+)/2,    g+ = g(x+).

G <= 2/K, because the compliance of a passive car with the tangent K of the law in it is at most 1/K at rest, and a step
response at most twice that. The slope of g is at least -K, so x+ + G g(x+)/2 = r = w - G g_n/2 is monotone at any step,
and also for a tyre that lifts off. Each segment of slope k gets the slope k/(1 + G k/2) over r, so

    g+ = sum over j of a_j max(0, sign(p_j) (r - p_j)),    with p_j + G g(p_j)/2 as breakpoints,

is a closed form without any search, and exactly zero in the segment in which the car is at rest. The work of the mean
force is the change of the energy of the law in a step within one segment: second order.

Rubber friction has the force g = -q with q = sum of k_i q_i, whose sliders q_i move in a step. With r' = w + G q_n,

    x+ - G (q+ - q_n)/2 = r',    so that x+ = r' and q+ = q_n if no slider moves.

Sliders of elements with ascending strokes x_i always lie so that they begin to move in this order: |q_i - q_j| is at
most |x_i - x_j|. When slider i begins to move up, x+ = q_i + x_i, and those before it have moved, which gives

    r' = m_i + e_i,    m_i = p_i q_i + G/2 (sum of k_j q_j before i),    e_i = p_i x_i + G/2 (sum of k_j x_j before i),

with p_i = 1 - G/2 (sum of k_j before i); down, r' = m_i - e_i. Beyond the slope of q+ - q_n over r' rises by the weight
w_i, that is from S/p to S'/p' with the sums S and S' of the k_j before i and up to i:

    q+ - q_n = sum over i of w_i (r' - max(m_i - e_i, min(m_i + e_i, r'))).

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

from typing import Any

from vehicle.engines.reduced.inlining import inlined
from vehicle.engines.reduced.simd_vector import before, filled, load, maximum, minimum, of_cars, select_below, store
from vehicle.engines.reduced.table_layout import TableRows

FAR = 1e30
"""Value of the left side of the equation of a group at an infinite displacement: the force is constant there."""


@inlined
def prepare_groups(t: Any, r: TableRows, owners: Any, count: int, work: int) -> None:
    """Set the corners of the equation u + G f(u) = r of each group of Jenkins elements.

    Args:
        t, r: table and sections.
        owners: index of the damper of each group.
        count: number of dampers.
        work: first row of the corners: for each group the smallest and the largest mean force, then left side and mean
            force at each corner.
    """
    half, size, width = filled(t, 0.5), 2 + 4 * r.elements, count + len(r.groups) + len(r.curves)
    for group in range(len(r.groups)):
        at, first, limit = work + size * group, r.elements * group, load(t, r.limit + owners[group])
        gain = load(t, r.gain + (count + group) * (width + 1))
        low, high = filled(t, 0.0), filled(t, 0.0)
        for i in range(r.elements):
            slider, end = load(t, r.slider + first + i), limit * load(t, r.share + first + i)
            low, high = low + half * (slider - end), high + half * (slider + end)
        store(t, at, low)
        store(t, at + 1, high)
        for corner in range(2 * r.elements):
            i = first + corner // 2
            end = limit * load(t, r.share + i)
            if corner % 2 == 0:
                end = filled(t, 0.0) - end
            u, force = (end - load(t, r.slider + i)) * load(t, r.give + i), filled(t, 0.0)
            for j in range(r.elements):
                slider, bound = load(t, r.slider + first + j), limit * load(t, r.share + first + j)
                moved = slider + load(t, r.spring + first + j) * u
                force = force + half * (slider + minimum(maximum(moved, filled(t, 0.0) - bound), bound))
            store(t, at + 2 + 2 * corner, u + gain * force)
            store(t, at + 3 + 2 * corner, force)


@inlined
def group_force(t: Any, at: int, corners: int, value: Any) -> Any:
    """Return the mean force of a group from the left side of its equation; see `prepare_groups`."""
    low, high = load(t, at), load(t, at + 1)
    below, above, lower, upper = filled(t, -FAR), filled(t, FAR), low, high
    for corner in range(corners):
        left, force = load(t, at + 2 + 2 * corner), load(t, at + 3 + 2 * corner)
        below = maximum(below, select_below(value, left, below, left))
        lower = maximum(lower, select_below(value, left, low, force))
        above = minimum(above, select_below(value, left, left, above))
        upper = minimum(upper, select_below(value, left, force, high))
    return lower + (upper - lower) * ((value - below) / (above - below))


@inlined
def law_force(t: Any, r: TableRows, curve: int, value: Any) -> Any:
    """Return the force g of a law over displacement at the end of a step from r, see above."""
    force, zero = filled(t, 0.0), filled(t, 0.0)
    for corner in range(r.corners):
        row = r.corner + 3 * (r.corners * curve + corner)
        force = force + load(t, row + 2) * maximum(load(t, row) * value - load(t, row + 1), zero)
    return force


@inlined
def rubber_change(t: Any, r: TableRows, rubber: int, value: Any) -> Any:
    """Return the change q+ - q_n of the sliders of rubber friction in a step from r', see above [N]."""
    change, moved = filled(t, 0.0), value - load(t, r.ahead + rubber)
    for i in range(r.layers * rubber, r.layers * (rubber + 1)):
        distance, reach = moved - load(t, r.middle + i), load(t, r.reach + i)
        inside = minimum(maximum(distance, filled(t, 0.0) - reach), reach)
        change = change + load(t, r.weight + i) * (distance - inside)
    return of_cars(change)


@inlined
def advance_rubber(t: Any, r: TableRows, rubber: int, displacement: Any) -> None:
    """Move the sliders of rubber friction to the end of a step, and set its force g and the middles of the next step.

    Args:
        t, r: table and sections.
        rubber: index of the rubber friction.
        displacement: displacement at the end of the step.
    """
    curve = len(r.curves) - r.rubbers + rubber
    held, half = filled(t, 0.0), load(t, r.own + curve)
    for i in range(r.layers * rubber, r.layers * (rubber + 1)):
        stroke, anchor = load(t, r.stroke + i), load(t, r.anchor + i)
        anchor = maximum(displacement - stroke, minimum(displacement + stroke, anchor))
        store(t, r.anchor + i, anchor)
        store(t, r.middle + i, load(t, r.part + i) * anchor + half * held)
        held = held + load(t, r.stiff + i) * anchor
    store(t, r.ahead + rubber, half * before(held))
    store(t, r.excess + curve, filled(t, 0.0) - of_cars(held))


@inlined
def advance_group(t: Any, r: TableRows, owners: Any, group: int, u: Any) -> None:
    """Advance the Jenkins elements of a group over a step.

    Args:
        t, r, owners: see `prepare_groups`.
        group: index of the group.
        u: change of its displacement over the step.
    """
    limit = load(t, r.limit + owners[group])
    store(t, r.place + group, load(t, r.place + group) + u)
    for i in range(r.elements * group, r.elements * (group + 1)):
        end = limit * load(t, r.share + i)
        force = load(t, r.slider + i) + load(t, r.spring + i) * u
        store(t, r.slider + i, minimum(maximum(force, filled(t, 0.0) - end), end))
