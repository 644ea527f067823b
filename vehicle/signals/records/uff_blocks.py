"""Datasets of a universal file: where they begin and end, their texts, whole numbers and numbers."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple, NoReturn

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.table import Vector
from vehicle.signals.records.text import LARGEST

END = re.compile(rb"\r?\n {0,4}-1[ ]*(?:\r?\n|$)")
BEGIN = re.compile(rb"(?:^|\n) {0,4}-1[ ]*\r?\n[ ]*(\d+)(b?)([^\n]*)\n")
D_EXPONENT = re.compile(rb"(?<=[\d.])[dD](?=[+-]?\d)")
_NUMBER = re.compile(rb"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


class Block(NamedTuple):
    """A dataset: its number, whether it is binary, the rest of its first line, and where its second line begins."""

    number: int
    binary: bool
    first: bytes
    start: int


def text_of(line: bytes) -> str:
    """A line; a byte that is no UTF-8 is Windows text; NONE is empty."""
    found = raw_text(line).strip(" \r\n\0")
    return "" if found.upper() == "NONE" else found


def raw_text(line: bytes) -> str:
    """A line with the blanks at its beginning."""
    try:
        return line.decode("utf-8").rstrip("\r\n")
    except UnicodeDecodeError:
        return line.decode("cp1252", "replace").rstrip("\r\n")


def cells(line: bytes, widths: tuple[int, ...]) -> list[str]:
    """Cells of fixed widths; blanks that were cut off are blanks."""
    text, found, start = raw_text(line), [], 0
    for width in widths:
        cell = text[start : start + width].strip()
        found.append("" if cell.upper() == "NONE" else cell)
        start += width
    return found


def wholes(line: bytes) -> list[int]:
    """Whole numbers of a line, between blanks, or in ten columns each where they stand against each other.

    Raises:
        ValueError: it holds something else.
    """
    parts = line.split()
    if any(len(part) > 10 for part in parts):
        parts = [cell.encode() for cell in cells(line, (10,) * (len(line.rstrip()) // 10 + 1)) if cell]
    return [int(part) for part in parts]


def numbers(lines: list[bytes]) -> list[float]:
    """Numbers of lines, which may stand against each other: 1.0E+00-2.0E+00.

    Raises:
        ValueError: there is something else among them.
    """
    body = D_EXPONENT.sub(b"E", b" ".join(lines))
    if _NUMBER.sub(b"", body).strip():
        raise ValueError(f"no number in {raw_text(_NUMBER.sub(b'', body)).strip()[:20]!r}")
    return [float(part) for part in _NUMBER.findall(body)]


def check_values(path: Path, where: str, values: Vector) -> None:
    """Refuse what no sensor says: numbers of the other byte order are not finite, or beyond `LARGEST`."""
    if not np.isfinite(values).all() or (values.size and float(np.abs(values).max()) > LARGEST):
        raise DataError(
            f"{path}: {where} holds numbers that are not finite, or beyond {LARGEST:g}; is its byte order wrong? "
            "export it again, or as text (UFF 58)"
        )


def refuse(path: Path, where: str, error: Exception) -> NoReturn:
    """The sentence for a dataset whose lines do not fit its format."""
    text = str(error) if not isinstance(error, (IndexError, KeyError)) else "a line is missing or too short"
    raise DataError(
        f"{path}: {where} is no such dataset ({text}); it was cut off or damaged; export it again"
    ) from None
