"""Adaptive solvers for lumped models with friction: smooth laws (stiff, analytic Jacobian) and the switch model."""

import itertools
import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import scipy

from scenarios.lumped.history import History
from scenarios.lumped.input_signals import InputSignal, ZeroSignal
from scenarios.lumped.switch import Switch
from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.errors import ConfigurationError, SimulationError
from vehicle.model.laws.law import ForceLaw, Parallel

MAX_EVALUATIONS = 200_000
"""Maximum number of evaluations of the switch model: half a minute; the published half second takes 1200."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Tolerances:
    """Tolerances of the solver: relative for every state, absolute by type of state."""

    relative: float = 1e-6
    displacement: float = 1e-9  # Absolute tolerance of displacements [m]: a millionth of a road of 1 mm
    velocity: float = 1e-8
    """Absolute tolerance of velocities [m/s]: a hundredth of 1/eps, the knee of a friction law with eps = 1e6 s/m."""
    force: float = 1e-5  # Absolute tolerance of the forces of Maxwell branches [N]

    def __post_init__(self) -> None:
        for name in ("relative", "displacement", "velocity", "force"):
            tolerance = getattr(self, name)
            if not (math.isfinite(tolerance) and tolerance > 0.0):
                raise ConfigurationError(f"Tolerances.{name}: found {tolerance!r}, must be finite and greater than 0.0")

    def absolute(self, model: FirstOrder) -> Vector:
        """Return the absolute tolerance of each state by its type, (s,)."""
        free = model.basis.shape[1]
        branches = model.state.shape[-1] - 2 * free
        return np.repeat([self.displacement, self.velocity, self.force], [free, free, branches])


class Driven:
    """Single model with its input signals, x' = A x + b0 z + b1 z' + bF F - N phi, for all adaptive solvers.

    Raises:
        ConfigurationError: a stack of models, different numbers of roads and inputs, invalid times or initial state.
    """

    def __init__(
        self,
        model: FirstOrder,
        time: npt.ArrayLike,
        *,
        road: InputSignal | tuple[InputSignal, ...] | None,
        force: InputSignal | None,
        initial: npt.ArrayLike | None,
    ) -> None:
        if model.models:
            raise ConfigurationError(
                f"stiff_solution: found a stack of {model.models} models; solve one model, or use fixed_step_solution"
            )
        self.model, self.force = model, force or ZeroSignal()
        roads = (ZeroSignal(),) * model.input.shape[-1] if road is None else road
        self.roads: tuple[InputSignal, ...] = roads if isinstance(roads, tuple) else (roads,)
        if len(self.roads) != model.input.shape[-1]:
            raise ConfigurationError(f"road: found {len(self.roads)} signals for {model.input.shape[-1]} inputs")
        self.time = np.asarray(time, dtype=float)
        if self.time.ndim != 1 or len(self.time) < 2 or not (np.diff(self.time) > 0.0).all() or np.isinf(time).any():
            raise ConfigurationError("time: must be at least two finite, strictly increasing sample times [s]")
        size = model.state.shape[-1]
        self.initial = np.zeros(size) if initial is None else np.asarray(initial, dtype=float)
        if self.initial.shape != (size,) or not np.isfinite(self.initial).all():
            raise ConfigurationError(f"initial: must be {size} finite numbers")
        # Constants are computed outside the inner loop.
        matrices = (np.ascontiguousarray(matrix.T) for matrix in (model.input, model.input_rate, model.slide_rate))
        self._effects = list(zip(*matrices, strict=True))
        self._by_rate, self._by_force = bool(model.input_rate.any()), bool(model.load.any())
        self._by_slip = bool(model.slide_rate.any())

    def bare(self, t: float, x: Vector) -> tuple[Vector, Vector]:
        """Return the rate of the state without sliding forces, and the contribution d z' to the sliding velocities."""
        rate, slip = self.model.state @ x, np.zeros(len(self.model.slide))
        for road, (by_height, by_rate, slide_rate) in zip(self.roads, self._effects, strict=True):
            z, dz = road.at(t)
            rate += by_height * z
            if self._by_rate:
                rate += by_rate * dz
            if self._by_slip:
                slip += slide_rate * dz
        if self._by_force:
            rate += self.model.load * self.force.at(t)[0]
        return rate, slip

    def solved(
        self, slope: Callable[[float, Vector], Vector], sliding: Callable[[float, Vector], Vector], **options: Any
    ) -> History:
        """Integrate from the first to the last sample time.

        Args:
            slope: function of time and state that returns x'.
            sliding: function of time and state that returns the forces of the sliding pairs, (p,).
            **options: options of `scipy.integrate.solve_ivp`.

        Raises:
            SimulationError: the solver failed or its solution is not finite.
        """
        with warnings.catch_warnings():
            # LSODA warns in addition to its status; the error message uses the status.
            warnings.simplefilter("ignore", UserWarning)
            solution: Any = scipy.integrate.solve_ivp(
                slope, (self.time[0], self.time[-1]), self.initial, t_eval=self.time, **options
            )
        if not solution.success or not np.isfinite(solution.y).all():
            raise SimulationError(
                f"stopped at t = {solution.t[-1] if solution.t.size else self.time[0]:g} s of {self.time[-1]:g} s: "
                f"{solution.message} Loosen the tolerances, lower the steepness of the friction law, or widen the "
                "stick band and lengthen the return time of the switch model."
            )
        states, times = solution.y.T, self.time.tolist()
        road_values = np.array([[road.at(t) for road in self.roads] for t in times])
        return History(
            model=self.model,
            time=self.time,
            state=states,
            inputs=road_values[..., 0],
            input_rates=road_values[..., 1],
            sliding_force=np.array([sliding(t, x) for t, x in zip(times, states, strict=True)]),
            force=np.array([self.force.at(t)[0] for t in times]),
        )


