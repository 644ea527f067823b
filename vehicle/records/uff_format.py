"""Universal files: functions at nodes (dataset 58, text or binary), read with the traps that real files hold.

Source: Universal File Datasets, University of Cincinnati SDRL, datasets 58, 58b, 151 and 164.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from vehicle.errors import DataError
from vehicle.records.channel import Channel, Measurement, Values, check_length, clock_step, uniform_axis
from vehicle.records.reader import digest
from vehicle.records.table import Vector
from vehicle.records.units import QUANTITIES, find_ratio, find_unit

DIRECTIONS = {0: "", **{sign * (n + 1): f"{'+' if sign > 0 else '-'}{axis}"
                        for sign in (1, -1) for n, axis in enumerate(("X", "Y", "Z", "RX", "RY", "RZ"))}}  # fmt: skip
FUNCTIONS = {
    1: "time history",
    2: "auto spectrum",
    3: "cross spectrum",
    4: "frequency response",
    6: "coherence",
    9: "power spectral density",
    12: "spectrum",
}
KINDS = {
    3: "strain",
    5: "temperature",
    8: "displacement",
    9: "force",
    11: "velocity",
    12: "acceleration",
    13: "force",
    15: "pressure",
    17: "time",
    18: "frequency",
    21: "pressure",
}
"""Specific data type to quantity; 0 and 1 leave it open."""

_END = re.compile(rb"\r?\n {0,4}-1[ ]*(?:\r?\n|$)")
_BEGIN = re.compile(rb"(?:^|\n) {0,4}-1[ ]*\r?\n[ ]*(\d+)(b?)([^\n]*)\n")
_D_EXPONENT = re.compile(rb"(?<=\d)[dD](?=[+-]?\d)")


class Block(NamedTuple):
    """A dataset: its number, whether it is binary, the rest of its first line, and where its second line begins."""

    number: int
    binary: bool
    first: bytes
    start: int


@dataclass(frozen=True, kw_only=True, slots=True)
class Units:
    """Dataset 164: what a number in the file is divided by to get SI."""

    length: float
    force: float


def read(path: Path) -> Measurement:
    """Read all functions of a file.

    Raises:
        DataError: damaged, cut off, or without functions.
    """
    data = path.read_bytes()
    channels: list[Channel] = []
    notices: list[str] = []
    others: Counter[int] = Counter()
    units: Units | None = None
    program = start = ""
    position = 0
    while (match := _BEGIN.search(data, position)) is not None:
        block = Block(int(match[1]), match[2] == b"b", match[3], match.end())
        where = f"dataset {block.number} at byte {match.start()}"
        if block.number == 58:
            channel, date, position = _function(path, data, block, f"{where} (function {len(channels) + 1})", units)
            channels.append(channel)
            start = start or date
            continue
        end = _END.search(data, block.start - 1)
        if end is None:
            raise DataError(f"{path}: {where} has no end; the file was cut off; export it again")
        lines = data[block.start : end.start()].splitlines()
        if block.number == 164:
            units = _units(path, where, lines)
        elif block.number == 151:
            program = _text(lines[2])[:40] if len(lines) > 2 else ""
        else:
            others[block.number] += 1
        position = end.end() - 1
    if not channels:
        held = ", ".join(f"{count} of {number}" for number, count in sorted(others.items())) or "none"
        raise DataError(
            f"{path}: no function (dataset 58) in this universal file; its datasets: {held}; export the time "
            "histories or frequency responses as UFF 58"
        )
    if others:
        notices.append("other datasets: " + ", ".join(f"{n} ({count})" for n, count in sorted(others.items())))
    return Measurement(
        path=path,
        format="uff",
        channels=_named(channels),
        sha256=digest(path),
        program=program,
        start=start,
        notices=tuple(notices),
    )


def _named(channels: list[Channel]) -> tuple[Channel, ...]:
    """The text of a set is its name where it tells it from the others; else its place and direction are."""
    texts = Counter(one.name for one in channels)
    named = []
    for one in channels:
        point = one.place + one.direction + (f"/{one.reference}" if one.reference else "")
        alone = one.name and texts[one.name] == 1
        named.append(one if alone or not point else replace(one, name=point))
    return tuple(named)


def _text(line: bytes) -> str:
    """A line; a byte that is no UTF-8 is Windows text."""
    try:
        found = line.decode("utf-8")
    except UnicodeDecodeError:
        found = line.decode("cp1252", "replace")
    found = found.strip(" \r\n\0")
    return "" if found.upper() == "NONE" else found


def _units(path: Path, where: str, lines: list[bytes]) -> Units:
    try:
        numbers = [float(text) for text in _D_EXPONENT.sub(b"E", b" ".join(lines[1:])).split()[:2]]
    except ValueError:
        numbers = []
    if len(numbers) < 2 or min(numbers) <= 0.0:
        raise DataError(f"{path}: {where} tells no factors of length and force; export it again")
    return Units(length=numbers[0], force=numbers[1])


def _function(path: Path, data: bytes, block: Block, where: str, units: Units | None) -> tuple[Channel, str, int]:
    """A dataset 58: the channel, its date, and where the next dataset may begin."""
    lines, position = _lines(data, block.start, 11)
    if len(lines) < 11:
        raise DataError(f"{path}: {where} ends within its header; the file was cut off; export it again")
    try:
        nodes = _cells(lines[5], (5, 10, 5, 10, 11, 10, 4, 11, 10, 4))
        form = _cells(lines[6], (10, 10, 10, 13, 13, 13))
        kind, points, spacing = (int(form[n] or 0) for n in range(3))
        first, step = (float((form[n] or "0").replace("D", "E")) for n in (3, 4))
        axes = [_cells(lines[n], (10, 5, 5, 5, 21, 21)) for n in (7, 8, 9)]
        codes = [int(axis[0] or 0) for axis in axes]
        function = int(nodes[0] or 0)
        directions = [int(nodes[n] or 0) for n in (6, 9)]
    except ValueError as error:
        raise DataError(f"{path}: {where} has a header that is none ({error}); export it again") from None
    if kind not in (2, 4, 5, 6) or points < 1 or spacing not in (0, 1) or not np.isfinite([first, step]).all():
        raise DataError(
            f"{path}: {where}: data type {kind} with {points} points and spacing {spacing}; known are types 2, 4, 5, "
            "6, one point or more, spacing 0 or 1"
        )
    per_point = (2 if kind > 4 else 1) + (spacing == 0)
    if block.binary:
        numbers, position = _binary(path, data, block, position, where, kind, points * per_point)
    else:
        numbers, position = _ascii(path, data, position, where, points * per_point)
    table = numbers.reshape(points, per_point)
    labels = [axis[5] for axis in axes]
    is_time, scale, axis_remark = _axis(codes[0], labels[0], axes[0][4], function)
    remarks = [axis_remark]
    axis: Vector | None = None
    if spacing == 0:
        axis = table[:, 0] * scale if scale else None
    elif step > 0.0 and scale:
        if is_time:
            step, rounded = clock_step(step * scale)
            remarks.append(rounded)
            axis = uniform_axis(points, step, first * scale)
        else:
            axis = uniform_axis(points, step * scale, first * scale)
    else:
        remarks.append("the file tells no time step" if is_time else "the file tells no frequency step")
    columns = table[:, 1:] if spacing == 0 else table
    values: Values = columns[:, 0]
    if kind > 4:
        values = columns[:, 0] + 1j * columns[:, 1]
        if function == 6 or not np.any(values.imag):
            values = values.real if function != 4 else values
    unit, remark = _unit(codes[1], labels[1], units)
    if function == 4 and (labels[2] or codes[2] > 1):
        lower, other = _unit(codes[2], labels[2], units)
        unit, remark = (f"({unit})/({lower})" if unit and lower else ""), remark or other
    remarks.append(remark)
    node, entity = nodes[5], nodes[4]
    place = entity if entity and not re.fullmatch(r"\d+[+-][XYZ]", entity) else "" if node in ("", "0") else node
    to = "" if nodes[8] in ("", "0", "-1") else nodes[8] + DIRECTIONS.get(directions[1], "")
    channel = Channel(
        name=_text(lines[0]) or entity,
        values=values.copy(),
        unit=unit,
        axis=axis,
        kind="time" if is_time else "frequency",
        function=FUNCTIONS.get(function, f"function of type {function}" if function else "general function"),
        place=place,
        direction=DIRECTIONS.get(directions[0], ""),
        reference=to if function in (3, 4, 6) else "",
        remark="; ".join(text for text in remarks if text),
    )
    return channel, _text(lines[2]), position


def _lines(data: bytes, start: int, count: int) -> tuple[list[bytes], int]:
    """Lines from a place on, and the place behind them."""
    lines: list[bytes] = []
    while len(lines) < count and (end := data.find(b"\n", start)) >= 0:
        lines.append(data[start:end])
        start = end + 1
    return lines, start


def _cells(line: bytes, widths: tuple[int, ...]) -> list[str]:
    """Cells of fixed widths; blanks that were cut off are blanks."""
    text, found, start = _raw(line), [], 0
    for width in widths:
        cell = text[start : start + width].strip()
        found.append("" if cell.upper() == "NONE" else cell)
        start += width
    return found


def _raw(line: bytes) -> str:
    try:
        return line.decode("utf-8").rstrip("\r\n")
    except UnicodeDecodeError:
        return line.decode("cp1252", "replace").rstrip("\r\n")


def _binary(
    path: Path, data: bytes, block: Block, position: int, where: str, kind: int, count: int
) -> tuple[Vector, int]:
    """Numbers of a binary set, and where it ends."""
    cells = _cells(block.first, (6, 6, 12, 12))
    try:
        order, number, bytes_told = int(cells[0] or 1), int(cells[1] or 2), int(cells[3] or 0)
    except ValueError:
        raise DataError(f"{path}: {where} has a first line that is none; export it again") from None
    if order not in (1, 2) or number != 2:
        raise DataError(
            f"{path}: {where}: byte order {order} (1 or 2) and numbers of kind {number} (2, IEEE) are not read; "
            "export it as text (UFF 58)"
        )
    width = 4 if kind in (2, 5) else 8
    size = count * width
    check_length(path, size, len(data) - position, where)
    if bytes_told not in (0, size):
        raise DataError(
            f"{path}: {where}: {bytes_told} bytes of data are told for {count} numbers of {width} bytes; it was "
            "damaged; export it again"
        )
    tail = data[position + size : position + size + 16].lstrip(b"\r\n ")
    if not tail.startswith(b"-1"):
        raise DataError(
            f"{path}: {where}: no end behind its {size} bytes of data; it was damaged, perhaps sent as text; export "
            "it again"
        )
    values = np.frombuffer(data, f"{'<' if order == 1 else '>'}f{width}", count, position).astype(np.float64)
    _check_values(path, where, values)
    return values, data.index(b"-1", position + size) + 2


def _ascii(path: Path, data: bytes, position: int, where: str, count: int) -> tuple[Vector, int]:
    """Numbers of a set in text, and where it ends."""
    end = _END.search(data, position - 1)
    if end is None:
        raise DataError(f"{path}: {where} has no end; the file was cut off; export it again")
    body = data[position : end.start()]
    if body.count(b"D") or body.count(b"d"):
        body = _D_EXPONENT.sub(b"E", body)
    try:
        values = np.array(body.split(), dtype=np.float64)
    except ValueError as error:
        raise DataError(f"{path}: {where} holds what is no number ({error}); export it again") from None
    more = values.size - count
    if more < 0 or more > 5 or values[count:].any():
        raise DataError(
            f"{path}: {where} claims {count} numbers, the file holds {values.size}; it was cut off or damaged; export "
            "it again"
        )
    _check_values(path, where, values)
    return values[:count], end.end() - 1


def _check_values(path: Path, where: str, values: Vector) -> None:
    """Refuse what no sensor says: numbers of the other byte order are not finite, or beyond 1e30."""
    if not np.isfinite(values).all() or float(np.abs(values).max()) > 1e30:
        raise DataError(
            f"{path}: {where} holds numbers that are not finite, or beyond 1e30; is its byte order wrong? export it "
            "again, or as text (UFF 58)"
        )


def _axis(code: int, label: str, title: str, function: int) -> tuple[bool, float, str]:
    """Whether the axis is the time, its factor to SI (0: open), and a remark."""
    quantity, unit = KINDS.get(code, ""), find_unit(label)
    if unit is None and not label:
        unit = find_unit(title)
    if quantity not in ("time", "frequency"):
        quantity = unit.quantity if unit is not None else ""
    if quantity not in ("time", "frequency"):
        return function in (0, 1), 0.0, f"the axis has no unit that is known ({label or title or 'none'})"
    if unit is None:
        return quantity == "time", (0.0 if label else 1.0), f"axis in {label!r}" if label else ""
    if unit.quantity != quantity:
        return quantity == "time", 0.0, f"the axis is a {quantity} in {label!r}: a contradiction"
    return quantity == "time", unit.factor, ""


def _unit(code: int, label: str, units: Units | None) -> tuple[str, str]:
    """The unit of an ordinate, empty where label, type and dataset 164 leave it open, and a remark."""
    quantity, unit = KINDS.get(code, ""), find_ratio(label)
    if label and unit is None:
        return label, ""
    if unit is not None:
        if quantity and "/" not in unit.quantity and unit.quantity != quantity:
            return "", f"the file says {quantity} and the unit {label!r}: a contradiction"
        told = _factor(unit.quantity, units)
        if told is not None and unit.si != "m/s2" and abs(told / unit.factor - 1.0) > 1e-6:
            return "", f"the unit is {label!r}, dataset 164 says {told:g} of the SI unit: a contradiction"
        if told is not None and unit.si == "m/s2" and "g" not in label.lower() and abs(told / unit.factor - 1.0) > 1e-6:
            return "", f"the unit is {label!r}, dataset 164 says {told:g} m/s2: a contradiction"
        return label, ""
    told = _factor(quantity, units)
    if told is None:
        return "", f"the file says {quantity}, and no unit" if quantity else ""
    si = QUANTITIES[quantity]
    by_factor = {1.0: si, 1e-3: {"N": "mN"}.get(si, f"m{si}")}
    for factor, text in by_factor.items():
        if abs(told / factor - 1.0) < 1e-9 and find_unit(text) is not None:
            return text, "unit from dataset 164"
    return "", f"dataset 164 says {told:g} {si}, which has no name here"


def _factor(quantity: str, units: Units | None) -> float | None:
    """SI value of the unit of a quantity by dataset 164; None where it tells none."""
    if units is None:
        return None
    if quantity in ("displacement", "velocity", "acceleration"):
        return 1.0 / units.length
    return 1.0 / units.force if quantity == "force" else None
