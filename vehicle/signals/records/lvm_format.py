"""Measurement files of LabVIEW (.lvm): text, a header of the file, then segments, each with a header and rows.

A line of a header is a key and one value for each column: attribute j of a line belongs to column j of the line of
names. `X_Columns` tells where the times are: in no column, in one for all channels, or in one before each channel.

Source: NI, Specification for the LabVIEW Measurement File.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement, uniform_axis
from vehicle.signals.records.clock_text import clock_seconds
from vehicle.signals.records.heads import split_head
from vehicle.signals.records.table import Header, Vector, Wanted
from vehicle.signals.records.text import read_text
from vehicle.signals.records.text_format import careful, fast, fast_with_gaps

END = "***End_of_Header***"
SPECIAL = ("***Start_Special***", "***End_Special***")
JOINED = 1e-3
"""Largest deviation of the first time of a segment from the continued times of the one before, in steps [-]."""


@dataclass(kw_only=True, slots=True)
class _Segment:
    """Rows below one header.

    Attributes:
        about: key of the header to its values, one a column.
        names: heads of the columns.
        line: of the names, from 1.
        rows: lines of numbers, with their numbers.
    """

    about: dict[str, list[str]] = field(default_factory=dict)
    names: list[str] = field(default_factory=list)
    line: int = 0
    rows: list[tuple[int, str]] = field(default_factory=list)

    def value(self, key: str, column: int) -> str:
        """Attribute of a column; empty where the header does not tell it."""
        cells = self.about.get(key, [])
        return cells[column].strip() if column < len(cells) else ""


def read(path: Path) -> Measurement:
    """Read the channels of all segments, each over its times.

    Raises:
        ConfigurationError: there is no such file.
        DataError: another form than that of the specification, damaged, or segments that overlap in time.
    """
    text = read_text(path, western=True)
    lines = text.lines
    head, first = _file_header(path, lines)
    separator = {"comma": ",", "tab": "\t"}.get(head.get("Separator", "Tab").lower())
    layout = head.get("X_Columns", "One").lower()
    if separator is None or layout not in ("no", "one", "multi"):
        raise DataError(
            f"{path}: Separator {head.get('Separator')!r}, X_Columns {head.get('X_Columns')!r}; allowed are Tab or "
            "Comma, and No, One or Multi; export it again"
        )
    segments = _segments(path, lines, first, separator)
    sign = {",": ",", ".": "."}.get(head.get("Decimal_Separator", ""), "")
    notices = list(text.notices)
    columns = [_channels(path, one, layout, separator, sign, notices) for one in segments]
    start = " ".join(filter(None, (segments[0].value("Date", 1), segments[0].value("Time", 1))))
    return Measurement(
        path=path,
        format="lvm",
        channels=_joined(path, segments, columns, notices),
        sha256=text.sha256,
        program=f"LabVIEW Measurement {head.get('Writer_Version', '')}".strip(),
        start=start or " ".join(filter(None, (head.get("Date", ""), head.get("Time", "")))),
        notices=tuple(dict.fromkeys(notices)),
    )


def _file_header(path: Path, lines: Sequence[str]) -> tuple[dict[str, str], int]:
    """Keys and values of the header of the file; index of the line behind it."""
    found: dict[str, str] = {}
    for index, line in enumerate(lines[:200]):
        if line.strip().strip(",").strip() == END:
            return found, index + 1
        key, _, value = line.partition("\t") if "\t" in line else line.partition(",")
        found[key.strip()] = value.strip("\t ")
    raise DataError(f"{path}: no line {END} behind the header of the file; it was cut off; export it again")


def _segments(path: Path, lines: Sequence[str], first: int, separator: str) -> list[_Segment]:
    """Segments of a file: a header with `Channels` up to its end, a line of names, and rows."""
    found: list[_Segment] = []
    inside = special = False
    for index in range(first, len(lines)):
        line = lines[index].rstrip("\r")
        word = line.split(separator)[0].strip()
        if special or word == SPECIAL[0]:
            special = word != SPECIAL[1]
        elif not line.strip():
            continue
        elif inside and word == END:
            inside = False
        elif inside:
            found[-1].about[word] = line.split(separator)
        elif word in ("Channels", "Notes"):
            inside = True
            found.append(_Segment(about={word: line.split(separator)}))
        elif not found:
            raise DataError(
                f"{path}:{index + 1}: {line[:40]!r} stands before a segment with its Channels; export again"
            )
        elif not found[-1].names:
            found[-1].names, found[-1].line = [cell.strip() for cell in line.split(separator)], index + 1
        else:
            found[-1].rows.append((index + 1, line))
    if inside or not found or not found[-1].rows:
        raise DataError(f"{path}: no rows of numbers in the last segment; the file was cut off; export it again")
    return found


def _channels(
    path: Path, segment: _Segment, layout: str, separator: str, sign: str, notices: list[str]
) -> list[Channel]:
    """Channels of a segment over times that begin with its own X0."""
    names = [name for name in segment.names if name]
    if names[-1:] == ["Comment"]:
        names = names[:-1]
    told = segment.value("Channels", 1)
    places = [n for n in range(len(names)) if not (names[n] == "X_Value" and (n == 0 or layout == "multi"))]
    if told.isdecimal() and int(told) != len(places):
        raise DataError(
            f"{path}:{segment.line}: {len(places)} names for {told} channels: {', '.join(map(repr, names[:6]))}; "
            "export it again"
        )
    values = _numbers(path, segment, names, separator, sign, notices)
    found = []
    for column in places:
        samples = values[:, column]
        last = np.flatnonzero(np.isfinite(samples))
        if not last.size:
            notices.append(f"channel {names[column]!r} holds no samples")
            continue
        samples = samples[: int(last[-1]) + 1]
        count = segment.value("Samples", column)
        packet = int(count) if count.isdecimal() else 0
        if packet > samples.size:
            notices.append(f"{packet} samples of {names[column]!r} are told, {samples.size} are held")
        at = column - 1 if layout == "multi" else 0
        times = None if layout == "no" or at < 0 else values[: samples.size, at]
        if layout == "one" and segment.value("Delta_X", column) != segment.value("Delta_X", places[0]):
            times = None  # the one column of times is that of the first channel
        axis, remark = _times(path, segment, column, times, samples.size, packet, sign)
        name, unit = split_head(names[column])
        over = segment.value("X_Dimension", column).lower()
        found.append(
            Channel(
                name=name,
                values=samples.copy(),
                unit=segment.value("Y_Unit_Label", column) or unit,
                axis=axis,
                kind="frequency" if over == "frequency" else "time",
                function="spectrum" if over == "frequency" else "time history",
                remark=remark,
            )
        )
    return found


def _numbers(path: Path, segment: _Segment, names: list[str], separator: str, sign: str, notices: list[str]) -> Vector:
    """Numbers of a segment, (rows, columns), NaN in empty cells; comments are left out."""
    width, rows = len(names), []
    for line, row in segment.rows:
        cells = row.split(separator)
        if len(cells) < width:
            raise DataError(
                f"{path}:{line}: row has {len(cells)} cells for {width} columns; the file was cut off; remove the row"
            )
        if any(cell.strip() for cell in cells[width:]):
            notices.append("comments of rows are left out")
        rows.append("\t".join(cells[:width]))
    commas = any("," in row for row in rows)
    if commas and any("." in row for row in rows):
        raise DataError(f"{path}:{segment.line}: decimal points and commas in one segment; export it with one of them")
    if commas and sign == ".":
        raise DataError(f"{path}:{segment.line}: decimal commas, but Decimal_Separator is '.'; export it again")
    if commas:
        rows = [row.replace(",", ".") for row in rows]
    header = Header(path=path, line=segment.line, cells=tuple(names), delimiter="\t")
    numbers = [line for line, _ in segment.rows]
    values = fast(rows, header)
    values = fast_with_gaps(rows, header, -1) if values is None else values
    wanted = Wanted(needed="", key=lambda _: -1, missing="mark")
    return careful(numbers, rows, header, -1, wanted) if values is None else values


def _times(
    path: Path, segment: _Segment, column: int, times: Vector | None, count: int, packet: int, sign: str
) -> tuple[Vector | None, str]:
    """Times of a channel and a remark: of its column, else X0 + i Delta_X."""
    if times is not None:
        if np.isfinite(times).all():
            return times.copy(), ""
        row = int(np.flatnonzero(~np.isfinite(times))[0])
        raise DataError(f"{path}:{segment.rows[row][0]}: the X_Value is missing; repair or remove the row")
    try:
        start, text = (segment.value(key, column).replace(",", ".") for key in ("X0", "Delta_X"))
        origin, (step, remark) = float(start or "0"), _step(text)
    except ValueError:
        return None, "no times: X0 or Delta_X is no number; give --rate HZ"
    if not (step > 0.0 and math.isfinite(origin) and math.isfinite(step)):
        return None, "no times: Delta_X is not positive; give --rate HZ"
    if 0 < packet < count:
        return None, (
            f"packets of {packet} samples under one header, without the times between them: give --rate "
            f"{1.0 / step:.9g} if they follow each other without a pause"
        )
    return uniform_axis(count, step, origin), remark


def _step(text: str) -> tuple[float, str]:
    """Step of a clock [s]: with fixed decimals, as 0.000977, the whole rate that alone is written so."""
    step = float(text)
    _, point, decimals = text.partition(".")
    if not point or not decimals.isdecimal() or step <= 0.0:
        return step, ""
    half = 0.5 * 10.0 ** -len(decimals)
    low, high = math.ceil(1.0 / (step + half)), math.floor(1.0 / (step - half)) if step > half else 0
    if low == high and abs(step * low - 1.0) > 1e-12:
        return 1.0 / low, f"time step {text} s is rounded: taken as a clock of {low} Hz"
    if low != high and half / step > 1e-5:
        return (
            step,
            f"time step {text} s is rounded: the rate {1.0 / step:.9g} Hz is known to {100 * half / step:.2g} %",
        )
    return step, ""


def _joined(
    path: Path, segments: Sequence[_Segment], columns: Sequence[list[Channel]], notices: list[str]
) -> tuple[Channel, ...]:
    """Channels of all segments: put behind each other where all have the same names, else with their segment."""
    if len(segments) == 1:
        return tuple(columns[0])
    names = [(one.name, one.unit, one.axis is None) for one in columns[0]]
    if any([(one.name, one.unit, one.axis is None) for one in other] != names for other in columns):
        notices.append(f"{len(segments)} segments with different channels: each is listed with its segment")
        return tuple(
            Channel(name=one.name, values=one.values, unit=one.unit, axis=one.axis, kind=one.kind,
                    function=one.function, place=f"segment {number}", remark=one.remark)
            for number, held in enumerate(columns, 1) for one in held
        )  # fmt: skip
    later = _starts(path, segments, columns)
    notices.append(f"{len(segments)} segments put behind each other by their times")
    found = []
    for index, one in enumerate(columns[0]):
        parts = [held[index] for held in columns]
        axes = [part.axis + shift for part, shift in zip(parts, later, strict=True) if part.axis is not None]
        found.append(
            Channel(
                name=one.name,
                values=np.concatenate([part.values for part in parts]),
                unit=one.unit,
                axis=np.concatenate(axes) if axes else None,
                kind=one.kind,
                function=one.function,
                remark=one.remark,
            )
        )
    return tuple(found)


def _starts(path: Path, segments: Sequence[_Segment], columns: Sequence[list[Channel]]) -> list[float]:
    """What is added to the times of each segment [s]: nothing where they go on, else the clock of its header."""
    axes = [next((one.axis for one in held if one.axis is not None), None) for held in columns]
    own = [axis for axis in axes if axis is not None]
    if len(own) != len(axes) or all(after[0] > before[-1] for before, after in pairwise(own)):
        return [0.0] * len(segments)
    try:
        days = [one.value("Date", 1) for one in segments]
        clocks = [one.value("Time", 1) for one in segments]
        shifts, _, _ = clock_seconds(clocks, days)
    except ValueError:
        shifts = np.zeros(len(segments))
    for number, (before, after) in enumerate(pairwise(own), 1):
        step = float(before[-1] - before[0]) / max(before.size - 1, 1)
        gap = shifts[number] + after[0] - shifts[number - 1] - before[-1]
        if gap <= 0.0 or gap < (1.0 - JOINED) * step * 0.5:
            raise DataError(
                f"{path}:{segments[number].line}: segment {number + 1} begins {-gap:.6g} s before the end of segment "
                f"{number}; the times of the segments overlap; export each of them into a file"
            )
    return [float(one) for one in shifts]
