"""Records that Python and the core share: structures read from layout.h, and packing of Python objects into them.

`packed("March", record)` takes the attributes of an object (or the keys of a mapping) by the names of the fields. An
array is passed by its address and shape, without a copy, so it must have the type, the dimensions and the order that
layout.h states; `Packed` keeps it alive.
"""

import ctypes
import struct
from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.core.header import listed
from vehicle.core.library import core

NUMBERS: dict[str, type[Any]] = {"double": ctypes.c_double, "int64_t": ctypes.c_int64}
"""ctypes of the kinds of numbers."""

ELEMENTS: dict[str, tuple[type[Any], ...]] = {
    "double": (np.float64,),
    "int64_t": (np.int64,),
    "uint32_t": (np.uint32,),
    "char": (np.uint8,),
    "REAL": (np.float32, np.float64),
}
"""numpy types of the elements of arrays."""

LANE_BYTES = 32
"""Size and alignment of a row of a `Lanes` array."""


class Field(NamedTuple):
    """Field of a record: kind and name, as in layout.h."""

    kind: str
    name: str


class ArrayKind(NamedTuple):
    """Kind of arrays: type of an element, and number of dimensions."""

    element: str
    dimensions: int


class Packed(NamedTuple):
    """Record in memory for the core.

    Attributes:
        memory: the structure. kept: arrays whose addresses are in it.
    """

    memory: ctypes.Structure
    kept: tuple[Any, ...]

    @property
    def address(self) -> int:
        """Return the address of the structure."""
        return ctypes.addressof(self.memory)


@cache
def records() -> dict[str, tuple[Field, ...]]:
    """Return the fields of all records by name, in the order of layout.h."""
    names = [*listed("layout.h", "EACH_LAW", "S"), *listed("layout.h", "EACH_RECORD", "S")]
    return {name: tuple(Field(*entry) for entry in listed("layout.h", macro, "F")) for name, macro in names}


@cache
def array_kinds() -> dict[str, ArrayKind]:
    """Return the kinds of arrays by name."""
    return {name: ArrayKind(element, int(count)) for name, element, count in listed("layout.h", "EACH_ARRAY", "A")}


@cache
def structure(name: str) -> type[ctypes.Structure]:
    """Return the ctypes structure of a record or of a kind of arrays."""
    if name in array_kinds():
        fields = [("at", ctypes.c_uint64), ("n", ctypes.c_int64 * array_kinds()[name].dimensions)]
    else:
        fields = [(field, NUMBERS.get(type_name) or structure(type_name)) for type_name, field in records()[name]]
    return type(name, (ctypes.Structure,), {"_fields_": fields})


@cache
def dtype(name: str) -> np.dtype[Any]:
    """Return the numpy type of a record of numbers, for arrays of records."""
    kinds = {"double": np.float64, "int64_t": np.int64}
    return np.dtype([(field, kinds[type_name]) for type_name, field in records()[name]], align=True)


def layout() -> list[int]:
    """Return size and offsets of all records as ctypes has them, in the order of `core_layout`."""
    return [
        number
        for name in records()
        for number in (
            ctypes.sizeof(structure(name)),
            *(getattr(structure(name), field).offset for _, field in records()[name]),
        )
    ]


def core_layout() -> list[int]:
    """Return the same numbers as the compiler of the core chose them."""
    numbers = (ctypes.c_int64 * len(layout()))()
    function = core().core_layout
    function.restype = ctypes.c_int64
    count = int(function(numbers, ctypes.c_int64(len(numbers))))
    return list(numbers) if count == len(numbers) else [count]


def packed(name: str, record: Any) -> Packed:
    """Return a record for the core.

    Args:
        name: name in layout.h.
        record: object whose attributes, or mapping whose keys, have the names of the fields.

    Raises:
        TypeError: type, dimensions, order or alignment of an array differs from its kind.
    """
    integers, kept = list[int](), list[Any]()

    def address_of(array: npt.NDArray[Any]) -> int:
        kept.append(array)
        return int(array.__array_interface__["data"][0])

    _add(integers, name, record, address_of)
    return Packed(structure(name).from_buffer(bytearray(struct.pack(f"{len(integers)}q", *integers))), tuple(kept))


