"""OpenCRG road surfaces (ASAM OpenCRG 1.2): heights over a grid along a reference line, as text or binary."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.signals.records.channel import Channel, Measurement, check_length, uniform_axis
from vehicle.signals.records.reader import digest
from vehicle.signals.records.table import Vector

WIDTHS = {"LRFI": 10, "LDFI": 20}
"""Name of a text format to the width of a number in its lines of 80 characters."""

BINARY = {"KRBI": ">f4", "KDBI": ">f8"}
"""Name of a binary format to the type of its numbers."""

LINE = 80
"""Length of a line of numbers, and of the blocks that a binary file is padded to [bytes]."""

LARGEST = 1e4
"""Largest height of a road above the sea [m]; bytes that were shifted make numbers of any size."""

_SECTION = re.compile(r"long section(?P<at> at v\s*=\s*(?P<v>[-+.\deE]+))?.*", re.IGNORECASE)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Surface:
    """Heights of a road over its own coordinates.

    Attributes:
        u: places along the reference line [m], (n,), uniform.
        v: places across it, to the left [m], (k,), increasing.
        z: heights [m], (n, k); NaN outside the road.
        curved: True if the reference line is curved: the car follows it as if it were straight.
        sha256: of the file.
    """

    u: Vector
    v: Vector
    z: Vector
    curved: bool
    sha256: str

    def height(self, v: float) -> Vector:
        """Return the heights of a track [m], (n,), linear between two sections as in OpenCRG; NaN outside the road.

        Args:
            v: place across the reference line, to the left [m].
        """
        if not self.v[0] - 1e-9 <= v <= self.v[-1] + 1e-9:
            return np.full(self.u.size, np.nan)
        left = min(int(np.searchsorted(self.v, v, side="right")), self.v.size - 1)
        share = float(np.clip((v - self.v[left - 1]) / (self.v[left] - self.v[left - 1]), 0.0, 1.0))
        right, other = self.z[:, left - 1], self.z[:, left]
        return right if share < 1e-9 else other if share > 1.0 - 1e-9 else (1.0 - share) * right + share * other


def read_surface(path: Path) -> Surface:
    """Read a road surface.

    z(u, v) = z_grid(u, v) + z_ref(u) + v b(u), with z_ref(u_i+1) = z_ref(u_i) + s(u_i+1) du of the slope s, and the
    banking b; both constant or a channel.

    Args:
        path: the file.

    Raises:
        DataError: no such surface, a damaged file, modifiers, or a reference to another file.

    Source: ASAM OpenCRG 1.2.0, file format; compared with its C library.
    """
    data = path.read_bytes()
    end = re.search(rb"^\$\$\$\$[^\n]*\n", data, re.MULTILINE)
    if end is None:
        if re.search(rb"^\$ROAD_CRG_FILE", data, re.MULTILINE | re.IGNORECASE):
            raise DataError(f"{path}: refers to another file ($ROAD_CRG_FILE) and holds no heights; give that file")
        raise DataError(f"{path}: no line $$$$ before the numbers; needed is a complete OpenCRG file")
    sections = _header(data[: end.start()].decode("latin-1"))
    if any(sections.get("ROAD_CRG_MODS", ())):
        raise DataError(f"{path}: $ROAD_CRG_MODS changes the heights, which is not read; save the changed road instead")
    numbers = _parameters(path, sections.get("ROAD_CRG", ()))
    definition = sections.get("KD_DEFINITION", ())
    form = next((line[2:6].upper() for line in definition if line.startswith("#:")), "")
    names, units = [], []
    for line in definition:
        if line.upper().startswith("D:"):
            name, _, unit = line[2:].partition(",")
            names.append(" ".join(name.split()).lower())
            units.append(unit.split(",")[0].strip())
    longs = [index for index, name in enumerate(names) if _SECTION.fullmatch(name)]
    if form not in WIDTHS and form not in BINARY:
        raise DataError(f"{path}: numbers of the form {form!r}; allowed are {', '.join([*WIDTHS, *BINARY])}")
    if len(longs) < 2 or any(units[index] not in ("m", "") for index in longs):
        raise DataError(f"{path}: {len(longs)} long sections in m; at least two are needed")
    step = numbers.get("reference_line_increment", 0.0)
    if not 0.0 < step < 100.0:
        raise DataError(f"{path}: reference_line_increment {step:g} m; must be above 0")
    start, last = numbers.get("reference_line_start_u", 0.0), numbers.get("reference_line_end_u")
    rows = None if last is None else round((last - start) / step) + 1
    table = _table(path, data[end.end() :], form, len(names), rows)
    if float(np.nanmax(np.abs(table), initial=0.0)) > LARGEST:
        raise DataError(
            f"{path}: holds {np.nanmax(np.abs(table)):.3g}, no height in m; the file was damaged, perhaps by a "
            "transfer that changes line ends; copy it as a binary file"
        )
    u, v = uniform_axis(table.shape[0], step, start), _places(path, [names[index] for index in longs], numbers)

    def along(name: str, letter: str) -> Vector:
        column = next((index for index, one in enumerate(names) if one == f"reference line {name}"), None)
        if column is None:
            return np.full(u.size, numbers.get(f"reference_line_start_{letter}", 0.0))
        return np.nan_to_num(table[:, column])  # the first number of a slope is not used

    slope, banking = along("slope", "s"), along("banking", "b")
    rise = numbers.get("reference_line_start_z", 0.0) + np.concatenate([[0.0], np.cumsum(slope[1:]) * step])
    heading = next((table[:, index] for index, one in enumerate(names) if one == "reference line phi"), np.zeros(1))
    return Surface(
        u=u,
        v=v,
        z=table[:, longs] + rise[:, None] + banking[:, None] * v[None, :],
        curved=bool(np.nanmax(heading[1:] if heading.size > 1 else heading) - np.nanmin(heading[-1:]) != 0.0),
        sha256=digest(path),
    )


def read(path: Path) -> Measurement:
    """Read a road surface as channels: the distance, and the heights of each long section."""
    surface = read_surface(path)
    channels = [Channel(name="distance", values=surface.u, unit="m", function="road profile")]
    channels += [
        Channel(name=f"v = {v:.3f} m", values=surface.z[:, index], unit="m", function="road profile")
        for index, v in enumerate(surface.v)
    ]
    return Measurement(
        path=path,
        format="crg",
        channels=tuple(channels),
        sha256=surface.sha256,
        program="OpenCRG",
        notices=(road_words(surface),),
    )


def road_words(surface: Surface) -> str:
    """Return a sentence on a surface: its size, what lies outside, its reference line."""
    step = float(surface.u[1] - surface.u[0])
    outside = int(np.count_nonzero(np.isnan(surface.z)))
    return (
        f"road surface of {surface.u[-1] - surface.u[0]:.6g} m by {surface.v[-1] - surface.v[0]:.4g} m, every "
        f"{step:.4g} m along and {surface.v.size} sections across (v to the left)"
        + (f"; {outside} points are missing" if outside else "")
        + ("; its reference line is curved and is driven along as a straight one" if surface.curved else "")
    )


def _header(text: str) -> dict[str, list[str]]:
    """Return the lines of each section of the header, without comments."""
    found: dict[str, list[str]] = {}
    section = ""
    for line in text.splitlines():
        if line.startswith("*"):
            continue
        plain = line.split("!")[0].strip()
        if plain.startswith("$"):
            section = plain[1:].strip().upper()
        elif plain and section != "CT":
            found.setdefault(section, []).append(plain)
    return found


def _parameters(path: Path, lines: list[str] | tuple[str, ...]) -> dict[str, float]:
    """Return the numbers of the road section."""
    found = {}
    for line in lines:
        name, sign, value = line.partition("=")
        if sign:
            try:
                found[name.strip().lower()] = float(value)
            except ValueError:
                raise DataError(f"{path}: {line!r} in $ROAD_CRG: needed is a number") from None
    return found


def _places(path: Path, names: list[str], numbers: dict[str, float]) -> Vector:
    """Return the places v of the long sections [m]: written in their names, or an increment from the right edge."""
    matches = [_SECTION.fullmatch(name) for name in names]
    if all(match and match["v"] for match in matches):
        places = np.array([float(match["v"]) for match in matches if match])
    else:
        step = numbers.get("long_section_v_increment")
        if step is None:
            raise DataError(f"{path}: long_section_v_increment is missing, and the sections do not name their v")
        right = numbers.get("long_section_v_right", -0.5 * step * (len(names) - 1))
        places = right + step * np.arange(len(names))
    if not (np.diff(places) > 0.0).all():
        raise DataError(f"{path}: the long sections must go from right to left; v must increase")
    return places


def _table(path: Path, data: bytes, form: str, columns: int, rows: int | None) -> Vector:
    """Return the numbers, (rows, columns); NaN where a text file writes stars."""
    if form in BINARY:
        kind = np.dtype(BINARY[form])
        if rows is None:
            rows = len(data) // (kind.itemsize * columns)
        needed = rows * columns * kind.itemsize
        check_length(path, needed, len(data), "its header")
        if len(data) - needed >= LINE + 2:
            raise DataError(
                f"{path}: {len(data)} bytes of numbers, its header tells {needed}; the file was damaged, perhaps by a "
                "transfer that changes line ends; copy it as a binary file"
            )
        with np.errstate(invalid="ignore"):  # bytes that are no numbers are judged by their size
            return np.frombuffer(data, kind, rows * columns).astype(np.float64).reshape(rows, columns)
    width = WIDTHS[form]
    each = LINE // width
    lines = [line for line in data.decode("latin-1").splitlines() if line.strip()]
    per_row = -(-columns // each)
    if len(lines) % per_row or not lines or (rows is not None and len(lines) != rows * per_row):
        told = "" if rows is None else f", its header tells {rows} rows"
        raise DataError(
            f"{path}: {len(lines)} lines of numbers, {per_row} for each row of {columns}{told}; the file was cut "
            "off or damaged; export it again"
        )
    cells = []
    for start in range(0, len(lines), per_row):
        row = "".join(line.ljust(LINE)[: each * width] for line in lines[start : start + per_row])
        cells.append([row[n * width : (n + 1) * width].strip() for n in range(columns)])
    try:
        numbers = [[np.nan if not cell or cell.startswith("*") else float(cell) for cell in row] for row in cells]
    except ValueError as error:
        raise DataError(f"{path}: numbers of the form {form}: {error}; the file is damaged") from None
    return np.array(numbers)
