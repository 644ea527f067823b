"""Read text logs of a CAN bus (Vector .asc, PEAK .trc, candump) and decode their frames with a DBC database.

Sources: Vector, CAN ASC logging file format; PEAK, PCAN-View TRC file format; can-utils, `candump -l`.
"""

from __future__ import annotations

import io
import logging
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.records.channel import Channel, Measurement
from vehicle.signals.records.reader import extra
from vehicle.signals.records.signatures import can_log_type
from vehicle.signals.records.text import read_text

_BYTES = r"(?P<data>(?:\s+[0-9A-Fa-f]{2})*)"
_ASC = re.compile(
    r"\s*(?P<time>\d+\.\d+)\s+(?P<bus>\d+)\s+(?P<id>[0-9A-Fa-f]+)(?P<long>x?)\s+(?:Rx|Tx)\s+d\s+(?P<count>[0-9A-Fa-f]+)"
    + _BYTES
)
_DUMP = re.compile(r"\((?P<time>\d+\.\d+)\)\s+(?P<bus>\S+)\s+(?P<id>[0-9A-Fa-f]{3,8})#(?P<data>[0-9A-Fa-f.]*)(?:\s.*)?")
_TRC_1 = re.compile(
    r"\s*\d+\)\s+(?P<time>\d+(?:\.\d+)?)\s+(?:(?P<bus>\d+)\s+)?(?:(?:Rx|Tx)\s+)?(?P<id>[0-9A-Fa-f]{4,8})\s+(?:-\s+)?"
    r"(?P<count>\d+)" + _BYTES
)
_TRC_2 = re.compile(
    r"\s*\d+\s+(?P<time>\d+(?:\.\d+)?)\s+(?:DT|FD|FB|FE|BI)\s+(?:(?P<bus>\d+)\s+)?(?P<id>[0-9A-Fa-f]{4,8})\s+(?:Rx|Tx)\s+"
    r"(?:-\s+)?(?P<count>\d+)" + _BYTES
)
SHOWN = 6
"""Maximum number of identifiers in a message."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Frame:
    """Data frame of a CAN bus.

    Attributes:
        time: time of reception [s].
        identifier: arbitration ID of the message.
        extended: True for an identifier of 29 bits.
        data: payload bytes.
    """

    time: float
    identifier: int
    extended: bool
    data: bytes


def read(path: Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read a bus log and decode its frames into channels.

    Args:
        path: bus log.
        databases: DBC files.

    Raises:
        ConfigurationError: a database is missing or unreadable.
        DataError: no database, no frames, or no identifier of the log in the databases.
        MissingPartError: asammdf is not installed.
    """
    text = read_text(path)
    log_format = can_log_type(text.body[:4096])
    frames = list(_frames(log_format, text.lines))
    if not frames:
        raise DataError(f"{path}: log of a CAN bus ({log_format}) without data frames; record it again")
    if not databases:
        raise needs_database(path, log_format, [database.identifier for database in frames])
    loaded = [load_database(database) for database in databases]
    try:
        with quiet():
            channels = tuple(decoded(frames, loaded))
    except Exception as error:  # asammdf raises errors of any type for damaged databases
        raise DataError(
            f"{path}: {_names(databases)} cannot decode its frames ({error}); use another database"
        ) from None
    if not channels:
        raise none_decoded(path, [database.identifier for database in frames], databases)
    return Measurement(
        path=path,
        format=log_format,
        channels=channels,
        sha256=text.sha256,
        program=text.lines[0].strip(" ;")[:80],
        start=frames[0].time.__format__(".6f") + " s after 1970" if log_format == "candump" else "",
        notices=(*text.notices, f"log of a CAN bus: {len(frames)} frames, decoded by {_names(databases)}"),
    )


def _names(databases: Sequence[Path]) -> str:
    return ", ".join(database.name for database in databases)


def needs_database(path: Path, log_format: str, identifiers: Sequence[int]) -> DataError:
    """Return the error for a bus log that is read without a database.

    Args:
        path: bus log.
        log_format: name of the log format.
        identifiers: identifiers of its frames.
    """
    different = sorted(set(identifiers))
    shown = ", ".join(f"0x{identifier:X}" for identifier in different[:SHOWN]) + (
        "..." if len(different) > SHOWN else ""
    )
    return DataError(
        f"{path}: log of a CAN bus ({log_format}) with {len(identifiers)} frames of {len(different)} messages "
        f"({shown}), not channels; set --dbc FILE to the database of this bus"
    )


