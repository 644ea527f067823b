"""Sensitivity of fitted values to causes other than noise: residuals of a model that is wrong, and lags of sensors.

The standard errors of a fit treat the residuals as noise: random, with the correlation of neighbours. Two further
causes are stated in addition.

1. Misfit. The residuals of a wrong model are systematic over whole stretches of time or frequency. Each measurement is
   cut into `STRETCHES` stretches, all rows together, and each stretch is one observation, whatever its residuals r_b:

       Cov = (J'J)^-1 (G / (G - 1) sum_b g_b g_b') (J'J)^-1,   g_b = J_b' r_b,   G stretches.

   For white noise this is the covariance of the noise; a misfit that varies from stretch to stretch adds to it.
   A constant misfit, for example of a wrong mass, moves the values and remains undetected.
2. Lag. With a lag of half a sample in one channel or in all, the residuals change by dr, and the values by
   (J'J)^-1 J' dr. A fitted delay takes the common lag of its group.

Source: Liang and Zeger, Longitudinal data analysis using generalized linear models, Biometrika 73 (1986), 13-22;
Kuensch, The jackknife and the bootstrap for general stationary observations, Annals of Statistics 17 (1989), 1217-1241.
"""

from collections.abc import Sequence

import numpy as np

from vehicle.arrays import Vector

STRETCHES = 20
"""Stretches of a measurement: with 20 a standard error is known to 1 / sqrt(40) = 16 %."""


def misfit_errors(jacobian: Sequence[Vector], weighted: Sequence[Vector], inverse: Vector) -> Vector:
    """Return the standard errors of u with the stretches of each measurement as observations, (p,).

    Args:
        jacobian: Jacobian of the weighted residuals of each measurement, (rows, samples, p).
        weighted: weighted residuals of each measurement, (rows, samples).
        inverse: (J'J)^-1, (p, p).
    """
    scores = list[Vector]()
    for columns, residuals in zip(jacobian, weighted, strict=True):
        products = (columns * residuals[..., None]).sum(axis=0)
        scores += [part.sum(axis=0) for part in np.array_split(products, min(STRETCHES, len(products)))]
    table = np.array(scores).reshape(len(scores), -1)
    factor = len(scores) / max(len(scores) - 1, 1)
    return np.asarray(np.sqrt(np.maximum(factor * np.diag(inverse @ (table.T @ table) @ inverse), 0.0)))


def lag_shifts(changes: Vector, sensitivity: Vector) -> Vector:
    """Return the largest |shift| of u over the cases, (p,); NaN without a case.

    Args:
        changes: changes of the weighted residuals, (cases, n).
        sensitivity: d u / d (weighted residuals), (p, n).
    """
    if not len(changes):
        return np.full(sensitivity.shape[0], np.nan)
    return np.asarray(np.max(np.abs(changes @ sensitivity.T), axis=0))
