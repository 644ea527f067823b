"""Decode the data frames of CAN buses with DBC databases: one decoder for every container of frames.

A signal is x = factor * raw + offset, raw an integer of given position, size and byte order in the payload (Vector, DBC
file format). The bits are extracted here: asammdf loses the sign of signals that are not aligned to bytes, takes
the raw value of a signal with a value table, and pads short frames with 0xFF. canmatrix reads the databases.
"""

import io
import logging
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehicle.arrays import Mask
from vehicle.errors import ConfigurationError, DataError
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.formats.can_frames import BusLog, Frames, Source
from vehicle.signals.formats.channel import Channel
from vehicle.signals.formats.optional_library import extra

SHOWN = 6
"""Maximum number of identifiers in a message."""

WIDEST = 64
"""Maximum size of a number in a payload [bit]."""

NULL_ADDRESS = 0xFE
"""Source address in a database for a J1939 message of any source."""

HIGHEST_VALID = {
    4: 0xA,
    8: 0xFA,
    10: 0x3FA,
    12: 0xFAF,
    16: 0xFAFF,
    20: 0xFAFFF,
    24: 0xFAFFFF,
    28: 0xFAFFFFF,
    32: 0xFAFFFFFF,
}
"""Highest valid raw value of a J1939 signal by size [bit]; higher values are error codes (SAE J1939-71, table 1)."""

NO_VALUE = re.compile(
    r"\bsna\b|\bsnv\b|\bn/?a\b|not ?avail|not ?valid|unavail|invalid|undefined"
    r"|(?<!no )(error|fault)|no ?(data|signal|value)|(?<!kein )fehler|ung(ue|ü)ltig|nicht ?verf"
)
"""Names in value tables that state that there is no measured value."""


def load_database(path: Path) -> Any:
    """Load a database of CAN messages: DBC, or another format of canmatrix."""
    extra("asammdf", "mdf", "decoding a bus log")
    if not path.is_file():
        raise ConfigurationError(f"--dbc {path}: file not found; give the path of a database of CAN messages")
    from asammdf.blocks.utils import load_can_database

    try:
        with quiet():
            database = load_can_database(path)
    except Exception as error:  # canmatrix raises errors of any type for damaged files
        raise ConfigurationError(f"--dbc {path}: cannot be read ({error}); use a DBC file") from None
    if database is None or not list(database.frames):
        raise ConfigurationError(f"--dbc {path}: contains no messages; use a DBC file")
    return database


@contextmanager
def quiet() -> Iterator[None]:
    """Suppress log records and prints of asammdf and canmatrix; callers raise one error instead."""
    loggers = [logging.getLogger(name) for name in ("asammdf", "canmatrix")]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        with redirect_stdout(io.StringIO()):
            yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


def decode(
    path: Path, container: str, log: BusLog, databases: Sequence[Path]
) -> tuple[tuple[Channel, ...], tuple[str, ...]]:
    """Convert the frames of a log into channels, each over the times of its message.

    Messages are selected by identifier, else by PGN if the database describes them as J1939. Frames of one message from
    several buses, directions or identifiers are different channels, whose names state what differs.

    Args:
        databases: DBC files; the first that describes a message decodes it.

    Returns:
        Channels, and notices on decoded and other frames.

    Raises:
        ConfigurationError: a database is missing or unreadable.
        DataError: no database, or no message of the log is in the databases.
        MissingPartError: asammdf is not installed.
    """
    frame_count, names = sum(frames.time.size for frames in log.values()), ", ".join(file.name for file in databases)
    if not databases:
        raise DataError(
            f"{path}: log of a CAN bus ({container}) with {frame_count} raw frames of {len(_identifiers(log))} "
            f"messages ({_shown(log)}); set --dbc FILE, the database that decodes them into channels"
        )
    loaded = [load_database(database) for database in databases]
    messages = {source: message for source in log if (message := _message(source, loaded)) is not None}
    if not messages:
        raise DataError(f"{path}: {names} describes none of the messages of the log ({_shown(log)}); use the right one")
    channels: list[Channel] = []
    missing: Counter[str] = Counter()
    try:
        for source, (message, j1939) in messages.items():
            same = [other for other, (of_other, _) in messages.items() if of_other is message]
            channels += _signals(source, log[source], message, j1939, _difference(source, same), missing)
    except Exception as error:  # damaged databases describe impossible signals
        raise DataError(f"{path}: the frames cannot be decoded with {names} ({error}); use another database") from None
    undecoded = {source: frames for source, frames in log.items() if source not in messages}
    decoded = frame_count - sum(frames.time.size for frames in undecoded.values())
    notices = [f"log of a CAN bus: {frame_count} frames, {decoded} decoded by {names}"]
    if undecoded:
        notices.append(
            f"{names} does not describe {frame_count - decoded} frames of {len(_identifiers(undecoded))} "
            f"messages, which are left out: {_shown(undecoded)}"
        )
    notices += [f"{text}: {count}" for text, count in missing.items()]
    return tuple(channels), tuple(notices)


