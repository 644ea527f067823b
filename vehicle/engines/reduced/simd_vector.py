"""SIMD vector types for compiled code: eight numbers in single precision, or four in double precision.

A vector has the LLVM type `<8 x float>` or `<4 x double>`: one register if the processor has registers of that size,
otherwise several. Loops over the numbers would leave the vectorisation and the order of sums to the compiler. With
these types the order is that of the source for every car, so the values of a car are bitwise independent of the
others. The type of a table decides: numba compiles a function once for each.

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir

from vehicle.compiler import numba_module
from vehicle.engines.reduced.table_layout import VECTOR_BYTES

numba = numba_module()
types, extending, cgutils = numba.types, numba.extending, numba.core.cgutils

_FUSED = ("contract",)
"""Fast-math flag: a product and a sum may be fused and rounded once."""


class Vector(types.Type):  # type: ignore[misc, name-defined]
    """Numba type of a vector of numbers."""

    def __init__(self, scalar: Any) -> None:
        super().__init__(name=f"Vector({scalar})")
        self.scalar, self.lanes = scalar, 8 * VECTOR_BYTES // scalar.bitwidth


VECTORS = {scalar: Vector(scalar) for scalar in (types.float32, types.float64)}
"""Type of a vector by the type of its numbers."""


@extending.register_model(Vector)
class _Model(extending.models.PrimitiveModel):  # type: ignore[misc, name-defined]
    def __init__(self, manager: Any, numba_type: Any) -> None:
        element = ir.FloatType() if numba_type.scalar == types.float32 else ir.DoubleType()
        super().__init__(manager, numba_type, ir.VectorType(element, numba_type.lanes))


def _pointer(context: Any, builder: Any, table_type: Any, table: Any, row: Any) -> Any:
    """Return the address of a row of a table (rows, columns)."""
    data = context.make_array(table_type)(context, builder, table).data
    vector = context.get_value_type(VECTORS[table_type.dtype])
    return builder.gep(builder.bitcast(data, vector.as_pointer()), [row])


def _load(typing_context: Any, table: Any, row: Any) -> Any:
    """Load a row of an aligned table (rows, columns)."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_pointer(context, builder, signature.args[0], *arguments), align=VECTOR_BYTES)

    return VECTORS[table.dtype](table, types.intp), generate


def _store(typing_context: Any, table: Any, row: Any, value: Any) -> Any:
    """Store a vector in a row of a table."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        address = _pointer(context, builder, signature.args[0], *arguments[:2])
        builder.store(arguments[2], address, align=VECTOR_BYTES)
        return context.get_dummy_value()

    return types.void(table, types.intp, value), generate


def _load_tuple(typing_context: Any, table: Any, row: Any, length: Any) -> Any:
    """Load rows from `row` on as a tuple of vectors with the length of another tuple."""
    tuple_type = types.UniTuple(VECTORS[table.dtype], len(length))

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        values = ir.Constant(context.get_value_type(tuple_type), ir.Undefined)
        for k in range(tuple_type.count):
            values = builder.insert_value(values, builder.load(cgutils.gep(builder, first, k), align=VECTOR_BYTES), k)
        return values

    return tuple_type(table, types.intp, length), generate


def _broadcast(typing_context: Any, number: Any) -> Any:
    """Return a vector of equal numbers."""
    return VECTORS[number](number), _same


def _filled(typing_context: Any, table: Any, number: Any) -> Any:
    """Return a vector of equal numbers of the type of a table."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        scalar = context.cast(builder, arguments[1], signature.args[1], signature.return_type.scalar)
        return _same(context, builder, signature, [scalar])

    return VECTORS[table.dtype](table, number), generate


