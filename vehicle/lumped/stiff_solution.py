"""Nonlinear lumped models by a stiff solver with the analytic Jacobian, free of events."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

from vehicle.errors import ConfigurationError, SimulationError
from vehicle.laws.law import ForceLaw, Parallel
from vehicle.linear.first_order import FirstOrder
from vehicle.lumped.drive import AtRest, Drive
from vehicle.lumped.history import Array, History

Method = Literal["LSODA", "Radau", "BDF"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Tolerances:
    """Accuracy asked of the solver: relative for every state, absolute by kind of state."""

    relative: float = 1e-6
    displacement: float = 1e-9
    """[m]: a millionth of a road of 1 mm."""
    velocity: float = 1e-8
    """[m/s]: a hundredth of the velocity 1/eps where a friction law of eps = 1e6 s/m bends."""
    force: float = 1e-5
    """[N] of a Maxwell branch."""

    def __post_init__(self) -> None:
        for name in ("relative", "displacement", "velocity", "force"):
            found = getattr(self, name)
            if not (math.isfinite(found) and found > 0.0):
                raise ConfigurationError(f"Tolerances.{name}: found {found!r}, must be finite and greater than 0.0")


def stiff_solution(
    model: FirstOrder,
    time: npt.ArrayLike,
    *,
    road: Drive | None = None,
    force: Drive | None = None,
    initial: npt.ArrayLike | None = None,
    method: Method = "LSODA",
    tolerances: Tolerances | None = None,
    longest_step: float = 5e-3,
) -> History:
    """Solve x' = A x + b0 w + b1 w' + bF F - N f(V x + d w') and sample it at the times asked for.

    The laws are smooth or at least continuous, so no event has to be located; the Jacobian A - N f'(v) V is exact.

    Args:
        model: a single model.
        time: increasing sample times [s], shape (T,), the first is the initial time.
        road: road displacement; at rest where not given.
        force: applied force; zero where not given.
        initial: state at the first time, shape (s,); zero where not given.
        method: LSODA (fast), Radau or BDF (both as independent checks).
        tolerances: accuracy asked for.
        longest_step: upper bound of the solver's step [s], so that it cannot step over a bump of the road.

    Returns:
        The history at the sample times, from the solver's dense output.

    Raises:
        ConfigurationError: a stack of models, bad times or a bad initial state.
        SimulationError: the solver gave up or its solution is not finite.
    """
    times = np.asarray(time, dtype=float)
    if times.ndim != 1 or times.size < 2 or not np.isfinite(times).all() or not (np.diff(times) > 0.0).all():
        raise ConfigurationError("time: needed are at least two finite, strictly increasing sample times [s]")
    if model.models:
        raise ConfigurationError(
            f"stiff_solution: found a stack of {model.models} models; solve one, or use marched_solution"
        )
    size = model.state.shape[-1]
    start = np.zeros(size) if initial is None else np.asarray(initial, dtype=float)
    if start.shape != (size,) or not np.isfinite(start).all():
        raise ConfigurationError(f"initial: needed are {size} finite numbers")
    road, force = road or AtRest(), force or AtRest()
    accuracy = tolerances or Tolerances()
    laws = pair_laws(model)
    right_hand_side, jacobian = _equations(model, laws, road, force)
    with warnings.catch_warnings():
        # LSODA warns beside its status; the status is what is reported.
        warnings.simplefilter("ignore", UserWarning)
        solution: Any = solve_ivp(
            right_hand_side,
            (times[0], times[-1]),
            start,
            method=method,
            t_eval=times,
            jac=jacobian,
            rtol=accuracy.relative,
            atol=_absolute(model, accuracy),
            max_step=longest_step,
        )
    if not solution.success or not np.isfinite(solution.y).all():
        raise SimulationError(
            f"{method}: stopped at t = {solution.t[-1] if solution.t.size else times[0]:g} s of {times[-1]:g} s: "
            f"{solution.message} Loosen the tolerances or lower the steepness of the friction law."
        )
    states = solution.y.T
    driven = np.array([(*road.at(t), force.at(t)[0]) for t in times.tolist()])
    velocities = states @ model.slide.T + driven[:, 1:2] * model.slide_rate[:, 0]
    forces = np.stack([law.force(velocities[:, i]) for i, law in enumerate(laws)], axis=-1) if laws else velocities
    return History(
        model=model,
        time=times,
        state=states,
        sliding_force=forces,
        road=driven[:, 0],
        road_rate=driven[:, 1],
        force=driven[:, 2],
        evaluations=int(solution.nfev),
        method=(
            f"{method}, relative {accuracy.relative:g}, "
            f"absolute {accuracy.displacement:g} m and {accuracy.velocity:g} m/s"
        ),
    )


def pair_laws(model: FirstOrder) -> list[ForceLaw]:
    """The whole law of each sliding pair: friction, and its viscous part where there is one."""
    return [
        pair.friction if pair.viscous is None else Parallel(laws=(pair.friction, pair.viscous))
        for pair in model.system.slides
    ]


def _equations(model: FirstOrder, laws: list[ForceLaw], road: Drive, force: Drive) -> tuple[Any, Any]:
    """Right-hand side and Jacobian, with everything constant taken out of the inner loop."""
    a, b0, b1, bf = model.state, model.input[:, 0], model.input_rate[:, 0], model.load
    n, v, d = model.friction, model.slide, model.slide_rate[:, 0]
    driven_by_rate, driven_by_force = bool(b1.any()), bool(bf.any())

    def right_hand_side(t: float, x: Array) -> Array:
        w, rate = road.at(t)
        result = a @ x + b0 * w
        if driven_by_rate:
            result += b1 * rate
        if driven_by_force:
            result += bf * force.at(t)[0]
        for i, law in enumerate(laws):
            result -= n[:, i] * law.force(v[i] @ x + d[i] * rate)
        return np.asarray(result)

    def jacobian(t: float, x: Array) -> Array:
        _, rate = road.at(t)
        result = a.copy()
        for i, law in enumerate(laws):
            result -= np.outer(n[:, i] * law.slope(v[i] @ x + d[i] * rate), v[i])
        return result

    return right_hand_side, jacobian


def _absolute(model: FirstOrder, accuracy: Tolerances) -> Array:
    """Absolute tolerance of each state by its kind."""
    n = model.system.size
    rest = model.state.shape[-1] - 2 * n
    return np.array([accuracy.displacement] * n + [accuracy.velocity] * n + [accuracy.force] * rest)
