"""Read MDF files of data loggers, versions 3 and 4, with raw frames of CAN buses, and write MDF 4."""

import gc
import sys
import warnings
from collections import Counter
from collections.abc import Sequence, Set
from dataclasses import replace
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.can_decoder import decode, load_database, quiet
from vehicle.signals.formats.can_frames import FD_LENGTHS, IDENTIFIER_BITS, BusLog, grouped, merged
from vehicle.signals.formats.channel import NOT_OVER_TIME, ROAD_PROFILE, Channel, Measurement
from vehicle.signals.formats.optional_library import extra
from vehicle.signals.formats.units import find_unit
from vehicle.signals.formats.unpacked_size import require_unpacked

BUS_FRAMES = frozenset(
    f"{bus}_{kind}"
    for bus in ("CAN", "LIN", "FLX", "ETH", "MOST")
    for kind in ("DataFrame", "ErrorFrame", "RemoteFrame", "OverloadFrame", "Frame", "FrameHeader", "NullFrame", "PDU")
)
"""First part of the names of channels with raw bus frames (ASAM MDF, bus logging)."""

SYNCHRONISATION = {1: "time", 2: "angle", 3: "distance", 4: "index"}
"""Quantity of a master channel by its synchronisation type."""

DIRECTIONS = {"0": "Rx", "1": "Tx", "0.0": "Rx", "1.0": "Tx", "rx": "Rx", "tx": "Tx"}
"""Direction of a frame by the value of CAN_DataFrame.Dir, in lower case."""

MASTERS = (2, 3)
"""Types of channels with the times of their group."""


