"""Read dataset 58 of a universal file: a function at a node, in text or binary."""

import re
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import Channel, Values, check_length, clock_step, uniform_axis
from vehicle.signals.formats.uff_blocks import D_EXPONENT, END, Block, cells, check_values, raw_text, text_of
from vehicle.signals.formats.uff_geometry import Units
from vehicle.signals.formats.units import QUANTITIES, find_ratio, find_unit

DIRECTIONS = {0: "", **{sign * (n + 1): f"{'+' if sign > 0 else '-'}{axis}"
                        for sign in (1, -1) for n, axis in enumerate(("X", "Y", "Z", "RX", "RY", "RZ"))}}  # fmt: skip
FUNCTIONS = {
    1: "time history",
    2: "auto spectrum",
    3: "cross spectrum",
    4: "frequency response",
    5: "transmissibility",
    6: "coherence",
    9: "power spectral density",
    12: "spectrum",
    26: "coherence",
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
"""Specific data type -> quantity; 0 and 1 are unknown."""

_WORDS = re.compile(r"\s*(\S.*?|)\s+(\d+)\s+(-?\d+)\s+(\S.*?|)\s+(-?\d+)\s+(-?\d+)\s*")
"""Name, node and direction of the response, then of the reference, separated by blanks."""


def read_function(path: Path, data: bytes, block: Block, where: str, units: Units | None) -> tuple[Channel, str, int]:
    """Read a dataset 58: return the channel, its date, and the byte position after the dataset."""
    lines, position = _lines(data, block.start, 11)
    if len(lines) < 11:
        raise DataError(f"{path}: {where} ends within its header; the file is truncated: export it again")
    try:
        nodes = _points(lines[5])
        layout = cells(lines[6], (10, 10, 10, 13, 13, 13))
        data_type, points, spacing = (int(layout[n] or 0) for n in range(3))
        first, step = (float((layout[n] or "0").replace("D", "E")) for n in (3, 4))
        axes = [_axis_cells(lines[n]) for n in (7, 8, 9)]
        codes = [int(axis[0] or 0) for axis in axes]
        function = int(nodes[0] or 0)
        directions = [int(nodes[n] or 0) for n in (6, 9)]
    except ValueError as error:
        raise DataError(f"{path}: {where} has an invalid header ({error}); export it again") from None
    if data_type not in (2, 4, 5, 6) or points < 1 or spacing not in (0, 1) or not np.isfinite([first, step]).all():
        raise DataError(
            f"{path}: {where}: found data type {data_type}, {points} points, spacing {spacing}; must be type 2, "
            "4, 5 or 6, at least 1 point, spacing 0 or 1"
        )
    per_point = (2 if data_type > 4 else 1) + (spacing == 0)
    if block.binary:
        numbers, position = _binary(path, data, block, position, where, data_type, (points, per_point), spacing == 0)
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
        step, rounded = clock_step(step * scale) if is_time else (step * scale, "")
        remarks.append(rounded)
        axis = uniform_axis(points, step, first * scale)
    else:
        remarks.append("no time step in the file" if is_time else "no frequency step in the file")
    columns = table[:, 1:] if spacing == 0 else table
    values: Values = columns[:, 0]
    if data_type > 4:
        values = columns[:, 0] + 1j * columns[:, 1]
        if function in (6, 26) or not np.any(values.imag):
            values = values.real if function not in (4, 5) else values
    unit, remark = _unit(codes[1], labels[1], units)
    if function in (4, 5) and (labels[2] or codes[2] > 1):
        lower, other_remark = _unit(codes[2], labels[2], units)
        unit, remark = (f"({unit})/({lower})" if unit and lower else ""), remark or other_remark
    remarks.append(remark)
    node, entity = nodes[5], nodes[4]
    point = entity if entity and not re.fullmatch(r"\d+[+-][XYZ]", entity) else "" if node in ("", "0") else node
    reference = "" if nodes[8] in ("", "0", "-1") else nodes[8] + DIRECTIONS.get(directions[1], "")
    channel = Channel(
        name=text_of(lines[0]) or entity,
        values=values.copy(),
        unit=unit,
        axis=axis,
        kind="time" if is_time else "frequency",
        function=FUNCTIONS.get(function, f"function of type {function}" if function else "general function"),
        place=point,
        direction=DIRECTIONS.get(directions[0], ""),
        reference=reference if function in (3, 4, 5, 6, 26) else "",
        remark="; ".join(text for text in remarks if text),
    )
    return channel, text_of(lines[2]), position


def _points(line: bytes) -> list[str]:
    """Return the cells of function, response point and reference: fixed columns, or words if a name exceeds its ten.

    The format gives a name ten letters and a node ten digits; a longer name moves all following columns.
    """
    fixed, text = cells(line, (5, 10, 5, 10, 11, 10, 4, 11, 10, 4)), raw_text(line)
    whole = all(re.fullmatch(r"(-?\d+)?", fixed[n]) for n in (5, 6, 8, 9))
    if whole and not any(_cut(text, at) and len(fixed[n]) < 10 for at, n in ((41, 5), (66, 8))):
        return fixed
    match = _WORDS.fullmatch(text[30:])
    if match is None:
        raise ValueError(
            f"the line {text[30:].strip()[:40]!r} has no nodes and directions (names of up to ten letters)"
        )
    return [*fixed[:4], *("" if word.upper() == "NONE" else word for word in match.groups())]


def _axis_cells(line: bytes) -> list[str]:
    """Return the cells of an axis: fixed columns, or the last word as unit if the title exceeds its twenty letters."""
    fixed, text = cells(line, (10, 5, 5, 5, 21, 21)), raw_text(line)
    if not _cut(text, 46):
        return fixed
    title, _, unit = text[25:].strip().rpartition(" ")
    return [*fixed[:4], title.strip(), "" if unit.upper() == "NONE" else unit]


def _cut(text: str, at: int) -> bool:
    """Return True if the boundary of two columns is within a word."""
    return len(text) > at and not text[at - 1].isspace() and not text[at].isspace()


def _lines(data: bytes, start: int, count: int) -> tuple[list[bytes], int]:
    """Return the lines from a byte position, and the position after them."""
    lines: list[bytes] = []
    while len(lines) < count and (end := data.find(b"\n", start)) >= 0:
        lines.append(data[start:end])
        start = end + 1
    return lines, start


def _binary(
    path: Path,
    data: bytes,
    block: Block,
    position: int,
    where: str,
    data_type: int,
    shape: tuple[int, int],
    uneven: bool,
) -> tuple[Vector, int]:
    """Read the numbers of a binary dataset; return them and the byte position after the dataset."""
    head = cells(block.first, (6, 6, 12, 12))
    try:
        order, number, stated_bytes = int(head[0] or 1), int(head[1] or 2), int(head[3] or 0)
    except ValueError:
        raise DataError(f"{path}: {where} has an invalid first line; export it again") from None
    if order not in (1, 2) or number != 2:
        raise DataError(
            f"{path}: {where}: byte order {order} (1 or 2) and numbers of type {number} (2, IEEE) are not supported; "
            "export it as text (UFF 58)"
        )
    sign, width = "<" if order == 1 else ">", 4 if data_type in (2, 5) else 8
    row = np.dtype(f"({shape[1]},){sign}f{width}")
    if uneven and width == 8 and stated_bytes == shape[0] * (row.itemsize - 4):
        row = np.dtype([("x", f"{sign}f4"), ("y", f"({shape[1] - 1},){sign}f8")])  # as specified by the format
    size = shape[0] * row.itemsize
    check_length(path, size, len(data) - position, where)
    if stated_bytes not in (0, size):
        raise DataError(
            f"{path}: {where}: states {stated_bytes} bytes of data for {shape[0] * shape[1]} numbers of {width} "
            "bytes; the file is damaged: export it again"
        )
    tail = data[position + size : position + size + 16].lstrip(b"\r\n ")
    if not tail.startswith(b"-1"):
        raise DataError(
            f"{path}: {where}: has no end after its {size} bytes of data; the file is damaged, perhaps sent as "
            "text; export it again"
        )
    rows_read = np.frombuffer(data, row, shape[0], position)
    values = (np.column_stack([rows_read["x"], rows_read["y"]]) if row.names else rows_read).astype(np.float64).ravel()
    check_values(path, where, values)
    return values, data.index(b"-1", position + size) + 2


def _ascii(path: Path, data: bytes, position: int, where: str, count: int) -> tuple[Vector, int]:
    """Read the numbers of a text dataset; return them and the byte position after the dataset."""
    end = END.search(data, position - 1)
    if end is None:
        raise DataError(f"{path}: {where} has no end; the file is truncated: export it again")
    body = data[position : end.start()]
    if body.count(b"D") or body.count(b"d"):
        body = D_EXPONENT.sub(b"E", body)
    try:
        values = np.array(body.split(), dtype=np.float64)
    except ValueError as error:
        raise DataError(f"{path}: {where} has an invalid number ({error}); export it again") from None
    more = values.size - count
    if more < 0 or more > 5 or values[count:].any():
        raise DataError(
            f"{path}: {where} states {count} numbers, but contains {values.size}; the file is truncated or "
            "damaged; export it again"
        )
    check_values(path, where, values)
    return values[:count], end.end() - 1


def _axis(code: int, label: str, title: str, function: int) -> tuple[bool, float, str]:
    """Return True for a time axis, its factor to SI (0: unknown), and a remark."""
    quantity, unit = KINDS.get(code, ""), find_unit(label)
    if unit is None and not label:
        unit = find_unit(title)
    if quantity not in ("time", "frequency"):
        quantity = unit.quantity if unit is not None else ""
    if quantity not in ("time", "frequency"):
        return function in (0, 1), 0.0, f"the axis has no known unit ({label or title or 'none'})"
    if unit is None:
        return quantity == "time", (0.0 if label else 1.0), f"axis in {label!r}" if label else ""
    if unit.quantity != quantity:
        return quantity == "time", 0.0, f"the axis is stated as a {quantity}, but in {label!r}, which contradicts it"
    return quantity == "time", unit.factor, ""


def _unit(code: int, label: str, units: Units | None) -> tuple[str, str]:
    """Return the unit of an ordinate from label, data type and dataset 164, empty if unknown, and a remark."""
    quantity, unit = KINDS.get(code, ""), find_ratio(label)
    if label and unit is None:
        return label, ""
    if unit is not None:
        if quantity and "/" not in unit.quantity and unit.quantity != quantity:
            return "", f"quantity {quantity}, unit {label!r}: a contradiction"
        dataset_factor, acceleration = _factor(unit.quantity, units), unit.si == "m/s2"
        gravity = acceleration and "g" in label.lower()
        if dataset_factor is not None and not gravity and abs(dataset_factor / unit.factor - 1.0) > 1e-6:
            si = "m/s2" if acceleration else "of the SI unit"
            return "", f"the unit {label!r} contradicts the {dataset_factor:g} {si} of dataset 164"
        return label, ""
    dataset_factor = _factor(quantity, units)
    if dataset_factor is None:
        return "", f"quantity {quantity}, without unit" if quantity else ""
    si = QUANTITIES[quantity]
    by_factor = {1.0: si, 1e-3: {"N": "mN"}.get(si, f"m{si}")}
    for factor, text in by_factor.items():
        if abs(dataset_factor / factor - 1.0) < 1e-9 and find_unit(text) is not None:
            return text, "unit from dataset 164"
    return "", f"the unit {dataset_factor:g} {si} of dataset 164 has no known name"


def _factor(quantity: str, units: Units | None) -> float | None:
    """Return the SI value of the unit of a quantity from dataset 164; None if unknown."""
    if units is None:
        return None
    if quantity in ("displacement", "velocity", "acceleration"):
        return 1.0 / units.length
    return 1.0 / units.force if quantity == "force" else None
