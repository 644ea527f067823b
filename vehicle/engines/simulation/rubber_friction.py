"""Rubber friction of the bushings: Jenkins elements over the displacement of an axis (`vehicle.model.laws.amplitude`).

The force t of an element follows from the displacement r at the present time, so it is explicit. Its stiffness k is in
the stiffness K of the row: f0 contains -K r - (t - k r). A vibration below the limits is integrated like that of a
spring K; beyond them t - k r enters a step like a table over displacement, with second order.
"""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import State
from vehicle.model.laws.friction import clamp


@jitable
def advance_rubber(time: float, e: Layout, s: State) -> None:
    """Compute the elements at the present displacement, from their state at the last time; call it after `local_axes`.

    An evaluation at the same time replaces the last one.
    """
    r, last = e.rubber, s.last_time[0]
    for k in range(r.elements.shape[0]):
        if time != last and last >= 0.0:
            s.rubber[2, k], s.rubber[3, k] = s.rubber[0, k], s.rubber[1, k]
        s.rubber[1, k] = s.residual[r.elements[k], r.axes[k]]
        s.rubber[0, k] = clamp(s.rubber[2, k] + r.stiffness[k] * (s.rubber[1, k] - s.rubber[3, k]), r.limit[k])


@jitable
def rubber_forces(e: Layout, s: State) -> None:
    """Add -(t - k r) to the explicit forces along the axes of the bushings."""
    r = e.rubber
    for k in range(r.elements.shape[0]):
        s.force[r.elements[k], r.axes[k]] -= s.rubber[0, k] - r.stiffness[k] * s.rubber[1, k]
