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
    for place in dict.fromkeys(_place(one.channel) for one in comparison.responses):
        own = [one for one in comparison.responses if _place(one.channel) == place]
        drawings[f"compare_frf_{place}"] = partial(plot_responses, place=place, responses=own, caption=caption)
    for place in dict.fromkeys(_place(one.channel) for one in comparison.records):
        rows = [one for one in comparison.records if _place(one.channel) == place]
        drawings[f"compare_time_{place}"] = partial(plot_histories, place=place, histories=rows, caption=caption)
    together = comparison.signatures
    if together is not None:
        words = f"{together.channels} responses; {caption}"
        drawings["compare_signatures"] = partial(plot_signatures, signatures=together, caption=words)
    return drawings


def _place(channel: str) -> str:
    """Return the output point of a channel: knuckle_fr of knuckle_fr_acc_z, damper_fr of damper_fr_velocity."""
    return re.sub(r"_(acc_[xyz]|velocity|force(_[xyz])?|displacement|torque)$", "", channel)
