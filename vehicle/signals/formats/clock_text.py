"""Convert dates, times of day, and counts since 1970 to seconds."""

import re
from collections.abc import Sequence
from datetime import UTC, date, datetime
from itertools import pairwise

import numpy as np

from vehicle.arrays import Vector

DAY = 86400.0
"""Length of a day [s]."""

FIRST_YEAR, LAST_YEAR = 2001, 2040
"""Years in which a number is accepted as a count since 1970."""

LONGEST_EPOCH_STEP = 0.5
"""Maximum median step of a count since 1970 [s]: a counter since power-on may have the same magnitude."""

EPOCHS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
"""Unit of a count since 1970 to its value in seconds."""

_MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
_YEAR_FIRST = re.compile(r"(?P<y>\d{4})(?P<s>[-/.])(?P<m>\d{1,2})(?P=s)(?P<d>\d{1,2})", re.ASCII)
_YEAR_LAST = re.compile(r"(?P<a>\d{1,2})(?P<s>[-/.])(?P<b>\d{1,2})(?P=s)(?P<y>\d{4}|\d{2})", re.ASCII)
_MONTH_NAME = re.compile(r"(?P<d>\d{1,2})[- ](?P<n>[A-Za-z]{3})[a-z]*[- ](?P<y>\d{4})", re.ASCII)
_CLOCK = re.compile(
    r"(?P<h>\d{1,2}):(?P<m>\d{2}):(?P<s>\d{2})(?:[.,](?P<f>\d+)|:(?P<ms>\d{3}|\d{6}))?\s*(?P<half>[AaPp]\.?[Mm]\.?)?"
    r"\s*(?P<zone>Z|UTC|GMT|[+-]\d{2}:?\d{2})?",
    re.ASCII,
)
_MINUTES = re.compile(r"(?P<m>\d{1,3}):(?P<s>\d{2})[.,](?P<f>\d+)", re.ASCII)
_BOTH = re.compile(
    r"(?P<date>\d[\d./-]{5,9}|\d{1,2}[ -][A-Za-z]{3,9}[ -]\d{4})(?:[T ] ?|, ?)(?P<clock>\d[\d:.,APMapmZUTCGz+ -]{3,27})"
)
LONGEST_CLOCK = 48
"""Maximum number of characters of a date and time."""


def is_clock(cell: str) -> bool:
    """Return True if a stripped cell contains a date, a time of day, or both."""
    if len(cell) > LONGEST_CLOCK:
        return False
    both = _BOTH.fullmatch(cell)
    if both:
        return is_date(both["date"]) and _seconds_of_clock(both["clock"]) is not None
    return _seconds_of_clock(cell) is not None or is_date(cell)


def is_date(cell: str) -> bool:
    """Return True if a cell contains a date only."""
    return bool(_YEAR_FIRST.fullmatch(cell) or _YEAR_LAST.fullmatch(cell) or _month_name(cell))


def clock_seconds(cells: Sequence[str], days: Sequence[str] | None = None) -> tuple[Vector, str, list[str]]:
    """Convert a column of times of day, with or without dates, to seconds.

    Args:
        cells: text of each row: a time of day, or a date and a time of day.
        days: date of each row if dates are in a separate column.

    Returns:
        Times after the first row [s], (n,); text of the first row; notices.

    Raises:
        ValueError: a cell is not a date and time; its argument is the index of the row.
    """
    dates, clocks = _same_form(cells) or _any_form(cells)
    if days is not None:
        dates = list(days)
    start = cells[0] if days is None else f"{days[0]} {cells[0]}"
    if dates:
        if len(dates) != len(cells):
            raise ValueError(next(row for row, cell in enumerate(cells) if not _BOTH.fullmatch(cell)))
        offsets, notices = _day_offsets(dates)
        return DAY * offsets + (clocks - clocks[0]), start, notices
    backward = np.flatnonzero(np.diff(clocks) < -0.5 * DAY)
    notices = (
        [] if not backward.size else [f"the clock passes midnight {backward.size} times; 24 h are added each time"]
    )
    offset = np.zeros(clocks.size)
    for at in backward:
        offset[at + 1 :] += DAY
    return clocks - clocks[0] + offset, start, notices


def _any_form(cells: Sequence[str]) -> tuple[list[str], Vector]:
    """Return dates (empty without dates) and seconds after midnight of cells of mixed formats."""
    dates: list[str] = []
    clocks: Vector = np.empty(len(cells))
    for row, cell in enumerate(cells):
        both = _BOTH.fullmatch(cell)
        seconds = _seconds_of_clock(both["clock"] if both else cell)
        if seconds is None:
            raise ValueError(row)
        clocks[row] = seconds
        if both:
            dates.append(both["date"])
    return dates, clocks


