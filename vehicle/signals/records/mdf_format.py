"""Read MDF files of data loggers, versions 3 and 4, decode their raw CAN frames with DBC databases, and write MDF 4."""

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
"""First part of the names of channels with raw bus frames (ASAM MDF, bus logging)."""

MASTERS = (2, 3)
"""Types of channels with the times of their group."""


def read(path: Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read the numeric channels of all groups over the times of their group, without resampling.

    Raw frames of a CAN bus are decoded with the databases, and ignored without databases.

    Args:
        path: MDF file.
        databases: DBC files for the frames of a CAN bus.

    Raises:
        ConfigurationError: a database is missing or unreadable.
        MissingPartError: asammdf is not installed.
        DataError: the file is damaged, truncated, without numbers, or has only frames that are not decoded.
    """
    asammdf = extra("asammdf", "mdf", "an MDF file")
    for database in databases:
        load_database(database)
    channels: list[Channel] = []
    identifiers: list[int] = []
    notices: list[str] = []
    skipped, reason = 0, ""
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
                channels, skipped = _channels(file, buses)
                if databases and identifiers:
                    with file.extract_bus_logging(
                        {"CAN": [(str(database), 0) for database in databases]}, ignore_value2text_conversion=True
                    ) as decoded:
                        signals, undecoded = _channels(decoded, set())
                        channels, skipped = [*channels, *signals], skipped + undecoded
                        notices.append(f"raw frames of a CAN bus: {len(identifiers)}, {len(signals)} signals decoded")
                start, program = str(file.start_time), f"MDF {file.version}"
    except DataError:
        raise
    except Exception as error:  # asammdf raises errors of any type for damaged files
        reason = str(error) or type(error).__name__
    if reason:
        _forget()
        raise DataError(f"{path}: cannot be read as MDF ({reason}); it may be truncated; export it again")
    if not channels and identifiers:
        log_format = f"raw frames in {program}"
        raise none_decoded(path, identifiers, databases) if databases else needs_database(path, log_format, identifiers)
    if identifiers and not databases:
        notices.append(f"{len(identifiers)} raw frames of a CAN bus are ignored; set --dbc FILE to decode them")
    if not channels:
        raise DataError(f"{path}: no numeric channel; {skipped} channels of other types; export numbers")
    return Measurement(
        path=path,
        format="mdf",
        channels=tuple(channels),
        sha256=digest(path),
        program=program,
        start=start,
        notices=(*notices, *((f"{skipped} channels without numbers are ignored",) if skipped else ())),
    )


def write(path: Path, channels: Sequence[Channel], description: str) -> None:
    """Write time histories as MDF 4.10, one channel group for each time axis; values are stored as float64.

    Args:
        path: file to write, with the extension .mf4.
        channels: time histories.
        description: comment in the header of the file.

    Raises:
        MissingPartError: asammdf is not installed.
        DataError: a channel without times.
    """
    asammdf = extra("asammdf", "mdf", "an MDF file")
    groups: dict[int, tuple[Any, list[Any]]] = {}
    for channel in channels:
        if channel.axis is None or channel.kind != "time":
            raise DataError(f"{path}: {channel.name} is not a time history; MDF has no other functions; leave it out")
        _, signals = groups.setdefault(id(channel.axis), (channel.axis, []))
        signals.append(
            asammdf.Signal(
                samples=np.asarray(channel.values, dtype=np.float64),
                timestamps=channel.axis,
                name=channel.name,
                unit=channel.unit,
                comment=" ".join(filter(None, (channel.place, channel.direction))),
            )
        )
    with quiet(), asammdf.MDF(version="4.10") as file:
        file.header.comment = description
        for _, signals in groups.values():
            file.append(signals, comment=description, common_timebase=True)
        file.save(path, overwrite=True, compression=2)


def _channels(file: Any, buses: Set[int]) -> tuple[list[Channel], int]:
    """Return the numeric channels of all groups except bus groups, and the count of other channels."""
    channels: list[Channel] = []
    skipped = 0
    for number, group in enumerate(file.groups):
        if number in buses:
            continue
        axes: dict[int, np.ndarray] = {}
        group_name = str(getattr(group.channel_group, "acq_name", "") or "") if len(file.groups) > 1 else ""
        for index, channel in enumerate(group.channels):
            if channel.channel_type in MASTERS and str(getattr(file, "version", "4")) >= "4":
                continue
            signal = file.get(group=number, index=index, raw=False)
            values = np.asarray(signal.samples)
            if values.dtype.kind not in "fiu" or values.ndim != 1 or not values.size:
                skipped += 1
                continue
            times = np.asarray(signal.timestamps, dtype=np.float64)
            axis = axes.setdefault(times.size, times)
            channels.append(
                Channel(
                    name=channel.name,
                    values=values.astype(np.float64),
                    unit=signal.unit or "",
                    axis=axis if np.array_equal(axis, times) else times,
                    place=group_name or (f"group {number + 1}" if len(file.groups) > 1 else ""),
                )
            )
    return channels, skipped


def _is_bus(group: Any) -> bool:
    """Return True for a group of raw bus frames."""
    return any(str(channel.name).split(".")[0] in BUS_FRAMES for channel in group.channels)


def _identifiers(file: Any, number: int) -> list[int]:
    """Return the identifiers of the CAN frames of a group; empty for error frames and other buses."""
    names = {str(identifier.name): index for index, identifier in enumerate(file.groups[number].channels)}
    index = names.get("CAN_DataFrame.ID")
    if index is None:
        return []
    samples = np.asarray(file.get(group=number, index=index, raw=True, ignore_invalidation_bits=True).samples)
    return [int(identifier) & 0x1FFFFFFF for identifier in samples]


def _forget() -> None:
    """Collect a failed reader silently: its finaliser fails too, and would print an error."""
    hook, sys.unraisablehook = sys.unraisablehook, lambda _: None
    try:
        gc.collect()
    finally:
        sys.unraisablehook = hook


def _check_size(path: Path, group: object, size: int) -> None:
    """Reject data blocks beyond the end of the file."""
    for block in getattr(group, "data_blocks", None) or ():
        address = getattr(block, "address", 0)
        length = getattr(block, "compressed_size", 0) or 0
        if address + length > size:
            raise DataError(f"{path}: a data block is beyond the end of the file; it is truncated; export it again")
