"""Best linear approximation of a car on random plates, from periodic realisations.

A realisation is a sum of sines at the lines k/T with given amplitudes and independent random phases: for many lines a
Gaussian signal that repeats. Y(k)/U(k) of its periodic state has no leakage and no start-up. Its mean over realisations
is the best linear approximation of the car for this spectrum and level, and its scatter is the nonlinear distortion
(Pintelon and Schoukens, System Identification, 2nd edition 2012, chapters 3 and 4). The variance of the mean is the
scatter over the number of realisations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Mask, Vector
from vehicle.engines.reduced.statistical_linearisation import line_segments
from vehicle.engines.steady.level_states import PeriodicCar, full_velocity
from vehicle.engines.steady.plant import Responses

TOGETHER = 2**15
"""Samples of all realisations that are iterated together."""

SCALED = (1.5, 4.0)
"""Band whose mean response sets the scaling of a port [Hz]: the body moves most there."""

TOLERANCE = 1e-5
"""Of the iteration: with 1e-3 the RMS is right within 2e-5."""

SETTLED, STEPS = 1e-6, 200
"""Last relative change of the linearised damping constants, and maximum number of steps."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RandomStates:
    """Figures of c channels and d dampers at l levels, of m lines and n realisations; NaN where one has not ended.

    Attributes:
        frequency: lines [Hz]; (m,).
        frf: best linear approximation; (c, m, l).
        scatter: standard deviation of Y/U of one realisation; (c, m, l).
        rms: RMS of each realisation at the lines of the input; (c, l, n).
        slip: share of the time in which each damper slips, NaN for one without a friction line; (d, l).
        linearised: FRF by statistical linearisation; (c, m, l), NaN without it.
        ended: True for converged realisations; (l, n).
    """

    frequency: Vector
    frf: Complex
    scatter: Vector
    rms: Vector
    slip: Vector
    linearised: Complex
    ended: Mask


def random_states(
    car: PeriodicCar,
    *,
    period: float,
    shares: Complex,
    amplitudes: Vector,
    level: Vector,
    realisations: int,
    seed: int,
    linearised: Mask,
    progress: Callable[[float], None] | None = None,
) -> RandomStates:
    """Return the best linear approximation at all levels.

    Args:
        car: the car, with all harmonics.
        period: period T [s].
        shares: amplitude of each plate over the input, with its phase, at each harmonic; (k, w).
        amplitudes: amplitudes of the harmonics of the input at the level 1, zero at harmonics without it; (k,).
        level: levels; (l,).
        realisations: number of realisations, the same phases at each level.
        seed: of the phases.
        linearised: True for levels with statistical linearisation; (l,).
        progress: called with the finished fraction.
    """
    cycle, lines = car.cycle, np.flatnonzero(amplitudes)
    speeds = np.asarray(2.0 * np.pi * cycle.harmonics / period, dtype=np.float64)
    table = _of_one_period(car, speeds, shares)
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (realisations, len(lines)))
    unit = np.zeros((realisations, len(speeds)), dtype=complex)
    unit[:, lines] = amplitudes[lines] * np.exp(1j * phases)
    points = [(row, column) for row in range(len(level)) for column in range(realisations)]
    first = car.plant.base + len(car.static)
    count = table.inputs.shape[1] - first
    ratio = np.full((count, len(lines), len(level), realisations), np.nan, dtype=complex)
    slip = np.full((len(car.dampers), len(level), realisations), np.nan)
    ended = np.zeros((len(level), realisations), dtype=bool)
    scaled = slice(*(max(1, round(limit * period)) for limit in SCALED))
    size = max(1, TOGETHER // cycle.stored)
    for start in range(0, len(points), size):
        at_level, which = np.array(points[start : start + size]).T
        driven = level[at_level, None] * unit[which]
        rates = (1j * speeds * driven)[:, None] * shares.T
        at = np.zeros(len(driven), dtype=int)
        batch = car.points(table, at, driven, rates, scaled)
        periodic = batch.states(car.ports, car.cycle, TOLERANCE)
        rows = car.rows(table, at, batch, periodic)
        rows[~periodic.ended] = np.nan
        ratio[:, :, at_level, which] = np.moveaxis(rows[:, first:, lines] / driven[:, None, lines], 0, -1)
        ended[at_level, which] = periodic.ended
        for index, port in enumerate(car.ports):
            if (full := full_velocity(port, car.dampers)) is not None:
                slip[port.base, at_level, which] = np.mean(np.abs(periodic.motion[:, index]) > full, axis=-1)
        if progress is not None:
            progress(min(1.0, (start + size) / len(points)))
    power = 0.5 * np.abs(ratio * amplitudes[lines, None, None]) ** 2
    by_line = np.full((count, len(lines), len(level)), np.nan, dtype=complex)
    for column in np.flatnonzero(linearised):
        by_line[..., column] = _linearised(car, table, amplitudes * level[column])[first:, lines]
    return RandomStates(
        frequency=speeds[lines] / (2.0 * np.pi),
        frf=ratio.mean(axis=-1),
        scatter=ratio.std(axis=-1, ddof=1),
        rms=level[:, None] * np.sqrt(power.sum(axis=1)),
        slip=slip.mean(axis=-1),
        linearised=by_line,
        ended=ended,
    )


def _of_one_period(car: PeriodicCar, speeds: Vector, shares: Complex) -> Responses:
    """Return the responses at the harmonics of a period; (1, rows, columns, k)."""
    table = car.plant.responses(speeds)
    inputs = np.einsum("rwk,kw->rk", table.inputs, shares)
    return Responses(forces=table.forces[None], slopes=table.slopes[None], inputs=inputs[None, :, None])


def _linearised(car: PeriodicCar, table: Responses, amplitudes: Vector) -> Complex:
    """Return the FRFs of all rows with c = E[dF/dv] of a Gaussian velocity in place of each damper; (r, k)."""
    at, laws = list(range(len(car.dampers))), [line_segments(damper) for damper in car.dampers]
    forces, inputs = np.moveaxis(table.forces[0][:, at], -1, 0), table.inputs[0, :, 0].T
    speeds, result = np.full(len(at), 0.1), inputs
    change = np.inf
    for _ in range(STEPS):
        damping = np.array([law.damping(speed) for law, speed in zip(laws, speeds, strict=True)])
        gain = damping - car.model.matrices.viscous
        velocity = np.linalg.solve(np.eye(len(at)) + forces[:, at] * gain, inputs[:, at, None])
        result = inputs - (forces @ (gain[:, None] * velocity))[..., 0]
        following = np.sqrt(0.5 * (np.abs(result[:, at] * amplitudes[:, None]) ** 2).sum(axis=0))
        change, speeds = float(np.max(np.abs(following / speeds - 1.0))), np.sqrt(following * speeds)
        if change < SETTLED:
            return np.asarray(result.T)
    return np.full(result.T.shape, np.nan)
