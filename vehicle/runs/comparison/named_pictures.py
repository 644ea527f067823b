"""Pictures of a comparison by their names: responses and time histories of each output point, signatures."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.drawing.rendering.figure import FADED, saved_figure
from vehicle.runs.comparison.comparison import Comparison
from vehicle.runs.comparison.pictures import draw_histories, draw_responses, draw_signatures


@dataclass(frozen=True, kw_only=True, slots=True)
class NamedPicture:
    """Picture of a comparison."""

    title: str
    caption: str
    draw: Callable[[npt.NDArray[Any]], None]  # function that draws the picture on axes
    rows: int  # rows, columns: number of axes
    columns: int
    size: tuple[float, float]  # width and height of a new figure [inch]
    options: Mapping[str, Any] = field(default_factory=dict)  # of the axes of a new figure, see `Figure.subplots`

    def write(self, path: Path) -> None:
        """Write the picture as a PNG file."""
        with saved_figure(path, self.size, self.title, self.caption) as figure:
            self.draw(figure.subplots(self.rows, self.columns, squeeze=False, **self.options))


def pictures_of(comparison: Comparison) -> dict[str, NamedPicture]:
    """Return the name of each picture, as "compare_frf_seat_rail", to the picture.

    Responses to several plates have a picture for each, as "compare_frf_seat_rail_plate_fr". Responses are in columns
    of magnitude, phase and both coherences, time histories in rows of the whole record and the excerpt with the highest
    level.
    """
    caption = f"measured: {comparison.measured}; simulated: {comparison.run}"
    pictures: dict[str, NamedPicture] = {}
    several = len(comparison.plates) > 1
    for point, plate in dict.fromkeys((_point_of(item.channel), item.plate) for item in comparison.responses):
        responses = [item for item in comparison.responses if (_point_of(item.channel), item.plate) == (point, plate)]
        coherences = np.concatenate([[item.measured_coherence, item.simulated_coherence] for item in responses])
        title = f"{point} to {plate}" if several else point
        pictures[f"compare_frf_{point}" + (f"_{plate}" if several else "")] = NamedPicture(
            title=f"{title}: measured and simulated",
            caption=f"{caption}; {FADED}" if np.isfinite(coherences).any() else caption,
            draw=partial(draw_responses, responses=responses),
            rows=3,
            columns=len(responses),
            size=(max(7.6, 5.2 * len(responses) + 1.0), 8.2),
            options={"sharex": True, "sharey": "row", "height_ratios": (2.4, 1.0, 0.9)},
        )
    for point in dict.fromkeys(_point_of(item.channel) for item in comparison.records):
        histories = [item for item in comparison.records if _point_of(item.channel) == point]
        pictures[f"compare_time_{point}"] = NamedPicture(
            title=f"{point}: measured and simulated",
            caption=caption,
            draw=partial(draw_histories, histories=histories),
            rows=len(histories),
            columns=2,
            size=(13.0, 2.6 * len(histories) + 1.4),
            options={"sharey": "row", "width_ratios": (1.6, 1.4)},
        )
    agreement = comparison.signatures
    if agreement is not None:
        pictures["compare_signatures"] = NamedPicture(
            title="Agreement of all responses together",
            caption=f"{agreement.channels} responses; {caption}",
            draw=partial(draw_signatures, signatures=agreement),
            rows=1,
            columns=1,
            size=(9.0, 4.6),
        )
    return pictures


def _point_of(channel: str) -> str:
    """Return the output point of a channel: knuckle_fr of knuckle_fr_acc_z, damper_fr of damper_fr_velocity."""
    return re.sub(r"_(acc_[xyz]|velocity|force(_[xyz])?|displacement|torque)$", "", channel)
