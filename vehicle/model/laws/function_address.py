"""C functions by their address, in Python and in compiled code.

Compiled code calls a function of a shared library in some nanoseconds by its address, which is a value of a run and no
part of the cached code. Pointers and sizes of C are passed as 64-bit integers, as on all platforms of MuJoCo.
"""

from __future__ import annotations

import ctypes
from importlib import import_module
from typing import Any

from vehicle.compiler import overloaded


def address_as_pointer(typing_context: Any, address: Any) -> Any:
    """Convert an integer to a pointer; a definition for `numba.extending.intrinsic`."""
    types, ir = import_module("numba").types, import_module("llvmlite.ir")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], ir.IntType(8).as_pointer())

    return types.voidptr(types.int64), generate


def _compiled_by_first_word(numba: Any) -> Any:
    """Return the compiled form of `result_at`: a call of the function whose address is the first word."""
    types, ir = numba.types, import_module("llvmlite.ir")
    word, real = ir.IntType(64), ir.DoubleType()
    form = ir.FunctionType(real, [word, real, real])

    @numba.extending.intrinsic  # type: ignore[untyped-decorator]
    def call(typing_context: Any, address: Any, first: Any, second: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            memory = builder.fptosi(arguments[0], word)
            function = builder.load(builder.inttoptr(memory, word.as_pointer()))
            return builder.call(builder.inttoptr(function, form.as_pointer()), [memory, *arguments[1:]])

        return types.float64(types.float64, types.float64, types.float64), generate

    # numba compares the names of the arguments of both functions.
    return lambda address, first, second: lambda address, first, second: call(address, first, second)


@overloaded(_compiled_by_first_word)
def result_at(address: float, first: float, second: float) -> float:
    """Call the C function whose address is the first word at an address; return its result.

    Args:
        address: address of the memory, which is the first argument of the function.
        first, second: further arguments.
    """
    form = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_int64, ctypes.c_double, ctypes.c_double)
    memory = int(address)
    return float(form(ctypes.c_int64.from_address(memory).value)(memory, first, second))
