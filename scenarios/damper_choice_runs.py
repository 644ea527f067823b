"""Numbers of the damper study: frequency responses, load fluctuation over damping, iteration and joint optimum."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.lumped.damper_optimum import Fluctuation, Optimum, Step, iterate, joint_optimum, optimum
from vehicle.lumped.road_holding import printed_load_fluctuation, tyre_load_ratio
from vehicle.lumped.road_holding_models import RoadHoldingModel, half_car_model, quarter_car_model
from vehicle.parameters.damper_choice import DamperChoiceParameters, ExponentialRoad, FrequencyBands

Array = npt.NDArray[np.float64]

QUARTER_DAMPING = (4000.0, 5000.0, 6000.0, 7000.0)
"""Damping of figures 2 and 3 [N s/m]."""

HALF_DAMPING = (3000.0, 4500.0, 6000.0, 7500.0)
"""Damping of figures 5 to 8, front and rear alike [N s/m]."""

READ_OFF = np.arange(1000.0, 8001.0, 250.0)
"""Damping among which the source reads its optima [N s/m]: all that it prints are multiples of 250."""

START_REAR = 3250.0
"""Rear damping with which the source starts its iteration [N s/m]."""

MEASURES: dict[str, Callable[[RoadHoldingModel, ExponentialRoad, FrequencyBands], Array]] = {
    "printed": printed_load_fluctuation,
    "physical": tyre_load_ratio,
}
"""Sum of band amplitudes as printed, and RMS tyre force over static load."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RoadHolding:
    """Everything about one measure on one road."""

    damping: Array
    """Abscissa of the curves [N s/m], shape (m,)."""
    quarter: Array
    """Quarter car over damping [-], shape (m,)."""
    equal: Array
    """Front and rear tyre of the half car with equal dampers [-], shape (2, m)."""
    quarter_optimum: Optimum
    equal_optima: tuple[Optimum, Optimum]
    read_off: list[Step]
    """Iteration among the values of `READ_OFF`, as in the source."""
    continuous: list[Step]
    """Iteration over all coefficients."""
    joint: tuple[float, float, Array]
    """Front and rear coefficient of the least sum of both tyres [N s/m], measures there."""


def quarter_responses(parameters: DamperChoiceParameters, lines: Array) -> dict[float, Array]:
    """|response| of wheel and body for the damping of figures 2 and 3; damping -> (2, m)."""
    return {c: np.abs(quarter_car_model(parameters.quarter_car, c).response(lines)) for c in QUARTER_DAMPING}


def half_responses(parameters: DamperChoiceParameters, lines: Array) -> dict[float, Array]:
    """|response| of front wheel, rear wheel, heave, pitch for the damping of figures 5 to 8; damping -> (4, m)."""
    return {c: np.abs(half_car_model(parameters.half_car, c, c).response(lines)) for c in HALF_DAMPING}


def half_car_measure(parameters: DamperChoiceParameters, measure: str, road: ExponentialRoad) -> Fluctuation:
    """Measure of both tyres as a function of front and rear damping."""
    return lambda front, rear: MEASURES[measure](
        half_car_model(parameters.half_car, front, rear), road, parameters.bands
    )


def road_holding(
    parameters: DamperChoiceParameters, measure: str, road: ExponentialRoad, damping: Sequence[float]
) -> RoadHolding:
    """Curves and optima of one measure on one road.

    Args:
        parameters: vehicle, bands.
        measure: "printed" or "physical".
        road: displacement density.
        damping: abscissa of the curves [N s/m].
    """
    rate = MEASURES[measure]
    both = half_car_measure(parameters, measure, road)

    def quarter(c: float) -> float:
        return float(rate(quarter_car_model(parameters.quarter_car, c), road, parameters.bands)[0])

    read_off = iterate(both, rear=START_REAR, grid=READ_OFF)
    return RoadHolding(
        damping=np.asarray(damping, dtype=float),
        quarter=np.array([quarter(c) for c in damping]),
        equal=np.array([both(c, c) for c in damping]).T,
        quarter_optimum=optimum(quarter),
        equal_optima=(optimum(lambda c: float(both(c, c)[0])), optimum(lambda c: float(both(c, c)[1]))),
        read_off=read_off,
        continuous=iterate(both, rear=START_REAR),
        joint=joint_optimum(both, start=(read_off[-1].front, read_off[-1].rear)),
    )
