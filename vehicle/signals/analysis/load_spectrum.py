"""Level, cycles and spectrum of a load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vehicle.signals.analysis.rainflow_count import Cycles, count_cycles
from vehicle.signals.analysis.samples import Vector


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
