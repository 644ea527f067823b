"""Addresses as arrays and as functions, for compiled code.

Like the other modules that import numba at their head, this one is imported only by a run that compiles.
"""

from __future__ import annotations

from typing import Any

import numba
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

Function = Any


def _address_as_void_pointer(typing_context: Any, address: Any) -> Any:
    """An integer address as a pointer."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], ir.IntType(8).as_pointer())

    return types.voidptr(types.int64), generate


def _call_step(typing_context: Any, function: Any, model: Any, data: Any) -> Any:
    """Call a C function `void f(mjModel*, mjData*)` that is known by its address."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [pointer, pointer])
        target = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(target, [builder.inttoptr(argument, pointer) for argument in arguments[1:]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64), generate


address_as_void_pointer: Function = intrinsic(_address_as_void_pointer)
call_step: Function = intrinsic(_call_step)


def _integers(address: int, rows: int, columns: int) -> Any:
    return numba.carray(address_as_void_pointer(address), (rows, columns), numba.int64)


def _floats(address: int, rows: int, columns: int) -> Any:
    return numba.carray(address_as_void_pointer(address), (rows, columns), numba.float64)


def _small_integer(address: int) -> Any:
    return numba.carray(address_as_void_pointer(address), 1, numba.int32)[0]


def _integer_table(table: Any, entry: int) -> Any:
    return integers(table[0, entry], table[1, entry], table[2, entry])


def _float_table(table: Any, entry: int) -> Any:
    return floats(table[0, entry], table[1, entry], table[2, entry])


def _field(table: Any, data: int, entry: int) -> Any:
    return floats(integers(data + table[0, entry], 1, 1)[0, 0], table[1, entry], table[2, entry])


integers: Function = numba.njit(_integers)
floats: Function = numba.njit(_floats)
small_integer: Function = numba.njit(_small_integer)
"""A C int."""
integer_table: Function = numba.njit(_integer_table)
"""Array of integers named by a column of a table (address, rows, columns)."""
float_table: Function = numba.njit(_float_table)
"""Array of floats named by a column of a table (address, rows, columns)."""
field: Function = numba.njit(_field)
"""Field of a C structure at `data`, named by a column of a table (offset of its pointer, rows, columns)."""
