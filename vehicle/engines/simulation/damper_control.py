"""One step of the control of dampers, in the rows of the complete car.

The sensors measure along the damper, on the wheel side and on the body side, modes included. MuJoCo's velocity is that
of the middle of the past step; the straight line through the last two carries it to the present. A row stands for half
a step before the present and half a step after it, so that its coefficient is the mean of what was set there: a setting
that is held from one instant to another is then exactly that.
"""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import Fields, State
from vehicle.model.laws.semi_active import PRESENT, act


@jitable
def control(time: float, d: Fields, e: Layout, s: State) -> None:
    """Read the sensors and set the coefficients of the present step; once for each time."""
    own, m = e.controls, e.modes
    if own.dampers.shape[0] == 0 or time == s.last_time[0]:
        return
    modes, column, turn = m.size, m.first_velocity, d.xmat[m.body]
    for row in range(own.shapes.shape[0]):
        axis = d.cdof[e.dampers.dofs[own.dampers[row // 2]]]
        s.sensed[row, 1], s.sensed[row, 0] = s.sensed[row, 0], 0.0
        for j in range(3):
            along = axis[3] * turn[j] + axis[4] * turn[3 + j] + axis[5] * turn[6 + j]
            for k in range(modes):
                s.sensed[row, 0] += along * own.shapes[row, j * modes + k] * d.qvel[column + k]
    for entry in range(own.dofs.shape[0]):
        n, end, dof, tree = own.dofs[entry, 0], own.dofs[entry, 1], own.dofs[entry, 2], own.dofs[entry, 3]
        axis, motion = d.cdof[e.dampers.dofs[own.dampers[n]]], d.cdof[dof]
        # MuJoCo refers the motion of a tree to its centre of mass.
        point, centre = d.site_xpos[own.sites[n, end]], d.subtree_com[tree]
        x, y, z = point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]
        s.sensed[2 * n + end, 0] += d.qvel[dof] * (
            axis[3] * (motion[3] + motion[1] * z - motion[2] * y)
            + axis[4] * (motion[4] + motion[2] * x - motion[0] * z)
            + axis[5] * (motion[5] + motion[0] * y - motion[1] * x)
        )
    for n in range(own.dampers.shape[0]):
        before = s.past[n, PRESENT]
        wheel = 1.5 * s.sensed[2 * n, 0] - 0.5 * s.sensed[2 * n, 1]
        body = 1.5 * s.sensed[2 * n + 1, 0] - 0.5 * s.sensed[2 * n + 1, 1]
        act(own.laws[n], int(s.steps[0]), body, wheel, s.past[n])
        s.coefficient[own.dampers[n]] = 0.5 * (before + s.past[n, PRESENT])
    s.steps[0] += 1.0
