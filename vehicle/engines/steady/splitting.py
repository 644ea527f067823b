"""Periodic forces of the ports of a car by operator splitting.

The car is w = W - G p at each harmonic, the laws are p = phi(w) at each instant. With a diagonal scaling lambda > 0
the Douglas-Rachford iteration finds both,

    x = (1 + lambda G)^-1 (s + lambda W),   y = phi(w), y + lambda w = 2 x - s,   s <- s + 1.6 (y - x),

which converges if G is positive and phi rises (Lions and Mercier, SIAM J. Numer. Anal. 16, 1979): both resolvents are
firmly nonexpansive. Anderson acceleration combines the last steps of each point (Walker and Ni, SIAM J. Numer. Anal.
49, 2011). Its convergence is not proven: if the residual of a point grows, its past steps are deleted and the plain
step is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Complex, Indices, Mask, Vector
from vehicle.engines.steady.cycle import Cycle
from vehicle.engines.steady.law_ports import Port

RELAXED = 1.6
"""Factor of the plain step; the iteration converges below 2."""

PAST = 8
"""Number of past steps of Anderson acceleration."""

GROWN = 10.0
"""Growth of the residual above its minimum at which the past steps of a point are deleted."""

LOST = 0.1
"""Residual over the largest force from which a further scaling goes on; with a larger one it begins at zero."""

SMALLEST = 1e-12
"""Residual that counts as none [N]."""

EVERY = 5
"""Iterations between two checks for finished points."""

LADDER = ((1.0, 1.0), (0.3, 0.05), (3.0, 0.1), (0.3, 3.0), (1.0, 0.1), (10.0, 0.3), (0.1, 0.3))
"""Factors of lambda of ports over velocity and over displacement: points that have not ended continue with the next."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PresentLoad:
    """Forces of rolling tyres on slopes by their present load: the slope velocity e = max(-1, dF/F0) z' of each plate.

    Attributes:
        ports: effect of e on the motions of the ports; (points, ports, w, k).
        tyres, slopes: effects of the forces p (with a negative sign) and of e on the tyre forces; (points, w, ..., k).
        plates: dynamic tyre forces without both; (points, w, k).
        rate: velocities z' of the plates; (points, w, samples).
        load: static tyre loads [N]; (w,).
        least: smallest dF/F0: a tyre that has left its plate; -inf for a small change of the state.
    """

    ports: Complex
    tyres: Complex
    slopes: Complex
    plates: Complex
    rate: Vector
    load: Vector
    least: float = -1.0

    def at(self, points: Mask | Indices) -> PresentLoad:
        """Return some of the points."""
        return PresentLoad(
            ports=self.ports[points],
            tyres=self.tyres[points],
            slopes=self.slopes[points],
            plates=self.plates[points],
            rate=self.rate[points],
            load=self.load,
            least=self.least,
        )

    def changes(self, forces: Complex, slope: Complex) -> Complex:
        """Return the dynamic tyre forces dF by the forces p and e; (points, w, k)."""
        return self.plates - _product(self.tyres, forces) + _product(self.slopes, slope)

    def slope_velocity(self, cycle: Cycle, forces: Complex, last: Complex) -> Complex:
        """Return e by the forces p and the last e; (points, w, k)."""
        change = self.changes(forces, last)
        return cycle.amplitudes(np.maximum(cycle.histories(change) / self.load[:, None], self.least) * self.rate)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PeriodicForces:
    """Periodic states of n points.

    Attributes:
        force: p of the ports; (n, ports, samples).
        motion: w of the ports; (n, ports, samples).
        slope: slope velocities of rolling tyres; (n, w, k), (n, 0, k) for standing tyres.
        ended: True for the points that have converged; (n,).
        iterations: iterations of each point; (n,).
    """

    force: Vector
    motion: Vector
    slope: Complex
    ended: Mask
    iterations: Indices


