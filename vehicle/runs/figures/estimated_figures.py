"""Figures of the catalogue of which an estimate without a run has the value, see `Car.estimate`."""

import math
from collections.abc import Sequence

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car.road_estimate import RoadEstimate
from vehicle.runs.figures.chosen_figure import ChosenFigure
from vehicle.runs.figures.comfort_figures import COMFORT_FIGURES
from vehicle.runs.figures.rows import axis_weighting

ESTIMATED = (*COMFORT_FIGURES, "tyre_load", "tyre_load_rms", "rms", "ratio")
"""Names of the figures with an estimate: mean squares. Peaks, doses, travels and shares of time need a run."""


def require_estimated(chosen: ChosenFigure, vehicle: Vehicle) -> None:
    """Check that an estimate has a figure.

    Raises:
        ConfigurationError: another figure, or a channel that is no acceleration.
    """
    if chosen.quantity not in ESTIMATED:
        raise ConfigurationError(
            f"estimate: {chosen.title} is unknown without a run; choose {', '.join(ESTIMATED)}, or run the cars"
        )
    others = [name for name in (*chosen.channels, *chosen.over) if name not in vehicle.acceleration_channels]
    if others:
        raise ConfigurationError(f"estimate: {', '.join(others)}: only accelerations are estimated; run the cars")


def estimated_figure(chosen: ChosenFigure, estimate: RoadEstimate) -> float:
    """Return the value of a figure of `ESTIMATED` in its unit."""
    if chosen.quantity in COMFORT_FIGURES:
        return estimate.values["_".join(filter(None, [chosen.quantity, chosen.axis]))]
    if chosen.quantity in ("rms", "ratio"):
        above = _rms(chosen, chosen.channels, estimate)
        return above / _rms(chosen, chosen.over, estimate) if chosen.quantity == "ratio" else above
    wheels = chosen.wheels or tuple(estimate.static_load)
    static = estimate.static_load if chosen.quantity == "tyre_load" else dict.fromkeys(wheels, 1.0)
    return math.sqrt(sum((estimate.tyre_load[wheel] / static[wheel]) ** 2 for wheel in wheels) / len(wheels))


def _rms(chosen: ChosenFigure, channels: Sequence[str], estimate: RoadEstimate) -> float:
    """Return the RMS of channels in the band and with the weighting of a figure."""
    band = None if chosen.band is None else (chosen.band[0], chosen.band[1])
    return math.hypot(
        *(estimate.rms(name, band=band, weighting=axis_weighting(chosen.weighting, name)) for name in channels)
    )
