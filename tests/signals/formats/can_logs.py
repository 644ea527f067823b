"""The same frames of a CAN bus in every container that the readers know."""

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import numpy as np

LENGTHS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)


class Frame(NamedTuple):
    """Frame of a log."""

    time: float
    bus: int
    way: str
    identifier: int
    extended: bool
    data: bytes


def candump(frames: Sequence[Frame]) -> str:
    lines = []
    for one in frames:
        number = f"{one.identifier:08X}" if one.extended else f"{one.identifier:03X}"
        sign = "#" if len(one.data) <= 8 else "##1"
        lines.append(f"({1.7e9 + one.time:.6f}) can{one.bus - 1} {number}{sign}{one.data.hex().upper()} {one.way[0]}")
    return "\n".join(lines) + "\n"


def screen(frames: Sequence[Frame]) -> str:
    """Return what `candump -x -t a` prints."""
    lines = []
    for one in frames:
        number = f"{one.identifier:08X}" if one.extended else f"{one.identifier:03X}"
        cells = (f"({1.7e9 + one.time:.6f})", f"can{one.bus - 1}", f"{one.way[0]}X - -", f"{number:>8}",
                 f"[{len(one.data):02d}]", one.data.hex(" ").upper())  # fmt: skip
        lines.append(" " + "  ".join(cells))
    return "\n".join(lines) + "\n"


def asc(frames: Sequence[Frame], base: str = "hex", times: str = "absolute") -> str:
    number = "{:X}" if base == "hex" else "{}"
    byte = "{:02X}" if base == "hex" else "{:03d}"
    lines = ["date Thu Nov 26 10:00:00.000 am 2026", f"base {base}  timestamps {times}", "internal events logged",
             "Begin Triggerblock Thu Nov 26 10:00:00.000 am 2026", "   0.000000 Start of measurement"]  # fmt: skip
    before = 0.0
    for one in frames:
        stamp, before = (one.time - before if times == "relative" else one.time), one.time
        name = number.format(one.identifier) + "x" * one.extended
        data = " ".join(byte.format(value) for value in one.data)
        code = LENGTHS.index(len(one.data))
        size = len(one.data)
        if size > 8:
            row = f"CANFD {one.bus:3d} {one.way}   {name:>10}  IMU_data   1 0 {code:x} {size:2d} {data}   130000  130 0"
        else:
            row = f"{one.bus}  {name:15} {one.way}   d {code:x} {data}  Length = 234000 BitCount = 120"
        lines.append(f"   {stamp:.6f} {row}")
    return "\n".join([*lines, "End TriggerBlock", ""])


def trc(frames: Sequence[Frame], version: str = "2.1") -> str:
    columns = {"2.0": "N,O,T,I,d,l,D", "2.1": "N,O,T,B,I,d,R,L,D"}.get(version, "")
    head = [
        f";$FILEVERSION={version}",
        ";$STARTTIME=46352.5",
        *([f";$COLUMNS={columns}"] if columns else []),
        ";   Start",
    ]
    lines = []
    for n, one in enumerate(frames, 1):
        number = f"{one.identifier:08X}" if one.extended else f"{one.identifier:04X}"
        data, stamp = one.data.hex(" ").upper(), f"{1e3 * one.time:.3f}"
        size = LENGTHS.index(len(one.data)) if version == "2.1" else len(one.data)
        kind = "DT" if len(one.data) <= 8 else "FB"
        lines.append({
            "1.0": f"{n:>6}) {stamp} {number} {size} {data}",
            "1.1": f"{n:>6}) {stamp} {one.way} {number} {size} {data}",
            "1.3": f"{n:>6}) {stamp} {one.bus} {one.way} {number} - {size} {data}",
            "2.0": f"{n:>6} {stamp} {kind} {number} {one.way} {size} {data}",
            "2.1": f"{n:>6} {stamp} {kind} {one.bus} {number} {one.way} - {size} {data}",
        }[version])  # fmt: skip
    return "\n".join([*head, *lines, ""])


