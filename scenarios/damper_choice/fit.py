"""Vehicle parameters that the damper study leaves out, fitted to the results it prints.

Least squares over the parameters in `QUARTER_FREE` and `HALF_FREE`; the spring stiffnesses follow from the printed
damping ratios zeta = c / (2 sqrt(k m)), m the share of the sprung mass on the axle. Every target below is printed, as a
number or as a direction; its scale is the width within which the print can be read.

Source: "Dynamic Modeling of Vehicles and Damper" (2014), figures 2 to 13 and the text on them.
"""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from scenarios.damper_choice.response_features import local_peaks
from scenarios.lumped.axle import Axle
from scenarios.lumped.damper_choice import ExponentialRoad, FrequencyBands, RoadHoldingHalfCar, RoadHoldingQuarterCar
from scenarios.lumped.road_holding import half_car_model, printed_load_fluctuation, quarter_car_model
from vehicle.arrays import Vector

QUARTER_RATIOS = {4000.0: 0.62, 5000.0: 0.78, 6000.0: 0.94, 7000.0: 1.09}
"""Damping [N s/m] -> printed damping ratio (figures 2 and 3)."""
FRONT_RATIOS = {3000.0: 0.35, 4500.0: 0.53, 6000.0: 0.71, 7500.0: 0.89}
"""The same at the front of the half car (figures 5 to 8)."""
REAR_RATIOS = {3000.0: 0.37, 4500.0: 0.55, 6000.0: 0.73, 7500.0: 0.92}
"""The same at the rear."""

QUARTER_FREE = ("sprung_mass", "unsprung_mass", "tyre_stiffness")
HALF_FREE = (
    "sprung_mass",
    "inertia_index",
    "wheelbase",
    "front_arm_share",
    "front_unsprung_mass",
    "rear_unsprung_mass",
    "front_tyre_stiffness",
    "rear_tyre_stiffness",
)

_QUARTER_SCALE = np.array([250.0, 60.0, 280e3])
_QUARTER_BOUNDS = (np.array([150.0, 30.0, 150e3]), np.array([400.0, 120.0, 500e3]))
HALF_SCALE = np.array([700.0, 1.0, 2.6, 0.5, 50.0, 70.0, 2e5, 2e5])
HALF_BOUNDS = (
    np.array([400.0, 0.2, 2.3, 0.3, 25.0, 25.0, 8e4, 8e4]),
    np.array([1500.0, 1.3, 2.9, 0.7, 130.0, 200.0, 5e5, 5e5]),
)
"""Lowest and highest values of `HALF_FREE` in their order: road vehicles, with room."""
_COARSE = np.arange(2000.0, 6001.0, 250.0)
_READING = 125.0  # half of the 250 N s/m to which the source reads its optima [N s/m]


def root_stiffness_mass(ratios: dict[float, float]) -> float:
    """Return sqrt(k m) = mean of c / (2 zeta) over printed pairs [N s/m]."""
    return float(np.mean([damping / (2.0 * ratio) for damping, ratio in ratios.items()]))


def fit_quarter_car(start: npt.ArrayLike, road: ExponentialRoad, bands: FrequencyBands) -> tuple[Vector, Vector]:
    """Fit the quarter car from a first guess in the order of `QUARTER_FREE`; otherwise as `fit_half_car`."""
    return _fit(quarter_car_residuals, start, road, bands, _QUARTER_SCALE, _QUARTER_BOUNDS)


def fit_half_car(
    start: npt.ArrayLike, road: ExponentialRoad, bands: FrequencyBands, *, least_index: float = 0.2
) -> tuple[Vector, Vector]:
    """Fit the half car.

    Args:
        start: first guess in the order of `HALF_FREE`.
        road: road of the printed optima (highway).
        bands: frequency bands of the printed measure.
        least_index: lower bound of J / (Ms a b) [-].

    Returns:
        The fitted values and the residuals there, each over its scale.
    """
    lower = np.where(np.array(HALF_FREE) == "inertia_index", least_index, HALF_BOUNDS[0])
    return _fit(half_car_residuals, start, road, bands, HALF_SCALE, (lower, HALF_BOUNDS[1]))


