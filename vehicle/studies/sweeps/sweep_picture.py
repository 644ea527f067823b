"""Picture of the comfort of all cars of a sweep over their parameters."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from vehicle.drawing.rendering.sweep_plot import plot_sweep
from vehicle.studies.sweeps.sweep_ranking import RankedCars

PICTURE = "sweep.png"
"""Name of the file in the folder of a sweep."""


def can_be_drawn(cars: RankedCars | None) -> bool:
    """Return True for two or more cars whose varied parameters are numbers."""
    return cars is not None and len(cars.order) > 1 and cars.numbers() is not None


def draw_ranked(path: Path, cars: RankedCars, units: Mapping[str, str], caption: str = "") -> None:
    """Write the picture of ranked cars that can be drawn.

    Args:
        path: PNG or SVG file.
        cars: the cars.
        units: parameter path to its unit; without unit if missing.
        caption: inputs, tyres and evaluated span.
    """
    parameters = cars.numbers()
    assert parameters is not None
    title = f"Comfort at the {cars.point} over the varied parameters"
    over = f"mean of {cars.inputs} inputs" if cars.inputs > 1 else "one input"
    names = [f"{name} [{units[name]}]" if units.get(name) else name for name in cars.paths]
    plot_sweep(path, names, parameters, cars.weighted, cars.unweighted, title, "; ".join(filter(None, (over, caption))))
