"""Experiments that show why rows on the half car disagree: one number changed, the row computed again."""

from dataclasses import replace

import numpy as np

from scenarios.damper_choice.fit import FRONT_RATIOS, QUARTER_RATIOS, REAR_RATIOS
from scenarios.damper_choice.response_features import crossing, spread_of
from scenarios.damper_choice.runs import HALF_DAMPING, START_REAR, half_car_measure, half_responses
from scenarios.lumped.damper_choice import DamperChoiceParameters
from vehicle.arrays import Vector

STIFFER = 1.1
"""Stiffer front tyre for the row on the crossing at the front [-]."""

MATCHED = 1.04
"""Stiffer rear tyre for the row on the printed R of the rear [-]."""


def rear_experiment(parameters: DamperChoiceParameters) -> str:
    """Return a text: R of the rear before and after step 1 with a stiffer rear tyre."""
    rear = parameters.half_car.rear
    stiffer = replace(rear, tyre_stiffness=MATCHED * rear.tyre_stiffness)
    other = replace(parameters, half_car=replace(parameters.half_car, rear=stiffer))
    measure = half_car_measure(other, "printed", parameters.highway)
    equal, improved = measure(START_REAR, START_REAR)[1], measure(4250.0, START_REAR)[1]
    return (
        f"the fit balances it against the R after step 1: with a rear tyre {MATCHED - 1.0:.0%} stiffer they are "
        f"{equal:.2f} and {improved:.2f}, printed 3.9 and 3.55"
    )


def wheel_experiments(parameters: DamperChoiceParameters, lines: Vector, end: int) -> tuple[str, str]:
    """Return the texts of the experiments for the two rows on the front (0) or rear (1) wheel of the half car."""
    ratios = (FRONT_RATIOS, REAR_RATIOS)[end]
    scale = np.mean([c / ratio for c, ratio in ratios.items()])
    damped = half_responses(parameters, lines, [float(scale * ratio) for ratio in QUARTER_RATIOS.values()])
    spread = spread_of(np.array([curves[end] for curves in damped.values()]))[lines < 2.0].max()
    no_effect = f"with the damping ratios of the quarter car, 0.62 to 1.09, they would differ by {spread:.2f} m/m"
    front = parameters.half_car.front
    stiffer = replace(front, tyre_stiffness=STIFFER * front.tyre_stiffness)
    other = half_responses(
        replace(parameters, half_car=replace(parameters.half_car, front=stiffer)), lines, HALF_DAMPING
    )
    change = crossing(lines, other[HALF_DAMPING[0]][end], other[HALF_DAMPING[-1]][end])
    return no_effect, f"with a front tyre {STIFFER - 1.0:.0%} stiffer they would cross at {change:.1f} Hz"