def _product(table: Complex, amplitudes: Complex) -> Complex:
    """Return the product at each point and harmonic; (n, i, j, k) with (n, j, k)."""
    return np.asarray(np.einsum("nijk,njk->nik", table, amplitudes))


def periodic_forces(
    ports: Sequence[Port],
    cycle: Cycle,
    effects: Complex,
    drive: Complex,
    scaling: Vector,
    *,
    present: PresentLoad | None = None,
    tolerance: float = 1e-7,
    limit: int = 250,
    ladder: Sequence[tuple[float, float]] = LADDER,
    start: PeriodicForces | None = None,
) -> PeriodicForces:
    """Return the periodic forces of the ports at n points with different cars and drives.

    Args:
        ports: the laws.
        cycle: samples of the period.
        effects: G, motion of each port against a force of each; (n, ports, ports, k).
        drive: W, motions without forces of the ports; (n, ports, k).
        scaling: lambda; (n, ports).
        present: forces of rolling tyres, if the tyres roll.
        tolerance: largest |y - x| of a finished point over the largest force of its ports.
        limit: largest number of iterations with one scaling.
        ladder: factors of the scalings, see `LADDER`.
        start: states at which the iteration begins; by default at rest.
    """
    count, wheels = len(drive), 0 if present is None else len(present.load)
    shape = (count, len(ports), cycle.stored)
    result = PeriodicForces(
        force=np.zeros(shape) if start is None else start.force.copy(),
        motion=np.zeros(shape) if start is None else start.motion.copy(),
        slope=np.zeros((count, wheels, len(cycle.harmonics)), dtype=complex) if start is None else start.slope.copy(),
        ended=np.zeros(count, dtype=bool),
        iterations=np.zeros(count, dtype=np.intp),
    )
    lowest = np.array([1.5 * port.fall for port in ports])
    for of_velocity, of_displacement in ladder:
        left = np.flatnonzero(~result.ended)
        if not left.size:
            break
        factors = np.array([of_velocity if port.of_velocity else of_displacement for port in ports])
        scaled = np.maximum(scaling[left] * factors, lowest)
        part = None if present is None else present.at(~result.ended)
        # A point that diverges is found at the next check, and leaves.
        with np.errstate(over="ignore", invalid="ignore"):
            _Iteration(ports, cycle, effects[left], drive[left], scaled, part, left, result).run(tolerance, limit)
    return result


