"""Passage of the wheels over a half-sine bump, and the exact response of a linear model to the bump.

While wheel i is on the bump its road height obeys z_i'' = -omega^2 z_i. Coordinates, velocities and road heights
together are therefore an autonomous linear system s' = A s between the four instants at which a wheel enters or
leaves the bump; there only (z_i, z_i') jumps, while x and x' are continuous. s(t) = expm(A (t - t_k)) s(t_k) has
no time-step error.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from scenarios.lumped.half_car_rider_parameters import BumpShape
from scenarios.lumped.history import History
from vehicle.arrays import Mask, Vector
from vehicle.engines.linear.first_order import FirstOrder, first_order
from vehicle.engines.linear.system import LinearSystem
from vehicle.errors import ConfigurationError


@dataclass(frozen=True, kw_only=True, slots=True)
class BumpPassage:
    """Road height z_i = h0 sin(omega (t - t_i)) while wheel i is on the bump, otherwise 0."""

    height: float  # h0 [m]
    omega: float  # Angular frequency pi v / wb [rad/s]
    arrivals: tuple[float, ...]  # Time t_i at which each wheel reaches the bump [s]
    halves: int = 1  # Number of half waves: 1 for a bump, more for a sine road of finite length

    @property
    def contact(self) -> float:
        """Return the time n wb / v of a wheel on n half waves [s]."""
        return self.halves * math.pi / self.omega

    def heights(self, time: npt.ArrayLike) -> Vector:
        """Return the road height under each wheel [m], shape (wheels, *time.shape)."""
        return np.stack(
            [self.height * np.sin(self.omega * elapsed) * on_bump for elapsed, on_bump in self._phases(time)]
        )

    def rates(self, time: npt.ArrayLike) -> Vector:
        """Return the rate of the road height under each wheel [m/s], shape (wheels, *time.shape)."""
        peak_rate = self.height * self.omega
        return np.stack([peak_rate * np.cos(self.omega * elapsed) * on_bump for elapsed, on_bump in self._phases(time)])

    def _phases(self, time: npt.ArrayLike) -> list[tuple[Vector, Mask]]:
        instants = np.asarray(time, dtype=float)
        elapsed = [instants - arrival for arrival in self.arrivals]
        return [(phase, (phase >= 0.0) & (phase < self.contact)) for phase in elapsed]


def bump_passage(
    shape: BumpShape, speed: float, wheelbase: float, start: float = 0.0, *, halves: int = 1
) -> BumpPassage:
    """Return the passage of a two-axle car over a bump at constant speed; the rear wheel arrives (a1 + a2) / v later.

    Args:
        shape: height and length of the bump.
        speed: v [m/s].
        wheelbase: a1 + a2 [m].
        start: time t0 at which the front wheel reaches the bump [s].
        halves: number of half waves in a row, alternately up and down.

    Returns:
        The passage, front wheel first.

    Raises:
        ConfigurationError: speed or wheelbase is not a positive finite number, or start is negative.

    Source: "Parametric study of rider's comfort ...", equation 20.
    """
    for name, value, unit in (("speed", speed, "m/s"), ("wheelbase", wheelbase, "m")):
        if not (math.isfinite(value) and value > 0.0):
            raise ConfigurationError(f"bump passage: {name}: found {value!r} {unit}, must be greater than 0.0")
    if not (math.isfinite(start) and start >= 0.0):
        raise ConfigurationError(f"bump passage: start: found {start!r} s, must be at least 0.0")
    omega = math.pi * speed / shape.length
    return BumpPassage(height=shape.height, omega=omega, arrivals=(start, start + wheelbase / speed), halves=halves)


def bump_response(model: LinearSystem, passage: BumpPassage, *, time_step: float, duration: float) -> History:
    """Compute the response of a model at rest to a bump, exact at every sample.

    Args:
        model: linear model with one road for each arrival of the passage.
        passage: the bump under each wheel.
        time_step: sample interval of the response [s]; no influence on its accuracy.
        duration: duration of the response [s].

    Returns:
        The motion from t = 0 to the duration. At an arrival, the acceleration is the value just after it.

    Raises:
        ConfigurationError: time step or duration not positive, or roads and arrivals differ in number.
    """
    if not (math.isfinite(time_step) and time_step > 0.0):
        raise ConfigurationError(f"bump response: time_step: found {time_step!r} s, must be greater than 0.0")
    if not (math.isfinite(duration) and duration >= time_step):
        raise ConfigurationError(f"bump response: duration: found {duration!r} s, must be at least one time step")
    if len(passage.arrivals) != len(model.inputs):
        raise ConfigurationError(
            f"bump response: found {len(passage.arrivals)} arrivals for {len(model.inputs)} roads, must be equal"
        )
    form, w = first_order(model), len(model.inputs)
    size = form.state.shape[-1]
    system = _autonomous(form, passage.omega)
    time = np.asarray(time_step * np.arange(round(duration / time_step) + 1), dtype=np.float64)
    states = np.zeros((system.shape[0], time.size))
    powers = [scipy.linalg.expm(system * time_step)]
    state, start = np.zeros(system.shape[0]), 0.0
    for instant, wheel, rate in [*_events(passage), (math.inf, 0, 0.0)]:
        samples = np.flatnonzero((time >= start) & (time < instant))
        if samples.size:
            first = scipy.linalg.expm(system * (time[samples[0]] - start)) @ state
            states[:, samples] = _steps(first, powers, samples.size)
        if math.isinf(instant):
            break
        state, start = scipy.linalg.expm(system * (instant - start)) @ state, instant
        state[size + wheel], state[size + w + wheel] = 0.0, rate
    state_of, inputs, input_rates = np.split(states.T, (size, size + w), axis=1)
    no_pairs = np.zeros((time.size, form.slide.shape[-2]))
    return History(
        model=form, time=time, state=state_of, inputs=inputs, input_rates=input_rates, sliding_force=no_pairs
    )


def _autonomous(form: FirstOrder, omega: float) -> Vector:
    """Return the matrix A of s = (states, z, z'), shape (s + 2w, s + 2w)."""
    w = len(form.system.inputs)
    return np.block(
        [
            [form.state, form.input, form.input_rate],
            [np.zeros((w, form.state.shape[0])), np.zeros((w, w)), np.eye(w)],
            [np.zeros((w, form.state.shape[0])), -(omega**2) * np.eye(w), np.zeros((w, w))],
        ]
    )


def _events(passage: BumpPassage) -> list[tuple[float, int, float]]:
    """Return the instants at which a wheel enters (road rate h0 omega) or leaves (rate 0) the bump, in order."""
    entering = [(arrival, wheel, passage.height * passage.omega) for wheel, arrival in enumerate(passage.arrivals)]
    leaving = [(arrival + passage.contact, wheel, 0.0) for wheel, arrival in enumerate(passage.arrivals)]
    return sorted(entering + leaving)


def _steps(first: Vector, powers: list[Vector], count: int) -> Vector:
    """Compute states P^0 s, P^1 s, ... of a uniform grid by doubling, (len(s), count); appends P^(2^k) to `powers`."""
    states = first[:, None]
    level = 0
    while states.shape[1] < count:
        if level == len(powers):
            powers.append(powers[-1] @ powers[-1])
        states = np.hstack((states, powers[level] @ states))
        level += 1
    return states[:, :count]
