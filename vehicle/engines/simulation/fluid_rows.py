"""Rows of the fluid of a hydromount, which moves through an inertia track.

The upper chamber with the bulge stiffness Kb is between the displaced volume, the extension z of the mount along its z
axis, and the volume in the track. Divided by the pumping area Ap of the rubber, the latter is the displacement x of the
coordinate of the fluid, with the mass mt = rho L Ap^2/At of a track of length L and area At:

    f = -Kb (z - x),    mt x'' + ct x' = Kb (z - x),    K(s) = Kb Z / (Kb + Z),    Z = mt s^2 + ct s.

x is relative to the mount, so no other motion accelerates mt, and mt has no weight. The rows of the fluid are those of
its mount with x subtracted, r -> r + n x e_z and J_x = n e_z with n = -1, e_z being the z axis of the law. Behind a
flexible attachment the rubber has x too; see `vehicle.model.assembly.connections.FluidLaw`.

A decoupler with the coordinate y has the same pressure and is parallel to the track: z - x - y in place of z - x, and
md y'' + cd y' + Km y + seat(y) = Kb (z - x - y). Within its gap it takes the fluid from the track; beyond the gap it
lies on its seat, and the fluid goes through the track.

Source: Singh, Kim and Ravindra, Linear analysis of automotive hydro-mechanical mount with emphasis on decoupler
characteristics, Journal of Sound and Vibration 158 (1992) 219-243, with p1 = Kb (z - x) / Ap and C1 = Ap^2 / Kb; the
lower chamber is soft.
"""

from __future__ import annotations

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Layout
from vehicle.engines.simulation.step_records import Efc, Fields


@jitable
def fluid_rows(d: Fields, efc: Efc, e: Layout) -> None:
    """Add the displacements of the fluids to the rows of their mounts; call this after `oblique_rows`."""
    b = e.bushings
    for k in range(e.fluids.elements.shape[0]):
        n, dof = e.fluids.elements[k], e.fluids.dofs[k]
        frame, oblique = d.xmat[b.carriers[n]], False
        for index in b.oblique:
            oblique = oblique or index == n
        for i in range(3):
            row, axis = b.rows[n, i], frame[3 * i + 2]
            if oblique:
                axis = 1.0 if i == 2 else 0.0
            efc.J[row, dof] = e.fluids.factors[k] * axis
            efc.pos[row] += efc.J[row, dof] * d.qpos[e.fluids.places[k]]
            efc.vel[row] += efc.J[row, dof] * d.qvel[dof]
