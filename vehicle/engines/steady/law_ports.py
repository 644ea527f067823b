"""Laws of a car as ports: a motion w of the car and the force p = phi(w) against it.

The splitting needs the resolvent of a law: the force p and the motion w that satisfy p = phi(w) and p + lambda w = u.
phi is the remainder of a law beyond its line in the matrices, so phi(0) = 0.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.laws import stribeck as law_of_friction


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Port(ABC):
    """A law between a motion and a force.

    Attributes:
        base: row of the motion, and column of the force, in `vehicle.engines.steady.plant`.
        of_velocity: True if w is a velocity [m/s], False for a displacement [m].
        share: scaling lambda as a share of 1/|G| of the car at the fundamental frequency.
    """

    base: int
    of_velocity: bool
    share: float

    @property
    @abstractmethod
    def fall(self) -> float:
        """Return the largest fall of p over w, -d phi/dw; 0 of a law that never falls."""

    @property
    @abstractmethod
    def odd(self) -> bool:
        """Return True if phi(-w) = -phi(w)."""

    def scaling(self, effect: Vector) -> Vector:
        """Return lambda by |G| of the port at the fundamental frequency; of the same shape."""
        # p + lambda w rises only if lambda exceeds the fall of p.
        return np.maximum(self.share / np.maximum(effect, 1e-30), 1.5 * self.fall)

    @abstractmethod
    def force(self, sums: Vector, scaling: Vector, sign: float) -> Vector:
        """Return the forces p of the sums u = p + lambda w.

        Args:
            sums: u; (points, samples).
            scaling: lambda; (points, 1).
            sign: factor of the samples in their continuation, see `Cycle`.
        """


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Polygon(Port):
    """Piecewise linear law without memory: friction line and curve of a damper, table, stop, one-sided tyre.

    Attributes:
        knots: breakpoints of w, ascending; (k,).
        slopes: d phi/dw of the segments; (k + 1,).
        steep: lambda of a law whose steepest segment decides, 0 for others.
    """

    knots: Vector
    slopes: Vector
    steep: float = 0.0

    @property
    def fall(self) -> float:
        """See `Port`."""
        return float(max(0.0, -np.min(self.slopes)))

    @property
    def odd(self) -> bool:
        """See `Port`."""
        return np.allclose(self.knots, -self.knots[::-1]) and np.allclose(self.slopes, self.slopes[::-1])

    def at(self, motion: Vector) -> Vector:
        """Return phi(w); same shape."""
        return self._sum(motion, self.knots[None], self.slopes[None])

    def slope(self, motion: Vector) -> Vector:
        """Return d phi/dw; same shape."""
        return self.slopes[np.searchsorted(self.knots, motion)]

    def scaling(self, effect: Vector) -> Vector:
        """See `Port`."""
        if self.steep:
            return np.full_like(effect, max(self.steep, 1.5 * self.fall))
        return Port.scaling(self, effect)

    def force(self, sums: Vector, scaling: Vector, sign: float) -> Vector:
        """See `Port`."""
        # p over u is a polygon too: knots phi(w_j) + lambda w_j, slopes s/(s + lambda).
        knots = self.at(self.knots) + scaling * self.knots
        return self._sum(sums, knots, self.slopes / (self.slopes + scaling))

    def _sum(self, x: Vector, knots: Vector, slopes: Vector) -> Vector:
        """Return the polygon through (0, 0) at x, the sum over its segments of slope times length within them.

        Args:
            x: positions; (rows, samples), or any shape with one row of knots.
            knots, slopes: of the polygon of each row; (rows, k) and (rows, k + 1).
        """
        beyond = np.full((len(knots), 1), np.inf)
        edges = np.hstack([-beyond, knots, beyond])
        # The part of each segment on the way from 0 to x is clip(x) - clip(0).
        result = np.zeros_like(x) - (slopes * np.clip(0.0, edges[:, :-1], edges[:, 1:])).sum(
            axis=1, keepdims=x.ndim > 1
        )
        part = np.empty_like(x)
        for segment in np.flatnonzero(self.slopes):
            low, high = (edges[:, end : end + 1] if x.ndim > 1 else edges[0, end] for end in (segment, segment + 1))
            np.maximum(x, low, out=part)
            np.minimum(part, high, out=part)
            part *= slopes[:, segment : segment + 1] if x.ndim > 1 else slopes[0, segment]
            result += part
        return np.asarray(result)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stribeck(Port):
    """Friction with a limit L(v) that falls with the velocity, and the curve of the damper.

        phi(v) = curve(v) + L(v) clamp(v/full),   L = Fd + (Fs - Fd) exp(-|v/vs|^delta)

    Attributes:
        curve: curve of the damper beyond its smallest slope, without friction.
        full: velocity at which the friction line reaches the limit [m/s].
        law: the friction law.
        sliding, static: polygons of the curve with friction of the limits Fd and Fs, which enclose phi.
    """

    curve: Polygon
    full: float
    law: law_of_friction.Stribeck
    sliding: Polygon
    static: Polygon

    @property
    def fall(self) -> float:
        """Return the largest -dL/dv beyond the friction line."""
        v = np.geomspace(self.full, 20.0 * float(np.max(self.law.stribeck_velocity)) + self.full, 4000)
        return float(np.max(-self.law.fall_at(v, self.law) / v))

    @property
    def odd(self) -> bool:
        """See `Port`."""
        return self.curve.odd

    def at(self, motion: Vector) -> Vector:
        """Return phi(v); same shape."""
        return self.curve.at(motion) + self.law.limit(motion) * np.clip(motion / self.full, -1.0, 1.0)

    def slope(self, motion: Vector) -> Vector:
        """Return d phi/dv; same shape."""
        return self.curve.slope(motion) + self._slope_of_friction(motion)

    def _slope_of_friction(self, velocity: Vector) -> Vector:
        """Return the slope of L(v) clamp(v/full); same shape."""
        moving = np.where(velocity == 0.0, self.full, np.abs(velocity))
        fall = np.minimum(moving / self.full, 1.0) * self.law.fall_at(velocity, self.law) / moving
        return np.asarray(fall + (moving < self.full) * self.law.limit(velocity) / self.full)

    def force(self, sums: Vector, scaling: Vector, sign: float) -> Vector:
        """Solve phi(v) + lambda v = u by Newton's method, between the motions with the limits Fd and Fs; see `Port`."""
        ends = [(sums - each.force(sums, scaling, sign)) / scaling for each in (self.sliding, self.static)]
        low, high = np.minimum(*ends), np.maximum(*ends)
        # A stuck damper has the limit Fs, and one far beyond vs the limit Fd.
        v = np.where(np.abs(ends[1]) < self.full, ends[1], ends[0])
        accuracy = ROUND_OFF * (np.abs(sums) + float(np.max(self.law.static_limit)))
        scaling = np.broadcast_to(scaling, v.shape)
        at = np.nonzero(np.abs(self.at(v) + scaling * v - sums) > accuracy)
        for _ in range(STEPS):
            if not at[0].size:
                break
            velocity, factor = v[at], scaling[at]
            excess = self.at(velocity) + factor * velocity - sums[at]
            low[at], high[at] = np.where(excess < 0.0, velocity, low[at]), np.where(excess > 0.0, velocity, high[at])
            new = velocity - excess / (factor + self._slope_of_friction(velocity))
            v[at] = np.where((new > low[at]) & (new < high[at]), new, 0.5 * (low[at] + high[at]))
            wrong = np.abs(excess) > accuracy[at]
            at = (at[0][wrong], at[1][wrong])
        return np.asarray(sums - scaling * v)


