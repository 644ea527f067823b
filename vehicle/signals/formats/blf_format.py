"""Read logs of a CAN bus in BLF, the binary form of Vector: python-can reads the frames, this program decodes them.

python-can skips objects of unknown types, and stops at the end of a truncated file. Here warnings of it, bytes that
it leaves, and a size other than that in the header refuse the file, and frames without data are counted.

Source: Vector, BLF (binlog); python-can, `can/io/blf.py`.
"""

import logging
from collections import Counter
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from vehicle.errors import DataError
from vehicle.signals.formats.can_decoder import decode
from vehicle.signals.formats.can_frames import Source, frames_of
from vehicle.signals.formats.channel import Measurement
from vehicle.signals.formats.optional_library import extra, reading
from vehicle.signals.formats.unpacked_size import require_unpacked

RECORD = "record it again, or convert it in the program that wrote it"
"""Remedy for a damaged log."""


class _Warnings(logging.Handler):
    """Messages of the library on parts of the file that it leaves out."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.texts.append(record.getMessage())


def read(path: Path, databases: Sequence[Path] = ()) -> Measurement:
    """Read a bus log and decode its frames into channels."""
    extra("can", "can", "a CAN log in BLF")
    module = import_module("can.io.blf")
    rows: dict[Source, list[tuple[float, bytes]]] = {}
    other: Counter[str] = Counter()
    warned, logger = _Warnings(), logging.getLogger("can")
    logger.addHandler(warned)
    first: float | None = None
    try:
        with reading(path, "BLF", RECORD), module.BLFReader(str(path)) as file:
            size = path.stat().st_size
            if file.file_size not in (0, size):
                raise DataError(f"{path}: {size} bytes, its header states {file.file_size}: truncated; {RECORD}")
            require_unpacked(path, float(file.uncompressed_size), size)
            started = float(file.start_timestamp)
            for message in file:
                if message.is_error_frame or message.is_remote_frame:
                    other["error frame" if message.is_error_frame else "remote frame"] += 1
                    continue
                if not message.is_fd and len(message.data) < message.dlc:
                    other["data frame with too few bytes"] += 1
                    continue
                first = message.timestamp if first is None else first
                way = "Rx" if message.is_rx else "Tx"
                source = Source(f"CAN{message.channel + 1}", way, message.arbitration_id, message.is_extended_id)
                rows.setdefault(source, []).append((message.timestamp - first, bytes(message.data)))
            left = len(getattr(file, "_tail", b""))
    finally:
        logger.removeHandler(warned)
    if warned.texts or left >= 16:
        raise DataError(
            f"{path}: {warned.texts[0] if warned.texts else f'{left} bytes at its end are not a whole object'}; "
            f"{RECORD}"
        )
    forms = ", ".join(f"{form!r} {count}" for form, count in other.most_common())
    if first is None:
        raise DataError(f"{path}: log of a CAN bus (blf) without data frames{f'; {forms}' if forms else ''}; {RECORD}")
    channels, notices = decode(
        path, "blf", {source: frames_of(of_source) for source, of_source in rows.items()}, databases
    )
    left_out = (f"{sum(other.values())} objects without data are left out: {forms}",) if forms else ()
    return Measurement(
        path=path,
        format="blf",
        channels=channels,
        start=f"{started + (first - started):.6f} s after 1970",
        notices=(*notices, *left_out),
    )
