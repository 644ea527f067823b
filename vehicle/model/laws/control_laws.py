"""Control laws of semi-active dampers, and what lies between sensor and valve: period, delay, rate.

A law asks for a force F along the damper (positive pulls body and wheel together); vb and vw are the absolute
velocities of its ends on the body and on the wheel, v = vb - vw is the rate at which they part. A damper can only
resist: it gives c v with cmin <= c <= cmax.

    skyhook     F = c_sky vb       a damper between body and sky
    groundhook  F = -c_ground vw   a damper between wheel and ground
    hybrid      F = share [c_sky vb] + (1 - share) [-c_ground vw],   [F] = F where F v > 0, else 0

Continuous laws come as near to F as the limits allow. On-off laws switch to cmax where F v > 0, else to cmin; the
hybrid one switches by share and 1 - share of the range. Without its brackets it would ask for share c v where both
gains are c and the share is a half: a passive damper.

Once a period the controller reads both velocities and holds what it asks for until the next. The damper has that a
delay later, or comes nearer to it as fast as its rate allows; so c v opposes v at every instant.

The functions take scalars and arrays: one form for the complete car and for lumped models of many cars at once.

Source: Karnopp, Crosby, Harwood (1974) for skyhook; Ahmadian (1997) for groundhook and hybrid.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.compiler import jitable
from vehicle.model.parameters.semi_active_damper import AT_ONCE, SemiActiveDamper

SETTING = np.dtype(
    [
        (name, np.float64)
        for name in (
            "softest",  # cmin [N s/m]
            "firmest",  # cmax [N s/m]
            "sky",  # F over vb [N s/m]; of an on-off law its share of the range [-]
            "ground",  # -F over vw, likewise
            "on_off",  # 1 of an on-off law
            "period",  # steps between two readings of the sensors
            "lag",  # steps from reading to setting
            "change",  # largest change of the coefficient in a step [N s/m]
        )
    ],
    align=True,
)
"""A controlled damper for one time step."""

HELD, REACHED, PRESENT, RING = 0, 1, 2, 3
"""Places in what a damper remembers: what is asked for, the coefficient that is reached at the end of a step, its mean
over the step, and what was asked for in the past steps."""


def pack(control: SemiActiveDamper) -> npt.NDArray[np.float64]:
    """Numbers of a controlled damper, law not "passive": those of `SETTING`, but with times [s] and a rate; (8,)."""
    kind = control.law.removesuffix("_on_off")
    share = {"skyhook": 1.0, "groundhook": 0.0, "hybrid": control.skyhook_share}[kind]
    sky, ground = share, 1.0 - share
    if kind == control.law:
        sky, ground = sky * control.skyhook_damping, ground * control.groundhook_damping
    limits, times = (control.minimum_damping, control.maximum_damping), (control.control_period, control.delay)
    return np.array([*limits, sky, ground, float(kind != control.law), *times, control.rate])


def in_steps(numbers: npt.ArrayLike, timestep: float) -> npt.NDArray[Any]:
    """Records of controlled dampers for a time step.

    Args:
        numbers: of `pack`, (..., 8).
        timestep: step [s]; period and delay become whole numbers of it, the period one at least.

    Returns:
        Records of `SETTING`, (...).
    """
    found = np.array(numbers, dtype=float)
    found[..., 5:7] = np.rint(found[..., 5:7] / timestep)
    found[..., 5] = np.maximum(found[..., 5], 1.0)
    found[..., 7] = np.where(found[..., 7] < AT_ONCE, found[..., 7] * timestep, np.inf)
    return found.view(SETTING)[..., 0]


def at_rest(numbers: npt.NDArray[Any], *shape: int) -> npt.NDArray[np.float64]:
    """What dampers remember before the first step: the softest setting, always; (2 + lag + 1, ...)."""
    return np.full((RING + int(numbers["lag"]) + 1, *shape), float(numbers["softest"]))


@jitable
def demanded(numbers: Any, body: Any, wheel: Any) -> Any:
    """Coefficient c [N s/m] that a law asks for.

    Args:
        numbers: record of `in_steps`.
        body, wheel: vb and vw [m/s].
    """
    speed, way = np.abs(body - wheel), np.sign(body - wheel)
    softest, firmest, sky, ground = numbers["softest"], numbers["firmest"], numbers["sky"], numbers["ground"]
    if numbers["on_off"] > 0.0:
        return softest + (firmest - softest) * (sky * (body * way > 0.0) + ground * (wheel * way < 0.0))
    force = sky * np.maximum(body * way, 0.0) + ground * np.maximum(-wheel * way, 0.0)
    # Within the limits before it is divided: no quotient is too large, and at rest the damper is soft.
    near = np.minimum(np.maximum(force, softest * speed), firmest * speed)
    return np.minimum(np.maximum(near / (speed + (speed == 0.0)), softest), firmest)


@jitable
def act(numbers: Any, step: int, body: Any, wheel: Any, past: Any) -> None:
    """One time step of a controlled damper: its mean coefficient over the step is in `past[PRESENT]`.

    Args:
        numbers: record of `in_steps`.
        step: number of the step, from 0.
        body, wheel: vb and vw at its beginning [m/s].
        past: as of `at_rest`, changed in place.
    """
    if step % int(numbers["period"]) == 0:
        past[HELD] = demanded(numbers, body, wheel)
    length = int(numbers["lag"]) + 1
    past[RING + step % length] = past[HELD]
    wanted, change, before = past[RING + (step + 1) % length], numbers["change"], past[REACHED] + 0.0
    past[REACHED] = np.minimum(np.maximum(wanted, before - change), before + change)
    # On its way for a share |moved| / change of the step, at half of the distance in the mean.
    moved = past[REACHED] - before
    past[PRESENT] = past[REACHED] - 0.5 * moved * np.abs(moved) / change
