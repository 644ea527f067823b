"""Where the fields of MuJoCo's C structures lie: byte offsets from the published declarations, checked by address."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import mujoco

Layout = type[ctypes.Structure]

PLAIN_TYPES: dict[str, Any] = {
    "mjtNum": ctypes.c_double,
    "mjtSize": ctypes.c_int64,
    "mjtByte": ctypes.c_uint8,
    "mjtBool": ctypes.c_bool,
    "int": ctypes.c_int,
    "float": ctypes.c_float,
    "double": ctypes.c_double,
    "char": ctypes.c_char,
    "unsigned char": ctypes.c_ubyte,
    "unsigned int": ctypes.c_uint,
    "size_t": ctypes.c_size_t,
    "uintptr_t": ctypes.c_size_t,
    "uint64_t": ctypes.c_uint64,
}


@functools.cache
def layout(name: str, last: str = "") -> Layout:
    """The ctypes form of a structure of MuJoCo, from `mujoco.introspect`.

    Args:
        name: name of the structure, like "mjData".
        last: field after which the rest may be left out.

    Returns:
        A structure class, of which only the layout is used.

    Raises:
        LookupError: the declarations hold a type that is not known here.
    """
    from mujoco.introspect import structs

    fields = []
    for field in structs.STRUCTS[name].fields:
        fields.append((field.name, _ctype(field.type)))
        if field.name == last:
            break
    return type(name, (ctypes.Structure,), {"_fields_": fields})


def _ctype(declared: Any) -> Any:
    """The ctypes type of a declared one."""
    from mujoco.introspect import ast_nodes, enums, structs

    if isinstance(declared, ast_nodes.PointerType):
        return ctypes.c_void_p
    if isinstance(declared, ast_nodes.ArrayType):
        kind = _ctype(declared.inner_type)
        for extent in reversed(declared.extents):
            kind = kind * extent
        return kind
    if not isinstance(declared, ast_nodes.ValueType):
        raise LookupError(f"type {declared!r}")
    name = declared.name.removeprefix("struct ")
    if name in PLAIN_TYPES:
        return PLAIN_TYPES[name]
    if name in enums.ENUMS:
        return ctypes.c_int
    if name in structs.STRUCTS:
        return layout(name)
    raise LookupError(f"type {name!r}")


def user_size_offset(model: mujoco.MjModel) -> int:
    """Byte offset of `nuserdata` in mjModel.

    Raises:
        LookupError: one of the sizes before it is not where the declarations say.
    """
    structure = layout("mjModel", "nuserdata")
    seen = structure.from_address(model._address)
    for name, kind in structure._fields_:  # type: ignore[misc]
        if kind is not ctypes.c_int64:
            continue
        if hasattr(model, name) and getattr(seen, name) != getattr(model, name):
            raise LookupError(f"mjModel.{name}")
        if name == "nuserdata":
            return int(structure.nuserdata.offset)
    raise LookupError("mjModel.nuserdata")


def pointer_offsets(data: mujoco.MjData, names: Iterable[str]) -> dict[str, int]:
    """Byte offsets of array pointers in mjData.

    Args:
        data: state in which the arrays exist, so after a forward evaluation.
        names: the arrays.

    Returns:
        Name to offset [bytes].

    Raises:
        LookupError: a pointer is not where the declarations say.
    """
    structure = layout("mjData")
    seen = structure.from_address(data._address)
    found = {}
    for name in names:
        array = getattr(data, name)
        if not array.size or getattr(seen, name, None) != array.ctypes.data:
            raise LookupError(f"mjData.{name}")
        found[name] = int(getattr(structure, name).offset)
    return found


def scalar_offsets(data: mujoco.MjData) -> tuple[int, int]:
    """Byte offsets of `time` and `nefc` in mjData.

    Raises:
        LookupError: a value is not where the declarations say.
    """
    structure = layout("mjData")
    seen = structure.from_address(data._address)
    for name in ("time", "nefc"):
        if getattr(seen, name) != getattr(data, name):
            raise LookupError(f"mjData.{name}")
    return int(structure.time.offset), int(structure.nefc.offset)


def step_address() -> int:
    """Address of `mj_step` in the library that the bindings of MuJoCo use.

    Raises:
        LookupError: there is no such library beside the bindings.
    """
    folder = Path(mujoco.__file__).parent
    found = [
        path for path in sorted(folder.iterdir()) if path.name.startswith("libmujoco") or path.name == "mujoco.dll"
    ]
    if len(found) != 1:
        raise LookupError(f"{len(found)} libraries beside the bindings, where one is expected")
    return int(ctypes.cast(ctypes.CDLL(str(found[0])).mj_step, ctypes.c_void_p).value or 0)