def quarter_car_of(values: npt.ArrayLike) -> RoadHoldingQuarterCar:
    """Return the quarter car of values in the order of `QUARTER_FREE`, with the printed optimum damper."""
    mass, unsprung, tyre = (float(value) for value in np.asarray(values, dtype=float))
    stiffness = root_stiffness_mass(QUARTER_RATIOS) ** 2 / mass
    return RoadHoldingQuarterCar(sprung_mass=mass, wheel=_axle(unsprung, stiffness, 3750.0, tyre))


def half_car_of(values: npt.ArrayLike) -> RoadHoldingHalfCar:
    """Return the half car of values in the order of `HALF_FREE`, with the dampers of the printed last iteration."""
    mass, index, wheelbase, share, front, rear, front_tyre, rear_tyre = (float(v) for v in np.asarray(values))
    a, b = share * wheelbase, (1.0 - share) * wheelbase
    front_stiffness = root_stiffness_mass(FRONT_RATIOS) ** 2 / (mass * b / wheelbase)
    rear_stiffness = root_stiffness_mass(REAR_RATIOS) ** 2 / (mass * a / wheelbase)
    return RoadHoldingHalfCar(
        sprung_mass=mass,
        pitch_inertia=index * mass * a * b,
        front_arm=a,
        rear_arm=b,
        front=_axle(front, front_stiffness, 4250.0, front_tyre),
        rear=_axle(rear, rear_stiffness, 3000.0, rear_tyre),
    )


def quarter_car_values(car: RoadHoldingQuarterCar) -> Vector:
    """Return the values of a quarter car in the order of `QUARTER_FREE`."""
    return np.array([car.sprung_mass, car.wheel.unsprung_mass, car.wheel.tyre_stiffness])


def half_car_values(car: RoadHoldingHalfCar) -> Vector:
    """Return the values of a half car in the order of `HALF_FREE`."""
    base = car.front_arm + car.rear_arm
    ends = [getattr(axle, name) for name in ("unsprung_mass", "tyre_stiffness") for axle in (car.front, car.rear)]
    index = car.pitch_inertia / (car.sprung_mass * car.front_arm * car.rear_arm)
    return np.array([car.sprung_mass, index, base, car.front_arm / base, *ends])


def quarter_car_residuals(values: npt.ArrayLike, road: ExponentialRoad, bands: FrequencyBands) -> Vector:
    """Return the deviations of a quarter car from printed values, over their scales, in the order of the comments."""
    car = quarter_car_of(values)
    best = _valley(lambda c: float(printed_load_fluctuation(quarter_car_model(car, c), road, bands)[0]))
    lines = np.arange(0.02, 15.0, 0.02)
    magnitude = [np.abs(quarter_car_model(car, c).response(lines)) for c in QUARTER_RATIOS]
    unsprung, sprung = (np.array([response[i] for response in magnitude]) for i in (0, 1))
    peaks = sprung.max(axis=1)
    residuals = [(best - 3750.0) / _READING]  # optimum 3500 to 4000 N s/m
    residuals += list((lines[sprung.argmax(axis=1)] - 2.0) / 0.3)  # one peak near 2 Hz for every damping
    residuals += list(np.minimum(-np.diff(peaks) - 0.02, 0.0) / 0.02)  # lower with more damping
    residuals.append(_outside(float(peaks.max()), 1.0, 1.5) / 0.05)  # axis of figure 3
    residuals.append(_outside(float(unsprung.max()), 1.4, 1.6) / 0.05)  # axis of figure 2
    peaks_of_wheel = local_peaks(lines, unsprung[0]) or [0.0]
    residuals.append(peaks_of_wheel[-1] - 7.0)  # second local maximum at about 7 Hz for low damping
    return np.array(residuals)


