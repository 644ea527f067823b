"""Read LabVIEW measurement files (.lvm): text with a file header, then segments, each with a header and rows.

A header line is a key and one value per column: value j belongs to column j of the line of names. `X_Columns` is the
number of time columns: none, one for all channels, or one before each channel.

Source: NI, Specification for the LabVIEW Measurement File.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.errors import DataError
from vehicle.signals.formats.channel import OVER_ANGLE, OVER_DISTANCE, Channel, Measurement, uniform_axis
from vehicle.signals.formats.clock_text import clock_seconds
from vehicle.signals.formats.csv_table import logged
from vehicle.signals.formats.heads import split_head
from vehicle.signals.formats.table import Header
from vehicle.signals.formats.text import read_text

END = "***End_of_Header***"
SPECIAL = ("***Start_Special***", "***End_Special***")
JOINED = 1e-3
"""Maximum deviation of the first time of a segment from the continued times of the previous segment, in steps [-]."""


@dataclass(kw_only=True, slots=True)
class _Segment:
    """Segment of a file: header and rows.

    Attributes:
        attributes: key of the header -> values of the columns.
        names: column headers.
        line: line number of the names, from 1.
        rows: line numbers and text of the rows.
    """

    attributes: dict[str, list[str]] = field(default_factory=dict)
    names: list[str] = field(default_factory=list)
    line: int = 0
    rows: list[tuple[int, str]] = field(default_factory=list)

    def value(self, key: str, column: int) -> str:
        """Return an attribute of a column; empty if the header has no value."""
        cells = self.attributes.get(key, [])
        return cells[column].strip() if column < len(cells) else ""


def read(path: Path) -> Measurement:
    """Read the channels of all segments; concatenate segments with equal channels."""
    text = read_text(path)
    lines = text.lines
    head, first = _file_header(path, lines)
    separator = {"comma": ",", "tab": "\t"}.get(head.get("Separator", "Tab").lower())
    layout = head.get("X_Columns", "One").lower()
    if separator is None or layout not in ("no", "one", "multi"):
        raise DataError(
            f"{path}: Separator is {head.get('Separator')!r} but must be Tab or Comma; X_Columns is "
            f"{head.get('X_Columns')!r} but must be No, One or Multi; export it again"
        )
    segments = _segments(path, lines, first, separator)
    sign = {",": ",", ".": "."}.get(head.get("Decimal_Separator", ""), "")
    notices = list(text.notices)
    columns = [_channels(path, segment, layout, separator, sign, notices) for segment in segments]
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
    """Return keys and values of the file header, and the index of the line after the header."""
    header: dict[str, str] = {}
    for index, line in enumerate(lines[:200]):
        if line.strip().strip(",").strip() == END:
            return header, index + 1
        key, _, value = line.partition("\t") if "\t" in line else line.partition(",")
        header[key.strip()] = value.strip("\t ")
    raise DataError(f"{path}: the line {END} after the file header is missing; the file is truncated: export it again")


def _segments(path: Path, lines: Sequence[str], first: int, separator: str) -> list[_Segment]:
    """Split the lines after the file header into segments: header, line of names, rows."""
    segments: list[_Segment] = []
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
            segments[-1].attributes[word] = line.split(separator)
        elif word in ("Channels", "Notes"):
            inside = True
            segments.append(_Segment(attributes={word: line.split(separator)}))
        elif not segments:
            raise DataError(
                f"{path}:{index + 1}: found {line[:40]!r}, must be the header of a segment; export it again"
            )
        elif not segments[-1].names:
            segments[-1].names, segments[-1].line = [cell.strip() for cell in line.split(separator)], index + 1
        else:
            segments[-1].rows.append((index + 1, line))
    if inside or not segments or not segments[-1].rows:
        raise DataError(f"{path}: no rows of numbers in the last segment; the file is truncated: export it again")
    return segments


def _channels(
    path: Path, segment: _Segment, layout: str, separator: str, sign: str, notices: list[str]
) -> list[Channel]:
    """Return the channels of a segment; their times begin at X0, and at Date and Time where these differ."""
    names = [name for name in segment.names if name]
    if names[-1:] == ["Comment"]:
        names = names[:-1]
    channel_count = segment.value("Channels", 1)
    columns = [n for n in range(len(names)) if not (names[n] == "X_Value" and (n == 0 or layout == "multi"))]
    if channel_count.isdecimal() and int(channel_count) != len(columns):
        raise DataError(
            f"{path}:{segment.line}: found {len(columns)} names for {channel_count} channels: "
            f"{', '.join(map(repr, names[:6]))}; export it again"
        )
    values = _numbers(path, segment, names, separator, sign, notices)
    later = _later(segment, columns)
    channels = []
    for column in columns:
        samples = values[:, column]
        last = np.flatnonzero(np.isfinite(samples))
        if not last.size:
            notices.append(f"channel {names[column]!r} has no samples")
            continue
        samples = samples[: int(last[-1]) + 1]
        count = segment.value("Samples", column)
        packet = int(count) if count.isdecimal() else 0
        if packet > samples.size:
            notices.append(f"channel {names[column]!r} has {samples.size} samples, but its header states {packet}")
        time_column = column - 1 if layout == "multi" else 0
        times = None if layout == "no" or time_column < 0 else values[: samples.size, time_column]
        if layout == "one" and any(
            segment.value(key, column) != segment.value(key, columns[0]) for key in ("X0", "Delta_X")
        ):
            times = None  # the time column is valid for the first channel only
        axis, remark = _times(path, segment, column, times, samples.size, packet, sign)
        name, unit = split_head(names[column])
        x_dimension = segment.value("X_Dimension", column).lower() or "time"
        if x_dimension == "time" and axis is not None:
            axis = axis + later[column]
        elif x_dimension not in ("time", "frequency"):
            axis, remark = None, f"the axis is a {x_dimension}, not a time"
        function = {"frequency": "spectrum", "distance": OVER_DISTANCE, "length": OVER_DISTANCE, "angle": OVER_ANGLE}
        channels.append(
            Channel(
                name=name,
                values=samples.copy(),
                unit=segment.value("Y_Unit_Label", column) or unit,
                axis=axis,
                kind="frequency" if x_dimension == "frequency" else "time",
                function=function.get(x_dimension, "time history"),
                remark=remark,
            )
        )
    return channels


def _later(segment: _Segment, columns: Sequence[int]) -> dict[int, float]:
    """Return the start of each channel after the earliest one by Date and Time [s].

    Zero where X0 differs by the same times, which then states the same fact.
    """
    clocks = [segment.value("Time", column) for column in columns]
    days = [segment.value("Date", column) for column in columns]
    none = dict.fromkeys(columns, 0.0)
    if len(set(zip(days, clocks, strict=True))) == 1:
        return none
    try:
        seconds, _, _ = clock_seconds(clocks, days)
        origins = np.array([float(segment.value("X0", column).replace(",", ".") or "0") for column in columns])
    except ValueError:
        return none
    if np.allclose(np.diff(seconds), np.diff(origins), rtol=0.0, atol=1e-3):
        return none
    return dict(zip(columns, (seconds - seconds.min()).tolist(), strict=True))


def _numbers(path: Path, segment: _Segment, names: list[str], separator: str, sign: str, notices: list[str]) -> Vector:
    """Return the numbers of a segment, (rows, columns), NaN for empty cells; ignore comments."""
    width, rows = len(names), []
    for line, row in segment.rows:
        cells = row.split(separator)
        if len(cells) < width:
            raise DataError(f"{path}:{line}: {len(cells)} cells for {width} columns: truncated; remove the row")
        if any(cell.strip() for cell in cells[width:]):
            notices.append("comments behind rows are ignored")
        rows.append("\t".join(cells[:width]))
    commas = any("," in row for row in rows)
    if commas and any("." in row for row in rows):
        raise DataError(f"{path}:{segment.line}: decimal points and decimal commas; export one of them")
    if commas and sign == ".":
        raise DataError(f"{path}:{segment.line}: decimal commas, but Decimal_Separator is '.'; export it again")
    if commas:
        rows = [row.replace(",", ".") for row in rows]
    header = Header(path=path, line=segment.line, cells=tuple(names), delimiter="\t")
    return logged([line for line, _ in segment.rows], rows, header)


def _times(
    path: Path, segment: _Segment, column: int, times: Vector | None, count: int, packet: int, sign: str
) -> tuple[Vector | None, str]:
    """Return the times of a channel, from its time column or X0 + i * Delta_X, and a remark."""
    if times is not None:
        if np.isfinite(times).all():
            return times.copy(), ""
        row = int(np.flatnonzero(~np.isfinite(times))[0])
        raise DataError(f"{path}:{segment.rows[row][0]}: the X_Value is missing; correct or remove the row")
    try:
        start, text = (segment.value(key, column).replace(",", ".") for key in ("X0", "Delta_X"))
        origin, (step, remark) = float(start or "0"), _step(text)
    except ValueError:
        return None, "the times are missing: X0 or Delta_X is not a number; set --rate HZ"
    if not (step > 0.0 and math.isfinite(origin) and math.isfinite(step)):
        return None, "the times are missing: Delta_X is not positive; set --rate HZ"
    if 0 < packet < count:
        return None, (
            f"the time between packets of {packet} samples is unknown; without gaps set --rate {1.0 / step:.9g}"
        )
    return uniform_axis(count, step, origin), remark


def _step(text: str) -> tuple[float, str]:
    """Parse a time step [s]; for fixed decimals (0.000977) recover the only matching whole rate."""
    step = float(text)
    _, point, decimals = text.partition(".")
    if not point or not decimals.isdecimal() or step <= 0.0:
        return step, ""
    half = 0.5 * 10.0 ** -len(decimals)
    low, high = math.ceil(1.0 / (step + half)), math.floor(1.0 / (step - half)) if step > half else 0
    if low == high and abs(step * low - 1.0) > 1e-12:
        return 1.0 / low, f"time step {text} s is rounded; the sampling rate is assumed to be {low} Hz"
    if low != high and half / step > 1e-5:
        uncertainty = f"the sampling rate is {1.0 / step:.6g} Hz +- {number(100 * half / step, 2)} %"
        return step, f"time step {text} s is rounded: {uncertainty}"
    return step, ""


def _joined(
    path: Path, segments: Sequence[_Segment], columns: Sequence[list[Channel]], notices: list[str]
) -> tuple[Channel, ...]:
    """Concatenate the channels of all segments if their names are equal; else return all with their segment."""
    if len(segments) == 1:
        return tuple(columns[0])
    names = [[(channel.name, channel.unit, channel.axis is None) for channel in of_segment] for of_segment in columns]
    if any(other_names != names[0] for other_names in names):
        notices.append(f"{len(segments)} segments have different channels; each segment has its channels in the list")
        return tuple(
            replace(channel, place=f"segment {number}")
            for number, of_segment in enumerate(columns, 1)
            for channel in of_segment
        )
    offsets = _starts(path, segments, columns)
    notices.append(f"{len(segments)} segments are joined by their times")
    joined = []
    for index, channel in enumerate(columns[0]):
        parts = [segment_channels[index] for segment_channels in columns]
        axes = [part.axis + shift for part, shift in zip(parts, offsets, strict=True) if part.axis is not None]
        values = np.concatenate([part.values for part in parts])
        joined.append(replace(channel, values=values, axis=np.concatenate(axes) if axes else None))
    return tuple(joined)


def _starts(path: Path, segments: Sequence[_Segment], columns: Sequence[list[Channel]]) -> list[float]:
    """Return the time offset of each segment [s]: 0 if times continue, else from the clocks in the headers."""
    axes = [
        next((channel.axis for channel in segment_channels if channel.axis is not None), None)
        for segment_channels in columns
    ]
    known_axes = [axis for axis in axes if axis is not None]
    if len(known_axes) != len(axes) or all(after[0] > before[-1] for before, after in pairwise(known_axes)):
        return [0.0] * len(segments)
    try:
        days = [segment.value("Date", 1) for segment in segments]
        clocks = [segment.value("Time", 1) for segment in segments]
        shifts, _, _ = clock_seconds(clocks, days)
    except ValueError:
        shifts = np.zeros(len(segments))
    for index, (before, after) in enumerate(pairwise(known_axes), 1):
        step = float(before[-1] - before[0]) / max(before.size - 1, 1)
        gap = shifts[index] + after[0] - shifts[index - 1] - before[-1]
        if gap <= 0.0 or gap < (1.0 - JOINED) * step * 0.5:
            raise DataError(
                f"{path}:{segments[index].line}: segment {index + 1} begins {-gap:.3g} s before the end of segment "
                f"{index} but must begin after it; export each segment to a separate file"
            )
    return [float(shift) for shift in shifts]
