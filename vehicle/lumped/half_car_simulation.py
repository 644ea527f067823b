"""Half cars with controlled dampers or tyres that can leave the road, many at once, over a bump.

The controller reads body and wheel velocity once a control period and holds the damper coefficients until the next;
so the damper force c v opposes its velocity at every instant. In between the equations are integrated by the classical
Runge-Kutta method with a fixed step. The road rate of a step is its difference quotient (z(t + h) - z(t)) / h: the
impulse of the tyre damper is then exact where the slope of the road jumps. Order of the whole: 2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError, SimulationError
from vehicle.linear.first_order import first_order
from vehicle.lumped.bump_road import BumpPassage, bump_passage
from vehicle.lumped.half_car_rider import half_car_rider, static_tyre_load
from vehicle.lumped.motion_history import MotionHistory
from vehicle.lumped.semi_active import LAWS, damping_coefficient
from vehicle.parameters.half_car_rider import HalfCarRiderParameters, SemiActiveDamper

Array = npt.NDArray[np.float64]

PASSIVE = "passive"
"""Name of the car's own dampers, beside the laws of `semi_active`."""

LARGEST_STEP = 5e-4
"""[s]: against half of it the dose values of the base case change by less than 0.1 %."""

ENDS = ("front", "rear")


@dataclass(frozen=True, kw_only=True, slots=True)
class _Cars:
    """Matrices of all cars, leading axis (runs)."""

    state: Array  # s' = state s without suspension dampers, (r, 2n, 2n)
    road: Array  # (r, 2n, w)
    road_rate: Array  # (r, 2n, w)
    damper: Array  # acceleration per damper force, (r, 2n, w)
    stretch: Array  # damper rate = stretch . s, (r, w, 2n)
    body: Array  # velocity above each wheel, (r, w, 2n)
    tyre_state: Array  # dynamic tyre load = tyre_state . s + stiffness z + damping z', (r, w, 2n)
    tyre_stiffness: Array  # (r, w)
    tyre_damping: Array  # (r, w)
    push: Array  # acceleration per tyre force, (r, 2n, w)
    static: Array  # (r, w)


def simulate_bump(
    cars: Sequence[HalfCarRiderParameters],
    speeds: Sequence[float],
    *,
    law: str = PASSIVE,
    one_sided_tyres: bool = False,
    duration: float = 5.0,
    largest_step: float = LARGEST_STEP,
) -> list[MotionHistory]:
    """Drive cars over their bump with passive or controlled dampers.

    Args:
        cars: one car for each run; control limits and period are those of the first, which all must share.
        speeds: one speed for each run [m/s].
        law: "passive" or one of `semi_active.LAWS`.
        one_sided_tyres: a tyre that would pull gives no force: its load is max(0, static + k (z - x) + c (z' - x')).
        duration: [s].
        largest_step: upper limit of the integration step [s].

    Returns:
        One history for each run, sampled once an integration step.

    Raises:
        ConfigurationError: unknown law, different numbers of cars and speeds, or limits that differ between the cars.
        SimulationError: the motion grew without bound.
    """
    if law not in (PASSIVE, *LAWS):
        raise ConfigurationError(f"half car: law: found {law!r}, allowed are {', '.join((PASSIVE, *LAWS))}")
    if len(cars) != len(speeds) or not cars:
        raise ConfigurationError(f"half car: found {len(cars)} cars and {len(speeds)} speeds, needed is one speed each")
    if not (math.isfinite(largest_step) and largest_step > 0.0):
        raise ConfigurationError(f"half car: largest_step: found {largest_step!r} s, must be greater than 0.0")
    control = cars[0].semi_active
    if any(car.semi_active != control for car in cars):
        raise ConfigurationError("half car: semi_active: the cars of one call must share it; call once for each")
    substeps = math.ceil(control.control_period / largest_step)
    step = control.control_period / substeps
    steps = round(duration / step)
    if steps < 1:
        raise ConfigurationError(f"half car: duration: found {duration!r} s, must be at least {step!r} s")
    passages = [
        bump_passage(car.bump, speed, car.body.front_arm + car.body.rear_arm)
        for car, speed in zip(cars, speeds, strict=True)
    ]
    matrices = _stack(cars)
    own = np.array([[car.front.suspension_damping, car.rear.suspension_damping] for car in cars])
    road = _half_steps(passages, step, steps)
    states = np.zeros((steps + 1, len(cars), matrices.state.shape[-1]))
    slopes = np.zeros_like(states)
    settings = np.empty((steps + 1, len(cars), len(ENDS)))
    coefficient = own
    for k in range(steps + 1):
        state = states[k]
        if law != PASSIVE and k % substeps == 0:
            coefficient = _setting(law, control, matrices, state)
        settings[k] = coefficient
        z0, z1, z2 = road[2 * k], road[2 * k + 1], road[2 * k + 2]
        rate = (z2 - z0) / step
        k1 = _slope(matrices, state, z0, rate, coefficient, one_sided_tyres)
        slopes[k] = k1
        if k == steps:
            break
        k2 = _slope(matrices, state + 0.5 * step * k1, z1, rate, coefficient, one_sided_tyres)
        k3 = _slope(matrices, state + 0.5 * step * k2, z1, rate, coefficient, one_sided_tyres)
        k4 = _slope(matrices, state + step * k3, z2, rate, coefficient, one_sided_tyres)
        states[k + 1] = state + step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        if not np.isfinite(states[k + 1]).all():
            raise SimulationError(
                f"half car: motion not finite at {step * (k + 1):g} s with a step of {step:g} s; use a smaller step"
            )
    time = np.asarray(step * np.arange(steps + 1), dtype=np.float64)
    return [
        _history(car, passage, time, states[:, i], slopes[:, i], None if law == PASSIVE else settings[:, i])
        for i, (car, passage) in enumerate(zip(cars, passages, strict=True))
    ]


