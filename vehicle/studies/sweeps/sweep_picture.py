"""Picture of the comfort of all cars of a sweep over their parameters."""

from pathlib import Path
from typing import Any

from vehicle.drawing.rendering.open_axes import open_axes
from vehicle.drawing.rendering.sweep_plot import draw_sweep, plot_sweep
from vehicle.errors import ConfigurationError
from vehicle.runs.report.differences import parameter_words
from vehicle.studies.sweeps.sweep_ranking import RankedCars

PICTURE = "sweep.png"
"""Name of the file in the folder of a sweep."""


def can_be_drawn(cars: RankedCars | None) -> bool:
    """Return True for two or more cars whose varied parameters are numbers."""
    return cars is not None and len(cars.order) > 1 and cars.numbers() is not None


def plotted(cars: RankedCars | None, ax: Any = None) -> Any:
    """Draw ranked cars on axes and return the axes.

    Args:
        cars: the cars; None for a sweep without comfort.
        ax: the axes; a new figure by default.
    """
    parameters = cars.numbers() if can_be_drawn(cars) and cars is not None else None
    if cars is None or parameters is None:
        raise ConfigurationError("plot: needs two or more cars with comfort values whose varied parameters are numbers")
    axes = open_axes(ax, (7.6, 5.0))
    draw_sweep(axes.item(), cars.headings(parameter_words), parameters, cars.weighted, cars.unweighted)
    return axes.item()


def draw_ranked(path: Path, cars: RankedCars, caption: str = "") -> None:
    """Write the picture of ranked cars that can be drawn.

    Args:
        path: PNG or SVG file.
        caption: inputs, tyres and evaluated span.
    """
    parameters = cars.numbers()
    assert parameters is not None
    title = f"Comfort {cars.point} against the varied parameters"
    over = f"mean of {cars.inputs} inputs" if cars.inputs > 1 else "one input"
    plot_sweep(
        path,
        cars.headings(parameter_words),
        parameters,
        cars.weighted,
        cars.unweighted,
        title,
        "; ".join(filter(None, (over, caption))),
    )
