"""Reading a record of acceleration: `time [s],x [m/s2],y [m/s2],z [m/s2]`, refused rather than guessed at.

Longer than a page because every way in which such files are damaged in practice has its own message.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehicle.errors import ConfigurationError, DataError

AXES = ("x", "y", "z")
STANDARD_GRAVITY = 9.80665
"""[m/s2], ISO 80000-3, for records in g"""
UNITS = {"m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "g": STANDARD_GRAVITY}
"""accepted units of acceleration and their value in m/s2"""
LARGEST_FILE = 256 * 1024 * 1024
"""bytes; about two hours at 1 kHz, and a gigabyte of memory while it is read"""
LONGEST_LINE = 1_000_000
"""characters"""
TIME_TOLERANCE = 1e-3
"""largest deviation of a time step from the median step, relative (bad-inputs item 3) [-]"""
LARGEST_ACCELERATION = 50.0
"""deviation from the mean above which a record is taken for one in a wrong unit (bad-inputs item 7) [m/s2]"""
ALIASED_SHARE = 0.05
"""share of the variance above 0.8 of Nyquist that is worth a notice (bad-inputs item 12) [-]"""


@dataclass(frozen=True, kw_only=True, slots=True)
class AccelerationRecord:
    """Acceleration of one point in three axes, uniformly sampled."""

    time_step: float
    """[s]"""
    xyz: NDArray[np.float64]
    """[m/s2], shape (3, n)"""
    notices: tuple[str, ...]
    """what a careful reader should know; empty when nothing is odd"""


def _text(path: Path) -> str:
    """Return the text of the file, refusing what is no text."""
    try:
        size = path.stat().st_size
        if not path.is_file():
            raise ConfigurationError(f"{path}: not a file; give a CSV file")
        if size > LARGEST_FILE:
            raise DataError(f"{path}: {size} bytes, allowed are {LARGEST_FILE}; cut the record into parts")
        raw = path.read_bytes()
    except FileNotFoundError:
        raise ConfigurationError(f"{path}: no such file") from None
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read ({error.strerror})") from None
    if b"\0" in raw:
        line = raw.count(b"\n", 0, raw.index(b"\0")) + 1
        raise DataError(f"{path}:{line}: a NUL byte; needed is a CSV file in UTF-8")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise DataError(f"{path}:{line}: byte 0x{raw[error.start]:02x} is not UTF-8; save the file as UTF-8") from None


def _columns(path: Path, number: int, header: str) -> dict[str, tuple[int, float]]:
    """Return for each needed column its position and its factor to SI units."""
    needed = "time [s], x [m/s2], y [m/s2], z [m/s2] (or [g])"
    if "," not in header and (";" in header or "\t" in header):
        raise DataError(
            f"{path}:{number}: columns are separated by {'semicolons' if ';' in header else 'tabs'}; "
            "save the file with commas between columns and points as decimal signs"
        )
    cells = [cell.strip() for cell in header.split(",")]
    shown = ", ".join(cells)[:200]
    found: dict[str, tuple[int, float]] = {}
    for position, cell in enumerate(cells):
        parts = re.fullmatch(r"(\S+)\s*\[([^\]]*)\]", cell)
        name, unit = (parts[1], parts[2].strip()) if parts else (cell, "")
        if name not in ("time", *AXES):
            raise DataError(f"{path}:{number}: unknown column {cell!r}; found {shown}; needed are {needed}")
        if name in found:
            raise DataError(f"{path}:{number}: column {name!r} appears twice; found {shown}; needed are {needed}")
        units = {"s": 1.0} if name == "time" else UNITS
        if unit not in units:
            raise DataError(
                f"{path}:{number}: column {name!r} has the unit {unit!r}, allowed are "
                f"{', '.join(f'[{u}]' for u in units)}; write the header as {needed}"
            )
        found[name] = (position, units[unit])
    missing = [name for name in ("time", *AXES) if name not in found]
    if missing:
        raise DataError(f"{path}:{number}: no column {', '.join(missing)}; found {shown}; needed are {needed}")
    return found


def _numbers(path: Path, rows: list[tuple[int, str]], names: list[str]) -> NDArray[np.float64]:
    """Return the values (n, 4); on any doubt find the line and the column to blame."""
    try:
        values = np.loadtxt([line for _, line in rows], delimiter=",", ndmin=2, dtype=np.float64, comments=None)
    except ValueError:
        values = np.empty((0, 0))
    if values.shape == (len(rows), len(names)) and np.isfinite(values).all():
        return values
    for number, line in rows:
        cells = line.split(",")
        if len(cells) != len(names):
            raise DataError(
                f"{path}:{number}: {len(cells)} values, the header names {len(names)} columns; "
                "a decimal comma or a cut line? write one value for each column, with points"
            )
        for name, cell in zip(names, cells, strict=True):
            try:
                finite = np.isfinite(float(cell))
            except ValueError:
                finite = False
            if not finite or "_" in cell:
                raise DataError(
                    f"{path}:{number}: column {name!r} holds {cell.strip()[:40]!r}, needed is a finite number; "
                    "repair or cut the record"
                )
    raise DataError(f"{path}: the values cannot be read as numbers; write them as plain decimal numbers")


def _time_step(path: Path, time: NDArray[np.float64], lines: list[int]) -> float:
    """Return the uniform time step [s], refusing repeated, decreasing and uneven stamps."""
    steps = np.diff(time)
    if np.any(steps <= 0.0):
        i = int(np.argmax(steps <= 0.0))
        raise DataError(
            f"{path}:{lines[i + 1]}: time {time[i + 1]:.9g} s does not come after {time[i]:.9g} s; two records in "
            "one file? time must increase from line to line"
        )
    median = float(np.median(steps))
    uneven = np.abs(steps / median - 1.0)
    if uneven.max() > TIME_TOLERANCE:
        i = int(np.argmax(uneven > TIME_TOLERANCE))
        raise DataError(
            f"{path}:{lines[i + 1]}: time step {steps[i]:.6g} s, the median is {median:.6g} s; allowed is a relative "
            f"deviation of {TIME_TOLERANCE:g}; resample the record to uniform steps"
        )
    return float((time[-1] - time[0]) / (time.size - 1))


def _notices(xyz: NDArray[np.float64], rate: float) -> tuple[str, ...]:
    """Return remarks on constant axes and on content near Nyquist."""
    found = []
    for axis, record in zip(AXES, xyz, strict=True):
        power = np.abs(np.fft.rfft(record - record.mean())) ** 2
        total = float(power.sum())
        if np.ptp(record) == 0.0:
            found.append(f"{axis}: constant at {record[0]:g} m/s2 (no sensor?)")
        elif total > 0.0:
            share = float(power[int(0.8 * power.size) :].sum()) / total
            if share > ALIASED_SHARE:
                found.append(
                    f"{axis}: {100 * share:.0f} % of the variance lies above {0.4 * rate:g} Hz (0.8 of Nyquist); "
                    "the record may be aliased"
                )
    return tuple(found)


def read_acceleration(path: str | Path) -> AccelerationRecord:
    """Read a record of acceleration in three axes from a CSV file.

    UTF-8 (with or without byte order mark), `#` comments, one header line with units, commas, points, any order of the
    columns, any line ends.

    Args:
        path: the file.

    Returns:
        The record in SI units.

    Raises:
        ConfigurationError: no such file.
        DataError: anything in it that is not as described; the message names line and column.
    """
    file = Path(path)
    rows: list[tuple[int, str]] = []
    for number, line in enumerate(_text(file).splitlines(), start=1):
        if len(line) > LONGEST_LINE:
            raise DataError(f"{file}:{number}: a line of {len(line)} characters, allowed are {LONGEST_LINE}")
        if line.strip() and not line.lstrip().startswith("#"):
            rows.append((number, line))
    if not rows:
        raise DataError(f"{file}: empty; needed are a header and samples")
    columns = _columns(file, *rows[0])
    names = sorted(columns, key=lambda name: columns[name][0])
    if len(rows) < 4:
        raise DataError(f"{file}: {len(rows) - 1} samples after the header, at least 3 are needed")
    values = _numbers(file, rows[1:], names)
    step = _time_step(file, values[:, columns["time"][0]], [number for number, _ in rows[1:]])
    xyz = np.stack([values[:, columns[axis][0]] * columns[axis][1] for axis in AXES])
    swing = np.abs(xyz - xyz.mean(axis=1, keepdims=True)).max(axis=1)
    worst = int(np.argmax(swing))
    if swing[worst] > LARGEST_ACCELERATION:
        raise DataError(
            f"{file}: column {AXES[worst]!r} swings by {swing[worst]:g} m/s2 about its mean, allowed are "
            f"{LARGEST_ACCELERATION:g}; looks like mm/s2 or a spike? correct the unit in the header or the record"
        )
    return AccelerationRecord(time_step=step, xyz=xyz, notices=_notices(xyz, 1.0 / step))
