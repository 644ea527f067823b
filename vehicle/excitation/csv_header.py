"""The header line of a signal file: which column holds which quantity in which unit; nothing is mapped by position."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from vehicle.errors import DataError
from vehicle.names import WHEELS

NEEDED = "'time [s]' and 'displacement [m]' (or 'displacement_fr [m]', 'displacement_fl [m]'); [mm] is accepted"

_LENGTH_UNITS = {"m": 1.0, "mm": 1e-3}
_CELL = re.compile(r"^(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?$")
_OTHER_QUANTITY = re.compile(r"(^|_)(acc|vel)|^[av](_|$)", re.IGNORECASE)
_OTHER_UNITS = {"m/s", "mm/s", "m/s2", "m/s^2", "m/s²", "mm/s2", "mm/s^2", "mm/s²", "g"}


@dataclass(frozen=True, kw_only=True, slots=True)
class CsvHeader:
    """What the columns of the file mean."""

    delimiter: str
    """Sign between two cells."""
    cells: tuple[str, ...]
    """Header cells as written, without blanks and quotes around them."""
    time_column: int
    """Index of the time column [s]."""
    wheel_columns: dict[str, int]
    """Wheel -> index of its displacement column."""
    factors: dict[str, float]
    """Wheel -> factor from the unit of its column to metres."""
    units: dict[str, str]
    """Wheel -> unit of its column as declared, 'm' or 'mm'."""
    notices: tuple[str, ...]
    """What was accepted although it is unusual."""


def parse_header(path: Path, line: int, text: str, *, wheel: str) -> CsvHeader:
    """Read the header line; `wheel` is the one that a plain `displacement` column drives.

    Raises:
        DataError: no header, unit missing or not allowed, unknown, missing or duplicate columns, another quantity.
    """
    delimiter = next((sign for sign in (";", "\t") if sign in text), ",")
    cells = tuple(cell.strip().strip('"').strip() for cell in text.split(delimiter))
    found = ", ".join(repr(cell) for cell in cells)
    where = f"{path}:{line}"
    if any(_is_number(cell) for cell in cells):
        raise DataError(f"{where}:1: no header line: found {found}; needed are the columns {NEEDED}")
    columns: dict[str, int] = {}
    factors: dict[str, float] = {}
    unknown = []
    notices = []
    for index, cell in enumerate(cells):
        match = _CELL.match(cell)
        name = match["name"].lower() if match else cell
        unit = match["unit"].strip() if match and match["unit"] is not None else None
        place = f"{where}:{index + 1}"
        if unit in _OTHER_UNITS or _OTHER_QUANTITY.search(name):
            raise DataError(
                f"{place}: column {cell!r} is an acceleration or a velocity; the plate needs a displacement. It is "
                "not integrated "
                "here: drift makes double integration depend on a high-pass filter that only you can choose. "
                "Integrate it, "
                f"record the filter in a '#' comment and give {NEEDED}"
            )
        if name not in {"time", "displacement", *(f"displacement_{known}" for known in WHEELS)}:
            unknown.append(repr(cell))
            continue
        key = f"displacement_{wheel}" if name == "displacement" else name
        if key in columns:
            raise DataError(
                f"{place}: column {cell!r} gives the same quantity as column {columns[key] + 1} "
                f"({cells[columns[key]]!r}); "
                f"each may appear once; found {found}"
            )
        columns[key] = index
        factors[key] = _factor(place, name, cell, unit)
        if factors[key] != 1.0:
            notices.append(f"column {cell!r} converted from {unit} to m")
    if unknown:
        raise DataError(
            f"{where}: unknown column {', '.join(unknown)}; found {found}; needed are {NEEDED}; remove the others"
        )
    driven = [known for known in WHEELS if f"displacement_{known}" in columns]
    if "time" not in columns or not driven:
        missing = "time" if "time" not in columns else "displacement"
        raise DataError(f"{where}: no {missing} column; found {found}; needed are {NEEDED}")
    if delimiter != ",":
        notices.append(f"delimiter {delimiter!r} accepted; ',' is the usual one")
    return CsvHeader(
        delimiter=delimiter,
        cells=cells,
        time_column=columns["time"],
        wheel_columns={known: columns[f"displacement_{known}"] for known in driven},
        factors={known: factors[f"displacement_{known}"] for known in driven},
        units={known: "m" if factors[f"displacement_{known}"] == 1.0 else "mm" for known in driven},
        notices=tuple(notices),
    )


def _factor(place: str, name: str, cell: str, unit: str | None) -> float:
    allowed = "[s]" if name == "time" else "[m] or [mm]"
    if not unit:
        raise DataError(
            f"{place}: column {cell!r} has no unit; write it in brackets behind the name, allowed: {allowed}"
        )
    if name == "time" and unit == "s":
        return 1.0
    if name != "time" and unit in _LENGTH_UNITS:
        return _LENGTH_UNITS[unit]
    hint = "; divide the column by 1000 and write [s]" if name == "time" and unit == "ms" else ""
    raise DataError(f"{place}: column {cell!r} has the unit [{unit}]; allowed: {allowed}{hint}")


def _is_number(cell: str) -> bool:
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    return True