def half_car_residuals(values: npt.ArrayLike, road: ExponentialRoad, bands: FrequencyBands) -> Vector:
    """Return the deviations of a half car from printed values, over their scales, in the order of the comments."""
    car = half_car_of(values)

    def rate(front: float, rear: float) -> Vector:
        return printed_load_fluctuation(half_car_model(car, front, rear), road, bands)

    optima = [
        _valley(lambda c: float(rate(c, c)[0])) - 4000.0,  # figure 10, front
        _valley(lambda c: float(rate(c, c)[1])) - 3125.0,  # figure 10, rear: 3000 and 3250 are both printed
        _valley(lambda c: float(rate(c, 3250.0)[0])) - 4250.0,  # figure 11
        _valley(lambda c: float(rate(4250.0, c)[1])) - 3000.0,  # figure 12
        _valley(lambda c: float(rate(c, 3000.0)[0])) - 4250.0,  # figure 13
    ]
    front = [rate(4000.0, 4000.0)[0] - 2.25, rate(4250.0, 3250.0)[0] - 2.125, rate(4250.0, 3000.0)[0] - 2.1]
    rear = [rate(3250.0, 3250.0)[1] - 3.9, rate(4250.0, 3250.0)[1] - 3.55, rate(4250.0, 3000.0)[1] - 3.5]
    lines = np.arange(0.2, 15.0, 0.1)
    responses = np.array([np.abs(half_car_model(car, c, c).response(lines)) for c in FRONT_RATIOS])
    peaks = responses.max(axis=2)
    highest = peaks.max(axis=0)
    residuals = [value / _READING for value in optima]
    residuals += [value / 0.05 for value in front] + [value / 0.1 for value in rear]  # 2 % of the printed R
    # axes of figures 5 to 8: the largest value is between the last two ticks
    residuals += [_outside(float(highest[0]), 1.0, 1.5) / 0.1, _outside(float(highest[1]), 1.6, 1.8) / 0.1]
    residuals += [_outside(float(highest[2]), 2.5, 3.0) / 0.2, _outside(float(highest[3]), 0.6, 0.7) / 0.1]
    residuals.append((lines[responses[:, 2].argmax(axis=1)].mean() - 2.0) / 0.3)  # heave peak as the quarter car's
    residuals += list(np.minimum(np.diff(peaks[:, 3]) - 0.02, 0.0) / 0.02)  # pitch peak rises with damping
    return np.array(residuals)


def _fit(
    residuals: Callable[[npt.ArrayLike, ExponentialRoad, FrequencyBands], Vector],
    start: npt.ArrayLike,
    road: ExponentialRoad,
    bands: FrequencyBands,
    scale: Vector,
    bounds: tuple[Vector, Vector],
) -> tuple[Vector, Vector]:
    solution = least_squares(
        lambda scaled: residuals(scaled * scale, road, bands),
        np.asarray(start, dtype=float) / scale,
        bounds=(bounds[0] / scale, bounds[1] / scale),
        diff_step=2e-3,  # wider than the steps that frequency grids and magnitudes leave in the residuals
        max_nfev=60,
    )
    return solution.x * scale, solution.fun


def _axle(unsprung: float, stiffness: float, damping: float, tyre: float) -> Axle:
    return Axle(
        unsprung_mass=unsprung,
        suspension_stiffness=stiffness,
        suspension_damping=damping,
        tyre_stiffness=tyre,
        tyre_damping=0.0,
    )


def _valley(measure: Callable[[float], float]) -> float:
    """Return the vertex of the parabola through the minimum of a coarse grid and its neighbours [N s/m]."""
    values = np.array([measure(float(c)) for c in _COARSE])
    best = int(np.clip(values.argmin(), 1, _COARSE.size - 2))
    left, middle, right = values[best - 1 : best + 2]
    shift = np.clip((left - right) / (2.0 * (left - 2.0 * middle + right)), -1.0, 1.0)
    return float(_COARSE[best] + (_COARSE[1] - _COARSE[0]) * shift)


def _outside(value: float, low: float, high: float) -> float:
    return min(value - low, 0.0) + max(value - high, 0.0)
