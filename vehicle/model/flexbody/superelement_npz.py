"""A modal superelement as npz: for thousands of nodes and hundreds of modes, as text slower to read than to run."""

from __future__ import annotations

import difflib
import io
import json
import zipfile
import zlib
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_toml import FORMAT, RIGID, given_rigid, head_of, numbers

_ARRAYS = {
    "positions": "position_m",
    "node_mass": "node_mass_kg",
    "frequencies": "frequency_hz",
    "damping_ratio": "damping_ratio",
    "shapes": "shape_per_sqrt_kg",
}
_OWNED = {"residual": "residual_flexibility_m_per_n", "rotation": "rotation_per_m_sqrt_kg"}
"""Arrays of some of the nodes, whose names stand in `residual_nodes` and `rotation_nodes`."""
_NAMES = {"nodes", "mode_names", "residual_nodes", "rotation_nodes"}
_NPZ = {"head", "edges", *_NAMES, *_ARRAYS.values(), *_OWNED.values()}
_NPZ_OPTIONAL = {"node_mass_kg"}


def of_arrays(raw: bytes) -> Superelement:
    """The superelement of an npz file.

    Raises:
        DataError: no such file, incomplete, an unknown array, or refused by `check_superelement`.
    """
    try:
        with np.load(io.BytesIO(raw), allow_pickle=False) as file:
            found = {name: np.asarray(file[name]) for name in file.files}
        head = json.loads(str(found.get("head", "null")))
    except (ValueError, OSError, EOFError, KeyError, zipfile.BadZipFile, zlib.error, NotImplementedError) as error:
        raise DataError(f"no valid npz, perhaps cut off: {error}. Write the file again.") from error
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        was = head.get("format") if isinstance(head, dict) else None
        raise DataError(f"format is {was!r}; {FORMAT!r} can be read as npz.")
    for name in sorted(found.keys() ^ _NPZ):
        if name not in _NPZ:
            near = difflib.get_close_matches(name, sorted(_NPZ), n=1, cutoff=0.0)
            raise DataError(f"unknown array {name!r}; the nearest valid one is {near[0]!r}.")
        if name not in _NPZ_OPTIONAL:
            raise DataError(f"array {name!r} is missing. The file is incomplete; write it again.")
    for name in _NPZ - {"head"} & found.keys():
        kinds = "U" if name in _NAMES else "if"
        if found[name].dtype.kind not in kinds and found[name].size:
            raise DataError(
                f"array {name!r}: of type {found[name].dtype}, needed are {'names' if kinds == 'U' else 'numbers'}."
            )
    for name, shape in {**dict.fromkeys(_NAMES, 1), "edges": 2, **dict.fromkeys(_OWNED.values(), 3)}.items():
        if found[name].ndim != shape or (name == "edges" and found[name].shape[1] != 2):
            raise DataError(
                f"array {name!r}: shape {found[name].shape}; needed is one of {shape} dimensions, edges in pairs."
            )
    missing = [key for key in ("name", "provenance", "hardpoint_tolerance_m") if key not in head]
    if missing:
        raise DataError(f"head: key {missing[0]!r} is missing. The file is incomplete; write it again.")
    tolerance = numbers(head["hardpoint_tolerance_m"], "hardpoint_tolerance_m")
    if tolerance.shape != ():
        raise DataError(f"hardpoint_tolerance_m: found {tolerance.tolist()}, needed is one number.")
    owned = {}
    for kind, key in _OWNED.items():
        owners, values = found[f"{kind}_nodes"], found[key]
        if len(owners) != len(values):
            raise DataError(f"{key}: {len(values)} arrays for {len(owners)} nodes.")
        owned[kind] = dict(zip(owners.tolist(), values, strict=True))
    return Superelement(
        name=str(head["name"]),
        nodes=tuple(found["nodes"].tolist()),
        edges=found["edges"],
        mass_properties=given_rigid({key: head[key] for key in RIGID if key in head}),
        residual=owned["residual"],
        mode_names=tuple(found["mode_names"].tolist()),
        provenance=str(head["provenance"]),
        hardpoint_tolerance=float(tolerance),
        positions=found["position_m"],
        node_mass=found.get("node_mass_kg"),
        frequencies=found["frequency_hz"],
        damping_ratio=found["damping_ratio"],
        shapes=found["shape_per_sqrt_kg"],
        rotations=owned["rotation"],
    )


def arrays(body: Superelement) -> bytes:
    """The bytes of a file."""
    content: dict[str, Any] = {
        key: value for name, key in _ARRAYS.items() if (value := getattr(body, name)) is not None
    }
    for kind, key, owned, shape in (
        ("residual", _OWNED["residual"], body.residual, (-1, 3, 3)),
        ("rotation", _OWNED["rotation"], body.rotations, (-1, len(body.frequencies), 3)),
    ):
        content[f"{kind}_nodes"] = np.array(list(owned), dtype=str)
        content[key] = np.array(list(owned.values()), dtype=float).reshape(shape)
    stream = io.BytesIO()
    np.savez(
        stream,
        head=json.dumps(head_of(body)),
        nodes=np.array(body.nodes, dtype=str),
        mode_names=np.array(body.mode_names, dtype=str),
        edges=body.edges,
        **content,
    )
    return stream.getvalue()
