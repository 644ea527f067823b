"""Files of a measurement beside a run: tables, and a picture for each place."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from vehicle.car import Run
from vehicle.comparison.comparison import comparison_of
from vehicle.comparison.pictures import plot_histories, plot_responses, plot_signatures
from vehicle.comparison.simulated import of_run
from vehicle.comparison.tables import Comparison
from vehicle.output.folder import write_json, write_text, write_whole
from vehicle.records.measured import Measured


def write_comparison(folder: Path, comparison: Comparison) -> dict[str, str]:
    """Write the tables and a picture for each place.

    Args:
        folder: where to.
        comparison: what to write.

    Returns:
        Kind of file to its name.
    """
    write_text(folder / "compare.csv", comparison.csv())
    write_json(folder / "compare.json", comparison.summary())
    files = {"compare": "compare.json", "compare_table": "compare.csv"}
    caption = f"measured: {comparison.measured}; simulated: {comparison.run}"
    pictures: dict[str, Callable[[Path], None]] = {}
    for place in dict.fromkeys(_place(one.channel) for one in comparison.responses):
        own = [one for one in comparison.responses if _place(one.channel) == place]
        pictures[f"compare_frf_{place}"] = partial(plot_responses, place=place, responses=own, caption=caption)
    for place in dict.fromkeys(_place(one.channel) for one in comparison.records):
        rows = [one for one in comparison.records if _place(one.channel) == place]
        pictures[f"compare_time_{place}"] = partial(plot_histories, place=place, histories=rows, caption=caption)
    together = comparison.signatures
    if together is not None:
        said = f"{together.channels} responses; {caption}"
        pictures["compare_signatures"] = partial(plot_signatures, signatures=together, caption=said)
    for name, draw in pictures.items():
        write_whole(folder / f"{name}.png", draw)
        files[name] = f"{name}.png"
    return files


def write_beside(folder: Path, measured: Measured, run: Run, files: dict[str, str]) -> dict[str, Any]:
    """Put a measurement beside a run, in the folder of the run.

    Args:
        folder: of the run.
        measured: the measurement.
        run: the run.
        files: kind of file to its name; what is written is added.

    Returns:
        What the summary says of it.
    """
    comparison = comparison_of(measured, of_run(run), command="python -m vehicle compare, after the run")
    files |= write_comparison(folder, comparison)
    told = comparison.summary()
    return {"file": comparison.measured, "table": told["table"], "notices": told["notices"]}


def _place(channel: str) -> str:
    """Place of a channel: knuckle_fr of knuckle_fr_acc_z, damper_fr of damper_fr_velocity."""
    return re.sub(r"_(acc_[xyz]|velocity|force(_[xyz])?|displacement|torque)$", "", channel)
