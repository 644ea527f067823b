"""Road holding, comfort and suspension travel of a quarter car on a random road."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.lumped.road_holding import tyre_load_ratio_of_density
from vehicle.lumped.road_holding_models import quarter_car_model
from vehicle.parameters.damper_choice import RoadHoldingQuarterCar

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True)
class RideMeasures:
    """Root mean squares of one damper on one road."""

    tyre_load: float
    """Dynamic tyre force over static load [-]."""
    acceleration: float
    """Weighted vertical acceleration of the body [m/s2]."""
    travel: float
    """Suspension travel [m]."""


def ride_measures(
    car: RoadHoldingQuarterCar, damping: float, lines: Array, density: Array, width: Array, weight: npt.ArrayLike = 1.0
) -> RideMeasures:
    """Root mean squares from spectra: y_rms^2 = int |H_y|^2 G df by the midpoint rule.

    Args:
        car: quarter car.
        damping: damper coefficient [N s/m].
        lines: midpoints [Hz], shape (m,).
        density: displacement density of the road at the midpoints [m2/Hz], shape (m,).
        width: width of each interval [Hz], shape (m,).
        weight: spectrum factor on the acceleration, as Wk of ISO 2631-1 [-], shape (m,); 1 leaves it unweighted.

    Returns:
        The three measures.
    """
    model = quarter_car_model(car, damping)
    wheel, body = model.response(lines, "wheel", "body")
    acceleration = np.asarray(weight) * (2.0 * np.pi * lines) ** 2 * np.abs(body)
    return RideMeasures(
        tyre_load=float(tyre_load_ratio_of_density(model, lines, density, width)[0]),
        acceleration=float(np.sqrt(np.sum(acceleration**2 * density * width))),
        travel=float(np.sqrt(np.sum(np.abs(body - wheel) ** 2 * density * width))),
    )
