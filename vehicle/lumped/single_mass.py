"""One mass with spring, damper and friction: the smallest model with stick and slip."""

from __future__ import annotations

from vehicle.laws.kelvin import Kelvin
from vehicle.laws.law import ForceLaw, Numbers
from vehicle.linear.parts import ROAD, Link, Mass, Network
from vehicle.linear.system import Slide


def single_mass(
    *, mass: Numbers, friction: ForceLaw, stiffness: Numbers = 0.0, damping: Numbers = 0.0, belt: bool = False
) -> Network:
    """m x'' + D x' + K x + f(x') = F; on a belt the friction sees x' minus the belt velocity.

    Coordinate and output: `mass`. The applied force acts on the mass; the road displacement is that of the belt.

    Args:
        mass: m [kg].
        friction: law of the friction f.
        stiffness: spring K to the ground [N/m].
        damping: damper D to the ground [N s/m].
        belt: let the friction act between mass and belt, not between mass and ground.

    Returns:
        The network.

    Source: Bommer 2006, section 2.3.2.1 and equation 2.5.
    """
    row = {"mass": 1.0}
    return Network(
        coordinates=("mass",),
        masses=(Mass(mass=mass, axes=(row,)),),
        links=(Link(row=row, law=Kelvin(stiffness=stiffness, damping=damping)),),
        outputs={"mass": row},
        slides=(Slide(row={**row, ROAD: -1.0} if belt else row, friction=friction),),
        force=row,
    )
