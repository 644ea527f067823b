"""Read OpenCRG road surfaces (ASAM OpenCRG 1.2): heights on a grid along a reference line, as text or binary."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.signals.formats.channel import ROAD_PROFILE, Channel, Measurement, check_length, uniform_axis

WIDTHS = {"LRFI": 10, "LDFI": 20}
"""Text formats of numbers: name to width of a number [characters]."""

BINARY = {"KRBI": ">f4", "KDBI": ">f8"}
"""Binary formats of numbers: name to NumPy type."""

LINE = 80
"""Length of a line of numbers, and block length of binary files [bytes]."""

LARGEST = 1e4
"""Maximum height of a road above sea level [m]; larger numbers come from shifted bytes."""

STEEPEST = 2.0
"""Maximum height of a step between two rows of a road [m], a wall that no wheel climbs; larger steps come from lost
bytes. On a line the road may be twice as high as long."""

_MOVES = re.compile(r"ref(point|line)_(offset_|rotcenter_)?(x|y|z|phi)|refpoint_[uv](_offset|_fraction)?")
"""Modifiers that move a road as a whole: a shift, a rotation in the plane, a constant height."""

_SECTION = re.compile(r"long section(?P<at> at v\s*=\s*(?P<v>[-+.\deE]+))?.*", re.IGNORECASE)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Surface:
    """Heights of a road surface on a grid along its reference line.

    Attributes:
        u: distances along the reference line [m], (n,), uniform.
        v: lateral positions, positive to the left [m], (k,), increasing.
        z: heights [m], (n, k); NaN outside the road.
        curved: True if the reference line is curved; it is used as a straight line.
        moved: names of the modifiers that move the road as a whole.
    """

    u: Vector
    v: Vector
    z: Vector
    curved: bool
    moved: tuple[str, ...] = ()

    def height(self, v: float) -> Vector:
        """Return the heights [m], (n,), of the track at v [m], linear between sections; NaN outside the road."""
        if not self.v[0] - 1e-9 <= v <= self.v[-1] + 1e-9:
            return np.full(self.u.size, np.nan)
        left = min(int(np.searchsorted(self.v, v, side="right")), self.v.size - 1)
        share = float(np.clip((v - self.v[left - 1]) / (self.v[left] - self.v[left - 1]), 0.0, 1.0))
        right, other = self.z[:, left - 1], self.z[:, left]
        return right if share < 1e-9 else other if share > 1.0 - 1e-9 else (1.0 - share) * right + share * other


def read_surface(path: Path) -> Surface:
    """Read an OpenCRG file as a road surface.

    z(u, v) = z_grid(u, v) + z_ref(u) + v b(u), with z_ref(u_i+1) = z_ref(u_i) + s(u_i+1) du with the slope s
    and the banking b, each constant or a channel.

    Raises:
        DataError: not an OpenCRG file, damaged, with modifiers of the surface, or with a reference to another file.

    Source: ASAM OpenCRG 1.2.0, file format; compared with its C library.
    """
    data = path.read_bytes()
    end = re.search(rb"^\$\$\$\$[^\n]*\n", data, re.MULTILINE)
    if end is None:
        if re.search(rb"^\$ROAD_CRG_FILE", data, re.MULTILINE | re.IGNORECASE):
            raise DataError(f"{path}: refers to another file ($ROAD_CRG_FILE) and contains no heights; use that file")
        raise DataError(f"{path}: no line $$$$ before the numbers; use a complete OpenCRG file")
    sections = _header(data[: end.start()].decode("latin-1"))
    moved = _modifiers(path, sections.get("ROAD_CRG_MODS", ()))
    numbers = _parameters(path, sections.get("ROAD_CRG", ()))
    definition = sections.get("KD_DEFINITION", ())
    number_format = next((line[2:6].upper() for line in definition if line.startswith("#:")), "")
    names, units = [], []
    for line in definition:
        if line.upper().startswith("D:"):
            name, _, unit = line[2:].partition(",")
            names.append(" ".join(name.split()).lower())
            units.append(unit.split(",")[0].strip())
    longs = [index for index, name in enumerate(names) if _SECTION.fullmatch(name)]
    if number_format not in WIDTHS and number_format not in BINARY:
        raise DataError(
            f"{path}: the numbers have the format {number_format!r}; must be one of {', '.join([*WIDTHS, *BINARY])}"
        )
    if len(longs) < 2 or any(units[index] not in ("m", "") for index in longs):
        raise DataError(f"{path}: has {len(longs)} long sections (columns of heights), but at least 2 are needed")
    step = numbers.get("reference_line_increment", 0.0)
    if not 0.0 < step < 100.0:
        raise DataError(f"{path}: reference_line_increment {step:g} m; must be above 0")
    start, last = numbers.get("reference_line_start_u", 0.0), numbers.get("reference_line_end_u")
    rows = None if last is None else round((last - start) / step) + 1
    table = _table(path, data[end.end() :], number_format, len(names), rows)
    if float(np.nanmax(np.abs(table), initial=0.0)) > LARGEST:
        raise DataError(
            f"{path}: has a height of {np.nanmax(np.abs(table)):.3g} m, but at most {LARGEST:g} m is possible; the "
            "file "
            "is damaged, perhaps by a transfer that changes line ends; copy it as a binary file"
        )
    jump = np.nan_to_num(np.abs(np.diff(table[:, longs], axis=0))).max(axis=1)
    high = np.flatnonzero(jump > STEEPEST + 2.0 * step)
    if high.size:
        raise DataError(
            f"{path}: the height changes by {jump[high[0]]:.3g} m between rows {high[0] + 1} and {high[0] + 2} of the "
            f"numbers, {step:g} m apart, but must change by at most {STEEPEST + 2.0 * step:.3g} m; the file is "
            "damaged; export it "
            "again"
        )
    u, v = uniform_axis(table.shape[0], step, start), _places(path, [names[index] for index in longs], numbers)

    def along(name: str, letter: str) -> Vector:
        if f"reference line {name}" not in names:
            return np.full(u.size, numbers.get(f"reference_line_start_{letter}", 0.0))
        return np.nan_to_num(table[:, names.index(f"reference line {name}")])  # the first value of a slope is not used

    slope, banking = along("slope", "s"), along("banking", "b")
    rise = numbers.get("reference_line_start_z", 0.0) + np.concatenate([[0.0], np.cumsum(slope[1:]) * step])
    phi = "reference line phi"
    heading = table[1:, names.index(phi)] if phi in names else np.zeros(0)  # the first value of a heading is not used
    return Surface(
        u=u,
        v=v,
        z=table[:, longs] + rise[:, None] + banking[:, None] * v[None, :],
        curved=np.unique(heading[np.isfinite(heading)]).size > 1,
        moved=moved,
    )


def read(path: Path) -> Measurement:
    """Read an OpenCRG file as channels: the distance, and the heights of each long section."""
    surface = read_surface(path)
    channels = [Channel(name="distance", values=surface.u, unit="m", function=ROAD_PROFILE)]
    channels += [
        Channel(name=f"v = {v:.3f} m", values=surface.z[:, index], unit="m", function=ROAD_PROFILE)
        for index, v in enumerate(surface.v)
    ]
    return Measurement(
        path=path, format="crg", channels=tuple(channels), program="OpenCRG", notices=(road_words(surface),)
    )


def road_words(surface: Surface) -> str:
    """Describe a road surface: size, spacing, missing points, curved reference line."""
    step = float(surface.u[1] - surface.u[0])
    outside = int(np.count_nonzero(np.isnan(surface.z)))
    return (
        f"road surface of {surface.u[-1] - surface.u[0]:.6g} m by {surface.v[-1] - surface.v[0]:.4g} m, with a "
        f"height every {step:.4g} m along the road and {surface.v.size} sections across (v to the left)"
        + (f"; {outside} points are missing" if outside else "")
        + ("; its curved reference line is used as a straight line" if surface.curved else "")
        + (f"; {', '.join(surface.moved)} move the road as a whole and are ignored" if surface.moved else "")
    )


def _header(text: str) -> dict[str, list[str]]:
    """Return the lines of each section of the header, without comments."""
    sections: dict[str, list[str]] = {}
    section = ""
    for line in text.splitlines():
        if line.startswith("*"):
            continue
        content = line.split("!")[0].strip()
        if content.startswith("$"):
            section = content[1:].strip().upper()
        elif content and section != "CT":
            sections.setdefault(section, []).append(content)
    return sections


def _modifiers(path: Path, lines: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the modifiers that move the road as a whole: a car drives over the same heights."""
    moved = []
    for name, value in _parameters(path, lines, "ROAD_CRG_MODS").items():
        if _MOVES.fullmatch(name):
            moved.append(name)
        elif not (name.startswith("scale_") and value == 1.0):
            raise DataError(
                f"{path}: the modifier {name} = {value:g} ($ROAD_CRG_MODS) changes the surface and is not supported; "
                "save the modified road instead"
            )
    return tuple(moved)