def _same(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    """Return a vector of numbers equal to the first argument."""
    vector_type = context.get_value_type(signature.return_type)
    undefined = ir.Constant(vector_type, ir.Undefined)
    single = builder.insert_element(undefined, arguments[0], ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(single, undefined, _mask([0] * vector_type.count))


def _mask(lanes: list[int]) -> Any:
    """Return the mask of a shuffle from the indices of its numbers."""
    return ir.Constant(ir.VectorType(ir.IntType(32), len(lanes)), lanes)


def _of_cars(typing_context: Any, value: Any) -> Any:
    """Return the sums of the cars: the sum of all numbers in double precision, the vector in single precision."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        (total,) = arguments
        count = signature.return_type.lanes if signature.return_type.scalar == types.float64 else 1
        while count > 1:
            count //= 2
            swapped = [lane ^ count for lane in range(total.type.count)]
            total = builder.fadd(total, builder.shuffle_vector(total, total, _mask(swapped)))
        return total

    return (value(value), generate) if isinstance(value, Vector) else None


def _before(typing_context: Any, value: Any) -> Any:
    """Return for each part of a car the sum of the parts before it; zeros in single precision."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        (total,), count = arguments, signature.return_type.lanes
        zeros = ir.Constant(total.type, [0.0] * count)
        if signature.return_type.scalar != types.float64:
            return zeros

        def moved(numbers: Any, by: int) -> Any:
            return builder.shuffle_vector(numbers, zeros, _mask([count] * by + [*range(count - by)]))

        total, by = moved(total, 1), 1
        while by < count:
            total, by = builder.fadd(total, moved(total, by)), 2 * by
        return total

    return (value(value), generate) if isinstance(value, Vector) else None


def _weighted_sum(typing_context: Any, table: Any, row: Any, factors: Any, value: Any) -> Any:
    """Return value + sum over k of table[row + k] factors[k]; factors is a tuple of vectors."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        total = arguments[3]
        for k in range(signature.args[2].count):
            weight = builder.load(cgutils.gep(builder, first, k), align=VECTOR_BYTES)
            total = _sum(builder, total, builder.fmul(weight, builder.extract_value(arguments[2], k), flags=_FUSED))
        return total

    return value(table, types.intp, factors, value), generate


def _add_scaled(typing_context: Any, table: Any, row: Any, value: Any, sums: Any) -> Any:
    """Return sums[k] + table[row + k] value for each vector of a tuple."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        values = arguments[3]
        for k in range(signature.args[3].count):
            weight = builder.load(cgutils.gep(builder, first, k), align=VECTOR_BYTES)
            product = builder.fmul(weight, arguments[2], flags=_FUSED)
            values = builder.insert_value(values, _sum(builder, builder.extract_value(arguments[3], k), product), k)
        return values

    return sums(table, types.intp, value, sums), generate


def _sum(builder: Any, first: Any, second: Any) -> Any:
    return builder.fadd(first, second, flags=_FUSED)


def _elementwise(make: Callable[[Any, Any, Any], Any]) -> Any:
    """Return an intrinsic function of two vectors."""

    def function(typing_context: Any, first: Any, second: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return make(builder, *arguments)

        return (first(first, first), generate) if first == second and isinstance(first, Vector) else None

    return extending.intrinsic(function)


def _choice(comparison: str) -> Any:
    """Return an intrinsic that selects the first number if the comparison is true, else the second."""
    return _elementwise(lambda builder, a, b: builder.select(builder.fcmp_ordered(comparison, a, b), a, b))


def _where_below(builder: Any, first: Any, second: Any) -> Any:
    ones, zeros = (ir.Constant(first.type, [number] * first.type.count) for number in (1.0, 0.0))
    return builder.select(builder.fcmp_ordered("<", first, second), ones, zeros)


load, load_tuple, store = map(extending.intrinsic, (_load, _load_tuple, _store))
broadcast, filled, of_cars, before = map(extending.intrinsic, (_broadcast, _filled, _of_cars, _before))
weighted_sum, add_scaled = map(extending.intrinsic, (_weighted_sum, _add_scaled))
minimum, maximum, less = _choice("<"), _choice(">"), _elementwise(_where_below)
"""Elementwise minimum and maximum, and 1 where a < b, else 0."""


def _select(typing_context: Any, first: Any, second: Any, third: Any, fourth: Any) -> Any:
    """Return the third number if the first is below the second, else the fourth."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.select(builder.fcmp_ordered("<", *arguments[:2]), *arguments[2:])

    equal = isinstance(first, Vector) and first == second == third == fourth
    return (first(first, first, first, first), generate) if equal else None


select_below = extending.intrinsic(_select)
"""Elementwise c where a < b, else d, for four vectors."""


def _operator(symbol: Any, name: str) -> None:
    """Implement an arithmetic operator for vectors."""
    implementation = _elementwise(lambda builder, a, b: getattr(builder, name)(a, b, flags=_FUSED))

    @extending.overload(symbol)
    def overloaded(first, second):  # type: ignore[no-untyped-def]
        both = first == second and isinstance(first, Vector)
        return (lambda first, second: implementation(first, second)) if both else None


for _symbol, _name in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
    _operator(getattr(operator, _symbol), _name)
