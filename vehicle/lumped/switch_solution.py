"""Lumped models with set-valued friction by the switch model: stick band, mixed vector fields, exponential return."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.integrate import LSODA, solve_ivp

from vehicle.errors import ConfigurationError, SimulationError
from vehicle.laws.switch import Switch
from vehicle.linear.first_order import FirstOrder
from vehicle.lumped.drive import AtRest, Drive
from vehicle.lumped.history import Array, History

MOST_STEPS = 200_000
"""Half a minute of solving; the published half second of the mass on a damper takes 700 steps."""


class _LimitedLSODA(LSODA):  # type: ignore[misc]
    """LSODA that gives up after a number of steps."""

    def __init__(self, *arguments: Any, most_steps: int, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.most_steps = most_steps
        self.taken = 0

    def step(self) -> str | None:
        """Advance by one step.

        Raises:
            SimulationError: all steps are taken.
        """
        if self.taken >= self.most_steps:
            raise SimulationError(
                f"switch model: stopped at t = {self.t:g} s of {self.t_bound:g} s after most_steps = "
                f"{self.most_steps} steps; widen the stick band, lengthen the return time, or allow more steps"
            )
        self.taken += 1
        message: str | None = super().step()
        return message


def switch_solution(
    model: FirstOrder,
    law: Switch,
    time: npt.ArrayLike,
    *,
    road: Drive | None = None,
    force: Drive | None = None,
    initial: npt.ArrayLike | None = None,
    relative: float = 1e-6,
    longest_step: float = 1e-3,
    most_steps: int = MOST_STEPS,
) -> History:
    """Solve x' = alpha f+ + (1 - alpha) f- with the mixing alpha of the switch model.

    f+ and f- are the vector fields with the friction +Fd and -Fd; the friction law of the model itself is replaced by
    the switch law. Inside the stick band the velocity returns to zero with the time constant tau.

    Args:
        model: a single model with one sliding pair that does not touch the road.
        law: Coulomb limit, stick band and return time.
        time: increasing sample times [s], shape (T,).
        road: road displacement; at rest where not given.
        force: applied force; zero where not given.
        initial: state at the first time, shape (s,); zero where not given.
        relative: relative tolerance of the solver; the absolute one of velocities is a hundredth of the band.
        longest_step: upper bound of the solver's step [s].
        most_steps: number of steps after which the run is given up; a law that chatters would take for ever.

    Returns:
        The history at the sample times.

    Raises:
        ConfigurationError: a stack of models, no or several sliding pairs, or one that touches the road; no steps.
        SimulationError: the solver gave up, or took too many steps.

    Source: Bommer 2006, appendix A (Leine and Nijmeijer).
    """
    if model.models or model.slide.shape[-2] != 1 or model.slide_rate.any():
        raise ConfigurationError("switch_solution: needed is a single model with one sliding pair off the road")
    if most_steps < 1:
        raise ConfigurationError(f"most_steps: found {most_steps!r}, must be at least 1")
    times = np.asarray(time, dtype=float)
    size, n = model.state.shape[-1], model.system.size
    start = np.zeros(size) if initial is None else np.asarray(initial, dtype=float)
    road, force = road or AtRest(), force or AtRest()
    row, effect, limit = model.slide[0], model.friction[:, 0], float(law.limit)

    def fields(t: float, x: Array) -> tuple[Array, float, Array]:
        """Vector field without friction, sliding velocity and mixing."""
        w, rate = road.at(t)
        bare = model.state @ x + model.input[:, 0] * w + model.input_rate[:, 0] * rate + model.load * force.at(t)[0]
        held, brake = float(row @ bare), float(row @ effect) * limit
        velocity = float(row @ x)
        return bare, velocity, law.mixing(velocity, held - brake, held + brake)

    def right_hand_side(t: float, x: Array) -> Array:
        bare, _, alpha = fields(t, x)
        return bare - effect * ((2.0 * alpha - 1.0) * limit)

    absolute = np.full(size, 1e-2 * float(law.band))
    # Positions move by velocity times time: a thousandth of the band's velocity over a millisecond.
    absolute[:n] = 1e-6 * float(law.band)
    with warnings.catch_warnings():
        # LSODA warns beside its status; the status is what is reported.
        warnings.simplefilter("ignore", UserWarning)
        solution: Any = solve_ivp(
            right_hand_side,
            (times[0], times[-1]),
            start,
            method=_LimitedLSODA,
            most_steps=most_steps,
            t_eval=times,
            rtol=relative,
            atol=absolute,
            max_step=longest_step,
        )
    if not solution.success or not np.isfinite(solution.y).all():
        raise SimulationError(f"switch model: {solution.message} Widen the stick band or lengthen the return time.")
    states = solution.y.T
    friction = [(2.0 * float(fields(t, x)[2]) - 1.0) * limit for t, x in zip(times.tolist(), states, strict=True)]
    driven = np.array([(*road.at(t), force.at(t)[0]) for t in times.tolist()])
    return History(
        model=model,
        time=times,
        state=states,
        sliding_force=np.array(friction)[:, None],
        road=driven[:, 0],
        road_rate=driven[:, 1],
        force=driven[:, 2],
        evaluations=int(solution.nfev),
        method=f"switch model, LSODA, relative {relative:g}, band {float(law.band):g} m/s",
    )
