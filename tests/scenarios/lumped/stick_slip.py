"""Exact motion of a mass on a spring with set-valued Coulomb friction under a sine force: closed forms."""

import math

import numpy as np
from scipy.optimize import brentq


class ExactStickSlip:
    """m x'' + k x + f = P sin(w t), |f| <= Fd at rest and f = Fd sign(x') in motion; no equation is integrated."""

    def __init__(self, mass, stiffness, friction, force, omega):
        self.k, self.fd, self.p, self.w = stiffness, friction, force, omega
        self.natural = math.sqrt(stiffness / mass)
        self.particular = force / (stiffness - mass * omega**2)

    def motion(self, end, x, v):
        """List of (start, end, kind, constants) up to a time; kind is +1, -1 (sliding) or 0 (stuck)."""
        t, pieces = 0.0, []
        while t < end:
            net = self.p * math.sin(self.w * t) - self.k * x
            if v == 0.0 and abs(net) <= self.fd * (1.0 + 1e-12):
                until, direction = self._stuck_until(t, x, end)
                pieces.append((t, until, 0, (x,)))
                t = until
                if direction == 0:
                    break
            else:
                direction = math.copysign(1.0, v if v != 0.0 else net)
            until, constants = self._slide(t, x, v, direction, end)
            pieces.append((t, until, direction, constants))
            x, v = self._at(until, direction, constants), 0.0
            t = until
        return pieces

    def sample(self, pieces, times):
        """Return the displacement at many times."""
        result = np.empty_like(times)
        for start, end, phase, constants in pieces:
            inside = (times >= start) & (times <= end)
            result[inside] = constants[0] if phase == 0 else self._at(times[inside], phase, constants)
        return result

    def _at(self, t, direction, constants):
        a, b = constants
        return (
            a * np.cos(self.natural * t)
            + b * np.sin(self.natural * t)
            - direction * self.fd / self.k
            + self.particular * np.sin(self.w * t)
        )

    def _rate(self, t, constants):
        a, b = constants
        return self.natural * (
            b * np.cos(self.natural * t) - a * np.sin(self.natural * t)
        ) + self.particular * self.w * np.cos(self.w * t)

    def _slide(self, t, x, v, direction, end):
        c, s, n = math.cos(self.natural * t), math.sin(self.natural * t), self.natural
        p = x + direction * self.fd / self.k - self.particular * math.sin(self.w * t)
        q = (v - self.particular * self.w * math.cos(self.w * t)) / n
        constants = (p * c - q * s, p * s + q * c)
        grid = t + np.arange(1, 4000) * (2.0 * math.pi / max(n, self.w) / 400.0)
        rates = self._rate(grid, constants) * direction
        hits = np.flatnonzero(rates < 0.0)
        if not hits.size or grid[hits[0]] > end:
            return end, constants
        low = grid[hits[0] - 1] if hits[0] else t + 1e-9 * (grid[0] - t)
        return brentq(lambda z: self._rate(z, constants), low, grid[hits[0]], xtol=1e-14), constants

    def _stuck_until(self, t, x, end):
        grid = t + np.arange(1, 4000) * (2.0 * math.pi / self.w / 1000.0)
        net = self.p * np.sin(self.w * grid) - self.k * x
        hits = np.flatnonzero(np.abs(net) > self.fd)
        if not hits.size or grid[hits[0]] > end:
            return end, 0
        direction = math.copysign(1.0, net[hits[0]])
        low = grid[hits[0] - 1] if hits[0] else t
        return brentq(
            lambda z: direction * (self.p * math.sin(self.w * z) - self.k * x) - self.fd, low, grid[hits[0]], xtol=1e-14
        ), direction
