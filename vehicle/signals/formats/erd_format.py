"""Read ERD files of road profilers (UMTRI): a header of text lines, then one row of numbers per sample."""

from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.formats.channel import ROAD_PROFILE, Channel, Measurement, uniform_axis
from vehicle.signals.formats.text import read_text
from vehicle.signals.formats.units import find_unit

TEXT = 5
"""KEYNUM of numbers written as text."""

FIELD = 8
"""Length of a keyword, and of a name or unit in the lines SHORTNAM and UNITSNAM [characters]."""

CONTINUED = "&1000"
"""First characters of a continuation line."""


def read(path: Path) -> Measurement:
    """Read a road profile: channels over the distance.

    The second line contains NCHAN, NSAMP, NRECS, NBYTES, KEYNUM and STEP: channels, samples (-1: unknown), layout of
    binary data, number format, and the spacing of the samples in XUNITS.

    Source: UMTRI, The ERD File Specification; headers of LTPP profiles.
    """
    text = read_text(path)
    lines = text.lines
    end = next((n for n, line in enumerate(lines[:400]) if line.strip().upper() == "END"), None)
    if end is None or end < 2:
        raise DataError(f"{path}: no line END after the header; use a complete ERD file")
    cells = [cell.strip() for cell in lines[1].replace(",", " ").split()]
    try:
        count, samples, number_format, step = int(cells[0]), int(cells[1]), int(cells[4]), float(cells[5])
    except (IndexError, ValueError):
        raise DataError(f"{path}:2: must be NCHAN, NSAMP, NRECS, NBYTES, KEYNUM, STEP; found {lines[1]!r}") from None
    if number_format != TEXT:
        raise DataError(f"{path}:2: binary numbers (KEYNUM {number_format}) are not read; export text ERD")
    if count < 1 or step <= 0.0:
        raise DataError(f"{path}:2: {count} channels with a step of {step:g}; both must be above 0")
    keywords = _keywords(lines[2:end])
    names = _fields(keywords.get("SHORTNAM", ""), count)
    units = [_unit(unit) for unit in _fields(keywords.get("UNITSNAM", ""), count)]
    distance_unit = find_unit(_unit(keywords.get("XUNITS", "").strip()))
    if distance_unit is None or distance_unit.quantity != "displacement":
        raise DataError(
            f"{path}: XUNITS {keywords.get('XUNITS', '').strip()!r}: must be a unit of length; the profile must be "
            "given against distance, not time; write the unit of the distance"
        )
    rows = [line.replace(",", " ") for line in lines[end + 1 :] if line.strip()]
    try:
        values = np.array(" ".join(rows).split(), dtype=np.float64)
    except ValueError as error:
        raise DataError(f"{path}: after line {end + 1}: {error}; write only numbers there") from None
    if values.size % count or not values.size or (samples > 0 and values.size != samples * count):
        claim = f"{samples} samples of " if samples > 0 else ""
        raise DataError(
            f"{path}: contains {values.size} numbers, but the header states {claim}{count} channels; the "
            "file is truncated or damaged: export it again"
        )
    table = values.reshape(-1, count)
    start = float(keywords["XSTART"]) if "XSTART" in keywords and _is_number(keywords["XSTART"]) else 0.0
    distance = uniform_axis(table.shape[0], step, start) * distance_unit.factor
    channels = [Channel(name="distance", values=distance, unit="m", function=ROAD_PROFILE)]
    channels += [
        Channel(
            name=name or f"channel {n + 1}",
            values=np.ascontiguousarray(table[:, n]),
            unit=unit,
            function=ROAD_PROFILE,
            remark="" if unit else "no unit in the file",
        )
        for n, (name, unit) in enumerate(zip(names, units, strict=True))
    ]
    return Measurement(
        path=path,
        format="erd",
        channels=tuple(channels),
        sha256=text.sha256,
        program=keywords.get("TITLE", "").strip()[:80],
        start=keywords.get("DATE", "").strip(),
        notices=text.notices,
    )


def _keywords(lines: list[str]) -> dict[str, str]:
    """Return the text after each keyword of eight characters, including continuation lines."""
    values: dict[str, str] = {}
    keyword = ""
    for line in lines:
        name, value = line[:FIELD].strip().upper(), line[FIELD:]
        if line.startswith(CONTINUED) and keyword:
            values[keyword] += value
        elif name:
            values[name], keyword = value, name
    return values


def _fields(text: str, count: int) -> list[str]:
    """Split a line into fields of eight characters; fields beyond its end are empty."""
    return [text[n * FIELD : (n + 1) * FIELD].strip() for n in range(count)]


def _unit(text: str) -> str:
    """Return a unit in the spelling of the unit table."""
    names = {"meters": "m", "meter": "m", "feet": "ft", "foot": "ft", "inches": "in", "inch": "in", "mils": "mil"}
    name = text.strip().rstrip(".")
    return names.get(name.lower(), name if find_unit(name) else name.lower())


def _is_number(text: str) -> bool:
    try:
        return bool(np.isfinite(float(text)))
    except ValueError:
        return False
