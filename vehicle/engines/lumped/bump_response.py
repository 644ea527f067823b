"""A half-sine bump met by one wheel after the other, and the exact response of a linear model to it.

While wheel i is on the bump its road height obeys z_i'' = -omega^2 z_i. Coordinates, velocities and road heights
together are therefore an autonomous linear system s' = A s between the four instants at which a wheel enters or
leaves the bump; there only (z_i, z_i') jumps, x and x' are continuous. s(t) = expm(A (t - t_k)) s(t_k) holds no
time-step error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.engines.linear.first_order import FirstOrder, first_order
from vehicle.engines.linear.system import LinearSystem
from vehicle.engines.lumped.history import Array, History
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.half_car_rider_parameters import BumpShape


@dataclass(frozen=True, kw_only=True, slots=True)
class BumpPassage:
    """z_i = h0 sin(omega (t - t_i)) while wheel i is on the bump, else 0."""

    height: float
    """h0 [m]."""
    omega: float
    """Angular frequency pi v / wb [rad/s]."""
    arrivals: tuple[float, ...]
    """Time t_i at which each wheel reaches the bump [s]."""

    @property
    def contact(self) -> float:
        """Time wb / v that one wheel spends on the bump [s]."""
        return math.pi / self.omega

    def heights(self, time: npt.ArrayLike) -> Array:
        """Road height under each wheel [m], shape (wheels, *time.shape)."""
        return np.stack([self.height * np.sin(self.omega * since) * on for since, on in self._phases(time)])

    def rates(self, time: npt.ArrayLike) -> Array:
        """Rate of the road height under each wheel [m/s], shape (wheels, *time.shape)."""
        top = self.height * self.omega
        return np.stack([top * np.cos(self.omega * since) * on for since, on in self._phases(time)])

    def _phases(self, time: npt.ArrayLike) -> list[tuple[Array, npt.NDArray[np.bool_]]]:
        instants = np.asarray(time, dtype=float)
        since = [instants - arrival for arrival in self.arrivals]
        return [(phase, (phase >= 0.0) & (phase < self.contact)) for phase in since]


def bump_passage(shape: BumpShape, speed: float, wheelbase: float, start: float = 0.0) -> BumpPassage:
    """Passage of a two-axled car over a bump at constant speed; the rear wheel follows (a1 + a2) / v later.

    Args:
        shape: height and length of the bump.
        speed: v [m/s].
        wheelbase: a1 + a2 [m].
        start: time t0 at which the front wheel reaches the bump [s].

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
    return BumpPassage(height=shape.height, omega=omega, arrivals=(start, start + wheelbase / speed))


def bump_response(model: LinearSystem, passage: BumpPassage, *, time_step: float, duration: float) -> History:
    """Response of a model at rest to a bump, exact at every sample.

    Args:
        model: linear model with one road for each arrival of the passage.
        passage: the bump under each wheel.
        time_step: sampling of the answer [s]; no influence on its accuracy.
        duration: length of the answer [s].

    Returns:
        The motion from t = 0 to the duration. At the instant of an arrival the acceleration is the one just after it.

    Raises:
        ConfigurationError: time step or duration not positive, or roads and arrivals differ in number.
    """
    if not (math.isfinite(time_step) and time_step > 0.0):
        raise ConfigurationError(f"bump response: time_step: found {time_step!r} s, must be greater than 0.0")
    if not (math.isfinite(duration) and duration >= time_step):
        raise ConfigurationError(f"bump response: duration: found {duration!r} s, must be at least one time step")
    if len(passage.arrivals) != len(model.inputs):
        raise ConfigurationError(
            f"bump response: found {len(passage.arrivals)} arrivals for {len(model.inputs)} roads, needed is one each"
        )
    form, w = first_order(model), len(model.inputs)
    size = form.state.shape[-1]
    system = _autonomous(form, passage.omega)
    time = np.asarray(time_step * np.arange(round(duration / time_step) + 1), dtype=np.float64)
    states = np.zeros((system.shape[0], time.size))
    powers = [scipy.linalg.expm(system * time_step)]
    state, since = np.zeros(system.shape[0]), 0.0
    for instant, wheel, rate in [*_events(passage), (math.inf, 0, 0.0)]:
        inside = np.flatnonzero((time >= since) & (time < instant))
        if inside.size:
            first = scipy.linalg.expm(system * (time[inside[0]] - since)) @ state
            states[:, inside] = _steps(first, powers, inside.size)
        if math.isinf(instant):
            break
        state, since = scipy.linalg.expm(system * (instant - since)) @ state, instant
        state[size + wheel], state[size + w + wheel] = 0.0, rate
    state_of, inputs, input_rates = np.split(states.T, (size, size + w), axis=1)
    none = np.zeros((time.size, form.slide.shape[-2]))
    return History(model=form, time=time, state=state_of, inputs=inputs, input_rates=input_rates, sliding_force=none)


def _autonomous(form: FirstOrder, omega: float) -> Array:
    """A of s = (states, z, z'), shape (s + 2w, s + 2w)."""
    w = len(form.system.inputs)
    return np.block(
        [
            [form.state, form.input, form.input_rate],
            [np.zeros((w, form.state.shape[0])), np.zeros((w, w)), np.eye(w)],
            [np.zeros((w, form.state.shape[0])), -(omega**2) * np.eye(w), np.zeros((w, w))],
        ]
    )


def _events(passage: BumpPassage) -> list[tuple[float, int, float]]:
    """Instants at which a wheel enters (road rate h0 omega) or leaves (0) the bump, in order."""
    entering = [(arrival, wheel, passage.height * passage.omega) for wheel, arrival in enumerate(passage.arrivals)]
    leaving = [(arrival + passage.contact, wheel, 0.0) for wheel, arrival in enumerate(passage.arrivals)]
    return sorted(entering + leaving)


def _steps(first: Array, powers: list[Array], count: int) -> Array:
    """States P^0 s, P^1 s, ... of a uniform grid by doubling, shape (len(s), count); powers grows as P^(2^k)."""
    states = first[:, None]
    level = 0
    while states.shape[1] < count:
        if level == len(powers):
            powers.append(powers[-1] @ powers[-1])
        states = np.hstack((states, powers[level] @ states))
        level += 1
    return states[:, :count]
