"""Level of a load, its rainflow cycles (ASTM E1049-85, 5.4.4), and the amplitude of equal damage.

Each closed hysteresis loop is a cycle of its range; open loops count as half cycles. n cycles of amplitude A cause the
damage n A^k (Miner's rule, Woehler curve of slope k). One cycle per second at the equivalent amplitude,

    A_eq = (sum n_i A_i^k / T)^(1/k),

over the time T [s] of the record causes the same damage. The package `rainflow` counts the cycles.
"""

from dataclasses import dataclass
from importlib import import_module

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.signals.analysis.samples import Vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Cycles:
    """Rainflow cycles of a load.

    Attributes:
        ranges: distinct ranges, increasing, in the unit of the load; (m,).
        counts: number of cycles of each range, half cycles included; (m,).
    """

    ranges: Vector
    counts: Vector

    @property
    def total(self) -> float:
        """Number of cycles."""
        return float(self.counts.sum())

    def exceeded(self) -> Vector:
        """Return the number of cycles at or above each range; (m,)."""
        return np.asarray(np.cumsum(self.counts[::-1])[::-1])

    def equivalent_amplitude(self, slope: float, duration: float) -> float:
        """Return the amplitude of one cycle per second with equal damage, in the unit of the load.

        Args:
            slope: slope k of the Woehler curve [-].
            duration: length T of the record [s].
        """
        if not (1.0 <= slope < np.inf and duration > 0.0):
            raise ConfigurationError(
                f"equivalent amplitude: found slope {slope:g} and duration {duration:g} s; must be a slope of at "
                "least 1 and a duration above 0"
            )
        if not self.ranges.size or self.ranges[-1] == 0.0:
            return 0.0
        # Relative to the largest range, so that a high slope does not overflow.
        largest = float(self.ranges[-1]) / 2.0
        damage = float(np.sum(self.counts * (self.ranges / self.ranges[-1]) ** slope)) / duration
        return largest * float(damage ** (1.0 / slope))


def count_cycles(load: npt.ArrayLike) -> Cycles:
    """Count the rainflow cycles of a load.

    Returns:
        Ranges and counts; empty for a constant load.
    """
    try:
        rainflow = import_module("rainflow")
    except ImportError:
        raise MissingPartError(
            "load cycles: the Python package rainflow is missing; install it with: pip install rainflow"
        ) from None
    values = np.asarray(load, dtype=np.float64)
    pairs = [pair for pair in rainflow.count_cycles(values.tolist()) if pair[0] > 0.0]
    table = np.array(pairs, dtype=np.float64).reshape(-1, 2)
    return Cycles(ranges=table[:, 0], counts=table[:, 1])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LoadSpectrum:
    """Level and cycles of a load, in the unit of its channel.

    Attributes:
        name, unit: name and unit of the channel.
        minimum, maximum, mean, rms: statistics of the values, static load included.
        counted: counted cycles.
        equivalent_amplitude: amplitude of one cycle per second with equal damage; see `Cycles`.
    """

    name: str
    unit: str
    minimum: float
    maximum: float
    mean: float
    rms: float
    counted: Cycles
    equivalent_amplitude: float

    @property
    def cycles(self) -> float:
        """Number of cycles, half cycles included."""
        return self.counted.total

    @property
    def largest_range(self) -> float:
        """Range of the largest cycle; 0 without cycles."""
        return float(self.counted.ranges[-1]) if self.counted.ranges.size else 0.0

    def classes(self, count: int) -> tuple[Vector, Vector]:
        """Count the cycles in classes of equal width from zero to the largest range.

        Returns:
            Edges of the classes, (count + 1,), and cycles in each class, (count,); a class includes its upper edge.
        """
        edges = np.linspace(0.0, max(self.largest_range, np.finfo(float).tiny), count + 1)
        index = np.clip(np.searchsorted(edges, self.counted.ranges, side="left") - 1, 0, count - 1)
        return edges, np.bincount(index, weights=self.counted.counts, minlength=count).astype(float)


def load_spectrum(name: str, unit: str, load: Vector, *, slope: float, duration: float) -> LoadSpectrum:
    """Return level and cycles of a load.

    Args:
        name, unit: name and unit of the channel.
        load: samples; (n,).
        slope: slope k of the Woehler curve [-].
        duration: length of the record [s].

    Raises:
        ConfigurationError: slope or duration out of range; see `Cycles.equivalent_amplitude`.
        MissingPartError: the package `rainflow` is not installed.
    """
    counted = count_cycles(load)
    return LoadSpectrum(
        name=name,
        unit=unit,
        minimum=float(np.min(load)),
        maximum=float(np.max(load)),
        mean=float(np.mean(load)),
        rms=float(np.sqrt(np.mean(np.square(load)))),
        counted=counted,
        equivalent_amplitude=counted.equivalent_amplitude(slope, duration),
    )
