"""ERD files of road profilers (UMTRI): a header of text lines, then one row of numbers for each sample."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement, uniform_axis
from vehicle.signals.records.text import read_text
from vehicle.signals.records.units import find_unit

TEXT = 5
"""Key of numbers that are written as text."""

FIELD = 8
"""Length of a name or a unit in the lines SHORTNAM and UNITSNAM, and of the keyword before it [characters]."""

CONTINUED = "&1000"
"""Begins a line that continues the one above."""


def read(path: Path) -> Measurement:
    """Read a road profile: channels over the distance.

    The second line holds NCHAN, NSAMP, NRECS, NBYTES, KEYNUM and STEP: channels, samples (-1: open), layout of binary
    data, kind of numbers, and the distance of the samples in XUNITS.

    Args:
        path: the file, whose first line begins with ERDFILEV.

    Raises:
        DataError: a damaged header or table, binary numbers, or a unit of the distance that is not known.

    Source: UMTRI, The ERD File Specification; headers of LTPP profiles.
    """
    text = read_text(path, western=True)
    lines = text.lines
    end = next((n for n, line in enumerate(lines[:400]) if line.strip().upper() == "END"), None)
    if end is None or end < 2:
        raise DataError(f"{path}: no line END behind the header; needed is a complete ERD file")
    cells = [cell.strip() for cell in lines[1].replace(",", " ").split()]
    try:
        count, samples, kind, step = int(cells[0]), int(cells[1]), int(cells[4]), float(cells[5])
    except (IndexError, ValueError):
        raise DataError(f"{path}:2: needed are NCHAN, NSAMP, NRECS, NBYTES, KEYNUM, STEP; found {lines[1]!r}") from None
    if kind != TEXT:
        raise DataError(f"{path}:2: binary numbers (KEYNUM {kind}), which are not read; export the profile as text ERD")
    if count < 1 or step <= 0.0:
        raise DataError(f"{path}:2: {count} channels every {step:g}; both must be above 0")
    words = _keywords(lines[2:end])
    names = _fields(words.get("SHORTNAM", ""), count)
    units = [_unit(unit) for unit in _fields(words.get("UNITSNAM", ""), count)]
    along = find_unit(_unit(words.get("XUNITS", "").strip()))
    if along is None or along.quantity != "displacement":
        raise DataError(
            f"{path}: XUNITS {words.get('XUNITS', '').strip()!r}: no length; a profile over time is no road; write the "
            "unit of the distance there"
        )
    rows = [line.replace(",", " ") for line in lines[end + 1 :] if line.strip()]
    try:
        values = np.array(" ".join(rows).split(), dtype=np.float64)
    except ValueError as error:
        raise DataError(f"{path}: behind line {end + 1}: {error}; allowed are numbers alone") from None
    if values.size % count or not values.size or (samples > 0 and values.size != samples * count):
        told = f"{samples} samples of " if samples > 0 else ""
        raise DataError(
            f"{path}: {values.size} numbers; the header tells {told}{count} channels; the file was cut off or damaged"
        )
    table = values.reshape(-1, count)
    start = float(words["XSTART"]) if "XSTART" in words and _is_number(words["XSTART"]) else 0.0
    distance = uniform_axis(table.shape[0], step, start) * along.factor
    channels = [Channel(name="distance", values=distance, unit="m", function="road profile")]
    channels += [
        Channel(
            name=name or f"channel {n + 1}",
            values=np.ascontiguousarray(table[:, n]),
            unit=unit,
            function="road profile",
            remark="" if unit else "the file tells no unit",
        )
        for n, (name, unit) in enumerate(zip(names, units, strict=True))
    ]
    return Measurement(
        path=path,
        format="erd",
        channels=tuple(channels),
        sha256=text.sha256,
        program=words.get("TITLE", "").strip()[:80],
        start=words.get("DATE", "").strip(),
        notices=text.notices,
    )


def _keywords(lines: list[str]) -> dict[str, str]:
    """Return what follows each keyword of eight characters, with its continuation lines."""
    found: dict[str, str] = {}
    last = ""
    for line in lines:
        word, value = line[:FIELD].strip().upper(), line[FIELD:]
        if line.startswith(CONTINUED) and last:
            found[last] += value
        elif word:
            found[word], last = value, word
    return found


def _fields(text: str, count: int) -> list[str]:
    """Return the fields of eight characters, empty where the line ends before."""
    return [text[n * FIELD : (n + 1) * FIELD].strip() for n in range(count)]


def _unit(text: str) -> str:
    """Return a unit as the table of units writes it."""
    known = {"meters": "m", "meter": "m", "feet": "ft", "foot": "ft", "inches": "in", "inch": "in", "mils": "mil"}
    plain = text.strip().rstrip(".")
    return known.get(plain.lower(), plain if find_unit(plain) else plain.lower())


def _is_number(text: str) -> bool:
    try:
        return bool(np.isfinite(float(text)))
    except ValueError:
        return False
