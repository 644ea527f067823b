"""Setting of a damper that changes during a test: current, temperature or clicks, with its lag and delay.

The damper is a mixture of two laws with equal parts, the soft one at the lowest and the firm one at the highest
condition of all tests,

    F = (1 - theta) F_soft(x, v) + theta F_firm(x, v),   theta = m y/(1 + (m - 1) y),

with theta = 0 and 1 at both ends, and the slope m > 0 at the lower one: 1 is linear, above 1 saturates. y follows the
condition u = (i - lowest)/(highest - lowest) with a delay d and a lag of first order,

    lag y' = u(t - d) - y,

solved exactly for a condition that is straight between its samples. Derivatives: dy/dd = -y'; that over the lag is the
solution of the differentiated recursion.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
import scipy

from vehicle.arrays import Indices, Vector


@dataclass(frozen=True, kw_only=True, eq=False)
class Setting:
    """Condition over a test."""

    name: str  # of the condition, for example "current"
    time: Vector  # uniform times [s]; (n,)
    values: Vector  # condition in its unit; (n,)
    lowest: float  # lowest, highest: condition of the soft and of the firm law
    highest: float
    groups: tuple[Indices, int] | None = None  # first sample of each group of means, and number of samples

    def averaged(self, first: Indices, last: int) -> Setting:
        """Return the setting with means over groups of samples, taken behind lag and delay."""
        return dataclasses.replace(self, groups=(first, last))

    def shares(self, lag: float, delay: float, slope: float) -> tuple[Vector, Vector, Vector, Vector]:
        """Return theta and its derivatives over lag [1/s], delay [1/s] and slope at each sample; (n,) each."""
        y, of_lag, of_delay = self._followed(lag, delay)
        below = 1.0 + (slope - 1.0) * y
        steep = slope / below**2
        each = slope * y / below, steep * of_lag, steep * of_delay, y * (1.0 - y) / below**2
        if self.groups is None:
            return each
        first, last = self.groups
        size = np.diff(first, append=last)
        theta, of_lag, of_delay, of_slope = (np.asarray(np.add.reduceat(v[:last], first) / size) for v in each)
        return theta, of_lag, of_delay, of_slope

    def _followed(self, lag: float, delay: float) -> tuple[Vector, Vector, Vector]:
        """Return y and its derivatives over lag and delay at all samples."""
        count = self.time.size
        step = float(self.time[-1] - self.time[0]) / (count - 1)
        u = (self.values - self.lowest) / (self.highest - self.lowest)
        rise = np.append(np.diff(u), 0.0) / step
        # Without the delay, from sample to sample.
        moved, of_moved = _toward(step, lag, u, rise)
        fade, of_fade = np.exp(-step / lag), np.exp(-step / lag) * step / lag**2
        y = np.concatenate([u[:1], scipy.signal.lfilter([1.0], [1.0, -fade], moved[:-1], zi=[fade * u[0]])[0]])
        change = of_fade * y[:-1] + of_moved[:-1]
        of_lag = np.concatenate([[0.0], scipy.signal.lfilter([1.0], [1.0, -fade], change)])
        # With the delay, between the samples; before the first sample at rest.
        position = (self.time - self.time[0] - delay) / step
        at = np.clip(np.floor(position), 0, count - 1).astype(int)
        after = np.where(position > 0.0, (position - at) * step, 0.0)
        moved, of_moved = _toward(after, lag, u[at], rise[at])
        fade = np.exp(-after / lag)
        late = fade * y[at] + moved
        of_late = fade * of_lag[at] + fade * after / lag**2 * y[at] + of_moved
        rate = np.where(position > 0.0, (u[at] + rise[at] * after - late) / lag, 0.0)
        return late, of_late, -rate


def _toward(time: Vector | float, lag: float, value: Vector, rise: Vector) -> tuple[Vector, Vector]:
    """Return y a time after y = 0, for a condition from a value with a constant rise, and its derivative over the lag.

    y = value (1 - e) + rise (t - lag (1 - e)),   e = exp(-t/lag).
    """
    gone = -np.expm1(-time / lag)
    of_fade = np.exp(-time / lag) * time / lag**2
    return value * gone + rise * (time - lag * gone), -value * of_fade + rise * (lag * of_fade - gone)
