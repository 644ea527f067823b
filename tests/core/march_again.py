"""Recorded marches, run again by a library of the core: `python -m tests.core.march_again FILE` runs all of a file.

It imports numpy and the core alone, so that it also runs with a checked memory (`tools/core_sanitized.py`).
"""

import ctypes
import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.core.library import core
from vehicle.core.records import packed
from vehicle.engines.reduced.table_layout import VECTOR_BYTES, aligned_table

Fields = dict[str, Any]


def copied(value: Any) -> Any:
    """Return a copy of an array, aligned if it is an array of vectors; other values as they are."""
    if not isinstance(value, np.ndarray):
        return value
    if value.ndim == 2 and value.dtype.kind == "f" and value.shape[1] * value.itemsize == VECTOR_BYTES:
        result = aligned_table(len(value), value.dtype)
        result[:] = value
        return result
    return value.copy()


def after(march: Callable[[ctypes.c_void_p], None], fields: Fields) -> Fields:
    """Return the arrays after the march of a block by a function of a library."""
    copy = {name: copied(value) for name, value in fields.items()}
    record = packed("March", copy)
    march(ctypes.c_void_p(record.address))
    return {name: value for name, value in copy.items() if isinstance(value, np.ndarray)}


if __name__ == "__main__":
    numbers = 0
    for fields, single in pickle.loads(Path(sys.argv[1]).read_bytes()):
        for variant in (1,) if core().core_variant() == 1 else (2, 3):
            after(getattr(core(), f"march_{'f' if single else 'd'}{variant}"), fields)
            numbers += 1
    print(numbers, "marches")
