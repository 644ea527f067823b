"""Batch of half cars with controlled dampers, or tyres that can lift off, over a bump.

The controller samples body and wheel velocity once in a control period and holds the damper coefficients until the next
(`vehicle.model.laws.control_laws`), so the damper force c v opposes its velocity at every instant. Between the samples
the equations are integrated by the classical Runge-Kutta method with a fixed step. The road rate of a step is its
difference quotient (z(t + h) - z(t)) / h: the impulse of the tyre damper is then exact where the slope of the road
jumps. The
method has order 2.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from scenarios.lumped.bump_response import bump_passage
from scenarios.lumped.half_car_rider_model import ENDS, half_car_rider, static_tyre_load
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters
from scenarios.lumped.history import History
from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import FirstOrder, first_order
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.laws.control_laws import PRESENT, act, at_rest, in_steps, pack
from vehicle.model.parameters.semi_active_damper import LAWS, PASSIVE

LARGEST_STEP = 5e-4
"""Maximum step [s]; with half of it the dose values of the base case change by less than 0.1 %."""


def simulate_bump(
    cars: Sequence[HalfCarRiderParameters],
    speeds: Sequence[float],
    *,
    law: str = PASSIVE,
    one_sided_tyres: bool = False,
    duration: float = 5.0,
    largest_step: float = LARGEST_STEP,
    halves: int = 1,
) -> list[History]:
    """Simulate cars over their bumps with passive or controlled dampers.

    Args:
        cars: car of each run; all cars must have the same `semi_active` parameters.
        speeds: speed of each run [m/s].
        law: "passive" or one of the laws of `vehicle.model.parameters.semi_active_damper`; the law in the parameters is
            ignored.
        one_sided_tyres: tyres cannot pull: the load is max(0, static + k (z - x) + c (z' - x')).
        duration: duration of the runs [s].
        largest_step: upper limit of the integration step [s].
        halves: number of half waves of the bump in a row, see `bump_passage`.

    Returns:
        History of each run, sampled once in an integration step. Its sliding pairs are the dampers of both axles,
        then the differences between one-sided and linear tyre forces.

    Raises:
        ConfigurationError: unknown law, different numbers of cars and speeds, or limits that differ between the cars.
        SimulationError: the motion is not finite.
    """
    if law not in (PASSIVE, *LAWS):
        raise ConfigurationError(f"half car: law: found {law!r}, must be one of {', '.join((PASSIVE, *LAWS))}")
    if len(cars) != len(speeds) or not cars:
        raise ConfigurationError(
            f"half car: found {len(cars)} cars and {len(speeds)} speeds, must be one speed for each car"
        )
    if not (math.isfinite(largest_step) and largest_step > 0.0):
        raise ConfigurationError(f"half car: largest_step: found {largest_step!r} s, must be greater than 0.0")
    control = cars[0].semi_active
    if any(car.semi_active != control for car in cars):
        raise ConfigurationError(
            "half car: semi_active: all cars of one call must have the same; simulate other cars in another call"
        )
    substeps = math.ceil(control.control_period / largest_step)
    step = control.control_period / substeps
    steps = round(duration / step)
    if steps < 1:
        raise ConfigurationError(f"half car: duration: found {duration!r} s, must be at least {step!r} s")
    passages = [
        bump_passage(car.bump, speed, car.body.front_arm + car.body.rear_arm, halves=halves)
        for car, speed in zip(cars, speeds, strict=True)
    ]
    run = _Cars([_without_dampers(car) for car in cars], cars, one_sided_tyres)
    grid = 0.5 * step * np.arange(2 * steps + 3)
    road = np.stack([passage.heights(grid).T for passage in passages], axis=1)  # at half steps, (2 steps + 3, runs, w)
    states = np.zeros((steps + 1, len(cars), run.state.shape[-1]))
    slopes, forces = np.zeros_like(states), np.zeros((steps + 1, len(cars), 2 * len(ENDS)))
    coefficient = np.array([[car.front.suspension_damping, car.rear.suspension_damping] for car in cars])
    record = in_steps(pack(replace(control, law=law)), step) if law != PASSIVE else None
    law_state = None if record is None else at_rest(record, *coefficient.shape)
    for k in range(steps + 1):
        state = states[k]
        if law_state is not None:
            act(record, k, *run.velocities(state), law_state)
            coefficient = law_state[PRESENT]
        z0, z1, z2 = road[2 * k], road[2 * k + 1], road[2 * k + 2]
        rate = (z2 - z0) / step
        k1, forces[k] = run.slope(state, z0, rate, coefficient)
        slopes[k] = k1
        if k == steps:
            break
        k2, _ = run.slope(state + 0.5 * step * k1, z1, rate, coefficient)
        k3, _ = run.slope(state + 0.5 * step * k2, z1, rate, coefficient)
        k4, _ = run.slope(state + step * k3, z2, rate, coefficient)
        states[k + 1] = state + step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        if not np.isfinite(states[k + 1]).all():
            raise SimulationError(
                f"half car: motion not finite at {step * (k + 1):g} s with a step of {step:g} s; use a smaller step"
            )
    time = np.asarray(step * np.arange(steps + 1), dtype=np.float64)
    return [
        History(
            model=run.forms[i],
            time=time,
            state=states[:, i],
            inputs=passage.heights(time).T,
            input_rates=passage.rates(time).T,
            sliding_force=forces[:, i],
            state_rate=slopes[:, i],
        )
        for i, passage in enumerate(passages)
    ]


def _without_dampers(car: HalfCarRiderParameters) -> FirstOrder:
    """Return a car without suspension dampers; dampers and lift-off forces of the tyres are sliding pairs instead."""
    front, rear = (replace(axle, suspension_damping=0.0) for axle in (car.front, car.rear))
    system = half_car_rider(replace(car, front=front, rear=rear))
    pairs = [system.output(f"{end}_{point}")[0] for point in ("travel", "wheel") for end in ENDS]
    return first_order(replace(system, slide_rows=np.stack(pairs), slide_inputs=np.zeros((4, 2))))


class _Cars:
    """Equations of motion of all cars, with the leading axis (runs)."""

    def __init__(self, forms: list[FirstOrder], cars: Sequence[HalfCarRiderParameters], one_sided: bool) -> None:
        self.forms, self.one_sided = forms, one_sided
        self.state, self.road, self.road_rate, self.grip, self.slide = (
            np.stack([getattr(form, name) for form in forms])
            for name in ("state", "input", "input_rate", "friction", "slide")
        )
        self.body = np.stack([[form.output(f"{end}_body")[0] for end in ENDS] for form in forms])  # (r, w, n)
        self.wheel = [forms[0].system.coordinates.index(f"{end}_wheel") for end in ENDS]
        self.static = np.stack([static_tyre_load(car) for car in cars])  # (r, w), as the next two
        self.stiffness = np.array([[car.front.tyre_stiffness, car.rear.tyre_stiffness] for car in cars])
        self.damping = np.array([[car.front.tyre_damping, car.rear.tyre_damping] for car in cars])

    def velocities(self, state: Vector) -> tuple[Vector, Vector]:
        """Return the velocities of the body above each wheel and of the wheel, (r, w)."""
        free = self.body.shape[-1]
        return _times(self.body, state[:, free : 2 * free]), state[:, free:][:, self.wheel]

    def slope(self, state: Vector, road: Vector, rate: Vector, coefficient: Vector) -> tuple[Vector, Vector]:
        """Return the time derivatives of the states and the forces of dampers and tyres, for a batch of runs.

        Args:
            state: states of the half cars, shape (runs, states).
            road: road heights under the wheels [m], shape (runs, wheels).
            rate: time derivatives of the road heights [m/s], shape (runs, wheels).
            coefficient: coefficients c of the dampers [N s/m], shape (runs, wheels).

        Returns:
            Derivatives, shape (runs, states), and forces [N], shape (runs, 2 wheels): dampers, then the correction
            of tyres that have lifted off.
        """
        sliding = _times(self.slide, state)
        ends = len(ENDS)
        force = np.concatenate((coefficient * sliding[:, :ends], np.zeros_like(coefficient)), axis=1)
        if self.one_sided:  # subtract the pull of the linear tyre
            dynamic = self.stiffness * (road - state[:, self.wheel]) + self.damping * (rate - sliding[:, ends:])
            force[:, ends:] = np.minimum(0.0, self.static + dynamic)
        slope = _times(self.state, state) + _times(self.road, road) + _times(self.road_rate, rate)
        return slope - _times(self.grip, force), force


def _times(matrix: Vector, vector: Vector) -> Vector:
    """Return the matrix-vector product of every run."""
    return np.asarray((matrix @ vector[..., None])[..., 0])
