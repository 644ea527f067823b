"""Time step of the damper controllers in the rows of the complete car.

The sensors measure velocities along the damper, on the wheel side and on the body side, modes included. MuJoCo's
velocity is that of the middle of the past step; linear extrapolation of the last two gives the present velocity. A row
covers half a step before and half a step after the present, so its coefficient is the mean of the settings in these two
halves. This is exact for a setting that is constant between two instants.
"""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import Fields, State
from vehicle.model.laws.control_laws import PRESENT, act


@jitable
def control(time: float, d: Fields, e: Layout, s: State) -> None:
    """Read the sensors and set the damping coefficients of the present step, once for each time."""
    controls, m = e.controls, e.modes
    if controls.dampers.shape[0] == 0 or time == s.last_time[0]:
        return
    modes, column, turn = m.size, m.first_velocity, d.xmat[m.body]
    for row in range(controls.shapes.shape[0]):
        axis = d.cdof[e.dampers.dofs[controls.dampers[row // 2]]]
        s.sensed[row, 1], s.sensed[row, 0] = s.sensed[row, 0], 0.0
        for j in range(3):
            along = axis[3] * turn[j] + axis[4] * turn[3 + j] + axis[5] * turn[6 + j]
            for k in range(modes):
                s.sensed[row, 0] += along * controls.shapes[row, j * modes + k] * d.qvel[column + k]
    for entry in range(controls.dofs.shape[0]):
        n, end, dof, tree = (
            controls.dofs[entry, 0],
            controls.dofs[entry, 1],
            controls.dofs[entry, 2],
            controls.dofs[entry, 3],
        )
        axis, motion = d.cdof[e.dampers.dofs[controls.dampers[n]]], d.cdof[dof]
        # `cdof` is relative to the centre of mass of the tree.
        point, centre = d.site_xpos[controls.sites[n, end]], d.subtree_com[tree]
        x, y, z = point[0] - centre[0], point[1] - centre[1], point[2] - centre[2]
        s.sensed[2 * n + end, 0] += d.qvel[dof] * (
            axis[3] * (motion[3] + motion[1] * z - motion[2] * y)
            + axis[4] * (motion[4] + motion[2] * x - motion[0] * z)
            + axis[5] * (motion[5] + motion[0] * y - motion[1] * x)
        )
    for n in range(controls.dampers.shape[0]):
        before = s.past[n, PRESENT]
        wheel = 1.5 * s.sensed[2 * n, 0] - 0.5 * s.sensed[2 * n, 1]
        body = 1.5 * s.sensed[2 * n + 1, 0] - 0.5 * s.sensed[2 * n + 1, 1]
        act(controls.laws[n], int(s.steps[0]), body, wheel, s.past[n])
        s.coefficient[controls.dampers[n]] = 0.5 * (before + s.past[n, PRESENT])
    s.steps[0] += 1.0
