"""Laws of the core at single states, as Python functions of records and numbers."""

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.core.library import core

REAL, INTEGER, ADDRESS = ctypes.c_double, ctypes.c_int64, ctypes.c_void_p


def _law(name: str, *arguments: Any) -> Any:
    """A law of the core that returns a number."""
    function = getattr(core(), f"core_{name}")
    function.restype, function.argtypes = REAL, arguments
    return function


def friction_limit(record: npt.NDArray[Any], velocity: float) -> float:
    """Friction limit [N] of the record of a damper."""
    return float(_law("friction_limit", ADDRESS, REAL)(record.ctypes.data, velocity))


def demanded(record: npt.NDArray[Any], body: float, wheel: float) -> float:
    """Coefficient [N s/m] that the record of a control law demands."""
    return float(_law("demanded", ADDRESS, REAL, REAL)(record.ctypes.data, body, wheel))


def act(record: npt.NDArray[Any], step: int, body: float, wheel: float, past: npt.NDArray[np.float64]) -> None:
    """Advance the memory of a controlled damper by a step."""
    _law("act", ADDRESS, INTEGER, REAL, REAL, ADDRESS)(record.ctypes.data, step, body, wheel, past.ctypes.data)


def curve_force(position: float, edges: Any, slopes: Any, offsets: Any) -> float:
    """Force of a piecewise linear law; the last edge is infinite."""
    arrays = [np.ascontiguousarray(values, dtype=float) for values in (edges, slopes, offsets)]
    found = _law("curve_force", REAL, ADDRESS, ADDRESS, ADDRESS)(position, *(array.ctypes.data for array in arrays))
    return float(found)


def called(address: int, first: float, second: float) -> float:
    """Result of a law by address: function(memory, first, second); `address`: of a record Call."""
    function, memory = (ctypes.c_int64.from_address(address + 8 * word).value for word in range(2))
    return float(ctypes.CFUNCTYPE(REAL, INTEGER, REAL, REAL)(function)(memory, first, second))
