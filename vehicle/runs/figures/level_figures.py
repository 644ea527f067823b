"""Figures of the periodic states of a car: the level at which a damper slips, and the damping that is left."""

from collections.abc import Callable
from typing import Any

import numpy as np

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car.level_inputs import MOTIONS, plate_shares
from vehicle.runs.car.levels import FREQUENCY, LEVEL
from vehicle.runs.figures.figure import Details, Figure, Reduction, Values
from vehicle.runs.figures.rows import unread
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.samples import Vector

DAMPED = 1e-3
"""Amplitude of the plates at which the damping is stated [m]."""

PATH = np.append(np.geomspace(LEVEL[0], DAMPED, 9), LEVEL[-1])
"""Levels from all dampers stuck to `DAMPED`, along which a mode is followed, and the highest, up to which the peak of
the mode falls most [m]."""


def _slip_level(car: Any, motion: str) -> float:
    # In closed form for the first damper of a frequency, so one level will do.
    return float(np.nanmin(car.levels(plates=motion, frequency=FREQUENCY, level=DAMPED).first))


def _level_damping(car: Any, motion: str) -> float:
    states = car.levels(plates=motion, frequency=FREQUENCY, level=PATH)
    return float(states.mode(states.falling_peak())[1][np.searchsorted(PATH, DAMPED)])


def _of_car(value: Callable[[Any, str], float]) -> Reduction:
    """Return the reduction to a number of the car itself."""

    def of(_: Vector, details: Details, runs: Runs) -> Values:
        return Values(np.array([value(car, details.motion) for car in runs.cars]))

    return Reduction(of=of)


def _require_motion(details: Details, vehicle: Vehicle) -> None:
    if details.motion not in MOTIONS:
        raise ConfigurationError(f"motion {details.motion!r}: must be one of {', '.join(MOTIONS)}")
    plate_shares(details.motion, vehicle.wheels)


LEVEL_FIGURES = {
    "slip_level": Figure(
        words="level of the first slip",
        meaning="smallest amplitude of the plates, for example in heave, at which a damper slips, 1 to 30 Hz [m]",
        unit="m", reads=unread(lambda *_: ()), reduces=_of_car(_slip_level), needs=("motion",), of_car="damper",
        exact=True, require=_require_motion,
    ),
    "level_damping": Figure(
        words="damping ratio at 1 mm",
        meaning="damping ratio of the mode whose peak at the seat rail falls most, plates of 1 mm, for example in "
        "heave [-]",
        unit="-", reads=unread(lambda *_: ()), reduces=_of_car(_level_damping), better="", needs=("motion",),
        of_car="damper", exact=True, require=_require_motion,
    ),
}  # fmt: skip
"""Name to figure of the periodic states."""