def checked(name: str, record: Packed, *sizes: int) -> Packed:
    """Return a record for the core whose lengths and indices fit together; see `check.c`.

    Args:
        name: name in layout.h: March or Simulation.
        record: the record.
        sizes: for a March the cars in a vector; for a Simulation numbers of positions, bodies and sites of the model.

    Raises:
        ValueError: a length or an index does not fit, which the core would not notice.
    """
    function = getattr(core(), f"core_check_{name.lower()}")
    function.restype = ctypes.c_char_p
    wrong = function(ctypes.c_void_p(record.address), *map(ctypes.c_int64, sizes))
    if wrong is not None:
        raise ValueError(f"{name}.{wrong.decode()}: its length, or an index in it, does not fit the other fields")
    return record


class Stored(NamedTuple):
    """Record as bytes, for a file.

    Attributes:
        content: the structure, then the arrays, each at a multiple of `LANE_BYTES`, little-endian; addresses are
            offsets from the beginning of the file.
        extents: offset in the file and size of each array by the path of its field, for example "march.table" [byte].
    """

    content: bytes
    extents: dict[str, tuple[int, int]]


def stored(name: str, record: Any, begin: int) -> Stored:
    """Return a record as bytes.

    Args:
        name, record: see `packed`.
        begin: bytes of the file before the record, a multiple of `LANE_BYTES`.

    Raises:
        TypeError: see `packed`.
    """
    integers, arrays, extents = list[int](), list[bytes](), list[tuple[int, int]]()
    end = begin + ctypes.sizeof(structure(name))

    def offset_of(array: npt.NDArray[Any]) -> int:
        nonlocal end
        filled = -end % LANE_BYTES
        arrays.append(b"\0" * filled + array.tobytes())
        extents.append((end + filled, array.nbytes))
        end += len(arrays[-1])
        return extents[-1][0]

    _add(integers, name, record, offset_of)
    content = struct.pack(f"<{len(integers)}q", *integers) + b"".join(arrays)
    return Stored(content, dict(zip(_array_paths(name), extents, strict=True)))


def _array_paths(name: str, before: str = "") -> list[str]:
    """Return the paths of the arrays of a record."""
    paths = list[str]()
    for type_name, field in records()[name]:
        if type_name in array_kinds():
            paths.append(before + field)
        elif type_name not in NUMBERS:
            paths += _array_paths(type_name, f"{before}{field}.")
    return paths


def _add(integers: list[int], name: str, record: Any, address_of: Callable[[npt.NDArray[Any]], int]) -> None:
    """Append the fields of a record as 64-bit words; `address_of` returns the address of an array."""
    kinds, read = array_kinds(), record.__getitem__ if isinstance(record, Mapping) else partial(getattr, record)
    for type_name, field in records()[name]:
        value, wanted = read(field), kinds.get(type_name)
        if wanted is not None:
            if not _fits(wanted, value):
                raise TypeError(
                    f"{name}.{field}: {value.dtype} {value.shape} is no {wanted.element} of {wanted.dimensions} "
                    "dimensions in C order"
                )
            integers += (address_of(value), *value.shape[: wanted.dimensions])
        elif type_name == "double":
            integers.append(struct.unpack("q", struct.pack("d", value))[0])
        elif type_name == "int64_t":
            integers.append(int(value))
        else:
            _add(integers, type_name, value, address_of)


def _fits(expected: ArrayKind, array: npt.NDArray[Any]) -> bool:
    """Return True for an array with type, dimensions, order and alignment of a kind."""
    if expected.element == "void":
        fits = array.ndim == 2 and array.shape[1] * array.itemsize == LANE_BYTES
        fits &= array.dtype in ELEMENTS["REAL"] and (array.ctypes.data % LANE_BYTES == 0 or array.size == 0)
    else:
        types = ELEMENTS.get(expected.element) or (dtype(expected.element),)
        fits = array.ndim == expected.dimensions and array.dtype in types
    return fits and array.flags.c_contiguous
