"""Pictures of a comparison by their names: responses and time histories of each output point, signatures."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from vehicle.runs.comparison.comparison import Comparison
from vehicle.runs.comparison.pictures import plot_histories, plot_responses, plot_signatures


def drawings_of(comparison: Comparison) -> dict[str, Callable[[Path], None]]:
    """Return the name of each picture, as "compare_frf_seat_rail", and what writes it as PNG at a path."""
    caption = f"measured: {comparison.measured}; simulated: {comparison.run}"
    drawings: dict[str, Callable[[Path], None]] = {}
    for point in dict.fromkeys(_point_of(item.channel) for item in comparison.responses):
        responses = [item for item in comparison.responses if _point_of(item.channel) == point]
        drawings[f"compare_frf_{point}"] = partial(plot_responses, point=point, responses=responses, caption=caption)
    for point in dict.fromkeys(_point_of(item.channel) for item in comparison.records):
        rows = [item for item in comparison.records if _point_of(item.channel) == point]
        drawings[f"compare_time_{point}"] = partial(plot_histories, point=point, histories=rows, caption=caption)
    agreement = comparison.signatures
    if agreement is not None:
        text = f"{agreement.channels} responses; {caption}"
        drawings["compare_signatures"] = partial(plot_signatures, signatures=agreement, caption=text)
    return drawings


def _point_of(channel: str) -> str:
    """Return the output point of a channel: knuckle_fr of knuckle_fr_acc_z, damper_fr of damper_fr_velocity."""
    return re.sub(r"_(acc_[xyz]|velocity|force(_[xyz])?|displacement|torque)$", "", channel)
