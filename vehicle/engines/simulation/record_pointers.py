"""Records of arrays in compiled code by address, with access to fields by name.

Passed by value, a record of many arrays is some hundred numbers, which the compiler passes through every function.
The memory of a record is constant while compiled code uses its address, so that each field is read once. Import this
module lazily: it imports numba.
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
"""numba types of the array types in `vehicle.engines.simulation.element_records`, by name."""

NUMBERS = {"int": numba.int64, "float": numba.float64}

WORD = ir.IntType(64)
OWNERS = 2
"""Number of pointers to owner objects at the head of an array structure: read as null, without reference counts."""


@cache
def _fields(record: Any) -> dict[str, Any]:
    """Return the types of the fields of a record: a record class, or the numba type of an array or a number."""
    inner = {name: field_type for name, field_type in get_type_hints(record).items() if hasattr(field_type, "_fields")}
    simple_types = ARRAYS | NUMBERS
    return {
        name: inner.get(name) or simple_types[record.__annotations__[name].__forward_arg__] for name in record._fields
    }


def _size(field_type: Any) -> int:
    """Return the number of 64-bit words of a field."""
    if hasattr(field_type, "_fields"):
        return sum(_size(nested) for nested in _fields(field_type).values())
    return OWNERS + 3 + 2 * field_type.ndim if isinstance(field_type, types.Array) else 1


def packed(record: Any) -> npt.NDArray[np.int64]:
    """Return a record for compiled code in 64-bit words; these contain addresses of arrays, without references.

    Raises:
        TypeError: type, number of dimensions or memory order of an array differs from its annotation.
    """
    return np.array(_words(record), dtype=np.int64)


def _words(record: Any) -> list[int]:
    """Return the 64-bit words of a record."""
    integers: list[int] = []
    kinds: Any = type(record)
    for (name, field_type), value in zip(_fields(kinds).items(), record, strict=True):
        if hasattr(field_type, "_fields"):
            integers += _words(value)
        elif isinstance(field_type, types.Array):
            if (
                numba.from_dtype(value.dtype) != field_type.dtype
                or value.ndim != field_type.ndim
                or not value.flags.c_contiguous
            ):
                raise TypeError(f"{type(record).__name__}.{name}: {value.dtype} {value.shape} is no {field_type}")
            integers += [*OWNERS * [0], value.size, value.itemsize, value.ctypes.data, *value.shape, *value.strides]
        else:
            integers.append(int(value) if field_type is numba.int64 else struct.unpack("q", struct.pack("d", value))[0])
    return integers


class Pointer(types.Type):  # type: ignore[misc, name-defined]
    """numba type of the address of a record."""

    def __init__(self, record: Any) -> None:
        self.record = record
        super().__init__(name=f"Pointer({record.__module__}.{record.__qualname__})")


@cache
def pointer(record: Any) -> Pointer:
    """Return the numba type of the address of a record class."""
    return Pointer(record)


def at(record: Any) -> Any:
    """Return a function for compiled code that converts an integer to the address of a record of this class."""

    def typed(typing_context: Any, address: Any) -> Any:
        return pointer(record)(types.int64), lambda context, builder, signature, arguments: arguments[0]

    return extending.intrinsic(typed)


@extending.register_model(Pointer)
class _Model(extending.models.PrimitiveModel):  # type: ignore[misc, name-defined]
    def __init__(self, manager: Any, pointer_type: Any) -> None:
        super().__init__(manager, pointer_type, WORD)


@extending.infer_getattr
class _Attributes(templates.AttributeTemplate):  # type: ignore[misc, name-defined]
    key = Pointer

    def generic_resolve(self, pointer_type: Any, name: str) -> Any:
        field = _fields(pointer_type.record).get(name)
        return pointer(field) if hasattr(field, "_fields") else field


def _read(context: Any, builder: Any, pointer_type: Any, value: Any, name: str) -> Any:
    """Generate code that returns the address of a nested record, or the value of a field."""
    fields = _fields(pointer_type.record)
    names = list(fields)
    before = sum(_size(fields[earlier]) for earlier in names[: names.index(name)])
    address = builder.add(value, ir.Constant(WORD, 8 * before))
    field = fields[name]
    return address if hasattr(field, "_fields") else _leaves(builder, address, context.get_value_type(field), [0])


def _leaves(builder: Any, address: Any, value_type: Any, position: list[int]) -> Any:
    """Generate code that reads a value from an address, 8 bytes for each scalar."""
    if not isinstance(value_type, ir.LiteralStructType | ir.ArrayType):
        where = builder.add(address, ir.Constant(WORD, 8 * position[0]))
        position[0] += 1
        read = builder.load(builder.inttoptr(where, value_type.as_pointer()))
        read.set_metadata("invariant.load", builder.module.add_metadata([]))
        return read
    members = (
        value_type.elements if isinstance(value_type, ir.LiteralStructType) else [value_type.element] * value_type.count
    )
    value = ir.Constant(value_type, ir.Undefined)
    for index, member in enumerate(members):
        if index < OWNERS and isinstance(member, ir.PointerType):
            position[0] += 1
            inner = ir.Constant(member, None)
        else:
            inner = _leaves(builder, address, member, position)
        value = builder.insert_value(value, inner, index)
    return value


extending.lower_getattr_generic(Pointer)(_read)
