"""Monotone, piecewise linear law through points: a damper over velocity, a spring over displacement.

On segment j between two breakpoints F = s_j x + b_j; the outer segments are extrapolated. After subtraction of the
minimum slope D, a sum of clamped lines remains, each of which a row with a limit solves implicitly and exactly:

    F(x) = D x + shift + sum over k of clamp(e_k (x - m_k), e_k w_k),   e = s - D, m, w: middle, half width.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.laws.law import Numbers

BEYOND = 10.0
"""Extent of an outer segment as a clamped line, [m/s] or [m]: faster than any damper; an infinite limit would cost the
solver its accuracy."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Curve:
    """Segments between breakpoints.

    Attributes:
        knots: inner breakpoints, ascending; (k,).
        slopes: dF/dx of the segments, not negative; (k + 1,).
        offsets: b of the segments [N]; (k + 1,).
    """

    knots: Vector
    slopes: Vector
    offsets: Vector

    @classmethod
    def line(cls, slope: float) -> Curve:
        """Return the law F = s x."""
        return cls(knots=np.zeros(0), slopes=np.array([slope]), offsets=np.zeros(1))

    @classmethod
    def through(cls, positions: Sequence[float], forces: Sequence[float]) -> Curve:
        """Return the law through two or more points (x, F), x ascending."""
        x, f = np.array(positions, dtype=float), np.array(forces, dtype=float)
        slopes = np.diff(f) / np.diff(x)
        return cls(knots=x[1:-1], slopes=slopes, offsets=f[:-1] - slopes * x[:-1])

    def force(self, position: Numbers) -> Vector:
        """Return F(x) [N]."""
        segment = np.searchsorted(self.knots, position)
        return np.asarray(self.slopes[segment] * np.asarray(position) + self.offsets[segment])

    def slope(self, position: Numbers) -> Vector:
        """Return dF/dx; at a breakpoint, the slope of the lower segment."""
        return np.asarray(self.slopes[np.searchsorted(self.knots, position)])

    def energy(self, position: float) -> float:
        """Return the integral of F from 0 to x, exactly: the elastic energy [J] of a spring."""
        corners = self.knots[(self.knots > min(position, 0.0)) & (self.knots < max(position, 0.0))]
        # Between corners the force is a line: its mean is that in the middle, so the sum is exact.
        ends = np.sort([0.0, position, *corners])
        return float(np.sign(position) * np.sum(np.diff(ends) * self.force(0.5 * (ends[1:] + ends[:-1]))))

    def position(self, force: float) -> float:
        """Return an x with F(x) = F: 0 if F(0) = F, otherwise the nearest point of a rising segment."""
        scale = 1e-9 * max(float(np.max(np.abs(self.force(self.knots)), initial=0.0)), 1.0)
        if abs(float(self.force(0.0)) - force) <= scale:
            return 0.0
        rising = np.flatnonzero(self.slopes > 0.0)
        # x = (F - b)/s on the line of each rising segment, limited to the segment: the nearest force wins.
        solutions = (force - self.offsets[rising]) / self.slopes[rising]
        edges = np.concatenate([[-np.inf], self.knots, [np.inf]])
        inside = np.clip(solutions, edges[rising], edges[rising + 1])
        return float(inside[np.argmin(np.abs(self.force(inside) - force))])

    @property
    def least_slope(self) -> float:
        """Minimum slope D."""
        return float(np.min(self.slopes))

    def clamped(self) -> Vector:
        """Return e, m and e w of every segment steeper than D; (segments, 3)."""
        # Outer segments end at BEYOND.
        edges = np.concatenate([self.knots[:1] - BEYOND, self.knots, self.knots[-1:] + BEYOND])
        excess = self.slopes - self.least_slope
        steeper = np.flatnonzero(excess > 0.0)
        middle, half = 0.5 * (edges[steeper] + edges[steeper + 1]), 0.5 * (edges[steeper + 1] - edges[steeper])
        return np.column_stack([excess[steeper], middle, excess[steeper] * half])

    def at_rest(self) -> float:
        """Return the sum of the clamped lines at x = 0; F(0) = shift + this sum."""
        excess, middle, limit = self.clamped().T
        return float(np.sum(np.clip(-excess * middle, -limit, limit)))
