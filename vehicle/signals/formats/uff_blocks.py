"""Parse the datasets of a universal file: begin and end, texts, integers and real numbers."""

import re
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.text import LARGEST

END = re.compile(rb"\r?\n {0,4}-1[ ]*(?:\r?\n|$)")
BEGIN = re.compile(rb"(?:^|\n) {0,4}-1[ ]*\r?\n[ ]*(\d+)(b?)([^\n]*)\n")
D_EXPONENT = re.compile(rb"(?<=[\d.])[dD](?=[+-]?\d)")
_NUMBER = re.compile(rb"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


class Block(NamedTuple):
    """Dataset: number, True if binary, rest of the first line, and byte position of the second line."""

    number: int
    binary: bool
    first: bytes
    start: int


def text_of(line: bytes) -> str:
    """Decode a line as UTF-8 or else Windows text, and strip blanks; NONE becomes an empty text."""
    text = raw_text(line).strip(" \r\n\0")
    return "" if text.upper() == "NONE" else text


def raw_text(line: bytes) -> str:
    """Decode a line as UTF-8 or else Windows text; keep leading blanks."""
    try:
        return line.decode("utf-8").rstrip("\r\n")
    except UnicodeDecodeError:
        return line.decode("cp1252", "replace").rstrip("\r\n")


def cells(line: bytes, widths: tuple[int, ...]) -> list[str]:
    """Split a line into cells of fixed widths; cells beyond the end of the line are empty."""
    text, fields, start = raw_text(line), [], 0
    for width in widths:
        cell = text[start : start + width].strip()
        fields.append("" if cell.upper() == "NONE" else cell)
        start += width
    return fields


def wholes(line: bytes) -> list[int]:
    """Parse the integers of a line, separated by blanks, or in fields of ten characters without blanks."""
    parts = line.split()
    if any(len(part) > 10 for part in parts):
        parts = [cell.encode() for cell in cells(line, (10,) * (len(line.rstrip()) // 10 + 1)) if cell]
    return [int(part) for part in parts]


def numbers(lines: list[bytes]) -> list[float]:
    """Parse the numbers of lines, with or without blanks between numbers: 1.0E+00-2.0E+00."""
    body = D_EXPONENT.sub(b"E", b" ".join(lines))
    if _NUMBER.sub(b"", body).strip():
        raise ValueError(f"{raw_text(_NUMBER.sub(b'', body)).strip()[:20]!r} is not a number")
    return [float(part) for part in _NUMBER.findall(body)]


def check_values(path: Path, where: str, values: Vector) -> None:
    """Reject numbers that are not finite or above `LARGEST`, as results from a wrong byte order."""
    if not np.isfinite(values).all() or (values.size and float(np.abs(values).max()) > LARGEST):
        raise DataError(
            f"{path}: {where} contains numbers that are not finite or above {LARGEST:g}; is the byte order "
            "wrong? export it again, or as text (UFF 58)"
        )


def refuse(path: Path, where: str, error: Exception) -> NoReturn:
    """Raise the error for a dataset whose lines do not match its format."""
    text = str(error) if not isinstance(error, (IndexError, KeyError)) else "a line is missing or too short"
    raise DataError(
        f"{path}: {where} does not match the format that it states ({text}); it is truncated or damaged; "
        "export it again"
    ) from None
