"""Universal files as they are written: units, nodes, lines, and a binary dataset 58 for each channel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.records.channel import Channel, Values
from vehicle.records.units import find_unit

FUNCTIONS = {"time history": 1, "frequency response": 4, "coherence": 6}
CODES = {"displacement": 8, "velocity": 11, "acceleration": 12, "force": 13, "pressure": 15}
AXES = {"X": 1, "Y": 2, "Z": 3}


@dataclass(frozen=True, kw_only=True, slots=True)
class Geometry:
    """Where the places are.

    Attributes:
        points: place to its coordinates [m].
        lines: each a sequence of places that are drawn connected.
    """

    points: Mapping[str, Sequence[float]] = field(default_factory=dict)
    lines: Sequence[Sequence[str]] = ()


def write(path: Path, channels: tuple[Channel, ...], about: str, geometry: Geometry | None = None) -> None:
    """Write datasets 151, 164 (SI), 15, 82 and 58b in double precision.

    A frequency response keeps its longest run of lines that are defined: the format knows no missing value. Time and
    frequency steps have six digits in this format.

    Args:
        path: the file.
        channels: time histories, frequency responses and coherences over uniform axes.
        about: what the record is.
        geometry: of the places.

    Raises:
        DataError: a channel without an axis, or a time history with a missing value.
    """
    shape = geometry or Geometry()
    places = list(dict.fromkeys([*shape.points, *(one.place for one in channels if one.place)]))
    nodes = {place: number for number, place in enumerate(places, 1)}
    blocks = [_header(about)]
    if shape.points:
        rows = [
            f"{nodes[place]:10d}{0:10d}{0:10d}{11:10d}" + "".join(f"{float(value):13.5e}" for value in at)
            for place, at in shape.points.items()
        ]
        blocks.append(_set(15, rows))
    for number, line in enumerate(shape.lines, 1):
        ends = [nodes[place] for place in line]
        rows = ["".join(f"{node:10d}" for node in ends[n : n + 8]) for n in range(0, len(ends), 8)]
        blocks.append(_set(82, [f"{number:10d}{len(ends):10d}{11:10d}", f"{'-'.join(line)[:80]:<80}", *rows]))
    blocks += [_function(path, one, nodes) for one in channels]
    path.write_bytes(b"".join(blocks))


def _set(number: int, rows: Sequence[str]) -> bytes:
    return "\n".join(["    -1", f"{number:6d}", *rows, "    -1", ""]).encode("ascii", "replace")


def _header(about: str) -> bytes:
    empty = " " * 10
    date = f"{'01-Jan-00':<10}{'00:00:00':<10}"
    program = f"{'vehicle-on-shaker':<80}"
    rows = [f"{'car on a shaker':<80}", f"{about[:80]:<80}", program, date + 3 * f"{'0':>10}", date, program, date]
    factors = "".join(f"{number:25.16e}" for number in (1.0, 1.0, 1.0)).replace("e", "D")
    offset = f"{273.15:25.16e}".replace("e", "D")
    return _set(151, rows) + _set(164, [f"{1:10d}{'SI: Meter (newton)':<20}{2:10d}", factors, offset + empty])


def _label(unit: str) -> tuple[int, str]:
    known = find_unit(unit)
    return (CODES.get(known.quantity, 1) if known is not None else 0), unit[:20] or "NONE"


def _direction(text: str) -> int:
    return (-1 if text.startswith("-") else 1) * AXES.get(text[-1:], 0)


def _function(path: Path, one: Channel, nodes: Mapping[str, int]) -> bytes:
    """A channel as dataset 58b."""
    values, axis = _defined(path, one)
    step = float(axis[-1] - axis[0]) / (axis.size - 1)
    double = "<c16" if np.iscomplexobj(values) else "<f8"
    raw = values.astype(double).tobytes()
    upper, _, lower = one.unit.partition(")/") if one.unit.startswith("(") else (one.unit, "", "")
    node = nodes.get(one.place, 0)
    reference = one.reference[:-2] if one.reference[-2:-1] in ("+", "-") else one.reference
    to = _direction(one.reference[-2:]) if reference != one.reference else 0

    def item(code: int, label: str, title: str = "NONE") -> str:
        return f"{code:10d}{0:5d}{0:5d}{0:5d} {title[:20]:<20} {label:<20}"

    rows = [
        "    -1",
        f"{58:6d}b{1:6d}{2:6d}{11:12d}{len(raw):12d}{0:6d}{0:6d}{0:12d}{0:12d}",
        f"{one.name[:80]:<80}",
        *[f"{'NONE':<80}"] * 4,
        f"{FUNCTIONS.get(one.function, 0):5d}{0:10d}{0:5d}{0:10d} {'NONE':<10}{node:10d}{_direction(one.direction):4d} "
        f"{'NONE':<10}{nodes.get(reference, 0):10d}{to:4d}",
        f"{6 if double == '<c16' else 4:10d}{values.size:10d}{1:10d}{axis[0]:13.5e}{step:13.5e}{0.0:13.5e}",
        item(17, "s", "Time") if one.kind == "time" else item(18, "Hz", "Frequency"),
        item(*_label(upper.lstrip("(")), one.name),
        item(*_label(lower.strip("()"))) if lower else item(0, "NONE"),
        item(0, "NONE"),
    ]
    return ("\n".join(rows) + "\n").encode("ascii", "replace") + raw + b"\n    -1\n"


def _defined(path: Path, one: Channel) -> tuple[Values, NDArray[np.float64]]:
    """Values and axis without what is missing at the ends of a spectrum."""
    if one.axis is None or one.axis.size < 2:
        raise DataError(f"{path}: {one.name} has no axis; UFF needs one")
    finite = np.isfinite(one.values)
    if finite.all():
        return one.values, one.axis
    if one.kind == "time" or not finite.any():
        raise DataError(f"{path}: {one.name} has a missing value; UFF knows none")
    edges = np.flatnonzero(np.diff(np.concatenate([[False], finite, [False]]).astype(int)))
    runs = edges.reshape(-1, 2)
    begin, end = runs[int(np.argmax(runs[:, 1] - runs[:, 0]))]
    return one.values[begin:end], one.axis[begin:end]
