"""Pictures of a comparison by their names: responses and time histories of each output point, signatures."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy.typing as npt

from vehicle.runs.comparison.comparison import Comparison
from vehicle.runs.comparison.pictures import (
    draw_histories,
    draw_responses,
    draw_signatures,
    plot_histories,
    plot_responses,
    plot_signatures,
)


@dataclass(frozen=True, kw_only=True, slots=True)
class NamedPicture:
    """Picture of a comparison."""

    write: Callable[[Path], None]  # function that writes the picture to a path
    draw: Callable[[npt.NDArray[Any]], None]  # function that draws the picture on axes
    rows: int  # rows, columns: number of axes
    columns: int
    size: tuple[float, float]  # width and height of a new figure [inch]


def pictures_of(comparison: Comparison) -> dict[str, NamedPicture]:
    """Return the name of each picture, as "compare_frf_seat_rail", to the picture.

    Responses to several plates have a picture for each, as "compare_frf_seat_rail_plate_fr".
    """
    caption = f"measured: {comparison.measured}; simulated: {comparison.run}"
    pictures: dict[str, NamedPicture] = {}
    several = len(comparison.plates) > 1
    for point, plate in dict.fromkeys((_point_of(item.channel), item.plate) for item in comparison.responses):
        responses = [item for item in comparison.responses if (_point_of(item.channel), item.plate) == (point, plate)]
        title = f"{point} to {plate}" if several else point
        pictures[f"compare_frf_{point}" + (f"_{plate}" if several else "")] = NamedPicture(
            write=partial(plot_responses, point=title, responses=responses, caption=caption),
            draw=partial(draw_responses, responses=responses),
            rows=3,
            columns=len(responses),
            size=(max(7.6, 5.2 * len(responses) + 1.0), 8.2),
        )
    for point in dict.fromkeys(_point_of(item.channel) for item in comparison.records):
        histories = [item for item in comparison.records if _point_of(item.channel) == point]
        pictures[f"compare_time_{point}"] = NamedPicture(
            write=partial(plot_histories, point=point, histories=histories, caption=caption),
            draw=partial(draw_histories, histories=histories),
            rows=len(histories),
            columns=2,
            size=(13.0, 2.6 * len(histories) + 1.4),
        )
    agreement = comparison.signatures
    if agreement is not None:
        text = f"{agreement.channels} responses; {caption}"
        pictures["compare_signatures"] = NamedPicture(
            write=partial(plot_signatures, signatures=agreement, caption=text),
            draw=partial(draw_signatures, signatures=agreement),
            rows=1,
            columns=1,
            size=(9.0, 4.6),
        )
    return pictures


def drawings_of(comparison: Comparison) -> dict[str, Callable[[Path], None]]:
    """Return the name of each picture and the function that writes it to a path."""
    return {name: picture.write for name, picture in pictures_of(comparison).items()}


def _point_of(channel: str) -> str:
    """Return the output point of a channel: knuckle_fr of knuckle_fr_acc_z, damper_fr of damper_fr_velocity."""
    return re.sub(r"_(acc_[xyz]|velocity|force(_[xyz])?|displacement|torque)$", "", channel)
