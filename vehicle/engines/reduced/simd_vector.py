"""SIMD vector type for compiled code: one number of each of eight cars.

A vector has the LLVM type `<8 x float>`: one register if the processor has registers of that size, otherwise several.
Loops over lanes would leave the vectorisation and the order of sums to the compiler. With this type the order is that
of the source in every lane, so the values of a car are bitwise independent of the other cars.

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir

from vehicle.compiler import numba_module
from vehicle.engines.reduced.batch_layout import ALIGNMENT, ELEMENT, LANES

numba = numba_module()
types, extending, cgutils = numba.types, numba.extending, numba.core.cgutils

_SCALAR = numba.from_dtype(np.dtype(ELEMENT))
_IR_TYPE = ir.VectorType(ir.FloatType(), LANES)
_FUSED = ("contract",)
"""Fast-math flag: a product and a sum may be fused and rounded once."""


class Vector(types.Type):  # type: ignore[misc, name-defined]
    """Numba type of a vector."""


VECTOR = Vector(name="Vector")


@extending.register_model(Vector)
class _Model(extending.models.PrimitiveModel):  # type: ignore[misc, name-defined]
    def __init__(self, manager: Any, numba_type: Any) -> None:
        super().__init__(manager, numba_type, _IR_TYPE)


def _pointer(context: Any, builder: Any, numba_type: Any, table: Any, row: Any) -> Any:
    """Return the address of a row of a table (rows, LANES)."""
    data = context.make_array(numba_type)(context, builder, table).data
    return builder.gep(builder.bitcast(data, _IR_TYPE.as_pointer()), [row])


def _load(typing_context: Any, table: Any, row: Any) -> Any:
    """Load a row of an aligned table (rows, LANES)."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_pointer(context, builder, signature.args[0], *arguments), align=ALIGNMENT)

    return VECTOR(table, types.intp), generate


def _store(typing_context: Any, table: Any, row: Any, value: Any) -> Any:
    """Store a vector in a row of a table."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address = _pointer(context, builder, signature.args[0], *arguments[:2])
        builder.store(arguments[2], address, align=ALIGNMENT)
        return context.get_dummy_value()

    return types.void(table, types.intp, VECTOR), generate


def _load_tuple(typing_context: Any, table: Any, row: Any, length: Any) -> Any:
    """Load rows from `row` on as a tuple of vectors with the length of another tuple."""
    tuple_type = types.UniTuple(VECTOR, len(length))

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        values = ir.Constant(context.get_value_type(tuple_type), ir.Undefined)
        for k in range(tuple_type.count):
            values = builder.insert_value(values, builder.load(cgutils.gep(builder, first, k), align=ALIGNMENT), k)
        return values

    return tuple_type(table, types.intp, length), generate


def _broadcast(typing_context: Any, number: Any) -> Any:
    """Return a vector with the same number in all lanes."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first_lane = ir.Constant(ir.IntType(32), 0)
        single = builder.insert_element(ir.Constant(_IR_TYPE, ir.Undefined), arguments[0], first_lane)
        mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        return builder.shuffle_vector(single, ir.Constant(_IR_TYPE, ir.Undefined), mask)

    return VECTOR(_SCALAR), generate


def _weighted_sum(typing_context: Any, table: Any, row: Any, factors: Any, value: Any) -> Any:
    """Return value + sum over k of table[row + k] factors[k]; factors is a tuple of vectors."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        total = arguments[3]
        for k in range(signature.args[2].count):
            weight = builder.load(cgutils.gep(builder, first, k), align=ALIGNMENT)
            total = _sum(builder, total, builder.fmul(weight, builder.extract_value(arguments[2], k), flags=_FUSED))
        return total

    return VECTOR(table, types.intp, factors, VECTOR), generate


def _add_scaled(typing_context: Any, table: Any, row: Any, value: Any, sums: Any) -> Any:
    """Return sums[k] + table[row + k] value for each vector of a tuple."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        values = arguments[3]
        for k in range(signature.args[3].count):
            weight = builder.load(cgutils.gep(builder, first, k), align=ALIGNMENT)
            product = builder.fmul(weight, arguments[2], flags=_FUSED)
            values = builder.insert_value(values, _sum(builder, builder.extract_value(arguments[3], k), product), k)
        return values

    return sums(table, types.intp, VECTOR, sums), generate


def _sum(builder: Any, first: Any, second: Any) -> Any:
    return builder.fadd(first, second, flags=_FUSED)


def _elementwise(make: Callable[[Any, Any, Any], Any]) -> Any:
    """Return an intrinsic function of two vectors."""

    def function(typing_context: Any, first: Any, second: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return make(builder, *arguments)

        return (VECTOR(VECTOR, VECTOR), generate) if first == second == VECTOR else None

    return extending.intrinsic(function)


def _choice(comparison: str) -> Any:
    """Return an intrinsic that selects the first number if the comparison is true, else the second."""
    return _elementwise(lambda builder, a, b: builder.select(builder.fcmp_ordered(comparison, a, b), a, b))


def _where_below(builder: Any, first: Any, second: Any) -> Any:
    ones, zeros = (ir.Constant(_IR_TYPE, [number] * LANES) for number in (1.0, 0.0))
    return builder.select(builder.fcmp_ordered("<", first, second), ones, zeros)


load, load_tuple, store, broadcast = map(extending.intrinsic, (_load, _load_tuple, _store, _broadcast))
weighted_sum, add_scaled = map(extending.intrinsic, (_weighted_sum, _add_scaled))
minimum, maximum, less = _choice("<"), _choice(">"), _elementwise(_where_below)
"""Elementwise minimum and maximum, and 1 where a < b, else 0."""


def _operator(symbol: Any, name: str) -> None:
    """Implement an arithmetic operator for vectors."""
    implementation = _elementwise(lambda builder, a, b: getattr(builder, name)(a, b, flags=_FUSED))

    @extending.overload(symbol)
    def overloaded(first, second):  # type: ignore[no-untyped-def]
        return (lambda first, second: implementation(first, second)) if first == second == VECTOR else None


for _symbol, _name in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
    _operator(getattr(operator, _symbol), _name)