def _half_steps(passages: Sequence[BumpPassage], step: float, steps: int) -> Array:
    """Road heights at every half step, shape (2 steps + 3, runs, w)."""
    grid = 0.5 * step * np.arange(2 * steps + 3)
    return np.stack([passage.heights(grid).T for passage in passages], axis=1)


def _stack(cars: Sequence[HalfCarRiderParameters]) -> _Cars:
    singles = [_matrices(car) for car in cars]
    return _Cars(**{name: np.stack([getattr(one, name) for one in singles]) for name in _Cars.__dataclass_fields__})


def _matrices(car: HalfCarRiderParameters) -> _Cars:
    """Matrices of one car; its suspension dampers are left out of the state matrix, they act through `damper`."""
    loose = replace(
        car, front=replace(car.front, suspension_damping=0.0), rear=replace(car.rear, suspension_damping=0.0)
    )
    model = half_car_rider(loose)
    form = first_order(model)
    inverse = np.linalg.inv(model.mass)
    still = np.zeros((model.size, len(ENDS)))
    stretch, body, wheel = (
        np.stack([model.output(f"{end}_{place}")[0] for end in ENDS]) for place in ("travel", "body", "wheel")
    )
    stiffness = np.array([car.front.tyre_stiffness, car.rear.tyre_stiffness])
    damping = np.array([car.front.tyre_damping, car.rear.tyre_damping])
    return _Cars(
        state=form.state,
        road=form.input,
        road_rate=form.input_rate,
        damper=np.vstack((still, -inverse @ stretch.T)),
        stretch=np.hstack((still.T, stretch)),
        body=np.hstack((still.T, body)),
        tyre_state=np.hstack((-stiffness[:, None] * wheel, -damping[:, None] * wheel)),
        tyre_stiffness=stiffness,
        tyre_damping=damping,
        push=np.vstack((still, inverse @ wheel.T)),
        static=static_tyre_load(car),
    )


def _times(matrix: Array, vector: Array) -> Array:
    """Matrix-vector product of every run."""
    return np.asarray((matrix @ vector[..., None])[..., 0])


def _setting(law: str, control: SemiActiveDamper, cars: _Cars, state: Array) -> Array:
    body = _times(cars.body, state)
    return damping_coefficient(law, control, body, body - _times(cars.stretch, state))


def _slope(cars: _Cars, state: Array, road: Array, rate: Array, coefficient: Array, one_sided: bool) -> Array:
    slope = _times(cars.state, state) + _times(cars.road, road) + _times(cars.road_rate, rate)
    slope += _times(cars.damper, coefficient * _times(cars.stretch, state))
    if one_sided:
        dynamic = _times(cars.tyre_state, state) + cars.tyre_stiffness * road + cars.tyre_damping * rate
        slope += _times(cars.push, np.maximum(0.0, -(cars.static + dynamic)))  # takes the pull away again
    return slope


def _history(
    car: HalfCarRiderParameters,
    passage: BumpPassage,
    time: Array,
    states: Array,
    slopes: Array,
    settings: Array | None,
) -> MotionHistory:
    model = half_car_rider(car)
    n = len(model.coordinates)
    return MotionHistory(
        coordinates=model.coordinates,
        time=time,
        displacement=states[:, :n].T,
        velocity=states[:, n:].T,
        acceleration=slopes[:, n:].T,
        road=passage.heights(time),
        road_rate=passage.rates(time),
        suspension_damping=None if settings is None else settings.T,
    )
