"""A monotone, piecewise linear law through points: a damper over velocity, a spring over displacement.

On the piece j between two knots F = s_j x + b_j; beyond the outer points the outer pieces go on. With the smallest
slope D taken out, the rest is a sum of clamped lines, each of which a row with a limit answers implicitly and exactly:

    F(x) = D x + shift + sum over k of clamp(e_k (x - m_k), e_k w_k),   e = s - D, m: middle, w: half width of a piece.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.compiler import jitable
from vehicle.model.laws.law import Numbers

Vector = npt.NDArray[np.float64]

BEYOND = 10.0
"""How far an outer piece reaches as a clamped line, [m/s] or [m]: no damper is that fast, and a limit without end would
cost the solver its digits."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Curve:
    """Pieces between knots.

    Attributes:
        knots: inner corners, ascending; (k,).
        slopes: dF/dx of the pieces, none negative; (k + 1,).
        offsets: b of the pieces [N]; (k + 1,).
    """

    knots: Vector
    slopes: Vector
    offsets: Vector

    @classmethod
    def line(cls, slope: float) -> Curve:
        """F = s x."""
        return cls(knots=np.zeros(0), slopes=np.array([slope]), offsets=np.zeros(1))

    @classmethod
    def through(cls, positions: Sequence[float], forces: Sequence[float]) -> Curve:
        """The law through points (x, F), x ascending, of which there are two or more."""
        x, f = np.array(positions, dtype=float), np.array(forces, dtype=float)
        slopes = np.diff(f) / np.diff(x)
        return cls(knots=x[1:-1], slopes=slopes, offsets=f[:-1] - slopes * x[:-1])

    def force(self, position: Numbers) -> Vector:
        """F(x)."""
        piece = np.searchsorted(self.knots, position)
        return np.asarray(self.slopes[piece] * np.asarray(position) + self.offsets[piece])

    def slope(self, position: Numbers) -> Vector:
        """dF/dx; at a knot that of the piece below it."""
        return np.asarray(self.slopes[np.searchsorted(self.knots, position)])

    def energy(self, position: float) -> float:
        """Integral of F from 0 to x: the elastic energy [J] of a spring, exact."""
        corners = self.knots[(self.knots > min(position, 0.0)) & (self.knots < max(position, 0.0))]
        ends = np.sort([0.0, position, *corners])
        return float(np.sign(position) * np.sum(np.diff(ends) * self.force(0.5 * (ends[1:] + ends[:-1]))))

    def position(self, force: float) -> float:
        """x with F(x) = F: the middle of those that have it where the law is flat, but 0 where 0 is one of them."""
        scale = 1e-9 * max(float(np.max(np.abs(self.force(self.knots)), initial=0.0)), 1.0)
        if abs(float(self.force(0.0)) - force) <= scale:
            return 0.0
        rising = np.flatnonzero(self.slopes > 0.0)
        found = (force - self.offsets[rising]) / self.slopes[rising]
        edges = np.concatenate([[-np.inf], self.knots, [np.inf]])
        inside = np.clip(found, edges[rising], edges[rising + 1])
        return float(inside[np.argmin(np.abs(self.force(inside) - force))])

    @property
    def least_slope(self) -> float:
        """D, the smallest slope."""
        return float(np.min(self.slopes))

    def clamped(self) -> Vector:
        """e, m and e w of every piece that is steeper than D; (pieces, 3)."""
        edges = np.concatenate([self.knots[:1] - BEYOND, self.knots, self.knots[-1:] + BEYOND])
        excess = self.slopes - self.least_slope
        steeper = np.flatnonzero(excess > 0.0)
        middle, half = 0.5 * (edges[steeper] + edges[steeper + 1]), 0.5 * (edges[steeper + 1] - edges[steeper])
        return np.column_stack([excess[steeper], middle, excess[steeper] * half])

    def at_rest(self) -> float:
        """Sum of the clamped lines at x = 0: what `shift` makes up to F(0)."""
        excess, middle, limit = self.clamped().T
        return float(np.sum(np.clip(-excess * middle, -limit, limit)))


@jitable
def curve_force(position: float, edges: Any, slopes: Any, offsets: Any) -> float:
    """F(x), the scalar form; upper edges, slopes and offsets of the pieces, the last edge infinite."""
    piece = 0
    while position > edges[piece]:
        piece += 1
    force: float = slopes[piece] * position + offsets[piece]
    return force
