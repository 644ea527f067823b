"""Weights with which a step answers the stiffness and the damping of a row: of high order, stable, without ringing."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]

FOURTH_ORDER = 1.0 / 12.0
"""Weight beta of the average over three steps, (beta, 1 - 2 beta, beta), with errors of fourth order (Numerov)."""

UNCONDITIONAL = 1.0 / 4.0
"""Weight beta with which a stiffness is stable at any step (Newmark)."""

SAFE_SHARE = 1.0 / 2.0
"""Share of its mass that a stiff row may lose to the explicit part of its stiffness: at 1 it would be unstable alone,
and the joints between the parts make the moved mass smaller than that of a row alone."""

FITTED_PHASE = 2.0
"""Phase w h up to which the damping of a branch is fitted to the decay of its row. The fit answers the rate a little
late, like a mass of (theta - 1/2) B h beside the row: nothing against the masses of the car at the suspension mounts
(0.5 kg), but not at stiffer branches, which the average calms anyway."""


def average(phase: Vector) -> Vector:
    """Weight beta with which a stiff row is averaged over three steps, from (w h)2 of the row alone.

    As much as stability asks for, (1/4 - beta) (w h)2 <= SAFE_SHARE: the fourth-order 1/12 up to w h = 1.7, and 1/4
    for a stiffness without bound.
    """
    explicit = np.divide(SAFE_SHARE, phase, out=np.full_like(phase, np.inf), where=phase > 0.0)
    return np.maximum(FOURTH_ORDER, UNCONDITIONAL - explicit)


def implicit_share(decay: Vector) -> Vector:
    """Share theta of a step of acceleration with which m v' = -B v decays by exp(-z) a step, z = B h/m.

    (m + theta B h) a = -B v gives v + h a = exp(-z) v for theta = 1/(1 - exp(-z)) - 1/z = 1/2 + z/12 - ...: second
    order like 1/2, but a light part behind a strong damper does not ring.
    """
    small = decay < 1e-4  # where the difference of two large numbers would have four digits less
    z = np.where(small, 1.0, decay)
    return np.where(small, 0.5 + decay / 12.0, -1.0 / np.expm1(-z) - 1.0 / z)
