"""Byte offsets of fields in MuJoCo's C structures, from its published declarations, checked by address."""

import ctypes
import functools
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import mujoco

from vehicle.errors import MissingPartError

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

SPARSE = ("efc_J_rownnz", "efc_J_rowadr", "efc_J_rowsuper", "efc_J_colind", "efc_J")
"""Arrays of a sparse constraint Jacobian in mjData."""

ROW_FIELDS = ("J", "KBIP", "pos", "vel", "aref", "D", "R", "frictionloss")
"""Fields of mjData over the constraint rows, whose addresses change between steps, without `efc_`; the order of
`efc` in the ticket of a simulation."""

POINTERS = (*(f"efc_{name}" for name in ROW_FIELDS), *SPARSE[:-1], "efc_force", "userdata")
"""Array pointers of mjData that compiled code follows."""

PROBE = """<mujoco><size nuserdata="2"/><option jacobian="sparse"/><worldbody><body>
<joint type="free" frictionloss="1"/><geom size=".1"/></body></worldbody></mujoco>"""
"""A model with user data and six constraint rows in sparse format."""


class Offsets(NamedTuple):
    """Byte offsets in MuJoCo's structures, and the address of `mj_step`.

    Attributes:
        user_size: offset of `nuserdata` in mjModel.
        time, row_count, nonzeros: offsets of `time`, `nefc` and `nJ` in mjData.
        pointers: offsets of the array pointers in mjData, by name.
        step: address of `mj_step`.
    """

    user_size: int
    time: int
    row_count: int
    nonzeros: int
    pointers: dict[str, int]
    step: int


@functools.cache
def layout(name: str, last: str = "") -> Layout:
    """Return a structure of MuJoCo as a ctypes class, from `mujoco.introspect`.

    Args:
        name: name of the structure, like "mjData".
        last: last field of the class; all fields by default.

    Raises:
        LookupError: the declarations contain an unsupported type.
    """
    from mujoco.introspect import structs

    fields = []
    for field in structs.STRUCTS[name].fields:
        fields.append((field.name, _ctype(field.type)))
        if field.name == last:
            break
    return type(name, (ctypes.Structure,), {"_fields_": fields})


def _ctype(declared: Any) -> Any:
    """Convert a declared type to a ctypes type."""
    from mujoco.introspect import ast_nodes, enums, structs

    if isinstance(declared, ast_nodes.PointerType):
        return ctypes.c_void_p
    if isinstance(declared, ast_nodes.ArrayType):
        element_type = _ctype(declared.inner_type)
        for extent in reversed(declared.extents):
            element_type = element_type * extent
        return element_type
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


def pointer_offsets(data: mujoco.MjData, names: Iterable[str]) -> dict[str, int]:
    """Return the byte offsets of array pointers in mjData, by name.

    Args:
        data: state after a forward evaluation, so that the arrays exist.
        names: names of the arrays.

    Raises:
        LookupError: a pointer has another offset than declared.
    """
    structure = layout("mjData")
    seen = structure.from_address(data._address)
    offset_by_name = {}
    for name in names:
        array = getattr(data, name)
        if not array.size or getattr(seen, name, None) != array.ctypes.data:
            raise LookupError(f"mjData.{name}")
        offset_by_name[name] = int(getattr(structure, name).offset)
    return offset_by_name


def step_address() -> int:
    """Return the address of `mj_step` in the library that the Python bindings of MuJoCo use.

    Raises:
        LookupError: there is no single library next to the bindings, or the bindings use another copy of it.
    """
    folder = Path(mujoco.__file__).parent
    paths = [path for path in folder.iterdir() if path.name.startswith("libmujoco") or path.name == "mujoco.dll"]
    if len(paths) != 1:
        raise LookupError(f"mj_step ({len(paths)} libraries in {folder} instead of one)")
    library, installed = ctypes.CDLL(str(paths[0])), mujoco.get_mjcb_control() is not None
    if not installed:
        mujoco.set_mjcb_control(lambda model, data: None)
    callback = ctypes.c_void_p.in_dll(library, "mjcb_control").value
    if not installed:
        mujoco.set_mjcb_control(None)
    if not callback:
        raise LookupError(f"mjcb_control (the bindings use another library than {paths[0]})")
    return int(ctypes.cast(library.mj_step, ctypes.c_void_p).value or 0)


@functools.cache
def offsets() -> Offsets:
    """Return the offsets and addresses for compiled code, checked once in a process with a small model.

    Raises:
        MissingPartError: a field has another offset than declared by the installed MuJoCo version.
    """
    model = mujoco.MjModel.from_xml_string(PROBE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    # A nonzero time, so that a zero field does not pass the check.
    data.time = 0.734
    try:
        sizes, scalars = layout("mjModel", "nuserdata"), layout("mjData")
        whole = [name for name, form in sizes._fields_ if form is ctypes.c_int64 and hasattr(model, name)]  # type: ignore[misc]
        for checked, structure, names in ((model, sizes, whole), (data, scalars, ("time", "nefc", "nJ"))):
            seen = structure.from_address(checked._address)
            for name in names:
                if getattr(seen, name) != getattr(checked, name):
                    raise LookupError(f"{structure.__name__}.{name}")
        return Offsets(
            user_size=int(sizes.nuserdata.offset),
            time=int(scalars.time.offset),
            row_count=int(scalars.nefc.offset),
            nonzeros=int(scalars.nJ.offset),
            pointers=pointer_offsets(data, POINTERS),
            step=step_address(),
        )
    except LookupError as error:
        raise MissingPartError(
            f"MuJoCo {mujoco.__version__} differs from its declarations (mujoco.introspect) at {error.args[0]}, so "
            "compiled code would read wrong values; install the tested version: pip install -c constraints.txt mujoco"
        ) from None
