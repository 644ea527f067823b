"""Exact factors of a time step for the scalar equation of a pole.

xi' = s xi + b_z z + b_c z' + e f over a step h, with a cubic z(t) given by z and z' at both ends, and constant f:

    xi+ = E xi + a0 z + a1 z' + c0 z+ + c1 z'+ + h phi1(sh) e f,   E = exp(s h).

With eta = xi - c0 z - c1 z' only the values at the beginning of a step enter: eta+ = E eta + (a0 + E c0) z + (a1 + E
c1) z' + ... The moments of the exponential are phi functions (Hochbruck and Ostermann, Acta Numerica 2010, eq. 2.10):
int_0^1 exp(x (1 - t)) t^j dt = j! phi_{j+1}(x), phi_{k+1}(x) = (phi_k(x) - 1/k!)/x.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.pole_model import PoleModel

Complex = npt.NDArray[np.complex128]

SERIES_BELOW = 2.0
"""|x| below which the recursion is inaccurate and the series of phi is summed."""
SERIES_TERMS = 30
"""Terms of that series: 2^30 / 30! is far below round-off."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepFactors:
    """Factors of a time step.

    Attributes:
        timestep: h [s].
        decay: E; (p,).
        plate: factors of z and z' of all plates at the beginning of a step, for eta; (p, 2 w).
        ahead: c0 and c1: xi = eta + ahead (z, z'); (p, 2 w).
        force: factors of the damper forces; (p, w).
        slope: factors of the slope forces (see `PoleModel.slope`), constant over a step; (p, w) or (p, 0).
    """

    timestep: float
    decay: Complex
    plate: Complex
    ahead: Complex
    force: Complex
    slope: Complex


def phi_functions(x: Complex, highest: int) -> list[Complex]:
    """Return phi_1 ... phi_highest at x, phi_k(x) = sum_i x^i / (i + k)!."""
    use_recursion, zeros = np.abs(x) >= SERIES_BELOW, np.zeros_like(x)
    safe, small = np.where(use_recursion, x, 1.0), np.where(use_recursion, 0.0, x)
    recursive = [np.expm1(safe) / safe]
    for k in range(1, highest):
        recursive.append((recursive[-1] - 1.0 / factorial(k)) / safe)
    values = []
    for k, by_recursion in enumerate(recursive, start=1):
        by_series = zeros
        for i in reversed(range(SERIES_TERMS)):
            by_series = by_series * small + 1.0 / factorial(i + k)
        values.append(np.where(use_recursion, by_recursion, by_series))
    return values


def step_factors(model: PoleModel, timestep: float) -> StepFactors:
    """Return the factors of a model for a time step [s]."""
    h, s = timestep, model.poles[:, None]
    exponent = model.poles * h
    phi = phi_functions(exponent, 4)
    # Moments of 1, t, t^2, t^3 against exp(x (1 - t)).
    m0, m1, m2, m3 = (h * factorial(j) * phi[j][:, None] for j in range(4))
    # Hermite polynomials of z and z' at both ends.
    z0, d0 = m0 - 3.0 * m2 + 2.0 * m3, h * (m1 - 2.0 * m2 + m3)
    z1, d1 = 3.0 * m2 - 2.0 * m3, h * (m3 - m2)
    decay = np.exp(exponent)
    # int exp(s (h - t)) z' dt = z+ - E z + s int exp(s (h - t)) z dt.
    a0 = model.height * z0 + model.velocity * (s * z0 - decay[:, None])
    a1 = (model.height + model.velocity * s) * d0
    c0 = model.height * z1 + model.velocity * (1.0 + s * z1)
    c1 = (model.height + model.velocity * s) * d1
    ahead = np.hstack([c0, c1])
    return StepFactors(
        timestep=h,
        decay=decay,
        plate=np.hstack([a0, a1]) + decay[:, None] * ahead,
        ahead=ahead,
        force=m0 * model.force,
        slope=m0 * model.slope,
    )
