"""Rows that disagree, with other seats and other measures: the source prints no seat.

A row that disagrees for all plausible seats and usual measures is a contradiction of the source: the printed equations
and parameters do not give the printed figure.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from scenarios.claims import Claim
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters
from vehicle.arrays import Vector

STIFFNESS = (5e3, 15e3, 50e3, 150e3)
"""Stiffness of the seat [N/m]: from a soft cushion on springs to a bare frame."""

DAMPING = (150.0, 500.0, 1500.0)
"""Damping of the seat [N s/m]."""

MASSES = (15.0, 35.0)
"""Mass of the seat [kg]."""

FACTORS = (0.8, 1.0, 1.2)
"""Ends and middle of the varied parameters."""

Measure = Callable[[float, Vector], float]
"""(time step [s], acceleration [m/s2]) -> size of the vibration."""

MEASURES: Mapping[str, Measure] = {
    "RMS": lambda _, acceleration: float(np.sqrt(np.mean(acceleration**2))),
    "peak": lambda _, acceleration: float(np.max(np.abs(acceleration))),
}
"""Measures in place of the vibration dose value."""

Rows = Callable[..., Sequence[Claim]]
"""Rows of the study for a car and, as a keyword, a measure."""


def seats(car: HalfCarRiderParameters) -> list[HalfCarRiderParameters]:
    """Return the car with every seat of the grid."""
    return [
        replace(car, seat=replace(car.seat, mass=mass, stiffness=stiffness, damping=damping))
        for stiffness, damping, mass in product(STIFFNESS, DAMPING, MASSES)
    ]


def with_experiment(rows: Sequence[Claim], car: HalfCarRiderParameters, rows_of: Rows) -> list[Claim]:
    """Return the rows; the reason of a disagreement contains the seats and measures for which the row holds."""
    tried = [{row.name: row for row in rows_of(seated_car)} for seated_car in seats(car)]
    measured = {name: {row.name: row for row in rows_of(car, measure=measure)} for name, measure in MEASURES.items()}
    return [
        replace(row, why=f"{row.why}; {_text(row.name, tried, measured)}")
        if row.within is False and row.name in tried[0]
        else row
        for row in rows
    ]


def _text(name: str, tried: Sequence[Mapping[str, Claim]], measured: Mapping[str, Mapping[str, Claim]]) -> str:
    seats_that_hold = sum(rows[name].within is True for rows in tried)
    measures = [measure for measure, rows in measured.items() if "VDV" in name and rows[name].within is True]
    other = f" and with {' and '.join(MEASURES)} in place of the dose value" if "VDV" in name else ""
    grid = (
        f"{len(tried)} seats of {STIFFNESS[0]:g} to {STIFFNESS[-1]:g} N/m, {DAMPING[0]:g} to {DAMPING[-1]:g} N s/m and "
        f"{MASSES[0]:g} to {MASSES[-1]:g} kg"
    )
    if not seats_that_hold and not measures:
        return f"a contradiction of the source: with its equations and parameters it holds for none of {grid}{other}"
    holding = [f"{seats_that_hold} of {grid}", *(f"the {measure}" for measure in measures)]
    return f"it holds for {' and with '.join(holding)}: it depends on what is not printed"
