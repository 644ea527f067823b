"""Header of a block of a table: kind and unit of each column."""

import re
from dataclasses import dataclass

from vehicle.studies.tables.cell_units import name_and_unit
from vehicle.studies.tables.cells import Row
from vehicle.studies.tables.name_words import AXLES, CORNERS, SIDES, words_of
from vehicle.studies.tables.number_names import QUALIFIERS

COLUMNS = {
    "name": "keyword name point hardpoint parameter quantity description bezeichnung punkt variable item property "
            "symbol location element groesse größe kenngröße",
    "unit": "unit units einheit",
    "value": "value wert val values",
    "side": "side symmetry seite",
    "axle": "axle achse",
    "skip": "source comment comments note notes reason remark remarks bemerkung quelle reference meaning",
}  # fmt: skip
"""Kind of a column -> words of its header."""

KINDS = {word: sort for sort, terms in COLUMNS.items() for word in terms.split()}
_COORDINATE = re.compile(r"(?:loc|pos|coord|coordinate)?[ _]*([xyz])(?:[ _]*(?:value|coordinate|coord|pos|loc))?", re.I)
_BUSHING = re.compile(r"(?:translational |linear )?(k|c|d|stiffness|damping|steifigkeit|dämpfung)(?: in)?[ _-]*([xyz])",
                      re.IGNORECASE)  # fmt: skip
VELOCITY, FORCE = ("velocity", "speed", "geschwindigkeit", "v"), ("force", "kraft", "f")


@dataclass(frozen=True, kw_only=True, slots=True)
class Heads:
    """Header of a block: index and unit of each column by its kind, axles of values, columns of names."""

    columns: dict[str, int]
    units: dict[str, str]
    axles: dict[int, tuple[str, str]]
    width: int
    names: list[int]

    @property
    def triples(self) -> list[str]:
        """Return the letters of the columns k, c, d, s that have x, y and z: stiffness or damping, by their units."""
        return [letter for letter in "kcds" if {f"{letter}{axis}" for axis in "xyz"} <= set(self.columns)]

    @property
    def limits(self) -> list[int]:
        """Return the columns of limits and of the laden car: "GVW", "max"."""
        return [index for key, index in self.columns.items() if key.startswith("skip") and key != "skip"]

    @property
    def is_curve(self) -> bool:
        """Return True for the velocities and forces of a damper."""
        return {"velocity", "force"} <= set(self.columns)


def axle_of(plain: list[str]) -> tuple[str, str] | None:
    """Return axle and side of the words of a column or row of one axle or wheel; None for other words."""
    if not plain or not set(plain) <= {*AXLES, *SIDES, *CORNERS, "axle", "f", "r", "value", "wheel"}:
        return None
    word = next((word for word in plain if word in (*AXLES, *CORNERS, "f", "r")), "")
    side = next((word for word in plain if word in SIDES), "")
    return CORNERS.get(word, ({"f": "front", "r": "rear"}.get(word, word), side))


def read_heads(row: Row) -> Heads | None:
    """Return the header that a row is; None for another text."""
    columns: dict[str, int] = {}
    units: dict[str, str] = {}
    axles: dict[int, tuple[str, str]] = {}
    names: list[int] = []
    has_velocity = any((plain := words_of(cell)) and plain[0] in VELOCITY for cell in row.cells)
    for index, cell in enumerate(row.cells):
        text, unit = name_and_unit(cell)
        plain = words_of(text)
        coordinate = _COORDINATE.fullmatch(text)
        if bushing := _BUSHING.fullmatch(text):
            sort = f"{bushing[1][0].lower()}{bushing[2].lower()}"
            columns.setdefault(sort, index)
            units.setdefault(sort, unit)
            continue
        sort = coordinate[1].lower() if coordinate else next((KINDS[word] for word in text.lower().split()
                                                              if word in KINDS), "")  # fmt: skip
        if sort in ("axle", "side") and {*AXLES, *SIDES} & set(plain):
            sort = ""  # "Rear axle" is a title.
        if not sort and plain and plain[0] in VELOCITY:
            sort = "velocity"
        elif not sort and plain and plain[0] in FORCE and has_velocity:
            sort = "force"
        elif not sort and (QUALIFIERS - {"tyre"}) & set(plain):
            sort = f"skip{index}"
        elif not sort and (axle := axle_of(plain)) is not None:
            axles[index] = axle
        if sort == "name":
            names.append(index)
        if sort and sort not in columns:
            columns[sort] = index
            units[sort] = unit
        elif unit and index in axles:
            units[f"axle{index}"] = unit
    title = next((cell for index, cell in enumerate(row.cells) if cell and index not in columns.values()), "")
    quantity = next((letter for word, letter in (("rate", "k"), ("damping", "c")) if word in words_of(title)), "")
    if quantity and {"x", "y", "z"} <= set(columns):
        # "Bushing stiffness (N/mm),x,y,z" heads no coordinates.
        for axis in "xyz":
            columns[f"{quantity}{axis}"] = columns.pop(axis)
            units[f"{quantity}{axis}"] = units.pop(axis) or name_and_unit(title)[1]
    heads = Heads(columns=columns, units=units, axles=axles, width=len(row.cells), names=names)
    points = {"x", "y", "z"} <= set(columns)
    has_value = "value" in columns and sum(map(bool, row.cells)) > 1
    has_limits = {"name", "unit"} <= set(columns) and bool(heads.limits)
    if not (points or heads.triples or heads.is_curve or has_value or has_limits or len(axles) > 1):
        return None
    if "name" not in columns:
        in_use = {*columns.values(), *(() if points else axles)}
        free = [index for index in range(len(row.cells)) if index not in in_use]
        columns["name"] = free[0] if free else 0
    return heads
