"""Control laws of semi-active dampers, limited to what a damper can do.

Each law asks for a force F along the damper (positive pulls body and wheel together); v = vb - vw is the rate at which
they part. A damper can only resist: it gives c v with cmin <= c <= cmax. On-off laws choose cmax where F and v have the
same sign, else cmin; continuous ones come as near to F as the limits allow.

    skyhook     F = c_sky vb                          a damper between body and sky
    groundhook  F = -c_ground vw                      a damper between wheel and ground
    hybrid      F = share c_sky vb - (1 - share) c_ground vw

Source: Karnopp, Crosby, Harwood (1974) for skyhook; Ahmadian (1997) for groundhook and hybrid.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.parameters.half_car_rider import SemiActiveDamper

Array = npt.NDArray[np.float64]

LAWS = ("skyhook_on_off", "skyhook", "groundhook_on_off", "groundhook", "hybrid_on_off", "hybrid")
"""Names of the laws."""


def damping_coefficient(law: str, damper: SemiActiveDamper, body: npt.ArrayLike, wheel: npt.ArrayLike) -> Array:
    """Setting of a semi-active damper.

    Args:
        law: one of `LAWS`.
        damper: limits and gains.
        body: velocity of the body above the wheel vb [m/s].
        wheel: velocity of the wheel vw [m/s], same shape.

    Returns:
        c [N s/m] between the limits, same shape.

    Raises:
        ConfigurationError: unknown law.
    """
    if law not in LAWS:
        raise ConfigurationError(f"semi-active law: found {law!r}, allowed are {', '.join(LAWS)}")
    above, below = np.asarray(body, dtype=float), np.asarray(wheel, dtype=float)
    share = {"skyhook": 1.0, "groundhook": 0.0, "hybrid": damper.skyhook_share}[law.removesuffix("_on_off")]
    force = share * damper.skyhook_damping * above - (1.0 - share) * damper.groundhook_damping * below
    parting = above - below
    if law.endswith("_on_off"):
        return np.where(force * parting > 0.0, damper.maximum_damping, damper.minimum_damping)
    return _nearest(force, parting, damper)


def _nearest(force: Array, parting: Array, damper: SemiActiveDamper) -> Array:
    """Coefficient whose force c v comes nearest to the one asked for; no division where a limit decides."""
    along, speed = force * np.sign(parting), np.abs(parting)
    firm = (along > 0.0) & (along >= damper.maximum_damping * speed)
    free = ~firm & (along > damper.minimum_damping * speed)
    chosen = np.where(firm, damper.maximum_damping, damper.minimum_damping)
    return np.divide(along, speed, out=chosen, where=free)
