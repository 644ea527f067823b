"""Eight cars at once in compiled code: a number of each, which the processor adds and multiplies together.

A vector is what the compiler's back end calls `<8 x float>`: one register where the processor has such, several where
not. Loops over lanes would leave it to the compiler to find that out, and the order of sums too. Here the order is that
of the source, in every lane alone, so that a car does not know its neighbours.

This module imports numba at its head: it is loaded only by a run that compiles.
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
_KIND = ir.VectorType(ir.FloatType(), LANES)
_FUSED = ("contract",)
"""A product and a sum may be rounded once."""


class Vector(types.Type):  # type: ignore[misc, name-defined]
    """Type of a vector."""


VECTOR = Vector(name="Vector")


@extending.register_model(Vector)
class _Model(extending.models.PrimitiveModel):  # type: ignore[misc, name-defined]
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _KIND)


def _pointer(context: Any, builder: Any, kind: Any, table: Any, row: Any) -> Any:
    """Address of a row of a table (rows, LANES)."""
    data = context.make_array(kind)(context, builder, table).data
    return builder.gep(builder.bitcast(data, _KIND.as_pointer()), [row])


def _load(typing_context: Any, table: Any, row: Any) -> Any:
    """A row of a table (rows, LANES) of aligned numbers."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_pointer(context, builder, signature.args[0], *arguments), align=ALIGNMENT)

    return VECTOR(table, types.intp), generate


def _store(typing_context: Any, table: Any, row: Any, value: Any) -> Any:
    """Write a row of a table."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        place = _pointer(context, builder, signature.args[0], *arguments[:2])
        builder.store(arguments[2], place, align=ALIGNMENT)
        return context.get_dummy_value()

    return types.void(table, types.intp, VECTOR), generate


def _loads(typing_context: Any, table: Any, row: Any, alike: Any) -> Any:
    """As many rows from `row` on as a tuple is long, as a tuple of vectors."""
    kind = types.UniTuple(VECTOR, len(alike))

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        found = ir.Constant(context.get_value_type(kind), ir.Undefined)
        for k in range(kind.count):
            found = builder.insert_value(found, builder.load(cgutils.gep(builder, first, k), align=ALIGNMENT), k)
        return found

    return kind(table, types.intp, alike), generate


def _alike(typing_context: Any, number: Any) -> Any:
    """The same number in all lanes."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        place = ir.Constant(ir.IntType(32), 0)
        one = builder.insert_element(ir.Constant(_KIND, ir.Undefined), arguments[0], place)
        mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        return builder.shuffle_vector(one, ir.Constant(_KIND, ir.Undefined), mask)

    return VECTOR(_SCALAR), generate


def _combined(typing_context: Any, table: Any, row: Any, factors: Any, value: Any) -> Any:
    """value + sum over k of table[row + k] factors[k]; factors is a tuple of vectors."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        total = arguments[3]
        for k in range(signature.args[2].count):
            weight = builder.load(cgutils.gep(builder, first, k), align=ALIGNMENT)
            total = _sum(builder, total, builder.fmul(weight, builder.extract_value(arguments[2], k), flags=_FUSED))
        return total

    return VECTOR(table, types.intp, factors, VECTOR), generate


def _spread(typing_context: Any, table: Any, row: Any, value: Any, sums: Any) -> Any:
    """sums[k] + table[row + k] value, for all of a tuple of vectors."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        first = _pointer(context, builder, signature.args[0], *arguments[:2])
        found = arguments[3]
        for k in range(signature.args[3].count):
            weight = builder.load(cgutils.gep(builder, first, k), align=ALIGNMENT)
            more = builder.fmul(weight, arguments[2], flags=_FUSED)
            found = builder.insert_value(found, _sum(builder, builder.extract_value(arguments[3], k), more), k)
        return found

    return sums(table, types.intp, VECTOR, sums), generate


def _sum(builder: Any, one: Any, other: Any) -> Any:
    return builder.fadd(one, other, flags=_FUSED)


def _elementwise(make: Callable[[Any, Any, Any], Any]) -> Any:
    """A function of two vectors."""

    def function(typing_context: Any, one: Any, other: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return make(builder, *arguments)

        return (VECTOR(VECTOR, VECTOR), generate) if one == other == VECTOR else None

    return extending.intrinsic(function)


def _choice(comparison: str) -> Any:
    """The first of two numbers where it compares so with the second, else the second."""
    return _elementwise(lambda builder, a, b: builder.select(builder.fcmp_ordered(comparison, a, b), a, b))


def _where_below(builder: Any, one: Any, other: Any) -> Any:
    ones, none = (ir.Constant(_KIND, [number] * LANES) for number in (1.0, 0.0))
    return builder.select(builder.fcmp_ordered("<", one, other), ones, none)


load, loads, store, alike = map(extending.intrinsic, (_load, _loads, _store, _alike))
combined, spread = map(extending.intrinsic, (_combined, _spread))
smaller, larger, below = _choice("<"), _choice(">"), _elementwise(_where_below)
"""min, max, and 1 where a < b, else 0."""


def _operator(symbol: Any, name: str) -> None:
    """Give vectors an operator."""
    made = _elementwise(lambda builder, a, b: getattr(builder, name)(a, b, flags=_FUSED))

    @extending.overload(symbol)
    def overloaded(one, other):  # type: ignore[no-untyped-def]
        return (lambda one, other: made(one, other)) if one == other == VECTOR else None


for _symbol, _name in (("add", "fadd"), ("sub", "fsub"), ("mul", "fmul"), ("truediv", "fdiv")):
    _operator(getattr(operator, _symbol), _name)
