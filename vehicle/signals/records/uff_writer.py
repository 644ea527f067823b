"""Universal files as they are written: units, nodes, lines, a dataset 58 for each channel, a 55 for each mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Values, even_step
from vehicle.signals.records.geometry import Geometry, ModeShape
from vehicle.signals.records.units import find_unit

FUNCTIONS = {"time history": 1, "frequency response": 4, "coherence": 6}
CODES = {"displacement": 8, "velocity": 11, "acceleration": 12, "force": 13, "pressure": 15}
AXES = {"X": 1, "Y": 2, "Z": 3}


def write(
    path: Path,
    channels: Sequence[Channel],
    about: str,
    geometry: Geometry | None = None,
    shapes: Sequence[ModeShape] = (),
) -> None:
    """Write datasets 151, 164 (SI), 15, 82, 58b in double precision, and 55.

    A frequency response keeps its longest run of lines that are defined: the format knows no missing value. Steps, and
    frequencies that are not even, have six digits in this format; functions over such frequencies are written as text.

    Args:
        path: the file.
        channels: time histories, frequency responses and coherences over uniform axes.
        about: what the record is.
        geometry: of the places.
        shapes: modes, whose points are places.

    Raises:
        DataError: a channel without an axis, or a time history with a missing value or uneven times.
    """
    shape = geometry or Geometry()
    places = list(dict.fromkeys([*shape.points, *(one.place for one in channels if one.place)]))
    places += [name for name in dict.fromkeys(point for one in shapes for point in one.points) if name not in places]
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
    blocks += [_shape(one, nodes) for one in shapes]
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
    """A channel as dataset 58b, or as text; in SI, which dataset 164 tells, but for accelerations in g."""
    known = find_unit(one.unit)
    if known is not None and known.factor != 1.0 and "g" not in one.unit:
        one = replace(one, values=one.si_values, unit=known.si)
    values, axis = _defined(path, one)
    step = even_step(axis)
    if step is None and one.kind == "time":
        raise DataError(f"{path}: {one.name} has uneven times; resample it")
    double = "<c16" if np.iscomplexobj(values) else "<f8"
    if step is None:
        form, body = f"{58:6d}{'':74}", _uneven(axis, values)
    else:
        raw = values.astype(double).tobytes()
        form = f"{58:6d}b{1:6d}{2:6d}{11:12d}{len(raw):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
        body = raw + b"\n"
    upper, _, lower = one.unit.partition(")/") if one.unit.startswith("(") else (one.unit, "", "")
    node = nodes.get(one.place, 0)
    reference = one.reference[:-2] if one.reference[-2:-1] in ("+", "-") else one.reference
    to = _direction(one.reference[-2:]) if reference != one.reference else 0

    def item(code: int, label: str, title: str = "NONE") -> str:
        return f"{code:10d}{0:5d}{0:5d}{0:5d} {title[:20]:<20} {label:<20}"

    rows = [
        "    -1",
        form,
        f"{one.name[:80]:<80}",
        *[f"{'NONE':<80}"] * 4,
        f"{FUNCTIONS.get(one.function, 0):5d}{0:10d}{0:5d}{0:10d} {'NONE':<10}{node:10d}{_direction(one.direction):4d} "
        f"{'NONE':<10}{nodes.get(reference, 0):10d}{to:4d}",
        f"{6 if double == '<c16' else 4:10d}{values.size:10d}"
        + (f"{0:10d}{0.0:13.5e}{0.0:13.5e}" if step is None else f"{1:10d}{axis[0]:13.5e}{step:13.5e}")
        + f"{0.0:13.5e}",
        item(17, "s", "Time") if one.kind == "time" else item(18, "Hz", "Frequency"),
        item(*_label(upper.lstrip("(")), one.name),
        item(*_label(lower.strip("()"))) if lower else item(0, "NONE"),
        item(0, "NONE"),
    ]
    return ("\n".join(rows) + "\n").encode("ascii", "replace") + body + b"    -1\n"


def _uneven(axis: NDArray[np.float64], values: Values) -> bytes:
    """Rows of a frequency and its value, complex ones in a row each, real ones two in a row."""
    parts = [
        f"{x:13.5e}" + "".join(f"{number:20.11e}" for number in _parts(value))
        for x, value in zip(axis, values, strict=True)
    ]
    if not np.iscomplexobj(values):
        parts = ["".join(parts[n : n + 2]) for n in range(0, len(parts), 2)]
    return ("\n".join(parts) + "\n").encode("ascii")


def _parts(value: complex) -> tuple[float, ...]:
    return (value.real, value.imag) if isinstance(value, complex) else (value,)


def _shape(one: ModeShape, nodes: Mapping[str, int]) -> bytes:
    """A mode as dataset 55; a complex one by its eigenvalue and Modal A, with Modal B = -s A."""
    complex_one = one.is_complex
    components = 6 if np.any(one.shape[:, 3:]) else 3
    code = CODES.get(one.quantity, 8)
    rows = [f"{text[:80] or 'NONE':<80}" for text in ("", "", "", one.name, f"{one.frequency:.6g} Hz")]
    rows.append(
        f"{1:10d}{3 if complex_one else 2:10d}{3 if components == 6 else 2:10d}{code:10d}{5 if complex_one else 2:10d}"
        f"{components:10d}"
    )
    size = 2.0 * np.pi * one.frequency
    if complex_one:
        pole = size * complex(-one.damping_ratio, np.sqrt(max(1.0 - one.damping_ratio**2, 0.0)))
        numbers = [part for value in (pole, one.modal_a, -pole * one.modal_a) for part in (value.real, value.imag)]
    else:
        numbers = [one.frequency, one.modal_mass, one.damping_ratio, 0.0]
    rows.append(f"{2:10d}{len(numbers):10d}{1:10d}{one.number:10d}")
    rows.append("".join(f"{number:13.5e}" for number in numbers))
    for point, motion in zip(one.points, one.shape[:, :components], strict=True):
        values = [part for value in motion for part in ((value.real, value.imag) if complex_one else (value.real,))]
        rows.append(f"{nodes[point]:10d}")
        rows += ["".join(f"{number:13.5e}" for number in values[n : n + 6]) for n in range(0, len(values), 6)]
    return _set(55, rows)


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
