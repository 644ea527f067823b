"""Smallest change of parameters with which all limits are met, or the limits that exclude each other.

With u_i = ln(x_i / x_i0) of each parameter and the relative excess e_j(u) of each figure over its limit:

    minimise sum (c_i u_i)^2   so that   e_j(u) <= 0,  bounds on u

The costs c_i weigh the parameters. A quadratic surface of each e_j over a sample of cars gives starts; sequential
quadratic programming on real runs, with differences of `DIFFERENCE`, refines them. If no car is inside all
limits, the largest excess is minimised the same way: its active figures exclude each other.

Source: Nocedal and Wright, Numerical Optimization, 2nd ed., chapter 18 (SLSQP of Kraft in SciPy).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from vehicle.arrays import Vector

Excesses = Callable[[Vector], Vector]
"""Function of positions u (n, p) that returns relative excesses (n, figures); NaN of a failed run."""

DIFFERENCE = 0.01
"""Step of the differences of u: 1 % of a parameter."""

MARGIN = 2e-4
"""Relative distance from the limits that the search keeps, so that rounding does not miss them."""

ACTIVE = 2e-3
"""Relative distance from the largest excess within which a figure is active; from a bound, a parameter."""

SAMPLE = 64
"""Default number of cars for the quadratic surfaces."""

SAMPLE_SHARE = 0.4
"""Share of the computing time that they take: 2 parameters need about as many steps as the sample has vectors."""

STARTS = 32
"""Random starts on the quadratic surfaces; they cost no runs."""

STEPS = 15
"""Maximum number of steps of a search on real runs."""

LARGEST = 1e3
"""Largest relative excess of a failed run or of an infinite value."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SmallestChange:
    """Result of the search."""

    position: Vector  # u of the car, (p,)
    excess: Vector  # relative excess of each figure at it, (figures,); at most 0 if all limits are met
    feasible: bool  # True if all limits are met
    cost: float  # root of the sum of (c u)^2
    active: tuple[int, ...]  # figures at their limit, or, for an infeasible problem, those that exclude each other
    at_bounds: tuple[int, ...]  # parameters at a bound
    runs: int  # number of cars that were run


class _Cars:
    """Cars that were run, with their excesses; each is run once."""

    def __init__(self, excesses: Excesses) -> None:
        self._excesses = excesses
        self._values: dict[bytes, Vector] = {}

    @property
    def runs(self) -> int:
        return len(self._values)

    def at(self, positions: Vector) -> Vector:
        """Return the excesses at positions (n, p), finite; (n, figures)."""
        keys = [position.tobytes() for position in positions]
        new = [index for index, key in enumerate(keys) if key not in self._values]
        if new:
            computed = np.clip(np.nan_to_num(self._excesses(positions[new]), nan=LARGEST), -LARGEST, LARGEST)
            self._values |= {keys[index]: values for index, values in zip(new, computed, strict=True)}
        return np.stack([self._values[key] for key in keys])

    def inside(self) -> list[Vector]:
        """Return the positions of the cars inside all limits."""
        return [np.frombuffer(key) for key, values in self._values.items() if np.all(values <= 0.0)]

    def with_slopes(self, position: Vector, low: Vector, high: Vector) -> tuple[Vector, Vector]:
        """Return the excesses at a position and their slopes, (figures,) and (figures, p), run together."""
        steps = np.where(position + DIFFERENCE <= high, DIFFERENCE, -DIFFERENCE)
        values = self.at(np.vstack([position, position + np.diag(steps)]))
        return values[0], (values[1:] - values[0]).T / steps


def smallest_change(
    excesses: Excesses, low: Vector, high: Vector, costs: Vector, *, progress: Callable[[float], None] | None = None
) -> SmallestChange:
    """Return the smallest change for which all limits are met.

    Args:
        excesses: see `Excesses`.
        low, high: bounds of u, (p,); they contain 0, the present car.
        costs: cost c of each parameter, (p,).
        progress: called with the finished fraction.
    """
    cars, done = _Cars(excesses), progress or (lambda share: None)
    present = np.zeros(low.size)
    if np.all(cars.at(present[None])[0] <= 0.0):
        return _result(cars, present, low, high, costs)
    positions = low + (high - low) * scipy.stats.qmc.Sobol(low.size, rng=1).random(SAMPLE)
    values = cars.at(np.vstack([present, positions]))
    done(SAMPLE_SHARE)
    surfaces = _Surfaces(np.vstack([present, positions]), values)
    starts = [present, *_predicted(surfaces, low, high, costs)]
    tried = np.vstack([present, positions, *(start[None] for start in starts)])
    nearest = tried[np.argmin(np.max(cars.at(tried), axis=1))]
    if cars.at(nearest[None])[0].max() > 0.0:
        position = _least_excess(lambda u: cars.with_slopes(u, low, high), nearest, low, high)
        if cars.at(position[None])[0].max() > 0.0:
            done(1.0)
            return _result(cars, position, low, high, costs)
        starts = [position, *starts[1:]]
    met = []
    for number, start in enumerate(starts):
        position = _least_cost(lambda u: cars.with_slopes(u, low, high), start, low, high, costs)
        if np.all(cars.at(position[None])[0] <= 0.0):
            met.append(position)
        done(SAMPLE_SHARE + 0.5 * (number + 1) / len(starts))
    # A search may end outside the limits; the cars that it met inside them count too.
    met += list(cars.inside())
    best = min(met, key=lambda position: float(np.sum((costs * position) ** 2)))
    done(1.0)
    return _result(cars, best, low, high, costs)


