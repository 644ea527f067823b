"""MDF files of data loggers, versions 3 and 4; raw frames of a CAN bus in them, decoded by databases."""

from __future__ import annotations

import gc
import sys
import warnings
from collections.abc import Sequence, Set
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.can_format import load_database, needs_database, none_decoded, quiet
from vehicle.signals.records.channel import Channel, Measurement
from vehicle.signals.records.reader import digest, extra

BUS_FRAMES = frozenset(
    f"{bus}_{kind}"
    for bus in ("CAN", "LIN", "FLX", "ETH", "MOST")
    for kind in ("DataFrame", "ErrorFrame", "RemoteFrame", "OverloadFrame", "Frame", "FrameHeader", "NullFrame", "PDU")
)
"""First parts of the names of channels that hold raw frames of a bus (ASAM MDF, bus logging)."""
MASTERS = (2, 3)
"""Kinds of channels that hold the times of their group."""


def read(path: Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read the channels of numbers of all groups, each over the times of its group; nothing is resampled.

    Groups of raw frames of a bus become the signals that databases decode; without databases they are left out.

    Args:
        path: the file.
        databases: files of the form DBC, for the frames of a CAN bus.

    Raises:
        ConfigurationError: a database that is not there or cannot be read.
        MissingPartError: asammdf is not installed.
        DataError: damaged, cut off, without numbers, or frames of a bus alone that no database decodes.
    """
    asammdf = extra("asammdf", "mdf", "an MDF file")
    for one in databases:
        load_database(one)
    found: list[Channel] = []
    identifiers: list[int] = []
    notices: list[str] = []
    left, told = 0, ""
    try:
        with warnings.catch_warnings(), quiet():
            warnings.simplefilter("ignore")
            with asammdf.MDF(path) as file:
                size = path.stat().st_size
                buses = {n for n, group in enumerate(file.groups) if _is_bus(group)}
                for group in file.groups:
                    _check_size(path, group, size)
                for number in sorted(buses):
                    identifiers += _identifiers(file, number)
                found, left = _channels(file, buses)
                if databases and identifiers:
                    with file.extract_bus_logging(
                        {"CAN": [(str(one), 0) for one in databases]}, ignore_value2text_conversion=True
                    ) as decoded:
                        signals, open_ = _channels(decoded, set())
                        found, left = [*found, *signals], left + open_
                        notices.append(f"raw frames of a CAN bus: {len(identifiers)}, {len(signals)} signals decoded")
                start, program = str(file.start_time), f"MDF {file.version}"
    except DataError:
        raise
    except Exception as error:  # damaged files raise what they like
        told = str(error) or type(error).__name__
    if told:
        _forget()
        raise DataError(f"{path}: no MDF file that can be read ({told}); it may be cut off; export it again")
    if not found and identifiers:
        form = f"raw frames in {program}"
        raise none_decoded(path, identifiers, databases) if databases else needs_database(path, form, identifiers)
    if identifiers and not databases:
        notices.append(f"{len(identifiers)} raw frames of a CAN bus are left out; give --dbc FILE to decode them")
    if not found:
        raise DataError(f"{path}: no channel of numbers; {left} of other kinds")
    return Measurement(
        path=path,
        format="mdf",
        channels=tuple(found),
        sha256=digest(path),
        program=program,
        start=start,
        notices=(*notices, *((f"{left} channels hold no numbers",) if left else ())),
    )


def _channels(file: Any, buses: Set[int]) -> tuple[list[Channel], int]:
    """Channels of numbers of all groups but those of buses, and how many hold no numbers."""
    found: list[Channel] = []
    left = 0
    for number, group in enumerate(file.groups):
        if number in buses:
            continue
        axes: dict[int, np.ndarray] = {}
        place = str(getattr(group.channel_group, "acq_name", "") or "") if len(file.groups) > 1 else ""
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
                    place=place or (f"group {number + 1}" if len(file.groups) > 1 else ""),
                )
            )
    return found, left


def _is_bus(group: Any) -> bool:
    """True for a group of raw frames of a bus."""
    return any(str(one.name).split(".")[0] in BUS_FRAMES for one in group.channels)


def _identifiers(file: Any, number: int) -> list[int]:
    """Identifiers of the frames of a group; empty for groups of errors and of other buses."""
    names = {str(one.name): index for index, one in enumerate(file.groups[number].channels)}
    index = names.get("CAN_DataFrame.ID")
    if index is None:
        return []
    samples = np.asarray(file.get(group=number, index=index, raw=True, ignore_invalidation_bits=True).samples)
    return [int(one) & 0x1FFFFFFF for one in samples]


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
