"""Presliding friction: below its limit a damper yields elastically, by Jenkins elements over its stroke.

K is the stiffness after a reversal; the curve of first loading rises by the slopes K s_j up to the shares p_j of the
limit L. Element i has the stiffness k_i = K (s_i - s_(i+1)) and the limit L (s_i - s_(i+1)) x_i, with
x_i = sum over j <= i of (p_j - p_(j-1)) / s_j: the shares of the limit sum to one. With K to infinity the force is
set-valued Coulomb friction.

The default curve has s_j = 1 - p_(j-1) in four steps: a polygon of dF/dx = K (1 - F/L) (Dahl 1968).
"""

from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.laws.coulomb import Coulomb
from vehicle.model.laws.jenkins import Jenkins
from vehicle.model.parameters.force_elements import Damper


@dataclass(frozen=True, kw_only=True, slots=True)
class Presliding(Coulomb):
    """L = Fd in sliding, like Coulomb friction."""


def presliding_elements(damper: Damper) -> Vector:
    """Return stiffness [N/m] and share of the limit [-] of the Jenkins elements of a damper; (n, 2), (0, 2) without."""
    if damper.friction_law != "presliding" or damper.presliding_stiffness is None:
        return np.zeros((0, 2))
    share, slope = np.array(damper.presliding_force), np.array(damper.presliding_slope)
    # Corners x_i of the first loading in units of L/K, with the shares p_i as forces.
    unit = Jenkins.through(np.cumsum(np.diff(share, prepend=0.0) / slope), share)
    return np.column_stack([damper.presliding_stiffness * unit.stiffness, unit.limit])