def _result(cars: _Cars, position: Vector, low: Vector, high: Vector, costs: Vector) -> SmallestChange:
    """Return the result at a position."""
    excess = cars.at(position[None])[0]
    feasible = bool(np.all(excess <= 0.0))
    level = 0.0 if feasible else float(excess.max())
    edge = ACTIVE * (high - low)
    return SmallestChange(
        position=position,
        excess=excess,
        feasible=feasible,
        cost=float(np.sqrt(np.sum((costs * position) ** 2))),
        active=tuple(np.flatnonzero(excess >= level - ACTIVE).tolist()),
        at_bounds=tuple(np.flatnonzero((position <= low + edge) | (position >= high - edge)).tolist()),
        runs=cars.runs,
    )


class _Surfaces:
    """Quadratic surface of each excess, fitted to the cars of a sample."""

    def __init__(self, positions: Vector, values: Vector) -> None:
        self._scale = np.max(np.abs(positions), axis=0)
        self._pairs = np.triu_indices(positions.shape[1])
        good = np.all(np.abs(values) < LARGEST, axis=1)
        self._coefficients = np.linalg.lstsq(self._terms(positions[good]), values[good], rcond=None)[0]

    def _terms(self, positions: Vector) -> Vector:
        scaled = positions / self._scale
        first, second = self._pairs
        return np.hstack([np.ones((len(scaled), 1)), scaled, scaled[:, first] * scaled[:, second]])

    def with_slopes(self, position: Vector) -> tuple[Vector, Vector]:
        """Return the excesses and their slopes at a position."""
        steps = 1e-6 * self._scale
        points = np.vstack([position, position + np.diag(steps), position - np.diag(steps)])
        values, count = self._terms(points) @ self._coefficients, position.size
        return values[0], ((values[1 : count + 1] - values[count + 1 :]) / (2.0 * steps[:, None])).T


WithSlopes = Callable[[Vector], tuple[Vector, Vector]]
"""Function of a position that returns the excesses and their slopes."""


def _predicted(surfaces: _Surfaces, low: Vector, high: Vector, costs: Vector) -> list[Vector]:
    """Return up to two different starts: the best cars on the surfaces from many places."""
    generator, candidates = np.random.default_rng(1), []
    for _ in range(STARTS):
        start = low + (high - low) * generator.random(low.size)
        position = _least_cost(surfaces.with_slopes, start, low, high, costs)
        excess = max(float(surfaces.with_slopes(position)[0].max()), 0.0)
        candidates.append((excess if excess > 10.0 * MARGIN else 0.0, float(np.sum((costs * position) ** 2)), position))
    candidates.sort(key=lambda each: each[:2])
    starts = [candidates[0][2]]
    for _, _, position in candidates[1:]:
        if np.max(np.abs(position - starts[0]) / (high - low)) > 0.1:
            return [*starts, position]
    return starts


def _least_cost(with_slopes: WithSlopes, start: Vector, low: Vector, high: Vector, costs: Vector) -> Vector:
    """Return the position of least cost with all excesses at most -`MARGIN`, near a start."""
    solution = scipy.optimize.minimize(
        lambda u: float(np.sum((costs * u) ** 2)),
        start,
        jac=lambda u: 2.0 * costs**2 * u,
        bounds=scipy.optimize.Bounds(low, high),
        constraints={"type": "ineq", "fun": lambda u: -MARGIN - with_slopes(u)[0], "jac": lambda u: -with_slopes(u)[1]},
        method="SLSQP",
        options={"maxiter": STEPS, "ftol": 1e-6},
    )
    return np.asarray(np.clip(solution.x, low, high))


def _least_excess(with_slopes: WithSlopes, start: Vector, low: Vector, high: Vector) -> Vector:
    """Return the position with the smallest largest excess, near a start."""
    first = np.append(start, float(with_slopes(start)[0].max()))
    solution = scipy.optimize.minimize(
        lambda y: float(y[-1]),
        first,
        jac=lambda y: np.append(np.zeros(start.size), 1.0),
        bounds=scipy.optimize.Bounds(np.append(low, -np.inf), np.append(high, np.inf)),
        constraints={
            "type": "ineq",
            "fun": lambda y: y[-1] - with_slopes(y[:-1])[0],
            "jac": lambda y: np.hstack([-with_slopes(y[:-1])[1], np.ones((with_slopes(y[:-1])[0].size, 1))]),
        },
        method="SLSQP",
        options={"maxiter": STEPS, "ftol": 1e-5},
    )
    return np.asarray(np.clip(solution.x[:-1], low, high))