def mf4(path: Path, frames: Sequence[Frame], *, constant: Sequence[str] = ()) -> None:
    """Write frames as data loggers of CAN do (ASAM MDF, bus logging).

    Args:
        path: file to write.
        frames: frames of the log.
        constant: fields that hold a count of the frames, and their value in a conversion, as virtual channels do.
    """
    import asammdf
    from asammdf.blocks import v4_constants as v4c
    from asammdf.blocks.conversion_utils import from_dict
    from asammdf.blocks.source_utils import Source

    width = max(len(one.data) for one in frames)
    fields = [("BusChannel", "u1"), ("ID", "<u4"), ("IDE", "u1"), ("Dir", "u1"), ("DLC", "u1"), ("DataLength", "u1"),
              ("DataBytes", f"({width},)u1")]  # fmt: skip
    rows = np.zeros(len(frames), dtype=[(f"CAN_DataFrame.{name}", kind) for name, kind in fields])
    for row, one in zip(rows, frames, strict=True):
        size = len(one.data)
        data = np.frombuffer(one.data.ljust(width, b"\xaa"), np.uint8)
        cells = (one.bus, one.identifier, one.extended, one.way == "Tx", LENGTHS.index(size), size, data)
        for (name, _), value in zip(fields, cells, strict=True):
            row[f"CAN_DataFrame.{name}"] = value
    constants = []
    for name in constant:
        value = float(rows[f"CAN_DataFrame.{name}"][0])
        conversion = from_dict({"a": 0.0, "b": value})
        count = np.arange(len(frames), dtype=np.uint16)
        constants.append(asammdf.Signal(count, np.array([one.time for one in frames]), name=f"CAN_DataFrame.{name}",
                                        conversion=conversion))  # fmt: skip
    rows = rows[[name for name in rows.dtype.names or () if name.removeprefix("CAN_DataFrame.") not in constant]].copy()
    bus = Source("CAN", "CAN", "", source_type=v4c.SOURCE_BUS, bus_type=v4c.BUS_TYPE_CAN)
    times = np.array([one.time for one in frames])
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(rows, times, name="CAN_DataFrame", source=bus), *constants], acq_source=bus)
        file.groups[0].channel_group.flags |= v4c.FLAG_CG_BUS_EVENT | v4c.FLAG_CG_PLAIN_BUS_EVENT  # type: ignore[union-attr]
        file.save(path, overwrite=True)


def blf(path: Path, frames: Sequence[Frame]) -> None:
    """Write frames with python-can."""
    from can import BLFWriter, Message

    with BLFWriter(str(path)) as file:
        for one in frames:
            size = len(one.data)
            file.on_message_received(Message(
                timestamp=1.7e9 + one.time, arbitration_id=one.identifier, is_extended_id=one.extended, data=one.data,
                channel=one.bus - 1, is_rx=one.way == "Rx", is_fd=size > 8, dlc=size))  # fmt: skip


def dated(frames: Sequence[Frame]) -> str:
    """Return what `candump -x -t A` prints: the date and time of day of each frame."""
    lines = []
    for line in screen(frames).splitlines():
        stamp, rest = line.strip().removeprefix("(").split(")", 1)
        date = datetime.fromtimestamp(float(stamp), tz=UTC)
        lines.append(f" ({date:%Y-%m-%d %H:%M:%S}.{date.microsecond:06d}){rest}")
    return "\n".join(lines) + "\n"


CONTAINERS = {
    "candump.log": candump,
    "screen.log": screen,
    "dated.log": dated,
    "hex.asc": asc,
    "dec.asc": lambda frames: asc(frames, base="dec"),
    "relative.asc": lambda frames: asc(frames, times="relative"),
    "1.0.trc": lambda frames: trc(frames, "1.0"),
    "1.1.trc": lambda frames: trc(frames, "1.1"),
    "1.3.trc": lambda frames: trc(frames, "1.3"),
    "2.0.trc": lambda frames: trc(frames, "2.0"),
    "2.1.trc": lambda frames: trc(frames, "2.1"),
    "raw.mf4": mf4,
    "bus.blf": blf,
}
"""File name to function from frames to text; for MF4 and BLF, from path and frames."""


def write_log(folder: Path, name: str, frames: Sequence[Frame]) -> Path:
    """Write frames in a container of `CONTAINERS`."""
    path = folder / name
    if name.endswith((".mf4", ".blf")):
        (mf4 if name.endswith(".mf4") else blf)(path, frames)
    else:
        path.write_text(CONTAINERS[name](frames))  # type: ignore[operator]
    return path
