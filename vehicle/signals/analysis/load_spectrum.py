"""What is said of a load: its level, its cycles, and their spectrum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.signals.analysis.rainflow_count import Cycles, count_cycles

Vector = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LoadSpectrum:
    """One load over a record, in its own unit.

    Attributes:
        name, unit: of the channel.
        minimum, maximum, mean, rms: of its values, the static part among them.
        counted: its cycles.
        equivalent_amplitude: of one cycle a second that does the same damage, as of `Cycles`.
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
        """Number of cycles, halves included."""
        return self.counted.total

    @property
    def largest_range(self) -> float:
        """Range of the largest cycle; 0 without any."""
        return float(self.counted.ranges[-1]) if self.counted.ranges.size else 0.0

    def classes(self, count: int) -> tuple[Vector, Vector]:
        """Cycles in classes of equal width from zero to the largest range.

        Args:
            count: number of classes.

        Returns:
            Their edges, (count + 1,), and the cycles in each, (count,); the upper edge belongs to a class.
        """
        edges = np.linspace(0.0, max(self.largest_range, np.finfo(float).tiny), count + 1)
        place = np.clip(np.searchsorted(edges, self.counted.ranges, side="left") - 1, 0, count - 1)
        return edges, np.bincount(place, weights=self.counted.counts, minlength=count).astype(float)


def load_spectrum(name: str, unit: str, load: Vector, *, slope: float, duration: float) -> LoadSpectrum:
    """Level and cycles of a load.

    Args:
        name, unit: of the channel.
        load: its record; (n,).
        slope: k of the line of Woehler [-].
        duration: of the record [s].

    Raises:
        ConfigurationError: as of `Cycles.equivalent_amplitude`.
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
