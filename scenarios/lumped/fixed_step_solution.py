"""Time stepping of a stack of lumped models with friction: exact linear part, implicit friction force."""

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import scipy

from scenarios.lumped.history import History
from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import FirstOrder
from vehicle.engines.linear.system import Slide
from vehicle.errors import ConfigurationError, SimulationError

ITERATIONS = 120
"""Maximum number of iterations: every second iteration halves the bracket or the step, and 52 halvings suffice."""


def fixed_step_solution(
    model: FirstOrder, timestep: float, road: npt.ArrayLike, *, every: int = 1, initial: npt.ArrayLike | None = None
) -> History:
    """Integrate a stack of models with one sliding pair over a road that is given at every step.

    Over a step the linear part is exact for a linear road displacement, and the sliding force is constant:
    x+ = P x + R0 w + R1 (w+ - w) + S f, v+ = V x+, with the mean force of the step
    f = theta friction(v+) + (1 - theta) friction(v) + viscous((v + v+) / 2),  theta = 1 / (1 - exp(-z)) - 1 / z.
    z = G slope is the stiffness of the friction law over the step, with the velocity change -G of a unit force. A
    sliding pair has z = 0 and theta = 1/2, the trapezoidal rule. A stuck pair has theta = 1, the law at the end of the
    step: sticking is exact at any step (the constant force stops the pair) and does not ring. The slope is the larger
    of the slopes at v and at the velocity for theta = 1. There remains one monotonic equation for v+ in each model,
    solved to round-off by Newton's method in a bracket.

    Motion and sliding force have second order in the step. The force of a stuck pair is computed as the mean over each
    step; its value at an instant is the mean of both adjacent steps. Only the single samples at which sticking begins
    and ends have first order, because the force has a jump or a kink inside the step.

    Args:
        model: models with exactly one sliding pair; leading axes "..." are the stack.
        timestep: step h [s].
        road: road displacement [m] at the ends of the steps, shape (T,) or (T, ...).
        every: store every n-th step.
        initial: initial states, shape (..., s); zero by default.

    Returns:
        The history at the stored steps, including the initial state.

    Raises:
        ConfigurationError: no or several sliding pairs, an invalid step, or a road of the wrong shape.
        SimulationError: the solution is not finite.

    Source: exponential fitting of theta: Liniger and Willoughby, SIAM J. Numer. Anal. 7 (1970).
    """
    shape, size = model.models, model.state.shape[-1]
    if len(model.system.slides) != 1:
        raise ConfigurationError(f"fixed_step_solution: found {len(model.system.slides)} sliding pairs, must be one")
    if model.input.shape[-1] != 1:
        raise ConfigurationError(f"fixed_step_solution: found {model.input.shape[-1]} inputs, must be one road")
    if not (math.isfinite(timestep) and timestep > 0.0):
        raise ConfigurationError(f"timestep: found {timestep!r} s, must be finite and greater than 0.0")
    if every < 1:
        raise ConfigurationError(f"every: found {every!r}, must be at least 1")
    driven = np.asarray(road, dtype=float)
    if driven.ndim not in (1, 1 + len(shape)) or driven.shape[1:] not in ((), shape) or len(driven) < 2:
        raise ConfigurationError(f"road: found shape {driven.shape}, must be (T,) or (T, *{shape}) with T >= 2")
    if not np.isfinite(driven).all():
        raise ConfigurationError("road: all displacements must be finite")
    pair = model.system.slides[0]
    propagate, at_start, over_step, by_force = _propagators(model, timestep)
    row = model.slide[..., 0, :]
    gain = -np.einsum("...i,...i->...", row, by_force)  # positive: a force against the motion slows it down
    road_of_models = driven if driven.ndim == 1 + len(shape) else driven.reshape(driven.shape + (1,) * len(shape))
    rates = np.diff(road_of_models, axis=0) / timestep
    state = (
        np.zeros((*shape, size)) if initial is None else np.array(np.broadcast_to(initial, (*shape, size)), dtype=float)
    )
    speed = np.einsum("...i,...i->...", row, state) + model.slide_rate[..., 0, 0] * rates[0]
    force, stuck = np.zeros(shape), np.zeros(shape)
    stored_steps = range(0, len(driven), every)
    states, forces = np.empty((len(stored_steps), *shape, size)), np.empty((len(stored_steps), *shape))
    states[0], forces[0] = state, _at_once(pair, speed)
    for step in range(1, len(driven)):
        free = (propagate @ state[..., None])[..., 0]
        free += (
            at_start * road_of_models[step - 1][..., None]
            + over_step * (road_of_models[step] - road_of_models[step - 1])[..., None]
        )
        arriving = np.einsum("...i,...i->...", row, free) + model.slide_rate[..., 0, 0] * rates[step - 1]
        last_speed, last_force, last_stuck = speed, force, stuck
        steep = gain * pair.friction.slope(last_speed)
        stuck = 2.0 * _end_share(steep) - 1.0
        stopped = _root(_balance(pair, gain, arriving, last_speed, 1.0), arriving, last_speed)
        share = _end_share(np.maximum(steep, gain * pair.friction.slope(stopped)))
        speed = _root(_balance(pair, gain, arriving, last_speed, share), arriving, last_speed, stopped)
        force = (arriving - speed) / gain
        state = free + by_force * force[..., None]
        if (step - 1) % every == 0 and step > 1:
            # Weighted by the stuck share, the force is the mean of both steps; if the pair slid in the earlier step,
            # it is the force of the later step.
            holding = last_force + (1.0 - 0.5 * last_stuck) * (force - last_force)
            forces[(step - 1) // every] += stuck * (holding - forces[(step - 1) // every])
        if step % every == 0:
            states[step // every], forces[step // every] = state, _at_once(pair, speed)
    if not np.isfinite(states).all():
        raise SimulationError("fixed_step_solution: a state is not finite; use a smaller step or check the parameters")
    stored_intervals = np.minimum(np.arange(len(stored_steps)) * every, len(rates) - 1)
    return History(
        model=model,
        time=np.asarray(timestep * every * np.arange(len(stored_steps)), dtype=float),
        state=states,
        inputs=road_of_models[::every, ..., None],
        input_rates=rates[stored_intervals][..., None],
        sliding_force=forces[..., None],
    )


def _propagators(model: FirstOrder, step: float) -> tuple[Vector, Vector, Vector, Vector]:
    """Return P, R0, R1 and S of a step, exact for a linear road displacement and a constant sliding force."""
    size = model.state.shape[-1]
    # One matrix exponential of (x, w, w', f), with w' and f constant over the step, gives all factors.
    augmented = np.zeros((*model.models, size + 3, size + 3))
    augmented[..., :size, :size] = model.state
    augmented[..., :size, size] = model.input[..., 0]
    augmented[..., :size, size + 1] = model.input_rate[..., 0]
    augmented[..., :size, size + 2] = -model.friction[..., 0]
    augmented[..., size, size + 1] = 1.0
    exponential = scipy.linalg.expm(augmented * step)
    return (
        exponential[..., :size, :size],
        exponential[..., :size, size],
        exponential[..., :size, size + 1] / step,
        exponential[..., :size, size + 2],
    )


def _at_once(pair: Slide, velocity: Vector) -> Vector:
    """Return the sum of the forces of both laws at a velocity."""
    return pair.friction.force(velocity) + (pair.viscous.force(velocity) if pair.viscous else 0.0)


def _end_share(steepness: Vector) -> Vector:
    """Return theta(z) = 1 / (1 - exp(-z)) - 1 / z: 1/2 + z/12 for small z, 1 for large z."""
    z = np.maximum(steepness, 1e-4)  # for smaller z, the difference of two large numbers is round-off, and theta is 1/2
    return np.asarray(-1.0 / np.expm1(-z) - 1.0 / z)


def _balance(
    pair: Slide, gain: Vector, arriving: Vector, last_speed: Vector, share: Vector | float
) -> Callable[[Vector], tuple[Vector, Vector]]:
    """Return the function v - v_free + G f(v) with its derivative; its root is the velocity at the end of the step."""
    explicit_force = (1.0 - share) * pair.friction.force(last_speed)

    def balance(velocity: Vector) -> tuple[Vector, Vector]:
        force, slope = explicit_force + share * pair.friction.force(velocity), share * pair.friction.slope(velocity)
        if pair.viscous is not None:
            middle = 0.5 * (velocity + last_speed)
            force, slope = force + pair.viscous.force(middle), slope + 0.5 * pair.viscous.slope(middle)
        return velocity - arriving + gain * force, 1.0 + gain * slope

    return balance


def _root(
    balance: Callable[[Vector], tuple[Vector, Vector]],
    arriving: Vector,
    last_speed: Vector,
    guess: Vector | None = None,
) -> Vector:
    """Find the root of an increasing function for each model by Newton's method, safeguarded by bisection."""
    # Friction opposes the velocity: the root for theta = 1 is between zero, the free velocity and the last velocity,
    # and half of the last friction shifts it by no more than the whole of that friction.
    bound = np.abs(arriving) + np.abs(last_speed) + np.abs(balance(np.zeros_like(last_speed))[0])
    low, high = -bound, bound
    velocity, last_change = last_speed if guess is None else guess, 2.0 * bound
    for _ in range(ITERATIONS):
        value, slope = balance(velocity)
        low, high = np.where(value < 0.0, velocity, low), np.where(value > 0.0, velocity, high)
        change = -value / slope
        # A relative change below 1e-13 of the velocities of the step is round-off and must not leave the bracket.
        settled = np.abs(change) <= 1e-13 * bound
        if settled.all():
            return velocity
        newton = velocity + change
        # Near the steep part of the friction law Newton's steps can oscillate, so they must at least halve.
        trusted = (newton >= low) & (newton <= high) & (np.abs(change) <= 0.5 * last_change)
        next_velocity = np.where(settled, velocity, np.where(trusted, newton, 0.5 * (low + high)))
        last_change = np.abs(next_velocity - velocity)
        velocity = next_velocity
    raise SimulationError("fixed_step_solution: the friction law has no unique force for a step; use a smaller step")
