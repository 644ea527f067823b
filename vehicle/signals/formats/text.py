"""Read text files: check size, encoding and line ends before parsing."""

import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from vehicle.errors import ConfigurationError, DataError

MEMORY_LIMIT = 2 * 1024**3
"""Maximum memory for reading a file [byte]."""

LARGEST = 1e30
"""Maximum value of a measurement in any unit; larger numbers indicate a damaged file or another byte order."""

BYTES_PER_ROW = 200
"""Memory per row in addition to its text [byte]: line and number objects, cells, and arrays."""

TEXT_COPIES = 4
"""Copies of the text that exist at the same time: bytes, string, lines, and lines with another decimal sign."""

LONGEST_LINE = 1_000_000
"""Maximum length of a line [byte]."""

BOM = b"\xef\xbb\xbf"


PIECE = 1_000_000
"""Number of characters split into lines at once: lines need four times the memory of their text."""


class Text(NamedTuple):
    """Content of a text file."""

    body: str
    """Whole text; lines end with a line feed only."""
    notices: tuple[str, ...]
    """Messages on unusual content that was accepted."""
    sha256: str
    """Hexadecimal digest of the bytes."""

    @property
    def lines(self) -> list[str]:
        """All lines without line ends; line number = index + 1."""
        return self.body.split("\n")

    def pieces(self) -> Iterator[tuple[int, list[str]]]:
        """Yield the lines in batches, each with the number of its first line."""
        begin, number = 0, 1
        while begin <= len(self.body):
            end = self.body.find("\n", begin + PIECE)
            lines = self.body[begin : end if end >= 0 else len(self.body)].split("\n")
            yield number, lines
            begin, number = end + 1 if end >= 0 else len(self.body) + 1, number + len(lines)


def read_text(path: Path) -> Text:
    """Read a UTF-8 file, or else Windows text (cp1252) with a notice; reject files before parsing that are no text.

    Memory needed = TEXT_COPIES * size + BYTES_PER_ROW * size / (mean length of the first rows).

    Raises:
        ConfigurationError: the file does not exist.
        DataError: empty, too large, NUL byte, a line above 1 MB, not readable.
    """
    if not path.is_file():
        raise ConfigurationError(f"{path}: the file does not exist; give the path of a CSV file")
    try:
        with path.open("rb") as file:
            size = path.stat().st_size
            head = file.read(LONGEST_LINE + 1)
            _check_bytes(path, head)
            _check_memory(path, size, head)
            data = head + file.read()
    except OSError as error:
        raise DataError(f"{path}: cannot be read ({error.strerror}); check the file and its permissions") from error
    if not data.strip():
        raise DataError(f"{path}: the file is empty; it needs a header line with units and one row per sample")
    _check_bytes(path, data)
    notices = []
    digest = hashlib.sha256(data).hexdigest()
    if data.startswith(BOM):
        notices.append("the byte order mark at the beginning of the file is skipped")
        data = data[len(BOM) :]
    if b"\r" in data:
        notices.append("line endings of Windows (CR LF) or old Macs (CR) are accepted")
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    try:
        body = data.decode("utf-8")
    except UnicodeDecodeError:
        notices.append("the text is not UTF-8; it is read as Windows text (cp1252)")
        body = data.decode("cp1252", "replace")
    text = Text(body=body, notices=tuple(notices), sha256=digest)
    for number, lines in text.pieces():
        longest = max(lines, key=len)
        if len(longest) > LONGEST_LINE:
            raise _line_too_long(path, number + lines.index(longest))
    return text


def _check_bytes(path: Path, data: bytes) -> None:
    """Reject UTF-16, NUL bytes and a too long first line; for the first megabyte and then the whole file."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise DataError(f"{path}:1:1: the file is UTF-16 but must be UTF-8; save it as UTF-8 text")
    nul = data.find(b"\0")
    if nul >= 0:
        raise DataError(
            f"{_place(path, data, nul)}: contains a NUL character, so it is binary or damaged; it must be UTF-8 text"
        )
    if len(data) == LONGEST_LINE + 1 and b"\n" not in data and b"\r" not in data:
        raise _line_too_long(path, 1)


def _check_memory(path: Path, size: int, head: bytes) -> None:
    rows = size * max(head.count(b"\n"), head.count(b"\r"), 1) / max(len(head), 1)
    needed = TEXT_COPIES * size + BYTES_PER_ROW * rows
    if needed > MEMORY_LIMIT:
        raise DataError(
            f"{path}: about {rows:.3g} rows in {size / 1e9:.3g} GB need {needed / 1024**3:.3g} GiB of memory but may "
            f"need at most {MEMORY_LIMIT / 1024**3:.3g} GiB; cut the record into parts or lower its sampling rate"
        )


def _place(path: Path, data: bytes, offset: int) -> str:
    line, column = data[:offset].count(b"\n") + 1, offset - data[:offset].rfind(b"\n")
    return f"{path}:{line}:{column}"


def _line_too_long(path: Path, line: int) -> DataError:
    return DataError(
        f"{path}:{line}: the line is longer than {LONGEST_LINE} characters; write one row per sample and check the "
        "line endings"
    )
