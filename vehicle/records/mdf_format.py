"""MDF files of data loggers, versions 3 and 4."""

from __future__ import annotations

import gc
import sys
import warnings
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.records.channel import Channel, Measurement
from vehicle.records.reader import digest, extra

MASTERS = (2, 3)
"""Kinds of channels that hold the times of their group."""


def read(path: Path) -> Measurement:
    """Read the channels of numbers of all groups, each over the times of its group; nothing is resampled.

    Raises:
        MissingPartError: asammdf is not installed.
        DataError: damaged, cut off, or without numbers.
    """
    asammdf = extra("asammdf", "mdf", "an MDF file")
    found: list[Channel] = []
    left, told = 0, ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with asammdf.MDF(path) as file:
                size = path.stat().st_size
                for number, group in enumerate(file.groups):
                    _check_size(path, group, size)
                    axes: dict[int, np.ndarray] = {}
                    for index, one in enumerate(group.channels):
                        if one.channel_type in MASTERS and str(getattr(file, "version", "4")) >= "4":
                            continue
                        signal = file.get(group=number, index=index, raw=False)
                        values = np.asarray(signal.samples)
                        if values.dtype.kind not in "fiu" or values.ndim != 1 or not values.size:
                            left += 1
                            continue
                        times = np.asarray(signal.timestamps, dtype=np.float64)
                        axis = axes.setdefault(times.size, times)
                        found.append(
                            Channel(
                                name=one.name,
                                values=values.astype(np.float64),
                                unit=signal.unit or "",
                                axis=axis if np.array_equal(axis, times) else times,
                                place=f"group {number + 1}" if len(file.groups) > 1 else "",
                            )
                        )
                start, program = str(file.start_time), f"MDF {file.version}"
    except DataError:
        raise
    except Exception as error:  # damaged files raise what they like
        told = str(error) or type(error).__name__
    if told:
        _forget()
        raise DataError(f"{path}: no MDF file that can be read ({told}); it may be cut off; export it again")
    if not found:
        raise DataError(f"{path}: no channel of numbers; {left} of other kinds")
    return Measurement(
        path=path,
        format="mdf",
        channels=tuple(found),
        sha256=digest(path),
        program=program,
        start=start,
        notices=(f"{left} channels hold no numbers",) if left else (),
    )


def _forget() -> None:
    """Let go of a reader that failed: its finaliser fails too, and would print that."""
    hook, sys.unraisablehook = sys.unraisablehook, lambda _: None
    try:
        gc.collect()
    finally:
        sys.unraisablehook = hook


def _check_size(path: Path, group: object, size: int) -> None:
    """Refuse blocks of data that lie beyond the end of the file."""
    for block in getattr(group, "data_blocks", None) or ():
        address = getattr(block, "address", 0)
        held = getattr(block, "compressed_size", 0) or 0
        if address + held > size:
            raise DataError(f"{path}: a block of data lies beyond the end of the file; it was cut off; export it again")
