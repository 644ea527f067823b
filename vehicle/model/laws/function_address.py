"""Memory and C functions by their address, in Python and in compiled code.

Compiled code calls a function of a shared library in some nanoseconds by its address, which is a value of a run and no
part of the cached code. Pointers and sizes of C are passed as 64-bit integers, as on all platforms of MuJoCo.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np
import numpy.typing as npt

from vehicle.compiler import overloaded


def address_as_pointer(typing_context: Any, address: Any) -> Any:
    """Convert an integer to a pointer; a definition for `numba.extending.intrinsic`."""
    types, ir = import_module("numba").types, import_module("llvmlite.ir")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], ir.IntType(8).as_pointer())

    return types.voidptr(types.int64), generate


def _memory(number_type: str) -> Callable[[Any], Any]:
    """Return the compiled form of a function that returns memory as an array of a number type of numba."""

    def compiled(numba: Any) -> Any:
        as_pointer, carray = numba.extending.intrinsic(address_as_pointer), numba.carray
        element = getattr(numba, number_type)
        return lambda address, size: lambda address, size: carray(as_pointer(address), size, element)

    return compiled


@overloaded(_memory("int64"))
def words_at(address: int, size: int) -> npt.NDArray[np.int64]:
    """Return 64-bit integers at an address as an array; (size,)."""
    return np.ctypeslib.as_array((ctypes.c_int64 * size).from_address(address))


@overloaded(_memory("float64"))
def floats_at(address: int, size: int) -> npt.NDArray[np.float64]:
    """Return 64-bit floats at an address as an array; (size,)."""
    return np.ctypeslib.as_array((ctypes.c_double * size).from_address(address))


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


def _compiled_transfer(numba: Any) -> Any:
    """Return the compiled form of `transfer`."""
    types, ir = numba.types, import_module("llvmlite.ir")
    form = ir.FunctionType(ir.IntType(32), 5 * [ir.IntType(64)])

    @numba.extending.intrinsic  # type: ignore[untyped-decorator]
    def call(typing_context: Any, function: Any, instance: Any, references: Any, count: Any, values: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, integers: Any) -> Any:
            target = builder.inttoptr(integers[0], form.as_pointer())
            return builder.call(target, [*integers[1:], integers[3]])

        return types.int32(*5 * [types.int64]), generate

    return lambda function, instance, references, count, values: (
        lambda function, instance, references, count, values: call(function, instance, references, count, values)
    )


@overloaded(_compiled_transfer)
def transfer(function: int, instance: int, references: int, count: int, values: int) -> int:
    """Call `fmi2SetReal`, `fmi2GetReal`, `fmi3SetFloat64` or `fmi3GetFloat64` by its address; return its status.

    The functions of FMI 3.0 take the number of values as a last argument. Those of FMI 2.0 ignore it: by the calling
    conventions of these platforms the caller removes the arguments.

    Args:
        function, instance, references, values: addresses of function, instance, value references and values.
        count: number of references and of values.
    """
    form = ctypes.CFUNCTYPE(ctypes.c_int, *5 * [ctypes.c_int64])
    return int(form(int(function))(*map(int, (instance, references, count, values, count))))


def _compiled_do_step(numba: Any) -> Any:
    """Return the compiled form of `do_step`."""
    types, ir = numba.types, import_module("llvmlite.ir")
    word, real = ir.IntType(64), ir.DoubleType()
    form = ir.FunctionType(ir.IntType(32), [word, real, real, *5 * [word]])

    @numba.extending.intrinsic  # type: ignore[untyped-decorator]
    def call(typing_context: Any, function: Any, instance: Any, time: Any, length: Any, results: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            target = builder.inttoptr(arguments[0], form.as_pointer())
            addresses = [builder.add(arguments[4], ir.Constant(word, 8 * n)) for n in range(4)]
            return builder.call(target, [*arguments[1:4], ir.Constant(word, 1), *addresses])

        return types.int32(types.int64, types.int64, types.float64, types.float64, types.int64), generate

    return lambda function, instance, time, length, results: (
        lambda function, instance, time, length, results: call(function, instance, time, length, results)
    )


@overloaded(_compiled_do_step)
def do_step(function: int, instance: int, time: float, length: float, results: int) -> int:
    """Call `fmi2DoStep` or `fmi3DoStep` by its address, without later resets of the state; return its status.

    Args:
        function, instance: addresses of function and instance.
        time, length: communication point and communication step [s].
        results: address of four words: event, termination, early return, time of the last success (FMI 3.0 alone).
    """
    word, real = ctypes.c_int64, ctypes.c_double
    form = ctypes.CFUNCTYPE(ctypes.c_int, word, real, real, word, word, word, word, word)
    addresses = [int(results) + 8 * n for n in range(4)]
    return int(form(int(function))(int(instance), time, length, 1, *addresses))
