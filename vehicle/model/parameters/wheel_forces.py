"""Forces of turning wheels: imbalance.

A wheel of a car that drives along -x turns at -V/R about y. A mark on it at (x, z) = r (cos theta, sin theta) has
theta' = V/R. Source: Genta, Dynamics of Rotating Systems, 2005, chapter 1.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle.model.parameters.quantity import Validated, quantity

WHEEL_FORCES = ("imbalance",)
"""Names of the tables of an axle for forces of its wheels."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Imbalance(Validated):
    """Mass on the rim that turns with the wheel: a force of m r (V/R)^2 from the axle to the mass.

    The mass is that of the imbalance alone: it is no part of the mass of the wheel, and its weight, 0.3 % of the force
    at 80 km/h, is left out.
    """

    mass: float = quantity(
        "kg", "mass of the imbalance", at_least=0.0, at_most=0.5, why="20 g is 0.02; balanced wheels have 5 to 10 g"
    )
    radius: float = quantity("m", "distance of the mass from the axle", above=0.0, at_most=1.0)
    angle: float = quantity("deg", "position of the mass at t = 0: 0 to the rear, 90 at the top", default=0.0)
    offset: float = quantity(
        "m", "distance of the mass from the middle of the wheel, outwards", at_least=-0.5, at_most=0.5, default=0.0
    )
