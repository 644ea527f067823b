"""Read text logs of a CAN bus (Vector .asc, PEAK .trc, candump) into data frames, and decode them with databases.

Every line is a data frame, a line of the header, or counted by its form: no line is dropped without a word. python-can
reads the same formats, but drops unknown lines silently and takes relative times of .asc as absolute times.

Sources: Vector, CAN ASC logging file format; PEAK, CAN TRC file format; can-utils, `candump -L`, `-t a` and `-t A`.
"""

import re
from collections import Counter
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from vehicle.errors import DataError
from vehicle.signals.formats.can_decoder import decode
from vehicle.signals.formats.can_frames import FD_LENGTHS, IDENTIFIER_BITS, Source, frames_of
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.signatures import DUMP_TIME, can_log_type
from vehicle.signals.formats.text import read_text

_ASC_TIME = re.compile(r"\s*(?P<time>\d+\.\d+)\s+(?P<event>\S.*)")
_ASC = re.compile(
    r"(?P<bus>\d+)\s+(?P<id>[0-9A-Fa-f]+)(?P<long>[xX]?)\s+(?P<way>Rx|Tx)\s+d\s+(?P<code>[0-9A-Fa-f]+)"
    r"(?P<data>(?:\s+[0-9A-Fa-f]{1,3}\b)*)"
)
_ASC_FD = re.compile(
    r"CANFD\s+(?P<bus>\d+)\s+(?P<way>Rx|Tx)\s+(?P<id>[0-9A-Fa-f]+)(?P<long>[xX]?)\s+(?:\S+\s+)??[01]\s+[01]\s+"
    r"(?P<code>[0-9A-Fa-f]+)\s+(?P<length>\d+)(?P<data>(?:\s+[0-9A-Fa-f]{1,3}\b)*)"
)
_DUMP = re.compile(
    rf"\s*\((?P<time>{DUMP_TIME})\)"
    r"\s+(?P<bus>\S+)\s+(?P<id>[0-9A-Fa-f]{8}|[0-9A-Fa-f]{3})#(?:#[0-9A-Fa-f])?"
    r"(?P<data>(?:[0-9A-Fa-f]{2}\.?)*)(?:\s+(?P<way>[RT])\S*)?\s*"
)
_SCREEN = re.compile(
    rf"\s*\((?P<time>{DUMP_TIME})\)"
    r"\s+(?P<bus>\S+)\s+(?:(?P<way>[RT])X\s\S\s\S\s+)?(?P<id>[0-9A-Fa-f]{8}|[0-9A-Fa-f]{3})\s+"
    r"\[(?P<length>\d+)\](?P<data>(?:\s+[0-9A-Fa-f]{2}\b)*)(?:\s+'.*')?\s*"
)
_TRC_1 = re.compile(
    r"\s*\d+\)\s+(?P<time>\d+(?:\.\d+)?)\s+(?:(?P<bus>\d{1,2})\s+)?(?:(?P<way>Rx|Tx)\s+)?(?P<id>[0-9A-Fa-f]{8}|[0-9A-Fa-f]{4})\s+"
    r"(?:-\s+)?(?P<length>\d+)(?P<data>(?:\s+[0-9A-Fa-f]{2}\b)*)\s*"
)
_ERROR_FLAG = 0x20000000
_REMOTE = re.compile(r"#R\d?\b|\b(Rx|Tx)\s+r\b|\bRTR\b|remote request|\s(RR)\s")


class _Row(NamedTuple):
    """Data frame in a line of a log: source, time [s], payload, and payload length by its header [byte]."""

    source: Source
    time: float
    data: bytes
    length: int


Parser = Callable[[str], "_Row | str"]
"""Function from a line to its data frame, the form of another line, or "" for a line of the header."""