RUBBER = 0.5
"""Scaling lambda of rubber friction over its stiffness at rest: with 2, twice as many points do not end."""

STEPS = 60
"""Maximum number of Newton steps: with bisection alone a bracket shrinks below round-off in 60."""

ROUND_OFF = 1e-12
"""Relative accuracy of the Newton iteration, far finer than the accuracy of the splitting."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Play(Port):
    """Jenkins elements in parallel over a displacement: presliding friction, rubber friction; p = H[x] - c x.

    The inverse of x + H[x]/lambda is of the same form (Kuhnen, Eur. J. Control 9, 2003): p over u = p + lambda x is the
    force of Jenkins elements too. With the stiffness K_i of the elements that stick while the elements before i slip,
    p has the slopes m_i = K_i/(K_i + lambda) over u, so its elements have the stiffness m_i - m_(i+1), and slip at the
    u of first loading by the stroke x_i of the element, lambda x_i + sum of k_j min(x_i, x_j).

    Attributes:
        stiffness: k of the elements [N/m], in the order of their strokes; (e,).
        stroke: x of the elements, ascending [m]; (e,).
        kept: part c of their stiffness that stays in the matrices [N/m].
    """

    stiffness: Vector
    stroke: Vector
    kept: float = 0.0

    @property
    def fall(self) -> float:
        """See `Port`."""
        return self.kept

    @property
    def odd(self) -> bool:
        """See `Port`."""
        return True

    def scaling(self, effect: Vector) -> Vector:
        """See `Port`."""
        return np.full_like(effect, RUBBER * self.stiffness.sum()) if self.kept else Port.scaling(self, effect)

    def force(self, sums: Vector, scaling: Vector, sign: float) -> Vector:
        """Return p = H - c (u - H)/l with l = lambda - c and H + l x = u; see `Port`."""
        reduced = scaling - self.kept
        elements = self._elements(sums, reduced, sign)
        return np.asarray(elements - self.kept * (sums - elements) / reduced)

    def _elements(self, sums: Vector, scaling: Vector, sign: float) -> Vector:
        """Return H of u = H + lambda x in the second of two periods, in which the elements repeat their forces.

        An element goes from f to clip(f + c, -L, L) over a change c, and over several from f to clip(f + a, low, high)
        with the sum a. With the three numbers of each block of samples all blocks are passed together.
        """
        sticking = np.cumsum(self.stiffness[::-1])[::-1][:, None]
        slopes = sticking / (sticking + scaling.T)
        stiffness = -np.diff(slopes, axis=0, append=0.0)
        loading = np.minimum(self.stroke[:, None], self.stroke) @ self.stiffness
        limit = stiffness * (scaling.T * self.stroke[:, None] + loading[:, None])
        count, points = sums.shape[::-1]
        blocks = max(1, TOGETHER // points)
        steps = -(-count // blocks)
        # (steps, blocks, elements, points): each step works on neighbouring numbers. The first change stands apart.
        u = np.ascontiguousarray(sums.T)[:, None]
        changes = np.zeros((blocks * steps, *limit.shape))
        changes[1:count] = stiffness * np.diff(u, axis=0)
        changes = np.ascontiguousarray(np.swapaxes(changes.reshape(blocks, steps, *limit.shape), 0, 1))
        total, ends = changes.sum(axis=0), np.empty((2, blocks, *limit.shape))
        ends[0], ends[1] = -limit, limit
        for change in changes:
            ends += change
            np.clip(ends, -limit, limit, out=ends)
        force = np.clip(stiffness * u[0], -limit, limit)
        starts = np.empty_like(total)
        for _ in range(2):
            for block in range(blocks):
                starts[block] = force
                force = np.clip(force + total[block], ends[0, block], ends[1, block])
            force = np.clip(sign * force + stiffness * (u[0] - sign * u[-1]), -limit, limit)
        result = np.empty((steps, blocks, points))
        for index, change in enumerate(changes):
            starts += change
            np.clip(starts, -limit, limit, out=starts)
            starts.sum(axis=1, out=result[index])
        return np.swapaxes(result, 0, 1).reshape(-1, points)[:count].T


TOGETHER = 256
"""Number of points and blocks of samples that are passed together."""