class _Iteration:
    """Iteration of points with one scaling; it writes into the result."""

    def __init__(
        self,
        ports: Sequence[Port],
        cycle: Cycle,
        effects: Complex,
        drive: Complex,
        scaling: Vector,
        present: PresentLoad | None,
        points: Indices,
        result: PeriodicForces,
    ) -> None:
        self.ports, self.cycle, self.result, self.points = ports, cycle, result, points
        scaled = np.moveaxis(scaling[:, :, None, None] * effects, -1, 1)
        inverse = np.linalg.inv(np.eye(len(ports)) + scaled)
        self.inverse = np.asarray(np.moveaxis(inverse, 1, -1), dtype=np.complex128)
        self.drive, self.scaling = drive, scaling[:, :, None]
        self.present, self.slope = present, result.slope[points]
        self.state = result.force[points] - self.scaling * result.motion[points]
        size = len(ports) * cycle.stored
        self.steps, self.states = np.zeros((2, len(points), PAST, size))
        self.products = np.zeros((len(points), PAST, PAST))
        self.before: tuple[Vector, Vector] | None = None
        self.best = np.full(len(points), np.inf)

    def run(self, tolerance: float, limit: int) -> None:
        """Iterate until all points have ended, or up to a number of iterations."""
        for iteration in range(1, limit + 1):
            drive = self.drive
            if self.present is not None:
                drive = drive + _product(self.present.ports, self.slope)
            x = _product(
                self.inverse, np.asarray(self.cycle.amplitudes(self.state) + self.scaling * drive, dtype=complex)
            )
            history = self.cycle.histories(x)
            sums = 2.0 * history - self.state
            force = np.empty_like(sums)
            for index, port in enumerate(self.ports):
                force[:, index] = port.force(sums[:, index], self.scaling[:, index], self.cycle.sign)
            step = RELAXED * (force - history)
            moved = np.zeros(len(step))
            if self.present is not None:
                last, self.slope = self.slope, self.present.slope_velocity(self.cycle, x, self.slope)
                moved = np.abs(self.slope - last).max(axis=(1, 2)) / (np.abs(self.slope).max(axis=(1, 2)) + 1e-300)
            final = iteration == limit
            if iteration % EVERY == 0 or final:
                gap = np.abs(step).max(axis=(1, 2)) / RELAXED
                largest = np.abs(force).max(axis=(1, 2))
                ended = (gap <= tolerance * largest + SMALLEST) & (moved <= tolerance)
                # A point that has grown beyond its forces begins the next scaling at zero.
                lost = ~(gap <= LOST * largest + SMALLEST) if final else ~(gap <= LOST**-2 * largest + SMALLEST)
                force[lost], sums[lost] = 0.0, 0.0
                leaving = ended | lost | final
                if leaving.any():
                    self._write(force, (sums - force) / self.scaling, ended, leaving, iteration)
                    if leaving.all():
                        return
                    step = step[~leaving]
                    self._keep(~leaving)
            self._advance(iteration, step)

    def _write(self, force: Vector, motion: Vector, ended: Mask, leaving: Mask, iteration: int) -> None:
        """Write the points that leave the iteration into the result."""
        at = self.points[leaving]
        self.result.force[at], self.result.motion[at] = force[leaving], motion[leaving]
        self.result.slope[at], self.result.ended[at] = self.slope[leaving], ended[leaving]
        self.result.iterations[at] += iteration

    def _keep(self, points: Mask) -> None:
        """Keep the points that have not ended."""
        names = ("inverse", "drive", "scaling", "state", "slope", "steps", "states", "products", "best", "points")
        for name in names:
            setattr(self, name, getattr(self, name)[points])
        self.present = None if self.present is None else self.present.at(points)
        if self.before is not None:
            self.before = (self.before[0][points], self.before[1][points])

    def _advance(self, iteration: int, step: Vector) -> None:
        """Take the accelerated step; (points, ports, samples)."""
        flat, residual = self.state.reshape(len(step), -1), step.reshape(len(step), -1)
        size = np.einsum("ni,ni->n", residual, residual)
        self.best = np.minimum(self.best, size)
        if self.before is None:
            self.before, self.state = (flat, residual), self.state + step
            return
        slot = iteration % PAST
        self.states[:, slot], self.steps[:, slot] = flat - self.before[0], residual - self.before[1]
        row = np.matmul(self.steps, self.steps[:, slot, :, None])[..., 0]
        self.products[:, slot], self.products[:, :, slot] = row, row
        lost = ~(size <= GROWN**2 * self.best)
        if lost.any():
            for array in (self.states, self.steps, self.products):
                array[lost] = 0.0
            self.best[lost] = size[lost]
        self.before = (flat, residual)
        # min |f - F c|: regularised in proportion to the trace, which is zero for a point without past steps.
        trace = np.trace(self.products, axis1=1, axis2=2)[:, None]
        trace = np.where(trace > 0.0, trace, 1.0)
        matrix = self.products / trace[..., None] + REGULAR * np.eye(PAST)
        matrix[~np.isfinite(matrix).all(axis=(1, 2))] = np.eye(PAST)
        right = np.matmul(self.steps, residual[..., None])[..., 0] / trace
        weights = np.linalg.solve(matrix, right[..., None])[..., 0]
        change = np.matmul(weights[:, None], self.states + self.steps)[:, 0]
        self.state = (flat + residual - change).reshape(step.shape)


REGULAR = 1e-10
"""Regularisation of Anderson acceleration over the trace of its matrix: past steps may be nearly parallel."""