def stiff_solution(
    model: FirstOrder,
    time: npt.ArrayLike,
    *,
    road: InputSignal | tuple[InputSignal, ...] | None = None,
    force: InputSignal | None = None,
    initial: npt.ArrayLike | None = None,
    method: Literal["LSODA", "Radau", "BDF"] = "LSODA",
    tolerances: Tolerances | None = None,
    longest_step: float = 5e-3,
) -> History:
    """Solve x' = A x + b0 z + b1 z' + bF F - N f(V x + d z') and sample the solution.

    The laws are smooth or at least continuous, so events need not be located; the Jacobian A - N f'(v) V is exact.

    Args:
        model: a single model with any number of inputs and sliding pairs.
        time: increasing sample times [s], shape (T,), the first is the initial time.
        road: displacement signal of the input, or of each input; zero by default.
        force: signal of the applied force; zero by default.
        initial: state at the first time, shape (s,); zero by default.
        method: LSODA (fast), Radau or BDF (both as independent checks).
        tolerances: tolerances of the solver.
        longest_step: maximum step of the solver [s], so that it cannot step over a bump of the road.

    Returns:
        The history at the sample times, from the solver's dense output.

    Raises:
        ConfigurationError: a stack of models, invalid times or initial state, or too few roads.
        SimulationError: the solver failed or its solution is not finite.
    """
    case = Driven(model, time, road=road, force=force, initial=initial)
    laws: list[ForceLaw] = [
        pair.friction if pair.viscous is None else Parallel(laws=(pair.friction, pair.viscous))
        for pair in model.system.slides
    ]
    grip, rows = model.friction, model.slide

    def slope(t: float, x: Vector) -> Vector:
        rate, slip = case.bare(t, x)
        for i, law in enumerate(laws):
            rate -= grip[:, i] * law.force(rows[i] @ x + slip[i])
        return rate

    def jacobian(t: float, x: Vector) -> Vector:
        _, slip = case.bare(t, x)
        result = model.state.copy()
        for i, law in enumerate(laws):
            result -= np.outer(grip[:, i] * law.slope(rows[i] @ x + slip[i]), rows[i])
        return result

    def sliding(t: float, x: Vector) -> Vector:
        _, slip = case.bare(t, x)
        return np.array([law.force(rows[i] @ x + slip[i]) for i, law in enumerate(laws)])

    accuracy = tolerances or Tolerances()
    options = {"rtol": accuracy.relative, "atol": accuracy.absolute(model), "max_step": longest_step}
    return case.solved(slope, sliding, method=method, jac=jacobian, **options)


def switch_solution(
    model: FirstOrder,
    law: Switch,
    time: npt.ArrayLike,
    *,
    force: InputSignal | None = None,
    max_evaluations: int = MAX_EVALUATIONS,
) -> History:
    """Solve x' = alpha f+ + (1 - alpha) f- with the mixing factor alpha of the switch model.

    f+ and f- are the vector fields with the friction +Fd and -Fd; the switch law replaces the friction law of the
    model. Inside the stick band the velocity returns to zero with the time constant tau.

    Args:
        model: a single model with one sliding pair that does not depend on the road velocity.
        law: Coulomb limit, stick band and return time.
        time, force: see `stiff_solution`.
        max_evaluations: maximum number of evaluations of the equations; a chattering law would need too many.

    Returns:
        The history at the sample times.

    Raises:
        ConfigurationError: a stack of models, no or several sliding pairs, or a pair that depends on the road velocity.
        SimulationError: the solver failed, or needed too many evaluations.

    Source: Bommer 2006, appendix A (Leine and Nijmeijer).
    """
    if model.models or model.slide.shape[-2] != 1 or model.slide_rate.any():
        raise ConfigurationError(
            "switch_solution: the model must be a single model with one sliding pair that is independent of the road"
        )
    if max_evaluations < 1:
        raise ConfigurationError(f"max_evaluations: found {max_evaluations!r}, must be at least 1")
    case = Driven(model, time, road=None, force=force, initial=None)
    row, effect, limit, band = model.slide[0], model.friction[:, 0], float(law.limit), float(law.band)

    def friction(t: float, x: Vector) -> tuple[Vector, float]:
        """Return the rate of the state without friction, and the friction force [N]."""
        bare, _ = case.bare(t, x)
        held, brake = float(row @ bare), float(row @ effect) * limit
        return bare, (2.0 * float(law.mixing(float(row @ x), held - brake, held + brake)) - 1.0) * limit

    remaining = itertools.count(max_evaluations, -1)

    def slope(t: float, x: Vector) -> Vector:
        if next(remaining) <= 0:
            raise SimulationError(
                f"switch model: stopped at t = {t:g} s of {case.time[-1]:g} s after max_evaluations = "
                f"{max_evaluations}; widen the stick band, lengthen the return time, or allow more"
            )
        bare, held = friction(t, x)
        return bare - effect * held

    # Tolerance of displacements: a thousandth of the velocity of the band over a millisecond.
    absolute = Tolerances(displacement=1e-6 * band, velocity=1e-2 * band, force=1e-2 * band).absolute(model)
    options = {"rtol": 1e-6, "atol": absolute, "max_step": 1e-3}
    return case.solved(slope, lambda t, x: np.array([friction(t, x)[1]]), method="LSODA", **options)
