"""Units in the words of a table: with the name in a header, or of length in a remark."""

import re
from collections.abc import Iterator

from vehicle.studies.tables.unit_factor import LENGTH, unit_factor

_UNIT_AT_END = re.compile(r"^(.*?)[\s_]*(?:\[([^\]]*)\]|\(([^)]*)\)|,\s*([^,\s]+)|[ _](mm|cm|inch|kg))$")
_OF_UNITS = re.compile(
    r"\bunits?\b|\beinheit|\[(mm|cm|m|in|inch)\]|\(mm\)|\bin mm\b|\bin millimet|\ball\b.*\bmm\b|\blength|"
    r"\binch(es)?\b|\bmillimet|\bmet(er|re)s\b|[,;(] *(mm|cm|m) *([,;).]|$)"
)


def name_and_unit(cell: str) -> tuple[str, str]:
    """Return the name of a header and its unit such as "x [mm]", "mass (kg)", "track, m", "x_mm"; "" for no unit."""
    match = _UNIT_AT_END.fullmatch(cell.strip())
    if match is None or match[3] == "1":
        # "M_US(1)" counts an axle.
        return cell.strip(), ""
    unit = next(group for group in match.groups()[1:] if group is not None)
    return (match[1].strip(), unit.strip()) if unit == "" or unit_factor(unit) is not None else (cell.strip(), "")


def length_unit(text: str) -> str:
    """Return the unit of length that a remark states: "all in mm", "units: mm", "x [m]"; "" for none."""
    terms = list(_units(text))
    return terms[0] if len(set(terms)) == 1 else ""


def _units(text: str) -> Iterator[str]:
    lowered = text.lower()
    stated = _OF_UNITS.search(lowered)
    if stated:
        for word in re.findall(r"[a-z]+", lowered[stated.start() :]):
            unit = unit_factor(word)
            if unit is not None and unit.dimension == LENGTH and word != "in":
                yield {"millimetres": "mm", "millimeters": "mm", "millimeter": "mm"}.get(word, word)