def _identifiers(log: BusLog) -> list[int]:
    return sorted({source.identifier for source in log})


def _shown(log: BusLog) -> str:
    identifiers = _identifiers(log)
    return ", ".join(f"0x{identifier:X}" for identifier in identifiers[:SHOWN]) + ("..." if identifiers[SHOWN:] else "")


def _message(source: Source, databases: Sequence[Any]) -> tuple[Any, bool] | None:
    """Return the message of a source and True for J1939: by identifier, else by PGN; None without a unique message.

    Of several messages of a PGN, that for any source address is taken.
    """
    frames = []
    for database in databases:
        of_bus = str(database.attributes.get("ProtocolType", "")).lower() == "j1939"
        frames += [(f, bool(f.arbitration_id.extended) and (bool(f.is_j1939) or of_bus)) for f in database.frames]
    for frame, j1939 in frames:
        if (frame.arbitration_id.id, bool(frame.arbitration_id.extended)) == (source.identifier, source.extended):
            return frame, j1939
    if not source.extended:
        return None
    group = [
        frame for frame, j1939 in frames if j1939 and frame.arbitration_id.pgn == parameter_group(source.identifier)
    ]
    any_source = [frame for frame in group if frame.arbitration_id.j1939_source == NULL_ADDRESS]
    return next(((candidates[0], True) for candidates in (any_source, group) if len(candidates) == 1), None)


def parameter_group(identifier: int) -> int:
    """Return the PGN of a J1939 identifier: without priority, source and, for PDU format below 240, destination."""
    group = identifier >> 8 & 0x3FFFF
    return group if group >> 8 & 0xFF >= 240 else group & 0x3FF00


def _difference(source: Source, same: Sequence[Source]) -> str:
    """Return what distinguishes a source from others of the same message: bus, direction, identifier."""
    parts = (source.bus, source.direction, f"0x{source.identifier:X}")
    several = [len({other[n] for other in same}) > 1 for n in range(3)]
    return " ".join(part or "?" for part, differs in zip(parts, several, strict=True) if differs)


def _signals(
    source: Source, frames: Frames, message: Any, j1939: bool, suffix: str, missing: Counter[str]
) -> Iterator[Channel]:
    """Yield the signals of a message; count the values that are missing by reason."""
    for signal in message.signals:
        label = f"{message.name}.{signal.name}"
        if signal.size > WIDEST:
            missing[f"signals wider than {WIDEST} bits are left out, such as {label}"] += 1
            continue
        rows = _rows(signal, message, frames)
        if signal.mux_val is None and not rows.all():
            missing[f"frames of {message.name} too short for {signal.name}"] += int(np.count_nonzero(~rows))
        if not rows.any():
            continue
        raw = raw_values(signal, frames.payload[rows])
        values = raw * float(signal.factor) + float(signal.offset)
        for reason, where in _without_value(signal, raw, values, j1939).items():
            missing[f"{label}: values {reason} are read as missing"] += int(np.count_nonzero(where))
            values[where] = np.nan
        yield Channel(
            name=f"{signal.name} {suffix}".rstrip(),
            values=values,
            unit=str(signal.unit or ""),
            axis=frames.time if rows.all() else frames.time[rows],
            place=f"{message.name} 0x{source.identifier:X}",
        )


