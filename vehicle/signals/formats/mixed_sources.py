"""Refuse long tables with rows of several sensors: time, sensor, value."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Measurement

LARGEST_KINDS = 64
"""Maximum number of different texts of a column that distinguishes sources of rows; more are remarks."""

SAMPLED = 200
"""Number of rows at the beginning of a table that show whether its sources alternate."""


def check_alternation(path: Path, name: str, texts: Sequence[str]) -> None:
    """Check that a column of texts, for example markers, does not name alternating sensors.

    Args:
        texts: cells of the first `SAMPLED` rows; empty texts for missing cells.
    """
    texts = [text for text in texts if text]  # a source has a name; a remark may be missing
    different = sorted(set(texts))
    changes = sum(1 for text, next_text in pairwise(texts) if text != next_text)
    alternates = changes > max(1 + 0.1 * len(texts), 1.5 * len(different))  # excludes texts that change rarely
    if 1 < len(different) <= LARGEST_KINDS and alternates:
        raise _mixed(path, name, different)


def check_cycles(measurement: Measurement) -> None:
    """Check that no channel counts sensors: the same k different whole numbers at each k equal times."""
    cycles: dict[int, int] = {}  # by axis, which many channels share
    for channel in measurement.channels:
        time, values = channel.axis, channel.values
        if channel.kind != "time" or time is None or time.size != values.size or np.iscomplexobj(values):
            continue
        if id(time) not in cycles:
            cycles[id(time)] = rows_at_once(time)
        cycle = cycles[id(time)]
        if cycle < 2:
            continue
        numbers = values[: values.size - values.size % cycle].reshape(-1, cycle)
        first = numbers[0]
        if (numbers == first).all() and np.unique(first).size == cycle and (first == np.rint(first)).all():
            raise _mixed(measurement.path, channel.name, [f"{number:g}" for number in np.sort(first)])


def rows_at_once(time: Vector) -> int:
    """Return the number of rows with equal times [s], (n,), if it is the same at all times; else 1."""
    cycle = int(np.argmax(time != time[0])) if time.size else 0
    if cycle < 2 or time.size < 4 * cycle:
        return 1
    times = time[: time.size - time.size % cycle].reshape(-1, cycle)
    return cycle if (times == times[:, :1]).all() and (np.diff(times[:, 0]) > 0.0).all() else 1


def _mixed(path: Path, name: str, sources: Sequence[str]) -> DataError:
    shown = ", ".join(map(repr, sources[:4]))
    return DataError(
        f"{path}: the table mixes rows of different sources: column {name!r} alternates between {shown}; write one "
        "file per source"
    )
