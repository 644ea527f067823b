"""Control laws of semi-active dampers, with the dynamics between sensor and valve: period, delay, rate.

A law demands a force F along the damper (positive: attraction of body and wheel); vb and vw are the absolute
velocities of its ends on the body and on the wheel, v = vb - vw is the rate of extension. A damper only dissipates: its
force is c v with cmin <= c <= cmax.

    skyhook     F = c_sky vb       a damper between body and sky
    groundhook  F = -c_ground vw   a damper between wheel and ground
    hybrid      F = share [c_sky vb] + (1 - share) [-c_ground vw],   [F] = F where F v > 0, else 0

Continuous laws approximate F within the limits. On-off laws switch to cmax if F v > 0, otherwise to cmin; the hybrid
law switches by share and 1 - share of the range. Without the brackets the hybrid law would demand c v / 2 if both gains
are c and the share is a half: a passive damper.

The law `fmu` takes its coefficient, within the limits, from a controller in an FMU
(`vehicle.model.laws.controller_fmu`).

Once a period the controller reads both velocities and holds its demand until the next reading. The damper receives the
demand after the delay, and follows with its maximum rate; c v opposes v at every instant.

The functions are for arrays, the batches of lumped models; both engines of the complete car use `demanded`
and `act` of `vehicle/core/source/laws.h`.

Source: Karnopp, Crosby, Harwood (1974) for skyhook; Ahmadian (1997) for groundhook and hybrid.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.arrays import Vector
from vehicle.model.parameters.semi_active_damper import AT_ONCE, FMU, SemiActiveDamper

SETTING = np.dtype(
    [
        (name, np.float64)
        for name in (
            "softest",  # cmin [N s/m]
            "firmest",  # cmax [N s/m]
            "sky",  # F over vb [N s/m]; for an on-off law the share of the range [-]
            "ground",  # -F over vw, likewise
            "on_off",  # 1 for an on-off law
            "period",  # steps between two readings of the sensors
            "lag",  # steps from reading to setting
            "change",  # largest change of the coefficient in a step [N s/m]
            "controller",  # address of the record of a controller FMU during a run, otherwise 0
        )
    ],
    align=True,
)
"""Record of a controlled damper for a given time step."""

NUMBERS = 8
"""Number of the parameters of a controlled damper: the fields of `SETTING` without the address."""

HELD, REACHED, PRESENT, RING = 0, 1, 2, 3
"""Indices in the memory of a damper: demand, coefficient at the end of the step, its mean over the step, demands of the
past steps."""


def pack(control: SemiActiveDamper) -> Vector:
    """Return the parameters of a controlled damper, in the order of `SETTING`, but with times [s] and a rate; (8,).

    Without a run, a damper with a controller FMU has its softest setting.
    """
    family = control.law.removesuffix("_on_off")
    shares = {"skyhook": 1.0, "groundhook": 0.0, "hybrid": control.skyhook_share or 0.0}
    sky, ground = (shares[family], 1.0 - shares[family]) if control.law != FMU else (0.0, 0.0)
    if family == control.law:
        sky, ground = sky * (control.skyhook_damping or 0.0), ground * (control.groundhook_damping or 0.0)
    limits, times = (control.minimum_damping, control.maximum_damping), (control.control_period, control.delay)
    return np.array([*limits, sky, ground, float(family != control.law), *times, control.rate])


def in_steps(numbers: npt.ArrayLike, timestep: float) -> npt.NDArray[Any]:
    """Return the records of `SETTING` of controlled dampers for a time step, (...), without controllers.

    Args:
        numbers: parameters from `pack`, (..., 8).
        timestep: time step [s]; period and delay are rounded to whole steps, the period to at least one.
    """
    values = np.asarray(numbers, dtype=float)
    records = np.concatenate([values, np.zeros((*values.shape[:-1], 1))], axis=-1)
    # Columns 5 and 6: period and delay in steps; column 7: largest change in a step, from a rate [N s/m per s].
    records[..., 5:7] = np.rint(records[..., 5:7] / timestep)
    records[..., 5] = np.maximum(records[..., 5], 1.0)
    records[..., 7] = np.where(records[..., 7] < AT_ONCE, records[..., 7] * timestep, np.inf)
    return records.view(SETTING)[..., 0]


def at_rest(numbers: npt.NDArray[Any], *shape: int) -> Vector:
    """Return the memory of dampers before the first step, filled with the softest setting; (3 + lag + 1, ...)."""
    return np.full((RING + int(numbers["lag"]) + 1, *shape), float(numbers["softest"]))


def demanded(numbers: Any, body: Any, wheel: Any) -> Any:
    """Return the coefficient c [N s/m] that a law demands.

    Args:
        numbers: record from `in_steps`.
        body, wheel: velocities vb, vw of the ends along the damper, from the wheel to the body [m/s].
    """
    speed, way = np.abs(body - wheel), np.sign(body - wheel)
    softest, firmest, sky, ground = numbers["softest"], numbers["firmest"], numbers["sky"], numbers["ground"]
    if numbers["on_off"] > 0.0:
        return softest + (firmest - softest) * (sky * (body * way > 0.0) + ground * (wheel * way < 0.0))
    force = sky * np.maximum(body * way, 0.0) + ground * np.maximum(-wheel * way, 0.0)
    # Limit the force before the division: the quotient stays finite, and at rest the damper is soft.
    near = np.minimum(np.maximum(force, softest * speed), firmest * speed)
    return np.minimum(np.maximum(near / (speed + (speed == 0.0)), softest), firmest)


def act(numbers: Any, step: int, body: Any, wheel: Any, past: Any) -> None:
    """Advance a controlled damper by one time step; `past[PRESENT]` is then its mean coefficient over the step.

    Args:
        numbers: record from `in_steps`.
        step: number of the step, from 0.
        body, wheel: vb and vw at the beginning of the step [m/s].
        past: memory from `at_rest`, changed in place.
    """
    if step % int(numbers["period"]) == 0:
        past[HELD] = demanded(numbers, body, wheel)
    length = int(numbers["lag"]) + 1
    past[RING + step % length] = past[HELD]
    wanted, change, before = past[RING + (step + 1) % length], numbers["change"], past[REACHED] + 0.0
    past[REACHED] = np.minimum(np.maximum(wanted, before - change), before + change)
    # The change takes the share |moved| / change of the step, with half of it as its mean.
    moved = past[REACHED] - before
    past[PRESENT] = past[REACHED] - 0.5 * moved * np.abs(moved) / change
