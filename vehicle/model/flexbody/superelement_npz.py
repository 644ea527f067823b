"""Modal superelement as npz, for thousands of nodes and hundreds of modes, which are slow to read as text."""

import io
import json
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.superelement import Superelement
from vehicle.model.flexbody.superelement_toml import FORMAT, RIGID, given_rigid, head_of, numbers
from vehicle.signals.formats.unpacked_size import require_archive
from vehicle.wording import did_you_mean

_ARRAYS = {
    "positions": "position_m",
    "node_mass": "node_mass_kg",
    "frequencies": "frequency_hz",
    "damping_ratio": "damping_ratio",
    "shapes": "shape_per_sqrt_kg",
}
_OWNED = {"residual": "residual_flexibility_m_per_n", "rotation": "rotation_per_m_sqrt_kg"}
"""Keys of the arrays of individual nodes, named in `residual_nodes` and `rotation_nodes`."""
_NAMES = {"nodes", "mode_names", "residual_nodes", "rotation_nodes"}
_NPZ = {"head", "edges", *_NAMES, *_ARRAYS.values(), *_OWNED.values()}
_NPZ_OPTIONAL = {"node_mass_kg"}


def of_arrays(raw: bytes) -> Superelement:
    """Build a superelement from the bytes of an npz file.

    Raises:
        DataError: not an npz file, incomplete, an unknown array, or a failed check of `check_superelement`.
    """
    try:
        with np.load(io.BytesIO(raw), allow_pickle=False) as file:
            require_archive("the npz", io.BytesIO(raw))
            content = {name: np.asarray(file[name]) for name in file.files}
        head = json.loads(str(content.get("head", "null")))
    except DataError:
        raise
    except Exception as error:  # NumPy raises errors of any type for damaged files, for example TokenError
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        raise DataError(f"is not a valid npz, perhaps truncated ({reason}). Save or export the file again.") from None
    if not isinstance(head, dict) or head.get("format") != FORMAT:
        file_format = head.get("format") if isinstance(head, dict) else None
        raise DataError(f"format is {file_format!r} but must be {FORMAT!r} for npz.")
    for name in sorted(content.keys() ^ _NPZ):
        if name not in _NPZ:
            raise DataError(f"unknown array {name!r}{did_you_mean(name, sorted(_NPZ))}")
        if name not in _NPZ_OPTIONAL:
            raise DataError(f"array {name!r} is missing. The file is incomplete; export it again.")
    for name in _NPZ - {"head"} & content.keys():
        kinds = "U" if name in _NAMES else "if"
        if content[name].dtype.kind not in kinds and content[name].size:
            raise DataError(
                f"array {name!r}: found type {content[name].dtype}, must be {'names' if kinds == 'U' else 'numbers'}."
            )
    for name, shape in {**dict.fromkeys(_NAMES, 1), "edges": 2, **dict.fromkeys(_OWNED.values(), 3)}.items():
        if content[name].ndim != shape or (name == "edges" and content[name].shape[1] != 2):
            raise DataError(
                f"array {name!r}: shape {content[name].shape}, must have {shape} dimensions, edges in pairs."
            )
    missing = [key for key in ("name", "provenance", "hardpoint_tolerance_m") if key not in head]
    if missing:
        raise DataError(f"head: key {missing[0]!r} is missing. The file is incomplete; export it again.")
    tolerance = numbers(head["hardpoint_tolerance_m"], "hardpoint_tolerance_m")
    if tolerance.shape != ():
        raise DataError(f"hardpoint_tolerance_m: must be a single number, not {tolerance.tolist()}.")
    node_arrays = {}
    for quantity, key in _OWNED.items():
        owners, values = content[f"{quantity}_nodes"], content[key]
        if len(owners) != len(values):
            raise DataError(f"{key}: {len(values)} arrays for {len(owners)} nodes.")
        node_arrays[quantity] = dict(zip(owners.tolist(), values, strict=True))
    return Superelement(
        name=str(head["name"]),
        nodes=tuple(content["nodes"].tolist()),
        edges=content["edges"],
        mass_properties=given_rigid({key: head[key] for key in RIGID if key in head}),
        residual=node_arrays["residual"],
        mode_names=tuple(content["mode_names"].tolist()),
        provenance=str(head["provenance"]),
        hardpoint_tolerance=float(tolerance),
        positions=content["position_m"],
        node_mass=content.get("node_mass_kg"),
        frequencies=content["frequency_hz"],
        damping_ratio=content["damping_ratio"],
        shapes=content["shape_per_sqrt_kg"],
        rotations=node_arrays["rotation"],
    )


def arrays(body: Superelement) -> bytes:
    """Return the bytes of an npz file of a superelement."""
    content: dict[str, Any] = {
        key: value for name, key in _ARRAYS.items() if (value := getattr(body, name)) is not None
    }
    for quantity, key, node_arrays, shape in (
        ("residual", _OWNED["residual"], body.residual, (-1, 3, 3)),
        ("rotation", _OWNED["rotation"], body.rotations, (-1, len(body.frequencies), 3)),
    ):
        content[f"{quantity}_nodes"] = np.array(list(node_arrays), dtype=str)
        content[key] = np.array(list(node_arrays.values()), dtype=float).reshape(shape)
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
