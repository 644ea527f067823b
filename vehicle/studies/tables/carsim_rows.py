"""Rows of a CarSim parameter file (`.par`): keyword with the indices of axle and side, value, unit.

    IAXLE 1                        axle of the keywords below that have no index
    M_US 71 ; kg ! unsprung mass   -> M_US(1), 71, kg; the mass of an axle
    L_TRACK(2) 1675                -> L_TRACK(2), 1675
    FS_COMP_TABLE ... ENDTABLE     left out

Source: text of parameter files ("parsfiles") of CarSim: keyword, value, unit after a semicolon, remark after "!".
"""

import re
from pathlib import Path

from vehicle.signals.formats.text import read_text
from vehicle.studies.tables.cells import NUMBER, Row
from vehicle.studies.tables.name_words import name_words
from vehicle.studies.tables.number_names import number_of

_LINE = re.compile(r"\*?([A-Z][A-Z0-9_]*)(?:\((\d)(?:, *(\d))?\))?\s+([^\s;!]+)\s*(?:;\s*([^!]*))?(?:!.*)?")


def carsim_rows(path: Path) -> tuple[list[Row], list[str]]:
    """Return a row for each known keyword, and the other keywords."""
    rows: list[Row] = []
    others: list[str] = []
    index = {"IAXLE": "", "ISIDE": ""}
    in_table = False
    for number, line in enumerate(read_text(path).lines, 1):
        match = _LINE.fullmatch(line.strip())
        if line.strip().startswith("ENDTABLE"):
            in_table = False
        elif match is None or in_table:
            continue
        elif match[1] in index:
            index[match[1]] = match[4]
        elif match[1].endswith(("_TABLE", "_CARPET")):
            in_table = True
            others.append(match[1])
        elif NUMBER.fullmatch(match[4]):
            axle, side = match[2] or index["IAXLE"], match[3] or ("" if match[2] else index["ISIDE"])
            name = name_words(match[1], right_letter="")
            listed = number_of(name) or number_of(name_words(f"front {match[1]}", right_letter=""))
            if listed is None or not listed[2]:
                others.append(match[1])
                continue
            indices = f"({axle},{side})" if axle and side else f"({axle})" if axle else ""
            note = "axle" if listed[0] == "unsprung_mass" else ""
            cells = (f"{match[1]}{indices}", match[4], (match[5] or "").strip(), note)
            rows.append(Row(where=f"{path}:{number}", sheet="", cells=cells, is_loose=True))
    return rows, others
