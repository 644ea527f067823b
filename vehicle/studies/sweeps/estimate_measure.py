"""Measure of a sweep whose cars are estimated in place of run, see `Car.estimate`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car, Run
from vehicle.runs.car.estimate_limits import require_class
from vehicle.runs.car.road_estimate import RoadEstimate, road_estimate
from vehicle.runs.figures.estimated_figures import estimated_figure, require_estimated
from vehicle.signals.analysis.ride_comfort import comfort_units
from vehicle.studies.sweeps.case import Input
from vehicle.studies.sweeps.measure import ComfortMeasure, FigureMeasure, Measure

ESTIMATE = "estimate"
"""Engine of a case that is estimated."""

WORDS = "estimates without a run, for all roads of the class"
"""Words of a table of estimates."""

NOTE = f"values are {WORDS} (error: docs/theory/estimate.md); run the best cars before you choose"
"""Message before a sweep of estimates."""


LEAST_ALIKE = 64
"""Minimum number of cars that differ in the same parameters for ports, which take as long as ten of the cars."""


@dataclass(frozen=True, kw_only=True, slots=True)
class EstimateMeasure:
    """Measure that estimates the values of another measure.

    Attributes:
        each: measure of comfort, or of figures with an estimate.
        by_ports: the cars differ in the same parameters and are many, see `vehicle.runs.car.linear_part`.
    """

    each: ComfortMeasure | FigureMeasure
    by_ports: bool = False

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the channels that a run would need."""
        return self.each.channels

    @property
    def units(self) -> Mapping[str, str]:
        """Return name to unit of each value; comfort has columns of errors, which stay empty, and no slip."""
        if isinstance(self.each, ComfortMeasure):
            return comfort_units(seated=self.each.seat)
        return {name: chosen.unit_in() for name, chosen in self.each.figures}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the values of a run."""
        return self.each(run)

    def of_car(self, car: Car, source: Input) -> dict[str, float]:
        """Return the estimated values of a car on a road.

        Raises:
            ConfigurationError, SimulationError: the estimate does not cover the car on this road.
        """
        if isinstance(self.each, ComfortMeasure):
            return dict(self._estimate(car, source).values)
        channels = {name for _, chosen in self.each.figures for name in (*chosen.channels, *chosen.over)}
        estimate = self._estimate(car, source, tuple(sorted(channels)))
        return {name: estimated_figure(chosen, estimate) for name, chosen in self.each.figures}

    def _estimate(self, car: Car, source: Input, channels: tuple[str, ...] = ()) -> RoadEstimate:
        return road_estimate(car, require_class(source), channels, by_ports=self.by_ports)


def estimate_measure(
    measure: Measure, vehicle: Vehicle, sources: Sequence[Input], *, alike: int = 0
) -> EstimateMeasure:
    """Return the measure that estimates the values of a measure.

    Args:
        measure: the measure.
        vehicle: the car.
        sources: the roads.
        alike: number of cars that differ in the same parameters.

    Raises:
        ConfigurationError: a figure, a function or an input without an estimate.
    """
    for source in sources:
        require_class(source)
    if not isinstance(measure, ComfortMeasure | FigureMeasure):
        raise ConfigurationError("estimate: this measure needs runs; choose comfort or figures of mean squares")
    for _, chosen in measure.figures if isinstance(measure, FigureMeasure) else ():
        require_estimated(chosen, vehicle)
    return EstimateMeasure(each=measure, by_ports=alike >= LEAST_ALIKE)
