"""Figures of the catalogue that the page computes anew for each setting of its sliders.

A figure is live if the page has its histories and its reduction by name (`ROWS` and `REDUCTIONS` of trial_worker.js).
"""

from collections.abc import Mapping, Sequence
from typing import Any

from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.runs.figures.chosen_figure import ChosenFigure, chosen_figure

ACCELERATION, DISPLACEMENT = "_acc_", "_displacement_"
"""Parts of the names of a recorded acceleration and of the output from which the page makes it."""


def is_live(chosen: ChosenFigure) -> bool:
    """Return True for a figure that the page can compute: it has no filter."""
    figure = chosen.figure
    reads = figure.reads.page or figure.reduces.page == "comfort"
    return bool(reads and figure.reduces.page and not chosen.band and not chosen.weighting)


def page_figures(car: Car, measure: Sequence[str]) -> list[dict[str, Any]]:
    """Return the live figures among those asked for: words, unit, histories, reduction, channels and their constants.

    Args:
        car: the car.
        measure: names of figures.

    Raises:
        ConfigurationError: the car lacks a figure.
    """
    figures = []
    for chosen in (chosen_figure(name, car.vehicle, "--measure") for name in measure):
        if not is_live(chosen):
            continue
        of_comfort = chosen.figure.reduces.page == "comfort"
        channels = () if of_comfort else chosen.channels_of(car.vehicle)
        tyres = {f"tyre_{wheel}_force_z": load for wheel, load in car.static.tyre_load.items()}
        figures.append(
            {
                "words": chosen.title,
                "unit": chosen.unit_in(),
                "rows": chosen.figure.reads.page,
                "reduction": chosen.figure.reduces.page,
                "channels": channels,
                "statics": [tyres.get(name, 0.0) for name in channels],
                "axis": AXES.index(chosen.axis) if chosen.axis else -1,
            }
        )
    return figures


def figure_data(figures: Sequence[Mapping[str, Any]], outputs: Mapping[str, int]) -> dict[str, Any]:
    """Return the entry of the live figures for the page; nothing without figures.

    A figure of a channel that is no output of the module, as the displacement of a plate, is left out.

    Args:
        figures: see `page_figures`.
        outputs: output of the module to its number.
    """
    listed = []
    for figure in figures:
        names = [name.replace(ACCELERATION, DISPLACEMENT) for name in figure["channels"]]
        if not {*names} <= outputs.keys():
            continue
        derived = [ACCELERATION in name for name in figure["channels"]]
        kept = {key: value for key, value in figure.items() if key != "channels"}
        listed.append({**kept, "outputs": [outputs[name] for name in names], "derived": derived})
    return {"figures": listed} if listed else {}
