"""Write universal files: units, nodes, lines, one dataset 58 per channel, one dataset 55 per mode."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.analysis.samples import Vector
from vehicle.signals.formats.channel import Channel, Values, even_step
from vehicle.signals.formats.geometry import Geometry, ModeShape
from vehicle.signals.formats.units import find_unit

FUNCTIONS = {"time history": 1, "frequency response": 4, "coherence": 6}
CODES = {"displacement": 8, "velocity": 11, "acceleration": 12, "force": 13, "pressure": 15}
AXES = {"X": 1, "Y": 2, "Z": 3}


def write(
    path: Path,
    channels: Sequence[Channel],
    description: str,
    geometry: Geometry | None = None,
    shapes: Sequence[ModeShape] = (),
) -> None:
    """Write datasets 151, 164 (SI), 15, 82, 58b in double precision, and 55.

    Only the longest run of defined lines of a frequency response is written, as the format has no missing values.
    Steps and uneven frequencies have six digits in this format; functions over uneven frequencies are written as text.

    Args:
        channels: time histories, frequency responses and coherences over uniform axes.
        geometry: coordinates and lines of the points.
        shapes: mode shapes at the points.
    """
    wireframe = geometry or Geometry()
    points = list(dict.fromkeys([*wireframe.points, *(channel.place for channel in channels if channel.place)]))
    points += [name for name in dict.fromkeys(point for mode in shapes for point in mode.points) if name not in points]
    nodes = {point: number for number, point in enumerate(points, 1)}
    blocks = [_header(description)]
    if wireframe.points:
        rows = [
            f"{nodes[point]:10d}{0:10d}{0:10d}{11:10d}" + "".join(f"{float(value):13.5e}" for value in coordinates)
            for point, coordinates in wireframe.points.items()
        ]
        blocks.append(_set(15, rows))
    for number, line in enumerate(wireframe.lines, 1):
        ends = [nodes[point] for point in line]
        rows = ["".join(f"{node:10d}" for node in ends[n : n + 8]) for n in range(0, len(ends), 8)]
        blocks.append(_set(82, [f"{number:10d}{len(ends):10d}{11:10d}", f"{'-'.join(line)[:80]:<80}", *rows]))
    blocks += [_function(path, channel, nodes) for channel in channels]
    blocks += [_shape(mode, nodes) for mode in shapes]
    path.write_bytes(b"".join(blocks))


def _set(number: int, rows: Sequence[str]) -> bytes:
    return "\n".join(["    -1", f"{number:6d}", *rows, "    -1", ""]).encode("ascii", "replace")


def _header(description: str) -> bytes:
    empty = " " * 10
    date = f"{'01-Jan-00':<10}{'00:00:00':<10}"
    program = f"{'vehicle-on-shaker':<80}"
    rows = [
        f"{'car on a shaker':<80}",
        f"{description[:80]:<80}",
        program,
        date + 3 * f"{'0':>10}",
        date,
        program,
        date,
    ]
    factors = "".join(f"{number:25.16e}" for number in (1.0, 1.0, 1.0)).replace("e", "D")
    offset = f"{273.15:25.16e}".replace("e", "D")
    return _set(151, rows) + _set(164, [f"{1:10d}{'SI: Meter (newton)':<20}{2:10d}", factors, offset + empty])


def _label(unit: str) -> tuple[int, str]:
    unit_entry = find_unit(unit)
    return (CODES.get(unit_entry.quantity, 1) if unit_entry is not None else 0), unit[:20] or "NONE"


def _direction(text: str) -> int:
    return (-1 if text.startswith("-") else 1) * AXES.get(text[-1:], 0)


def _function(path: Path, channel: Channel, nodes: Mapping[str, int]) -> bytes:
    """Format a channel as dataset 58b or 58, in SI units as in dataset 164, except accelerations in g."""
    unit_entry = find_unit(channel.unit)
    if unit_entry is not None and unit_entry.factor != 1.0 and "g" not in channel.unit:
        channel = replace(channel, values=channel.si_values, unit=unit_entry.si)
    values, axis = _defined(path, channel)
    step = even_step(axis)
    if step is None and channel.kind == "time":
        raise DataError(f"{path}: {channel.name} has uneven times; resample the channel")
    double = "<c16" if np.iscomplexobj(values) else "<f8"
    if step is None:
        first_line, body = f"{58:6d}{'':74}", _uneven(axis, values)
    else:
        raw = values.astype(double).tobytes()
        first_line = f"{58:6d}b{1:6d}{2:6d}{11:12d}{len(raw):12d}{0:6d}{0:6d}{0:12d}{0:12d}"
        body = raw + b"\n"
    upper, _, lower = channel.unit.partition(")/") if channel.unit.startswith("(") else (channel.unit, "", "")
    node = nodes.get(channel.place, 0)
    reference = channel.reference[:-2] if channel.reference[-2:-1] in ("+", "-") else channel.reference
    reference_direction = _direction(channel.reference[-2:]) if reference != channel.reference else 0

    def item(code: int, label: str, title: str = "NONE") -> str:
        return f"{code:10d}{0:5d}{0:5d}{0:5d} {title[:20]:<20} {label:<20}"

    rows = [
        "    -1",
        first_line,
        f"{channel.name[:80]:<80}",
        *[f"{'NONE':<80}"] * 4,
        f"{FUNCTIONS.get(channel.function, 0):5d}{0:10d}{0:5d}{0:10d} "
        f"{'NONE':<10}{node:10d}{_direction(channel.direction):4d} "
        f"{'NONE':<10}{nodes.get(reference, 0):10d}{reference_direction:4d}",
        f"{6 if double == '<c16' else 4:10d}{values.size:10d}"
        + (f"{0:10d}{0.0:13.5e}{0.0:13.5e}" if step is None else f"{1:10d}{axis[0]:13.5e}{step:13.5e}")
        + f"{0.0:13.5e}",
        item(17, "s", "Time") if channel.kind == "time" else item(18, "Hz", "Frequency"),
        item(*_label(upper.lstrip("(")), channel.name),
        item(*_label(lower.strip("()"))) if lower else item(0, "NONE"),
        item(0, "NONE"),
    ]
    return ("\n".join(rows) + "\n").encode("ascii", "replace") + body + b"    -1\n"


def _uneven(axis: Vector, values: Values) -> bytes:
    """Format frequencies with values: one complex value per row, or two real values per row."""
    parts = [
        f"{x:13.5e}" + "".join(f"{number:20.11e}" for number in _parts(value))
        for x, value in zip(axis, values, strict=True)
    ]
    if not np.iscomplexobj(values):
        parts = ["".join(parts[n : n + 2]) for n in range(0, len(parts), 2)]
    return ("\n".join(parts) + "\n").encode("ascii")


def _parts(value: complex) -> tuple[float, ...]:
    return (value.real, value.imag) if isinstance(value, complex) else (value,)


def _shape(mode: ModeShape, nodes: Mapping[str, int]) -> bytes:
    """Format a mode as dataset 55; a complex mode with its eigenvalue and Modal A, and Modal B = -s A."""
    is_complex = mode.is_complex
    components = 6 if np.any(mode.shape[:, 3:]) else 3
    code = CODES.get(mode.quantity, 8)
    rows = [f"{text[:80] or 'NONE':<80}" for text in ("", "", "", mode.name, f"{mode.frequency:.6g} Hz")]
    rows.append(
        f"{1:10d}{3 if is_complex else 2:10d}{3 if components == 6 else 2:10d}{code:10d}{5 if is_complex else 2:10d}"
        f"{components:10d}"
    )
    size = 2.0 * np.pi * mode.frequency
    if is_complex:
        pole = size * complex(-mode.damping_ratio, np.sqrt(max(1.0 - mode.damping_ratio**2, 0.0)))
        numbers = [part for value in (pole, mode.modal_a, -pole * mode.modal_a) for part in (value.real, value.imag)]
    else:
        numbers = [mode.frequency, mode.modal_mass, mode.damping_ratio, 0.0]
    rows.append(f"{2:10d}{len(numbers):10d}{1:10d}{mode.number:10d}")
    rows.append("".join(f"{number:13.5e}" for number in numbers))
    for point, motion in zip(mode.points, mode.shape[:, :components], strict=True):
        values = [part for value in motion for part in ((value.real, value.imag) if is_complex else (value.real,))]
        rows.append(f"{nodes[point]:10d}")
        rows += ["".join(f"{number:13.5e}" for number in values[n : n + 6]) for n in range(0, len(values), 6)]
    return _set(55, rows)


def _defined(path: Path, channel: Channel) -> tuple[Values, Vector]:
    """Return values and axis of the longest run of defined values of a spectrum."""
    if channel.axis is None or channel.axis.size < 2:
        raise DataError(f"{path}: {channel.name} has no time or frequency axis, which UFF requires; leave it out")
    finite = np.isfinite(channel.values)
    if finite.all():
        return channel.values, channel.axis
    if channel.kind == "time" or not finite.any():
        raise DataError(f"{path}: {channel.name} has a missing value, which UFF cannot store; leave it out")
    edges = np.flatnonzero(np.diff(np.concatenate([[False], finite, [False]]).astype(int)))
    runs = edges.reshape(-1, 2)
    begin, end = runs[int(np.argmax(runs[:, 1] - runs[:, 0]))]
    return channel.values[begin:end], channel.axis[begin:end]
