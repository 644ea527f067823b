"""The logarithm of a ratio of FRFs, and how uncertain a measured one is."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

LEAST_COHERENCE = 0.1
"""Points below it are left out: with so much noise the logarithm is biased, and they would count next to nothing."""

FLOOR = 0.005
"""Least standard deviation of ln|H| and of the phase [rad]: a coherence of exactly 1 does not make a calibration or an
estimator exact. Half a percent is what two estimators of one linear car differ by."""


def log_ratio(measured: npt.ArrayLike, model: npt.ArrayLike) -> npt.NDArray[np.complex128]:
    """ln(H / Hm) = ln|H / Hm| + j arg(H / Hm), with the phase of the ratio between -pi and pi.

    The phase is that of one FRF relative to the other, so that the turns both have in common drop out. It is not
    unwrapped over frequency: one noisy point near pi would then add a whole turn to all points above it, and the sum of
    squares would jump, whereas the square of the principal value is continuous everywhere.

    Args:
        measured: H.
        model: Hm, same shape.

    Returns:
        The logarithm; NaN where either is undefined or zero.
    """
    top, bottom = np.asarray(measured, dtype=complex), np.asarray(model, dtype=complex)
    fine = np.isfinite(top) & np.isfinite(bottom) & (top != 0.0) & (bottom != 0.0)
    ratio = np.full(top.shape, complex(np.nan, np.nan))
    np.divide(top, bottom, out=ratio, where=fine)
    logarithm = np.full(top.shape, complex(np.nan, np.nan))
    np.log(ratio, out=logarithm, where=fine)
    return logarithm


def log_deviation(coherence: npt.ArrayLike, averages: float) -> npt.NDArray[np.float64]:
    """Standard deviation of ln|H| and of the phase [rad] of an estimated FRF.

    sigma^2 = (1 - gamma^2) / (2 gamma^2 n) + floor^2

    Args:
        coherence: gamma^2 [-].
        averages: n, independent averages; an unknown number, taken as 1, changes a common factor only, which the fit
            finds from the residuals.

    Returns:
        sigma [-]; NaN below `LEAST_COHERENCE` and where the coherence is.

    Source: Bendat and Piersol, Random Data, 4th ed., section 9.2: the normalised random error of |H| and the standard
    deviation of the phase in radians are both sqrt(1 - gamma^2) / (|gamma| sqrt(2 n)).
    """
    gamma2 = np.asarray(coherence, dtype=float)
    gamma2 = np.where(gamma2 >= LEAST_COHERENCE, np.minimum(gamma2, 1.0), np.nan)
    return np.sqrt((1.0 - gamma2) / (2.0 * gamma2 * averages) + FLOOR**2)
