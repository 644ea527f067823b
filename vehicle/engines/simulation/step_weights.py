"""Time integration weights for stiffness and damping of a row: high order, stability, no ringing."""

import numpy as np

from vehicle.arrays import Vector

FOURTH_ORDER = 1.0 / 12.0
"""Weight beta of the average over three steps, (beta, 1 - 2 beta, beta), with errors of fourth order (Numerov)."""

UNCONDITIONAL = 1.0 / 4.0
"""Weight beta of unconditional stability (Newmark)."""

SAFE_SHARE = 1.0 / 2.0
"""Maximum share of the row mass that the explicit part of its stiffness may cancel. A single row is unstable at 1, and
joints between the parts make the effective mass smaller than that of a single row."""

FITTED_PHASE = 2.0
"""Phase w h up to which the damping of a branch is fitted to the decay of its row. The fit delays the force
slightly, like an added mass of (theta - 1/2) B h: negligible at the suspension mounts (0.5 kg), but not at stiffer
branches, which the average stabilises anyway."""


def average(phase: Vector) -> Vector:
    """Return the weight beta of the average over three steps of a stiff row, from (w h)2 of the single row.

    Minimum that satisfies the stability limit (1/4 - beta) (w h)2 <= SAFE_SHARE: the fourth-order 1/12 up to w h = 1.7,
    tending to 1/4 for an infinite stiffness.
    """
    explicit = np.divide(SAFE_SHARE, phase, out=np.full_like(phase, np.inf), where=phase > 0.0)
    return np.maximum(FOURTH_ORDER, UNCONDITIONAL - explicit)


def implicit_share(decay: Vector) -> Vector:
    """Return the implicit share theta for which m v' = -B v decays by exp(-z) in a step, z = B h/m.

    (m + theta B h) a = -B v gives v + h a = exp(-z) v for theta = 1/(1 - exp(-z)) - 1/z = 1/2 + z/12 - ...: second
    order like 1/2, but without ringing of a low-mass part with strong damping.
    """
    small = decay < 1e-4  # avoid the cancellation of two large terms
    z = np.where(small, 1.0, decay)
    return np.where(small, 0.5 + decay / 12.0, -1.0 / np.expm1(-z) - 1.0 / z)