def _rows(signal: Any, message: Any, frames: Frames) -> Mask:
    """Return which frames contain a signal, (n,): long enough, and the multiplexer selects the signal."""
    first, size = _first_bit(signal), signal.size
    inside: Mask = frames.length >= -(-(first + size) // 8)
    name = signal.muxer_for_signal
    if name is None and signal.mux_val is not None:
        name = next((other.name for other in message.signals if other.is_multiplexer and other.mux_val is None), None)
    selector = next((other for other in message.signals if other.name == name and other is not signal), None)
    if selector is None or not inside.any():
        return inside
    selected = _rows(selector, message, frames)
    inside &= selected
    raw = np.zeros(inside.size)
    raw[selected] = raw_values(selector, frames.payload[selected])
    ranges = signal.mux_val_grp or [(signal.mux_val, signal.mux_val)]
    inside &= np.any([(low <= raw) & (raw <= high) for low, high in ranges], axis=0)
    return inside


def _first_bit(signal: Any) -> int:
    """Return the number of the first bit, counted from the least (Intel) or most (Motorola) significant of a byte."""
    start = signal.get_startbit(bit_numbering=1)
    return int(start if signal.is_little_endian else start - start % 8 + 7 - start % 8)


def raw_values(signal: Any, payload: NDArray[np.uint8]) -> NDArray[Any]:
    """Return the raw numbers of a signal, (n,), from payloads, (n, width), that contain it.

    Args:
        signal: signal of a database, of at most `WIDEST` bits.
    """
    first, size = _first_bit(signal), signal.size
    begin, end = first // 8, -(-(first + size) // 8)
    bits = np.unpackbits(payload[:, begin:end], axis=1, bitorder="little" if signal.is_little_endian else "big")
    bits = bits[:, first - 8 * begin :][:, :size]
    if not signal.is_little_endian:
        bits = bits[:, ::-1]
    padded = np.zeros((len(payload), 8), dtype=np.uint8)
    packed = np.packbits(bits, axis=1, bitorder="little")
    padded[:, : packed.shape[1]] = packed
    if signal.is_float:
        return padded.view(f"<f{size // 8}")[:, 0].astype(np.float64)
    numbers = padded.view("<u8")[:, 0]
    if not signal.is_signed:
        return numbers
    return (numbers << np.uint64(WIDEST - size)).view(np.int64) >> np.int64(WIDEST - size)


def _without_value(signal: Any, raw: NDArray[Any], values: Vector, j1939: bool) -> dict[str, Mask]:
    """Return the raw values that are no measured values, by reason, with their frames, (n,).

    A value table names raw values; it does not replace factor and offset. A named value of a measured quantity
    (with a unit or a factor) is missing if its name matches `NO_VALUE`, or if it is outside the stated range.
    """
    if not signal.unit and float(signal.factor) == 1.0 and float(signal.offset) == 0.0:
        return {}  # a state, whose numbers are its values
    reasons: dict[str, Mask] = {}
    for key, text in signal.values.items():
        value = float(key) * float(signal.factor) + float(signal.offset)
        spaced = re.sub(r"(?<=[a-z])(?=[A-Z])|_", " ", str(text)).lower()
        if NO_VALUE.search(spaced) or _outside(signal, value):
            reasons[f"named {text!r}"] = raw == float(key)
    size = next((size for size in HIGHEST_VALID if signal.size <= size), 0)
    if j1939 and size and not signal.is_float and not signal.is_signed:
        reasons["above the valid range of J1939"] = (raw > HIGHEST_VALID[size]) & np.isfinite(values)
    return {reason: where for reason, where in reasons.items() if where.any()}


def _outside(signal: Any, value: float) -> bool:
    """Return True for a value outside the range in the database; [0|0] is none."""
    if signal.min is None or signal.max is None or not signal.min < signal.max:
        return False
    return not float(signal.min) <= value <= float(signal.max)
