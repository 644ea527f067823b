"""Cycles of a load, counted by rainflow (ASTM E1049-85, 5.4.4), and the amplitude that does the same damage.

Each closed hysteresis loop is a cycle of its range; what is left open counts by halves. n cycles of amplitude A do the
damage n A^k (Miner's rule on a line of Woehler with slope k); the equivalent amplitude is that of one cycle a second,

    A_eq = (sum n_i A_i^k / T)^(1/k),

over the time T [s] of the record. The counting is that of the package `rainflow`.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError, MissingPartError

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Cycles:
    """Cycles of one load.

    Attributes:
        ranges: different ranges, rising, in the unit of the load; (m,).
        counts: number of cycles of each, halves included; (m,).
    """

    ranges: Vector
    counts: Vector

    @property
    def total(self) -> float:
        """Number of cycles."""
        return float(self.counts.sum())

    def exceeded(self) -> Vector:
        """Number of cycles with at least each range; (m,)."""
        return np.asarray(np.cumsum(self.counts[::-1])[::-1])

    def equivalent_amplitude(self, slope: float, duration: float) -> float:
        """Amplitude of one cycle a second that does the same damage.

        Args:
            slope: k [-], of the line of Woehler.
            duration: T of the record [s].

        Raises:
            ConfigurationError: the slope is no number of at least 1, or the duration not above 0.
        """
        if not (1.0 <= slope < np.inf and duration > 0.0):
            raise ConfigurationError(
                f"equivalent amplitude: found slope {slope:g} and duration {duration:g} s; allowed are a slope of at "
                "least 1 and a duration above 0"
            )
        if not self.ranges.size or self.ranges[-1] == 0.0:
            return 0.0
        # In parts of the largest, so that a high slope does not overflow.
        largest = float(self.ranges[-1]) / 2.0
        damage = float(np.sum(self.counts * (self.ranges / self.ranges[-1]) ** slope)) / duration
        return largest * float(damage ** (1.0 / slope))


def count_cycles(load: npt.ArrayLike) -> Cycles:
    """Count the cycles of a load.

    Args:
        load: its record; (n,).

    Returns:
        The cycles; none of a load that does not change.

    Raises:
        MissingPartError: the package `rainflow` is not installed.
    """
    try:
        rainflow = import_module("rainflow")
    except ImportError:
        raise MissingPartError("load cycles: needs rainflow, of the extra 'loads' (pip install rainflow)") from None
    values = np.asarray(load, dtype=np.float64)
    pairs = [pair for pair in rainflow.count_cycles(values.tolist()) if pair[0] > 0.0]
    table = np.array(pairs, dtype=np.float64).reshape(-1, 2)
    return Cycles(ranges=table[:, 0], counts=table[:, 1])
