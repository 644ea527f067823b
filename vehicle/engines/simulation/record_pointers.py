"""Records of arrays in compiled code as what they are in memory: an address, from which a field is read by its name.

Passed by value, a record of many arrays is some hundred numbers, which the compiler carries through every function.
A record stands still while compiled code has its address, so that a field is read once. This module imports numba at
its head: it is loaded only by a run that compiles.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import Any, get_type_hints

import numpy as np
import numpy.typing as npt
from llvmlite import ir

from vehicle.compiler import numba_module
from vehicle.model.laws.control_laws import SETTING
from vehicle.model.laws.damper import RECORD

numba = numba_module()
types, extending, templates = numba.types, numba.extending, numba.core.typing.templates

ARRAYS = {
    "Vector": numba.float64[::1],
    "Table": numba.float64[:, ::1],
    "Tables3": numba.float64[:, :, ::1],
    "Index": numba.int64[::1],
    "Indices": numba.int64[:, ::1],
    "Records": types.Array(numba.from_dtype(RECORD), 1, "C"),
    "Settings": types.Array(numba.from_dtype(SETTING), 1, "C"),
}
"""What the words for arrays in `vehicle.engines.simulation.element_records` and those built on it mean."""

NUMBERS = {"int": numba.int64, "float": numba.float64}

WORD = ir.IntType(64)
OWNERS = 2
"""Pointers at the head of an array that say who owns it: read as none, for nobody counts references here."""


@cache
def _fields(record: Any) -> dict[str, Any]:
    """Fields of a record to what they are: a record, or the compiler's type of an array or a number."""
    inner = {name: kind for name, kind in get_type_hints(record).items() if hasattr(kind, "_fields")}
    known = ARRAYS | NUMBERS
    return {name: inner.get(name) or known[record.__annotations__[name].__forward_arg__] for name in record._fields}


def _size(kind: Any) -> int:
    """Words of 64 bits that a field takes."""
    if hasattr(kind, "_fields"):
        return sum(_size(one) for one in _fields(kind).values())
    return OWNERS + 3 + 2 * kind.ndim if isinstance(kind, types.Array) else 1


def packed(record: Any) -> npt.NDArray[np.int64]:
    """A record as compiled code reads it, in words of 64 bits; it holds addresses of arrays, and keeps none.

    Raises:
        TypeError: an array has another type, number of dimensions or order than its word says.
    """
    return np.array(_words(record), dtype=np.int64)


def _words(record: Any) -> list[int]:
    found: list[int] = []
    kinds: Any = type(record)
    for (name, kind), value in zip(_fields(kinds).items(), record, strict=True):
        if hasattr(kind, "_fields"):
            found += _words(value)
        elif isinstance(kind, types.Array):
            if numba.from_dtype(value.dtype) != kind.dtype or value.ndim != kind.ndim or not value.flags.c_contiguous:
                raise TypeError(f"{type(record).__name__}.{name}: {value.dtype} {value.shape} is no {kind}")
            found += [*OWNERS * [0], value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides]
        else:
            found.append(int(value) if kind is numba.int64 else struct.unpack("q", struct.pack("d", value))[0])
    return found


class Pointer(types.Type):  # type: ignore[misc, name-defined]
    """Type of the address of a record."""

    def __init__(self, record: Any) -> None:
        self.record = record
        super().__init__(name=f"Pointer({record.__module__}.{record.__qualname__})")


@cache
def pointer(record: Any) -> Pointer:
    """The type of the address of a kind of record."""
    return Pointer(record)


def at(record: Any) -> Any:
    """A function for compiled code that takes a number as the address of such a record."""

    def typed(typing_context: Any, address: Any) -> Any:
        return pointer(record)(types.int64), lambda context, builder, signature, arguments: arguments[0]

    return extending.intrinsic(typed)


@extending.register_model(Pointer)
class _Model(extending.models.PrimitiveModel):  # type: ignore[misc, name-defined]
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, WORD)


@extending.infer_getattr
class _Attributes(templates.AttributeTemplate):  # type: ignore[misc, name-defined]
    key = Pointer

    def generic_resolve(self, kind: Any, name: str) -> Any:
        field = _fields(kind.record).get(name)
        return pointer(field) if hasattr(field, "_fields") else field


def _read(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    """The address of a record inside, or the words of a field."""
    fields = _fields(kind.record)
    names = list(fields)
    before = sum(_size(fields[one]) for one in names[: names.index(name)])
    address = builder.add(value, ir.Constant(WORD, 8 * before))
    field = fields[name]
    return address if hasattr(field, "_fields") else _leaves(builder, address, context.get_value_type(field), [0])


def _leaves(builder: Any, address: Any, kind: Any, place: list[int]) -> Any:
    """Read a value from an address, 8 bytes a leaf."""
    if not isinstance(kind, ir.LiteralStructType | ir.ArrayType):
        where = builder.add(address, ir.Constant(WORD, 8 * place[0]))
        place[0] += 1
        read = builder.load(builder.inttoptr(where, kind.as_pointer()))
        read.set_metadata("invariant.load", builder.module.add_metadata([]))
        return read
    members = kind.elements if isinstance(kind, ir.LiteralStructType) else [kind.element] * kind.count
    found = ir.Constant(kind, ir.Undefined)
    for index, member in enumerate(members):
        if index < OWNERS and isinstance(member, ir.PointerType):
            place[0] += 1
            inner = ir.Constant(member, None)
        else:
            inner = _leaves(builder, address, member, place)
        found = builder.insert_value(found, inner, index)
    return found


extending.lower_getattr_generic(Pointer)(_read)
