"""Logs of a CAN bus as text (Vector .asc, PEAK .trc, candump): frames, which a database (.dbc) decodes into channels.

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
    """A frame of a bus.

    Attributes:
        time: of its reception [s].
        identifier: of the message.
        extended: True for an identifier of 29 bits.
        data: payload.
    """

    time: float
    identifier: int
    extended: bool
    data: bytes


def read(path: Path, databases: Sequence[Path] = ()) -> Measurement:
    """Decode the frames of a log into the signals of databases.

    Args:
        path: the log.
        databases: files of the form DBC.

    Raises:
        ConfigurationError: a database that is not there or cannot be read.
        DataError: no database is given, no frames, or none of the identifiers is in the databases.
        MissingPartError: asammdf is not installed.
    """
    text = read_text(path, western=True)
    form = can_log_type(text.body[:4096])
    frames = list(_frames(form, text.lines))
    if not frames:
        raise DataError(f"{path}: is a log of a CAN bus ({form}) without frames of data; record it again")
    if not databases:
        raise needs_database(path, form, [one.identifier for one in frames])
    loaded = [load_database(one) for one in databases]
    try:
        with quiet():
            channels = tuple(decoded(frames, loaded))
    except Exception as error:  # damaged databases raise what they like
        raise DataError(f"{path}: {_names(databases)} does not decode its frames ({error}); give another") from None
    if not channels:
        raise none_decoded(path, [one.identifier for one in frames], databases)
    return Measurement(
        path=path,
        format=form,
        channels=channels,
        sha256=text.sha256,
        program=text.lines[0].strip(" ;")[:80],
        start=frames[0].time.__format__(".6f") + " s after 1970" if form == "candump" else "",
        notices=(*text.notices, f"log of a CAN bus: {len(frames)} frames, decoded by {_names(databases)}"),
    )


def _names(databases: Sequence[Path]) -> str:
    return ", ".join(one.name for one in databases)


def needs_database(path: Path, form: str, identifiers: Sequence[int]) -> DataError:
    """Return the refusal of a bus log that no database decodes.

    Args:
        path: the log.
        form: of the file, in words.
        identifiers: of its frames.
    """
    different = sorted(set(identifiers))
    shown = ", ".join(f"0x{one:X}" for one in different[:SHOWN]) + ("..." if len(different) > SHOWN else "")
    return DataError(
        f"{path}: is a log of a CAN bus ({form}) with {len(identifiers)} frames of {len(different)} messages "
        f"({shown}), no channels; give --dbc FILE with the database that decodes them"
    )


def none_decoded(path: Path, identifiers: Sequence[int], databases: Sequence[Path]) -> DataError:
    """Return the refusal of a bus log whose messages are in no database.

    Args:
        path: the log.
        identifiers: of its frames.
        databases: that were given.
    """
    shown = ", ".join(f"0x{one:X}" for one in sorted(set(identifiers))[:SHOWN])
    return DataError(f"{path}: none of its messages ({shown}) is in {_names(databases)}; give the database of this bus")


def load_database(path: Path) -> Any:
    """Load a database of messages.

    Args:
        path: a file of the form DBC, or another form of canmatrix.

    Raises:
        ConfigurationError: there is no such file, or it holds no messages.
    """
    extra("asammdf", "mdf", "decoding a bus log")
    if not path.is_file():
        raise ConfigurationError(f"--dbc {path}: no such file; give the path of a database of CAN messages")
    from asammdf.blocks.utils import load_can_database

    try:
        with quiet():
            found = load_can_database(path)
    except Exception as error:  # damaged files raise what they like
        raise ConfigurationError(f"--dbc {path}: cannot be read ({error}); give a DBC file") from None
    if found is None or not list(found.frames):
        raise ConfigurationError(f"--dbc {path}: holds no messages; give a DBC file")
    return found


@contextmanager
def quiet() -> Iterator[None]:
    """Keep the library from logging and printing: what is wrong becomes one message."""
    logger = logging.getLogger("asammdf")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        with redirect_stdout(io.StringIO()):
            yield
    finally:
        logger.setLevel(level)


def decoded(frames: Sequence[Frame], databases: Sequence[Any]) -> Iterator[Channel]:
    """Yield the signals of all frames that a database describes, each over the times of its message.

    Args:
        frames: of a log.
        databases: see `load_database`.
    """
    from asammdf.blocks.bus_logging_utils import extract_mux

    groups: dict[tuple[int, bool], list[Frame]] = {}
    for one in frames:
        groups.setdefault((one.identifier, one.extended), []).append(one)
    for (identifier, extended), held in groups.items():
        for database in databases:
            match = [m for m in database.frames if m.arbitration_id.id == identifier
                     and bool(m.arbitration_id.extended) == extended]  # fmt: skip
            if not match:
                continue
            size = max(match[0].size, 1)
            kept = [one for one in held if len(one.data) >= size]
            if not kept:
                continue
            payload = np.frombuffer(b"".join(one.data[:size] for one in kept), np.uint8).reshape(-1, size)
            times = np.array([one.time for one in kept]) - frames[0].time
            found = extract_mux(payload, match[0], identifier, 0, times, ignore_value2text_conversion=True)
            for signals in found.values():
                for name, signal in signals.items():
                    values = np.asarray(signal["samples"])
                    if values.dtype.kind in "fiub" and values.ndim == 1:
                        yield Channel(
                            name=name,
                            values=values.astype(np.float64),
                            unit=str(signal["unit"] or ""),
                            axis=np.asarray(signal["t"], dtype=np.float64),
                            place=f"{match[0].name} 0x{identifier:X}",
                        )
            break


def _frames(form: str, lines: Sequence[str]) -> Iterator[Frame]:
    """Frames of data of a log; lines of other events are passed over."""
    base, relative, time = 16, False, 0.0
    new = any(line.startswith(";$FILEVERSION=2") for line in lines[:20])
    pattern = {"asc": _ASC, "candump": _DUMP}.get(form, _TRC_2 if new else _TRC_1)
    for line in lines:
        if form == "asc" and line.startswith("base"):
            base, relative = 10 if " dec" in line else 16, "relative" in line
        match = pattern.match(line)
        if match is None:
            continue
        stamp = float(match["time"]) * (1e-3 if form == "trc" else 1.0)
        time = time + stamp if relative else stamp
        digits = match["id"]
        extended = match["long"] == "x" if form == "asc" else len(digits) == 8
        text = re.sub(r"[\s.]", "", match["data"])
        if len(text) % 2:
            continue
        count = len(text) // 2 if form == "candump" else int(match["count"], 16 if form == "asc" else 10)
        data = bytes.fromhex(text) if base == 16 or form != "asc" else b""
        yield Frame(
            time=time, identifier=int(digits, base if form == "asc" else 16), extended=extended, data=data[:count]
        )
