"""A march with given numbers, and zeros or empty arrays for all others: for tests of its parts."""

from typing import Any

import numpy as np

from vehicle.core.records import NUMBERS, Packed, array_kinds, dtype, packed, records

EMPTY = {"double": np.float64, "int64_t": np.int64, "REAL": np.float64}


def idle_march(**given: Any) -> Packed:
    """Return the record March with these fields."""
    fields: dict[str, Any] = {}
    for kind, name in records()["March"]:
        if name in given:
            fields[name] = given[name]
        elif kind in NUMBERS:
            fields[name] = 0
        elif array_kinds()[kind].element == "void":
            fields[name] = np.zeros((0, 4))
        else:
            element = array_kinds()[kind].element
            fields[name] = np.zeros((0,) * array_kinds()[kind].dimensions, dtype=EMPTY.get(element) or dtype(element))
    return packed("March", fields)
