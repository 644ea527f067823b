"""Damper coefficients of least tyre-load fluctuation: one damper, front and rear in turn, and both at once."""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize, minimize_scalar

from scenarios.lumped.half_car_rider_model import ENDS
from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, SimulationError

Fluctuation = Callable[[float, float], Vector]
"""(front damping, rear damping) [N s/m] -> measure of the front and the rear tyre [-], shape (2,)."""

SEARCHED = (500.0, 12000.0)
"""Damper coefficients searched [N s/m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Optimum:
    """Least value of a measure over one damper coefficient."""

    damping: float  # [N s/m]
    value: float  # The measure there [-]


@dataclass(frozen=True, kw_only=True, slots=True)
class Step:
    """One step of the front/rear iteration."""

    changed: str  # "front" or "rear": end of the optimised damper, whose tyre load is minimised
    front: float  # Front damper coefficient after the step [N s/m]
    rear: float  # Rear damper coefficient after the step [N s/m]
    fluctuation: tuple[float, float]  # Measure of the front and the rear tyre after the step [-]

    @property
    def damping(self) -> float:
        """Return the coefficient of the optimised damper [N s/m]."""
        return self.front if self.changed == "front" else self.rear


def optimum(measure: Callable[[float], float], grid: npt.ArrayLike | None = None) -> Optimum:
    """Find the damping coefficient of minimum load fluctuation.

    Args:
        measure: function of the damping [N s/m] that returns the fluctuation [-].
        grid: allowed coefficients [N s/m]; None to search the whole range, to 1 N s/m.

    Returns:
        The optimum. The continuous search starts at the minimum of a coarse grid: the printed measure, a sum of
        magnitudes, may have several minima.
    """
    coarse = np.linspace(*SEARCHED, 47) if grid is None else np.asarray(grid, dtype=float)
    values = np.array([measure(float(c)) for c in coarse])
    best = int(values.argmin())
    if grid is not None:
        return Optimum(damping=float(coarse[best]), value=float(values[best]))
    inside = (float(coarse[max(best - 1, 0)]), float(coarse[min(best + 1, coarse.size - 1)]))
    minimum = minimize_scalar(measure, bounds=inside, method="bounded", options={"xatol": 1.0})
    return Optimum(damping=float(minimum.x), value=float(minimum.fun))


def iterate(measure: Fluctuation, *, rear: float, grid: npt.ArrayLike | None = None, limit: int = 20) -> list[Step]:
    """Optimise front and rear damper alternately, each for the tyre at its end, until both are constant.

    Args:
        measure: fluctuation of both tyres.
        rear: start value of the rear coefficient [N s/m].
        grid: allowed coefficients [N s/m]; None for the whole range with a tolerance of 5 N s/m.
        limit: maximum number of steps.

    Returns:
        The steps, front first; the last step repeats the damper of two steps before.

    Raises:
        SimulationError: no convergence within the limit.

    Source: "Dynamic Modeling of Vehicles and Damper" (2014), section 4.2, figures 11 to 13.
    """
    if not rear > 0.0:
        raise ConfigurationError(f"iteration: rear: found {rear!r} N s/m, must be greater than 0.0")
    steps: list[Step] = []
    damping, tolerance = [math.nan, rear], 0.0 if grid is not None else 5.0
    for end in itertools.islice(itertools.cycle((0, 1)), limit):
        old, other = damping[end], damping[1 - end]

        def own(c: float, end: int = end, other: float = other) -> float:
            return float(measure(c, other)[0] if end == 0 else measure(other, c)[1])

        damping[end] = optimum(own, grid).damping
        front, back = (float(value) for value in measure(*damping))
        steps.append(Step(changed=ENDS[end], front=damping[0], rear=damping[1], fluctuation=(front, back)))
        if abs(damping[end] - old) <= tolerance:
            return steps
    raise SimulationError(f"front/rear iteration: still changing after {limit} steps; give a coarser grid")


def joint_optimum(measure: Fluctuation, *, start: tuple[float, float]) -> tuple[float, float, Vector]:
    """Return the front and rear coefficient of the minimum sum of both measures.

    Args:
        measure: fluctuation of both tyres.
        start: front and rear coefficient to start with [N s/m].

    Returns:
        Front coefficient, rear coefficient [N s/m], measures there, shape (2,).

    Raises:
        SimulationError: the search did not converge.
    """
    minimum = minimize(
        lambda pair: float(measure(float(pair[0]), float(pair[1])).sum()),
        np.array(start),
        method="Nelder-Mead",  # the printed measure has kinks where a band passes |H| = 1
        bounds=[SEARCHED, SEARCHED],
        options={"xatol": 1.0, "fatol": 1e-7},
    )
    if not minimum.success:
        raise SimulationError(f"joint optimum of the dampers: {minimum.message}")
    front, rear = (float(value) for value in minimum.x)
    return front, rear, measure(front, rear)