def read(path: Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read a bus log and decode its frames into channels."""
    text = read_text(path)
    lines = text.lines
    log_format = can_log_type(text.body[:4096])
    parse = {"asc": _asc_parser, "trc": _trc_parser}[log_format](lines) if log_format != "candump" else _dump_row
    rows: dict[Source, list[tuple[float, bytes]]] = {}
    other: Counter[str] = Counter()
    first: float | None = None
    for line in lines:
        row = parse(line) if line.strip() else ""
        if isinstance(row, str):
            other[row] += 1
        elif len(row.data) < row.length:
            other["data frame with too few bytes"] += 1
        else:
            first = row.time if first is None else first
            rows.setdefault(row.source, []).append((row.time - first, row.data[: row.length]))
    del other[""]
    forms = ", ".join(f"{form!r} {count}" for form, count in other.most_common(8))
    if first is None:
        other_forms = f"; lines of other forms: {forms}" if forms else ""
        raise DataError(f"{path}: log of a CAN bus ({log_format}) without data frames{other_forms}; record it again")
    log = {source: frames_of(of_source) for source, of_source in rows.items()}
    channels, notices = decode(path, log_format, log, databases)
    left_out = (f"{sum(other.values())} lines without a data frame are left out: {forms}",) if forms else ()
    return Measurement(
        path=path,
        format=log_format,
        channels=channels,
        sha256=text.sha256,
        program=lines[0].strip(" ;")[:80],
        start=f"{first:.6f} s after 1970" if log_format == "candump" else "",
        notices=(*text.notices, *notices, *left_out),
    )


def _row(match: re.Match[str], bus: str, extended: bool, length: int | None, scale: float = 1.0) -> _Row | str:
    """Return the data frame of a line with hexadecimal identifier and bytes."""
    groups = match.groupdict()
    identifier = int(groups["id"], 16)
    if extended and identifier > IDENTIFIER_BITS:
        return "error frame" if identifier & _ERROR_FLAG else "identifier above 29 bits"
    data = bytes.fromhex(re.sub(r"[\s.]", "", groups["data"]))
    source = Source(bus, {"R": "Rx", "T": "Tx"}.get((groups["way"] or " ")[0], ""), identifier, extended)
    return _Row(source, _seconds(groups["time"]) * scale, data, len(data) if length is None else length)


def _seconds(text: str) -> float:
    """Return a time stamp [s]; a date and time of day, as `candump -t A` writes them, after 1970."""
    if text[4:5] != "-":
        return float(text)
    return datetime.fromisoformat(text).replace(tzinfo=UTC).timestamp()


def _form(line: str, default: str) -> str:
    """Return the form of a line without a data frame, for the count of lines by form."""
    if re.search(r"error ?frame", line, re.IGNORECASE):
        return "error frame"
    return "remote frame" if _REMOTE.search(line) else default


def _dump_row(line: str) -> _Row | str:
    """Return the frame of a line of candump."""
    match = _DUMP.fullmatch(line) or _SCREEN.fullmatch(line)
    if match is None:
        return _form(line, line.strip()[:24])
    length = int(match["length"]) if "length" in match.groupdict() else None
    return _row(match, match["bus"], len(match["id"]) == 8, length)


def _asc_parser(lines: Sequence[str]) -> Parser:
    """Return the parser of Vector .asc; relative times count from the previous line of any event."""
    head = next((line.lower() for line in lines if line.lower().startswith("base")), "")
    base, relative = 10 if " dec" in head else 16, "relative" in head
    clock = 0.0

    def parse(line: str) -> _Row | str:
        nonlocal clock
        event = _ASC_TIME.fullmatch(line)
        if event is None:
            return "" if not line.strip()[:1].isdigit() else _form(line, "line without a time")
        clock = clock * relative + float(event["time"])
        match = _ASC.match(event["event"]) or _ASC_FD.match(event["event"])
        if match is None:
            keywords = [word for word in event["event"].split() if not word[0].isdigit()]
            if "Start" in keywords[:2]:
                return ""  # start of the measurement, in the language of the program
            symbolic = re.match(r"(CANFD\s+)?\d+\s+\w+\s+(Rx|Tx)\s+(d|[01])\s", event["event"])
            return _form(line, "frame with a symbolic name" if symbolic else keywords[0] if keywords else "numbers")
        try:
            identifier = int(match["id"], base)
            data = bytes(int(byte, base) for byte in match["data"].split())
        except ValueError:
            return f"a number that is not written to base {base}"
        code = int(match["code"], 16)
        length = int(match["length"]) if "length" in match.groupdict() else min(code, 8)
        source = Source(f"CAN{match['bus']}", match["way"], identifier, bool(match["long"]))
        return _Row(source, clock, data, length)

    return parse


def _trc_parser(lines: Sequence[str]) -> Parser:
    """Return the parser of PEAK .trc: the columns of version 2 are named in its header."""
    head = [line for line in lines[:100] if line.startswith(";$")]
    version = next((line.partition("=")[2].strip() for line in head if line.startswith(";$FILEVERSION")), "1.0")
    if not version.startswith("2"):
        return _trc_1_row
    usual = "N,O,T,I,d,l,D" if version == "2.0" else "N,O,T,B,I,d,R,l,D"
    named = next((line.partition("=")[2].strip() for line in head if line.startswith(";$COLUMNS")), usual)
    columns = named.split(",")

    def parse(line: str) -> _Row | str:
        if line.lstrip().startswith(";"):
            return ""
        cells = dict(zip(columns, line.split(None, len(columns) - 1), strict=False))
        frame_type = cells.get("T", "")
        if frame_type not in ("DT", "FD", "FB", "FE", "BI"):
            return "remote frame" if frame_type == "RR" else f"type {frame_type}"
        try:
            length = int(cells["l"]) if "l" in cells else FD_LENGTHS[int(cells["L"])]
            length = min(length, 8) if frame_type == "DT" else length
            identifier = int(cells["I"], 16)
            data = bytes.fromhex(cells.get("D", ""))
            time = 1e-3 * float(cells["O"])
        except (KeyError, ValueError, IndexError):
            return "damaged line"
        bus = f"CAN{cells['B']}" if "B" in cells else ""
        return _Row(Source(bus, cells.get("d", ""), identifier, len(cells["I"]) == 8), time, data, length)

    return parse


def _trc_1_row(line: str) -> _Row | str:
    """Return the frame of a line of .trc of version 1."""
    if line.lstrip().startswith(";"):
        return ""
    if "FFFFFFFF" in line:
        return "bus status"
    match = _TRC_1.fullmatch(line)
    if match is None:
        keywords = [word for word in line.split() if word[0].isalpha()]
        return _form(line, keywords[0] if keywords else "numbers")
    bus = f"CAN{match['bus']}" if match["bus"] else ""
    return _row(match, bus, len(match["id"]) == 8, min(int(match["length"]), 8), 1e-3)
