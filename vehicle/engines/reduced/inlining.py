"""Compilation of the functions of a time step: options, inlined functions, functions that are compiled once.

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from vehicle.compiler import OPTIONS, numba_module

numba = numba_module()

# Sums in the order of the source: the values of a car must not depend on the number of poles of other cars.
EXACT = OPTIONS | {"fastmath": {"contract"}}


def inlined(function: Callable[..., Any]) -> Any:
    """Compile a function that is inlined in its callers, without reference counting."""
    return numba.njit(no_cpython_wrapper=True, forceinline=True, _nrt=False, **EXACT)(function)


def compiled_once(function: Callable[..., Any]) -> Any:
    """Compile a function separately, without inlining: it is called once for many samples."""
    return numba.njit(no_cpython_wrapper=True, _nrt=False, **EXACT)(function)