def read(path: Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read the numeric channels of all groups over the times of their group, without resampling.

    Raw frames of a CAN bus are decoded with the databases, and ignored without databases.
    """
    asammdf = extra("asammdf", "mdf", "an MDF file")
    for database in databases:
        load_database(database)
    reason = ""
    try:
        with warnings.catch_warnings(), quiet():
            warnings.simplefilter("ignore")
            with asammdf.MDF(path) as file:
                size = path.stat().st_size
                buses = {n for n, group in enumerate(file.groups) if _bus_frames(group)}
                for group in file.groups:
                    _check_size(path, group, size)
                require_unpacked(path, sum(map(_unpacked, file.groups)), size)
                log = merged([_frames(file, number) for number in sorted(buses)])
                channels, notices = _channels(file, buses)
                start, program = str(file.start_time) if file.header.abs_time else "", f"MDF {file.version}"
    except DataError:
        raise
    except Exception as error:  # asammdf raises errors of any type for damaged files
        reason = str(error) or type(error).__name__
    if reason:
        _forget()
        raise DataError(f"{path}: cannot be read as MDF ({reason}); it may be truncated; export it again")
    if log and (databases or not channels):
        decoded, of_log = decode(path, f"raw frames in {program}", log, databases)
        channels, notices = [*channels, *decoded], [*of_log, *notices]
    elif log:
        count = sum(frames.time.size for frames in log.values())
        notices = [f"{count} raw frames of a CAN bus are ignored; set --dbc FILE to decode them", *notices]
    if not channels:
        raise DataError(f"{path}: no channel with numbers; {'; '.join(notices) or 'no channels'}; export numbers")
    return Measurement(
        path=path, format="mdf", channels=tuple(channels), program=program, start=start, notices=tuple(notices)
    )


def write(path: Path, channels: Sequence[Channel], description: str) -> None:
    """Write time histories as MDF 4.10, one channel group for each time axis; values are stored as float64."""
    asammdf = extra("asammdf", "mdf", "an MDF file")
    groups: dict[int, tuple[Any, list[Any]]] = {}
    for channel in channels:
        if channel.axis is None or channel.kind != "time":
            raise DataError(f"{path}: {channel.name} is not a time history, and MDF stores nothing else; leave it out")
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
    blocks = import_module("asammdf.blocks.v4_blocks")
    history = blocks.FileHistory()
    history.comment = "<FHcomment><TX>created</TX><tool_id>vehicle-on-shaker</tool_id></FHcomment>"
    with quiet(), asammdf.MDF(version="4.10") as file:
        file.header.comment = description
        file.header.start_time = history.time_stamp = datetime.fromtimestamp(0, UTC)  # equal results are equal bytes
        file.file_history.append(history)
        for _, signals in groups.values():
            file.append(signals, comment=description, common_timebase=True)
        file.save(path, overwrite=True, compression=2, add_history_block=False)


def _channels(file: Any, buses: Set[int]) -> tuple[list[Channel], list[str]]:
    """Return the numeric channels of all groups except bus groups, and notices."""
    channels: list[Channel] = []
    notices: list[str] = []
    skipped = 0
    frames: Counter[str] = Counter()
    for number, group in enumerate(file.groups):
        if number in buses:
            count = int(getattr(group.channel_group, "cycles_nr", 0))
            if count and not _is_can(group):
                frames[_bus_frames(group)] += count
            continue
        axes: dict[int, np.ndarray] = {}
        group_name = str(getattr(group.channel_group, "acq_name", "") or "") if len(file.groups) > 1 else ""
        group_label = group_name or (f"group {number + 1}" if len(file.groups) > 1 else "")
        master, seconds, remark = _axis(file, number)
        if master is not None:
            channels.append(replace(master, place=group_label))
        elif remark:
            notices.append(f"{group_label or 'the group'}: {remark}")
        for index, channel in enumerate(group.channels):
            if channel.channel_type in MASTERS and str(getattr(file, "version", "4")) >= "4":
                continue
            signal = file.get(group=number, index=index, raw=False)
            values = np.asarray(signal.samples)
            if values.dtype.kind not in "fiu" or values.ndim != 1 or not values.size:
                skipped += 1
                continue
            times = np.asarray(signal.timestamps, dtype=np.float64) * seconds
            axis = axes.setdefault(times.size, times)
            over_time = Channel(
                name=channel.name,
                values=values.astype(np.float64),
                unit=signal.unit or "",
                axis=axis if np.array_equal(axis, times) else times,
                place=group_label,
            )
            if master is not None:
                is_profile = master.name == "distance" and over_time.quantity == "displacement"
                function = ROAD_PROFILE if is_profile else master.function
                over_time = replace(over_time, axis=None, function=function, remark=remark)
            channels.append(over_time)
    if frames:
        shown = ", ".join(f"{frame_type} {count}" for frame_type, count in frames.items())
        notices.append(f"frames that are not CAN data are left out: {shown}")
    return channels, [*notices, *([f"{skipped} channels without numbers are ignored"] if skipped else [])]


def _axis(file: Any, number: int) -> tuple[Channel | None, float, str]:
    """Return the axis of a group: a channel for a master that is not time, the factor of a time to s, and a remark.

    Source: ASAM MDF 4, synchronisation type of a master channel: time [s], angle [rad], distance [m], index.
    """
    index = file.masters_db.get(number)
    if index is None:
        return None, 1.0, ""
    block = file.groups[number].channels[index]
    unit = file.get_channel_unit(group=number, index=index) or ""
    entry, quantity = find_unit(unit), SYNCHRONISATION.get(getattr(block, "sync_type", 1), "time")
    if quantity == "time" and (entry is None or entry.quantity == "time"):
        factor = 1.0 if entry is None else entry.factor
        return None, factor, "" if factor == 1.0 else f"times in {unit!r} are converted to s"
    if quantity == "time" and entry is not None:
        quantity = "distance" if entry.quantity == "displacement" else entry.quantity
    remark = f"the axis {block.name!r} has the quantity {quantity}, not time"
    function = f"function of {quantity}"
    return (
        Channel(
            name="distance" if quantity == "distance" else block.name,
            values=np.asarray(file.get_master(number), dtype=np.float64),
            unit=unit or {"distance": "m", "angle": "rad"}.get(quantity, ""),
            function=function if function in NOT_OVER_TIME else "time history",
            remark=remark,
        ),
        1.0,
        remark,
    )


def _bus_frames(group: Any) -> str:
    """Return the type of the raw bus frames of a group; empty for other groups."""
    return next((name for channel in group.channels if (name := str(channel.name).split(".")[0]) in BUS_FRAMES), "")


def _is_can(group: Any) -> bool:
    return any(str(channel.name) == "CAN_DataFrame.ID" for channel in group.channels)


def _frames(file: Any, number: int) -> BusLog:
    """Return the CAN data frames of a group; empty for error frames and other buses."""
    group = file.groups[number]
    if not _is_can(group):
        return {}
    index = {str(channel.name).removeprefix("CAN_DataFrame."): n for n, channel in enumerate(group.channels)}
    columns = {  # values of virtual channels, for example a constant bus, are in their conversions
        name: file.get(group=number, index=index[name], ignore_invalidation_bits=True)
        for name in ("ID", "IDE", "BusChannel", "Dir", "DataLength", "DLC", "DataBytes")
        if name in index
    }
    payload, identifiers = np.asarray(columns["DataBytes"].samples), columns["ID"].samples.astype(np.int64)
    if not identifiers.size:
        return {}
    if payload.ndim == 1:
        cells = [bytes(cell) for cell in payload]
        width = max(map(len, cells), default=0)
        payload = np.frombuffer(b"".join(cell.ljust(width, b"\0") for cell in cells), np.uint8).reshape(-1, width)
    count = len(identifiers)
    if "DataLength" in columns:
        length = columns["DataLength"].samples.astype(np.int64)
    elif "DLC" in columns:
        length = np.array(FD_LENGTHS)[np.minimum(columns["DLC"].samples.astype(np.int64), len(FD_LENGTHS) - 1)]
    else:
        length = np.full(count, payload.shape[1])
    extended = columns["IDE"].samples.astype(bool) if "IDE" in columns else identifiers >> 31 & 1 > 0
    buses = columns["BusChannel"].samples if "BusChannel" in columns else np.zeros(count, dtype=np.int64)
    ways = [str(way) for way in columns["Dir"].samples.astype(str)] if "Dir" in columns else [""] * count
    return grouped(
        np.asarray(columns["ID"].timestamps, dtype=np.float64),
        payload,
        np.minimum(length, payload.shape[1]),
        (
            [f"CAN{int(bus)}" for bus in buses],
            [DIRECTIONS.get(way.lower(), way) for way in ways],
            (identifiers & IDENTIFIER_BITS).tolist(),
            extended.tolist(),
        ),
    )


def _unpacked(group: Any) -> float:
    """Return the size of the values and times of a group in memory by its headers [byte]."""
    cycles = float(getattr(group.channel_group, "cycles_nr", 0))
    return cycles * max(float(getattr(group.channel_group, "samples_byte_nr", 0)), 8.0 * len(group.channels))


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
            raise DataError(f"{path}: a data block is beyond the end of the file; it is truncated: export it again")
