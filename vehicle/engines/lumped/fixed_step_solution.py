"""A thousand nonlinear lumped models at once: exact propagator of the linear part, friction solved implicitly."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.engines.linear.first_order import FirstOrder
from vehicle.engines.linear.system import Slide
from vehicle.engines.lumped.history import Array, History
from vehicle.errors import ConfigurationError, SimulationError

ITERATIONS = 120
"""More than enough: of two iterations one halves the bracket or the step, and 52 halvings exhaust a double."""


def fixed_step_solution(
    model: FirstOrder, timestep: float, road: npt.ArrayLike, *, every: int = 1, initial: npt.ArrayLike | None = None
) -> History:
    """March a stack of models with one sliding pair over a road given at every step.

    Over a step the linear part is exact for a road that moves on a straight line, and the sliding force is constant:
    x+ = P x + R0 w + R1 (w+ - w) + S f, v+ = V x+, with the mean force of the step
    f = theta friction(v+) + (1 - theta) friction(v) + viscous((v + v+) / 2),  theta = 1 / (1 - exp(-z)) - 1 / z.
    z = G slope is the stiffness of the friction law over the step, G the velocity that a unit force takes away. A pair
    that slides has z = 0 and theta = 1/2, the trapezium; a stuck one has theta = 1, the law at the end of the step:
    sticking is exact at any step (the constant force is the one that stops the pair) and nothing rings. The slope is
    the larger of those at v and at the velocity found with theta = 1. What remains is one monotone equation for v+ in
    each model, solved to rounding by Newton's method in a bracket.

    Second order in the step, in motion and in sliding force. The force that holds a stuck pair is known as the mean of
    each step; at an instant it is the mean of the two steps that meet there. Only the single samples at which sticking
    begins and ends are first order, for the force jumps or bends inside a step.

    Args:
        model: models with exactly one sliding pair; leading axes "..." are the stack.
        timestep: step h [s].
        road: road displacement [m] at the ends of the steps, shape (T,) or (T, ...).
        every: keep every so manieth step.
        initial: states at the start, shape (..., s); zero where not given.

    Returns:
        The history at the steps kept, first one included.

    Raises:
        ConfigurationError: no or several sliding pairs, a bad step, or a road that does not fit the stack.
        SimulationError: a solution that is not finite.

    Source: exponential fitting of theta: Liniger and Willoughby, SIAM J. Numer. Anal. 7 (1970).
    """
    shape, size = model.models, model.state.shape[-1]
    if len(model.system.slides) != 1:
        raise ConfigurationError(f"fixed_step_solution: needed is one sliding pair, found {len(model.system.slides)}")
    if model.input.shape[-1] != 1:
        raise ConfigurationError(f"fixed_step_solution: needed is one road, found {model.input.shape[-1]} inputs")
    if not (math.isfinite(timestep) and timestep > 0.0):
        raise ConfigurationError(f"timestep: found {timestep!r} s, must be finite and greater than 0.0")
    if every < 1:
        raise ConfigurationError(f"every: found {every!r}, must be at least 1")
    driven = np.asarray(road, dtype=float)
    if driven.ndim not in (1, 1 + len(shape)) or driven.shape[1:] not in ((), shape) or len(driven) < 2:
        raise ConfigurationError(f"road: found shape {driven.shape}, needed is (T,) or (T, *{shape}) with T >= 2")
    if not np.isfinite(driven).all():
        raise ConfigurationError("road: all displacements must be finite")
    pair = model.system.slides[0]
    propagate, at_start, over_step, by_force = _propagators(model, timestep)
    row = model.slide[..., 0, :]
    gain = -np.einsum("...i,...i->...", row, by_force)  # positive: a force against the motion slows it down
    ahead = driven if driven.ndim == 1 + len(shape) else driven.reshape(driven.shape + (1,) * len(shape))
    rates = np.diff(ahead, axis=0) / timestep
    state = (
        np.zeros((*shape, size)) if initial is None else np.array(np.broadcast_to(initial, (*shape, size)), dtype=float)
    )
    speed = np.einsum("...i,...i->...", row, state) + model.slide_rate[..., 0, 0] * rates[0]
    force, stuck = np.zeros(shape), np.zeros(shape)
    kept = range(0, len(driven), every)
    states, forces = np.empty((len(kept), *shape, size)), np.empty((len(kept), *shape))
    states[0], forces[0] = state, _at_once(pair, speed)
    for step in range(1, len(driven)):
        free = (propagate @ state[..., None])[..., 0]
        free += at_start * ahead[step - 1][..., None] + over_step * (ahead[step] - ahead[step - 1])[..., None]
        arriving = np.einsum("...i,...i->...", row, free) + model.slide_rate[..., 0, 0] * rates[step - 1]
        before, earlier, stuck_earlier = speed, force, stuck
        steep = gain * pair.friction.slope(before)
        stuck = 2.0 * _end_share(steep) - 1.0
        stopped = _root(_balance(pair, gain, arriving, before, 1.0), arriving, before)
        share = _end_share(np.maximum(steep, gain * pair.friction.slope(stopped)))
        speed = _root(_balance(pair, gain, arriving, before, share), arriving, before, stopped)
        force = (arriving - speed) / gain
        state = free + by_force * force[..., None]
        if (step - 1) % every == 0 and step > 1:
            # Stuck by this share, the pair is held by the mean of the forces of both steps; where the earlier step
            # still slid, by that of the later one.
            holding = earlier + (1.0 - 0.5 * stuck_earlier) * (force - earlier)
            forces[(step - 1) // every] += stuck * (holding - forces[(step - 1) // every])
        if step % every == 0:
            states[step // every], forces[step // every] = state, _at_once(pair, speed)
    if not np.isfinite(states).all():
        raise SimulationError("fixed_step_solution: a state is not finite; take a smaller step or check the parameters")
    at_kept = np.minimum(np.arange(len(kept)) * every, len(rates) - 1)
    return History(
        model=model,
        time=np.asarray(timestep * every * np.arange(len(kept)), dtype=float),
        state=states,
        inputs=ahead[::every, ..., None],
        input_rates=rates[at_kept][..., None],
        sliding_force=forces[..., None],
    )


def _propagators(model: FirstOrder, step: float) -> tuple[Array, Array, Array, Array]:
    """P, R0, R1 and S of a step: exact for a road on a straight line and a constant sliding force."""
    size = model.state.shape[-1]
    # (x, w, w', f) with w' and f constant over the step: one matrix exponential gives all of them.
    whole = np.zeros((*model.models, size + 3, size + 3))
    whole[..., :size, :size] = model.state
    whole[..., :size, size] = model.input[..., 0]
    whole[..., :size, size + 1] = model.input_rate[..., 0]
    whole[..., :size, size + 2] = -model.friction[..., 0]
    whole[..., size, size + 1] = 1.0
    moved = scipy.linalg.expm(whole * step)
    return (
        moved[..., :size, :size],
        moved[..., :size, size],
        moved[..., :size, size + 1] / step,
        moved[..., :size, size + 2],
    )


def _at_once(pair: Slide, velocity: Array) -> Array:
    """Force of both laws at a velocity."""
    return pair.friction.force(velocity) + (pair.viscous.force(velocity) if pair.viscous else 0.0)


def _end_share(steepness: Array) -> Array:
    """theta(z) = 1 / (1 - exp(-z)) - 1 / z: 1/2 + z/12 for small z, 1 for large ones."""
    z = np.maximum(steepness, 1e-4)  # below, the difference of two large numbers is rounding, and theta 1/2
    return np.asarray(-1.0 / np.expm1(-z) - 1.0 / z)


def _balance(
    pair: Slide, gain: Array, arriving: Array, before: Array, share: Array | float
) -> Callable[[Array], tuple[Array, Array]]:
    """v - v_free + G f(v) and its derivative: zero where the mean force of the step fits the velocity it leads to."""
    known = (1.0 - share) * pair.friction.force(before)

    def balance(velocity: Array) -> tuple[Array, Array]:
        force, slope = known + share * pair.friction.force(velocity), share * pair.friction.slope(velocity)
        if pair.viscous is not None:
            middle = 0.5 * (velocity + before)
            force, slope = force + pair.viscous.force(middle), slope + 0.5 * pair.viscous.slope(middle)
        return velocity - arriving + gain * force, 1.0 + gain * slope

    return balance


def _root(
    balance: Callable[[Array], tuple[Array, Array]], arriving: Array, before: Array, guess: Array | None = None
) -> Array:
    """Root of an increasing function for each model: Newton's method, safeguarded by bisection."""
    # Laws oppose the velocities they see: the root of theta = 1 lies between zero, the free and the earlier velocity,
    # and half the friction of the earlier one moves it by no more than that friction does at all.
    reach = np.abs(arriving) + np.abs(before) + np.abs(balance(np.zeros_like(before))[0])
    low, high = -reach, reach
    velocity, last = before if guess is None else guess, 2.0 * reach
    for _ in range(ITERATIONS):
        value, slope = balance(velocity)
        low, high = np.where(value < 0.0, velocity, low), np.where(value > 0.0, velocity, high)
        change = -value / slope
        # A change below a part in 1e13 of the velocities of the step is rounding, and no reason to leave the bracket.
        settled = np.abs(change) <= 1e-13 * reach
        if settled.all():
            return velocity
        newton = velocity + change
        # Across the steep part of the friction Newton's steps can swing for ever: they must at least halve.
        trusted = (newton >= low) & (newton <= high) & (np.abs(change) <= 0.5 * last)
        better = np.where(settled, velocity, np.where(trusted, newton, 0.5 * (low + high)))
        last = np.abs(better - velocity)
        velocity = better
    raise SimulationError("fixed_step_solution: the friction law has no single force for a step; take a smaller step")