def none_decoded(path: Path, identifiers: Sequence[int], databases: Sequence[Path]) -> DataError:
    """Return the error for a bus log whose messages are missing from all databases.

    Args:
        path: bus log.
        identifiers: identifiers of its frames.
        databases: DBC files searched.
    """
    shown = ", ".join(f"0x{identifier:X}" for identifier in sorted(set(identifiers))[:SHOWN])
    return DataError(f"{path}: none of its messages ({shown}) is in {_names(databases)}; use the database of this bus")


def load_database(path: Path) -> Any:
    """Load a database of CAN messages.

    Args:
        path: DBC file, or another format of canmatrix.

    Raises:
        ConfigurationError: the file does not exist or contains no messages.
    """
    extra("asammdf", "mdf", "decoding a bus log")
    if not path.is_file():
        raise ConfigurationError(f"--dbc {path}: file not found; set the path of a database of CAN messages")
    from asammdf.blocks.utils import load_can_database

    try:
        with quiet():
            database = load_can_database(path)
    except Exception as error:  # asammdf raises errors of any type for damaged files
        raise ConfigurationError(f"--dbc {path}: cannot be read ({error}); use a DBC file") from None
    if database is None or not list(database.frames):
        raise ConfigurationError(f"--dbc {path}: contains no messages; use a DBC file")
    return database


@contextmanager
def quiet() -> Iterator[None]:
    """Suppress log records and prints of asammdf; callers raise one error instead."""
    logger = logging.getLogger("asammdf")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        with redirect_stdout(io.StringIO()):
            yield
    finally:
        logger.setLevel(level)


def decoded(frames: Sequence[Frame], databases: Sequence[Any]) -> Iterator[Channel]:
    """Yield the signals of all frames described by a database, each over the times of its message.

    Args:
        frames: frames of a log.
        databases: databases returned by `load_database`.
    """
    from asammdf.blocks.bus_logging_utils import extract_mux

    groups: dict[tuple[int, bool], list[Frame]] = {}
    for one in frames:
        groups.setdefault((one.identifier, one.extended), []).append(one)
    for (identifier, extended), group in groups.items():
        for database in databases:
            matches = [m for m in database.frames if m.arbitration_id.id == identifier
                     and bool(m.arbitration_id.extended) == extended]  # fmt: skip
            if not matches:
                continue
            size = max(matches[0].size, 1)
            complete = [one for one in group if len(one.data) >= size]
            if not complete:
                continue
            payload = np.frombuffer(b"".join(one.data[:size] for one in complete), np.uint8).reshape(-1, size)
            times = np.array([one.time for one in complete]) - frames[0].time
            decoded_groups = extract_mux(payload, matches[0], identifier, 0, times, ignore_value2text_conversion=True)
            for signals in decoded_groups.values():
                for name, signal in signals.items():
                    values = np.asarray(signal["samples"])
                    if values.dtype.kind in "fiub" and values.ndim == 1:
                        yield Channel(
                            name=name,
                            values=values.astype(np.float64),
                            unit=str(signal["unit"] or ""),
                            axis=np.asarray(signal["t"], dtype=np.float64),
                            place=f"{matches[0].name} 0x{identifier:X}",
                        )
            break


def _frames(log_format: str, lines: Sequence[str]) -> Iterator[Frame]:
    """Yield the data frames of a log; skip lines of other events."""
    base, relative, time = 16, False, 0.0
    new = any(line.startswith(";$FILEVERSION=2") for line in lines[:20])
    pattern = {"asc": _ASC, "candump": _DUMP}.get(log_format, _TRC_2 if new else _TRC_1)
    for line in lines:
        if log_format == "asc" and line.startswith("base"):
            base, relative = 10 if " dec" in line else 16, "relative" in line
        match = pattern.match(line)
        if match is None:
            continue
        stamp = float(match["time"]) * (1e-3 if log_format == "trc" else 1.0)
        time = time + stamp if relative else stamp
        digits = match["id"]
        extended = match["long"] == "x" if log_format == "asc" else len(digits) == 8
        text = re.sub(r"[\s.]", "", match["data"])
        if len(text) % 2:
            continue
        count = len(text) // 2 if log_format == "candump" else int(match["count"], 16 if log_format == "asc" else 10)
        data = bytes.fromhex(text) if base == 16 or log_format != "asc" else b""
        yield Frame(
            time=time, identifier=int(digits, base if log_format == "asc" else 16), extended=extended, data=data[:count]
        )
