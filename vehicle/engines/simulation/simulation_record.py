"""Records of a simulation for the core: one state of a car with its rows, see `vehicle/core/source/callback.c`."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from vehicle.core.library import core
from vehicle.core.records import Packed, checked, packed
from vehicle.engines.simulation.sparse_rows import Pattern, solution_of, sparse_rows
from vehicle.engines.simulation.structures import ROW_FIELDS, offsets

if TYPE_CHECKING:
    from vehicle.engines.simulation.rows import Rows

ADDRESS, INTEGER, REAL = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double

SIGNATURES = {
    "locate": (None, INTEGER, INTEGER),
    "attach": (None, ADDRESS, ADDRESS),
    "detach": (None, ADDRESS, ADDRESS),
    "rewrite": (None, ADDRESS, ADDRESS),
    "damper_force": (REAL, ADDRESS, INTEGER),
    "control": (None, ADDRESS, ADDRESS),
    "gain": (REAL, ADDRESS, ADDRESS, ctypes.c_int),
    "bias": (REAL, ADDRESS, ADDRESS, ctypes.c_int),
    "set_plates": (None, ADDRESS, INTEGER),
    "keep_row": (None, ADDRESS, INTEGER, REAL),
    "run_steps": (INTEGER, ADDRESS, INTEGER, INTEGER, INTEGER),
}
"""Functions of the core that Python calls: type of the result and types of the arguments."""


def functions() -> ctypes.CDLL:
    """Return the core with the types of its functions, and with the offsets of this process's MuJoCo.

    Raises:
        MissingPartError: there is no core for this platform, or MuJoCo differs from its declarations.
    """
    library, located = core(), offsets()
    for name, (result, *arguments) in SIGNATURES.items():
        function = getattr(library, f"core_{name}_d")
        function.restype, function.argtypes = result, arguments
    library.core_locate_d(located.user_size, located.pointers["userdata"])
    return library


def packed_simulation(rows: Rows, data: mujoco.MjData, pattern: Pattern | None = None) -> Packed:
    """Return the record of a state; its memory keeps the addresses of the arrays of state, rows and MuJoCo.

    Args:
        rows: rows of the model of the state.
        data: the state.
        pattern: nonzero numbers of the rows for a run in MuJoCo's sparse format; None for dense rows.
    """
    located = offsets()
    record, arrays = sparse_rows(pattern, located)
    # With the ticket a callback finds and checks its state: rows of the records, byte offsets in mjData.
    ticket = {
        "model": rows.model._address,
        "rows": rows.layout.row_count,
        "row_count": located.row_count,
        "time": located.time,
        "efc": np.array([located.pointers[f"efc_{name}"] for name in ROW_FIELDS], dtype=np.int64),
        "sparse": record,
    }
    parts = {"ticket": ticket, "fields": data, "layout": rows.layout, "weights": rows.weights, "state": rows.state}
    parts["solution"] = solution_of(rows.model, rows.layout, pattern)
    memory, kept = packed("Simulation", parts)
    model = rows.model
    return checked("Simulation", Packed(memory, (*kept, arrays, data)), model.nq, model.nbody, model.nsite)