def _parameters(path: Path, lines: Sequence[str], section: str = "ROAD_CRG") -> dict[str, float]:
    """Return the parameters of a section."""
    parameters = {}
    for line in lines:
        name, sign, value = line.partition("=")
        if sign:
            try:
                parameters[name.strip().lower()] = float(value)
            except ValueError:
                raise DataError(f"{path}: {line!r} in ${section}: the value must be a number") from None
    return parameters


def _places(path: Path, names: list[str], numbers: dict[str, float]) -> Vector:
    """Return the lateral positions v of the long sections [m], from their names or from the increment."""
    matches = [_SECTION.fullmatch(name) for name in names]
    if all(match and match["v"] for match in matches):
        positions = np.array([float(match["v"]) for match in matches if match])
    else:
        step = numbers.get("long_section_v_increment")
        if step is None:
            raise DataError(
                f"{path}: the lateral positions v are missing; add long_section_v_increment, or name the "
                "sections by their v"
            )
        right = numbers.get("long_section_v_right", -0.5 * step * (len(names) - 1))
        positions = right + step * np.arange(len(names))
    if not (np.diff(positions) > 0.0).all():
        raise DataError(f"{path}: the long sections must go from right to left; v must increase")
    return positions


def _table(path: Path, data: bytes, number_format: str, columns: int, rows: int | None) -> Vector:
    """Return the table of numbers, (rows, columns); NaN for stars in a text file."""
    if number_format in BINARY:
        number_type = np.dtype(BINARY[number_format])
        if rows is None:
            rows = len(data) // (number_type.itemsize * columns)
        needed = rows * columns * number_type.itemsize
        check_length(path, needed, len(data), "its header")
        if len(data) - needed >= LINE + 2:
            raise DataError(
                f"{path}: has {len(data)} bytes of numbers, but its header states {needed}; it is damaged, "
                "perhaps by a transfer that changes line ends; copy it as a binary file"
            )
        with np.errstate(invalid="ignore"):  # the caller rejects invalid numbers by their magnitude
            return np.frombuffer(data, number_type, rows * columns).astype(np.float64).reshape(rows, columns)
    width = WIDTHS[number_format]
    per_line = LINE // width
    lines = [line for line in data.decode("latin-1").splitlines() if line.strip()]
    per_row = -(-columns // per_line)
    if len(lines) % per_row or not lines or (rows is not None and len(lines) != rows * per_row):
        claim = "" if rows is None else f"; its header states {rows} rows"
        raise DataError(
            f"{path}: {len(lines)} lines of numbers, must be {per_row} for each row of {columns} values{claim}; "
            "the file is truncated or damaged: export it again"
        )
    cells = []
    for start in range(0, len(lines), per_row):
        row = "".join(line.ljust(LINE)[: per_line * width] for line in lines[start : start + per_row])
        cells.append([row[n * width : (n + 1) * width].strip() for n in range(columns)])
        cell_count = sum(map(bool, cells[-1])) + bool(row[columns * width :].strip())
        if cell_count != columns:
            raise DataError(
                f"{path}: row {len(cells)} of the numbers has {'more' if cell_count > columns else 'fewer'} than the "
                f"{columns} numbers of its header; the file is damaged: export it again"
            )
    try:
        numbers = [[np.nan if cell.startswith("*") else float(cell) for cell in row] for row in cells]
    except ValueError as error:
        raise DataError(f"{path}: numbers in the format {number_format}: {error}; the file is damaged") from None
    return np.array(numbers)
