"""Rows on the wheels of the half car with another vehicle: the source prints none, so it is fitted to these rows too.

The repeated fit separates rows that depend on the unprinted vehicle from contradictions of the source: rows that the
fit misses together with the remaining printed numbers.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from scenarios.damper_choice.fit import HALF_BOUNDS, HALF_SCALE, half_car_of, half_car_residuals, half_car_values
from scenarios.damper_choice.response_features import crossing, spread_of
from scenarios.damper_choice.runs import HALF_DAMPING, half_responses
from scenarios.lumped.damper_choice import DamperChoiceParameters
from scenarios.lumped.road_holding import half_car_model
from vehicle.arrays import Vector

SAME = 0.15
""""No effect of damping": the curves differ by less than this share of the road amplitude [-]."""

CROSSING = 1.5
"""Reading of the 6 Hz at which the order of the curves changes, a third of a tick interval [Hz]."""

LOW_EDGE = 2.0
"""The half car shows no effect of damping below this frequency [Hz]."""

LINES = np.arange(0.1, 12.0, 0.1)

SCALE = 0.02
"""Scale of the residuals of these rows: a seventh of `SAME` [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Refit:
    """Vehicle fitted to the rows on the wheels as well."""

    holds: dict[tuple[int, int], bool]  # (end, row of `region_verdicts`) to the verdict with this vehicle
    # before, after: sum of squared residuals of the remaining printed numbers, shipped and fitted vehicle [-]
    before: float
    after: float
    vehicle: str  # text on the vehicle

    def text(self, end: int, row: int) -> str:
        """Return the text of the experiment for a row."""
        cost = f"sum of squared residuals of the other printed numbers {self.after:.1f} for {self.before:.1f}"
        if self.holds[end, row]:
            return (
                f"it depends on the vehicle, which is not printed: a fit to this row as well meets it ({self.vehicle}; "
                f"{cost})"
            )
        return (
            f"a contradiction of the source: no vehicle near its other numbers gives it; the fit to this row as well "
            f"misses it too ({cost})"
        )


def region_verdicts(lines: Vector, curves: Vector, low_edge: float) -> tuple[bool, bool]:
    """Return whether the curves of a wheel show no effect of damping below an edge [Hz], and change order at 6 Hz.

    Curves are magnitudes over rising damping, (n, m), at lines [Hz], (m,).
    """
    softest, firmest = curves[0], curves[-1]
    middle, high = (lines > 3.0) & (lines < 5.0), lines > 8.0
    above = firmest > softest
    ordered = bool(np.all(above[middle]) and not np.any(above[high]))
    same = bool(spread_of(curves)[lines < low_edge].max() < SAME)
    return same, ordered and abs(crossing(lines, softest, firmest) - 6.0) < CROSSING


def fitted_to_wheels(parameters: DamperChoiceParameters) -> Refit:
    """Repeat the fit of the half car with the rows on its wheels, from the shipped vehicle."""
    road, bands, start = parameters.highway, parameters.bands, half_car_values(parameters.half_car)

    def others(values: Vector) -> Vector:
        return half_car_residuals(values, road, bands)

    solution = least_squares(
        lambda scaled: np.concatenate([others(scaled * HALF_SCALE), _rows(scaled * HALF_SCALE)]),
        start / HALF_SCALE,
        bounds=(HALF_BOUNDS[0] / HALF_SCALE, HALF_BOUNDS[1] / HALF_SCALE),
        diff_step=2e-3,
        max_nfev=30,
    )
    values = solution.x * HALF_SCALE
    car = half_car_of(values)
    curves = half_responses(replace(parameters, half_car=car), LINES)
    stack = np.array(list(curves.values()))
    index = car.pitch_inertia / (car.sprung_mass * car.front_arm * car.rear_arm)
    return Refit(
        holds={
            (end, row): holds
            for end in (0, 1)
            for row, holds in enumerate(region_verdicts(LINES, stack[:, end], LOW_EDGE))
        },
        before=float(np.sum(others(start) ** 2)),
        after=float(np.sum(others(values) ** 2)),
        vehicle=f"Ms {car.sprung_mass:.0f} kg, J {index:.2f} Ms a b, mu {car.front.unsprung_mass:.0f} and "
        f"{car.rear.unsprung_mass:.0f} kg, kt {1e-3 * car.front.tyre_stiffness:.0f} and "
        f"{1e-3 * car.rear.tyre_stiffness:.0f} kN/m",
    )


def _rows(values: Vector) -> Vector:
    """Return the deviations of both wheels from their rows, over `SCALE`; smooth in the values."""
    car = half_car_of(values)
    curves = np.array([np.abs(half_car_model(car, c, c).response(LINES))[:2] for c in HALF_DAMPING])
    gap = curves[-1] - curves[0]  # (2, m), positive where the firmest damper moves the wheel more
    deviations = []
    for end in (0, 1):
        apart = spread_of(curves[:, end])[LINES < LOW_EDGE].max() - 0.95 * SAME
        early = gap[end][(LINES > 3.0) & (LINES < 5.05)].min()
        deviations += [max(apart, 0.0), min(early, 0.0), max(gap[end][LINES > 8.0].max(), 0.0)]
    return np.array(deviations) / SCALE