def _same_form(cells: Sequence[str]) -> tuple[list[str], Vector] | None:
    """Return the result of `_any_form`, faster, for cells that differ in digits only; None for other cells."""
    first = cells[0]
    both = _BOTH.fullmatch(first)
    clock, offset = (both["clock"], both.start("clock")) if both else (first, 0)
    match = _CLOCK.fullmatch(clock)
    text = "".join(cells)
    if match is None or match["half"] or not text.isascii() or len(text) != len(first) * len(cells):
        return None
    codes = np.frombuffer(text.encode("ascii"), dtype=np.uint8).reshape(len(cells), len(first))
    signs = np.array([not sign.isdigit() for sign in first])
    digits = codes[:, ~signs]
    if not (codes[:, signs] == codes[0, signs]).all() or digits.min() < ord("0") or digits.max() > ord("9"):
        return None

    def number(name: str) -> Vector:
        begin, end = (offset + at for at in match.span(name))
        powers = 10.0 ** np.arange(end - begin - 1, -1, -1)
        return np.asarray((codes[:, begin:end] - float(ord("0"))) @ powers)

    part = "f" if match["f"] else "ms" if match["ms"] else ""
    fraction = number(part) / 10.0 ** len(match[part]) if part else 0.0
    hours, minutes, seconds = number("h"), number("m"), number("s")
    if hours.max() > 24 or minutes.max() > 59 or seconds.max() > 60:
        return None  # `_any_form` reports the row
    dates: list[str] = []
    if both:
        date_codes, width = codes[:, : both.end("date")], both.end("date")
        starts = np.flatnonzero((date_codes[1:] != date_codes[:-1]).any(axis=1)) + 1
        for begin, end in pairwise((0, *starts.tolist(), len(cells))):
            dates += [cells[begin][:width]] * (end - begin)
    return dates, 3600.0 * hours + 60.0 * minutes + seconds + fraction


def epoch_seconds(values: Vector, unit: str) -> tuple[Vector, str, str] | None:
    """Convert counts since 1970-01-01 UTC to seconds.

    Args:
        values: counts, (n,).
        unit: "s", "ms", "us" or "ns" as written in the file; empty if unknown.

    Returns:
        Times after the first row [s], (n,); start in ISO 8601; unit of the count. None for other values.
    """
    if values.size < 2 or not np.isfinite(values).all():
        return None
    for name, factor in EPOCHS.items():
        first, last = (float(values[at]) * factor for at in (0, -1))
        limits = [datetime(year, 1, 1, tzinfo=UTC).timestamp() for year in (FIRST_YEAR, LAST_YEAR)]
        if unit in ("", name) and limits[0] <= first <= limits[1] and limits[0] <= last <= limits[1]:
            step = factor * abs(float(np.median(np.diff(values))))
            if step > LONGEST_EPOCH_STEP and unit == "":
                return None
            start = datetime.fromtimestamp(first, tz=UTC)
            return (values - values[0]) * factor, start.isoformat(timespec="milliseconds"), name
    return None


def clock_of_day(value: float) -> float:
    """Return the seconds after midnight of a time of day written as a number HHMMSS.sss."""
    if not 0.0 <= value < 250000.0:  # also infinity and NaN
        raise ValueError(value)
    whole = int(value)
    hours, minutes, seconds = whole // 10000, whole // 100 % 100, whole % 100
    if hours > 24 or minutes > 59 or seconds > 60:
        raise ValueError(value)
    return 3600.0 * hours + 60.0 * minutes + seconds + (value - whole)


def _seconds_of_clock(cell: str) -> float | None:
    """Return the seconds after midnight of a time of day; None for other text."""
    match = _CLOCK.fullmatch(cell)
    if match is None:
        short = _MINUTES.fullmatch(cell)
        return None if short is None else 60.0 * int(short["m"]) + float(f"{short['s']}.{short['f']}")
    hours, minutes, seconds = int(match["h"]), int(match["m"]), int(match["s"])
    if hours > 24 or minutes > 59 or seconds > 60:
        return None
    if match["half"]:
        hours = hours % 12 + (12 if match["half"][0] in "Pp" else 0)
    digits = match["f"] or match["ms"] or "0"
    return 3600.0 * hours + 60.0 * minutes + seconds + float(f"0.{digits}")


def _month_name(cell: str) -> re.Match[str] | None:
    match = _MONTH_NAME.fullmatch(cell)
    return match if match and match["n"].lower() in _MONTHS else None


def _day_offsets(dates: Sequence[str]) -> tuple[Vector, list[str]]:
    """Return days after the first row, (n,), and a notice if the order of day and month is ambiguous."""
    different = list(dict.fromkeys(dates))
    if len(different) == 1:
        if not is_date(different[0]):
            raise ValueError(0)
        return np.zeros(len(dates)), []
    readings = []
    for day_first in (True, False):
        parsed = {text: _date(text, day_first) for text in different}
        if all(day is not None for day in parsed.values()):
            first = parsed[dates[0]]
            readings.append({text: (day - first).days for text, day in parsed.items()})  # type: ignore[operator]
    if not readings:
        raise ValueError(next((row for row, text in enumerate(dates) if _date(text, True) is None), 0))
    spans = [max(map(abs, day.values())) for day in readings]
    best = readings[int(np.argmin(spans))]
    notices = []
    if len(readings) == 2 and readings[0] != readings[1]:
        order = "day first" if best is readings[0] else "month first"
        notices.append(f"dates such as {different[0]} are read {order}: this order gives the shorter record")
    return np.array([float(best[text]) for text in dates]), notices


def _date(text: str, day_first: bool) -> date | None:
    """Parse a date with the day or the month first; None if the text is not a date in that order."""
    try:
        if match := _YEAR_FIRST.fullmatch(text):
            return date(int(match["y"]), int(match["m"]), int(match["d"]))
        if match := _month_name(text):
            return date(int(match["y"]), _MONTHS.index(match["n"].lower()) + 1, int(match["d"]))
        if match := _YEAR_LAST.fullmatch(text):
            year = int(match["y"]) + (2000 if len(match["y"]) == 2 else 0)
            day, month = (match["a"], match["b"]) if day_first or match["s"] == "." else (match["b"], match["a"])
            return date(year, int(month), int(day))
    except ValueError:
        return None
    return None
