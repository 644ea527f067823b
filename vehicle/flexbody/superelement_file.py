"""Data file of a modal superelement: TOML with a unit in every key, read strictly, written whole or not at all."""

from __future__ import annotations

import difflib
import json
import tempfile
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from vehicle.errors import DataError, OutputError
from vehicle.flexbody.superelement import Superelement

_FORMAT = "modal superelement 1"
_KEYS = {
    "": ("format", "name", "provenance", "node_count", "mode_count", "hardpoint_tolerance_m", "edges", "node", "mode"),
    "node": ("name", "position_m", "mass_kg", "attachment_stiffness_n_per_m"),
    "mode": ("name", "frequency_hz", "damping_ratio", "shape_per_sqrt_kg"),
}
_OPTIONAL = ("hardpoint_tolerance_m", "edges", "attachment_stiffness_n_per_m")


def read_superelement(path: Path) -> Superelement:
    """Read a modal superelement.

    Args:
        path: TOML file; top level `format`, `name`, `provenance`, `node_count`, `mode_count`, `edges` (pairs of node
            names), `hardpoint_tolerance_m` (0.001 where it is left out), a `[[node]]` table for each node and a
            `[[mode]]` table for each mode, `shape_per_sqrt_kg` with one row per node in the order of the nodes.

    Returns:
        The checked superelement.

    Raises:
        DataError: unreadable, truncated, incomplete, an unknown key, or refused by `check_superelement`.
    """
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise DataError(f"{path}: no such file. Give the path of a body model.") from error
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: cannot be read as UTF-8 text ({error}). Give a body model in TOML.") from error
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise DataError(f"{path}: no valid TOML, perhaps cut off: {error}. Write the file again.") from error
    try:
        return _superelement(content)
    except DataError as error:
        raise DataError(f"{path}: {error}") from error


def _superelement(content: dict[str, Any]) -> Superelement:
    found = content.get("format")
    if found != _FORMAT:
        raise DataError(f"format is {found!r}; {_FORMAT!r} is the one that can be read.")
    _check_keys(content, "", "top level")
    nodes, modes = (_tables(content, kind) for kind in ("node", "mode"))
    if not modes:
        raise DataError("mode_count is 0; at least 1 mode is needed. A rigid body is body.flexible = false.")
    names = tuple(str(node["name"]) for node in nodes)
    tolerance = _numbers(content.get("hardpoint_tolerance_m", 1e-3), "hardpoint_tolerance_m")
    if tolerance.shape != ():
        raise DataError(f"hardpoint_tolerance_m: found {tolerance.tolist()}, needed is one number.")
    index = {name: i for i, name in enumerate(names)}
    edges = []
    for edge in content.get("edges", []):
        if not (isinstance(edge, list) and len(edge) == 2 and all(end in index for end in edge)):
            raise DataError(f"edges: {edge!r} is no pair of node names.")
        edges.append([index[end] for end in edge])
    for i, mode in enumerate(modes):
        if np.shape(_numbers(mode["shape_per_sqrt_kg"], f"mode {i + 1}, shape_per_sqrt_kg")) != (len(names), 3):
            raise DataError(
                f"mode {i + 1}, shape_per_sqrt_kg: {len(mode['shape_per_sqrt_kg'])} rows; {len(names)} nodes need "
                f"{len(names)} rows of three numbers."
            )
    return Superelement(
        name=str(content["name"]),
        nodes=names,
        positions=_column(nodes, "node", "position_m"),
        edges=np.array(edges, dtype=int).reshape(-1, 2),
        node_mass=_column(nodes, "node", "mass_kg"),
        frequencies=_column(modes, "mode", "frequency_hz"),
        damping_ratio=_column(modes, "mode", "damping_ratio"),
        shapes=_column(modes, "mode", "shape_per_sqrt_kg"),
        attachment_stiffness={
            str(node["name"]): _numbers(node[key], f"node {node['name']!r}, {key}")
            for node in nodes
            for key in ("attachment_stiffness_n_per_m",)
            if key in node
        },
        mode_names=tuple(str(mode["name"]) for mode in modes),
        provenance=str(content["provenance"]),
        hardpoint_tolerance=float(tolerance),
    )


def _check_keys(table: dict[str, Any], kind: str, where: str) -> None:
    for key in table:
        if key not in _KEYS[kind]:
            near = difflib.get_close_matches(key, _KEYS[kind], n=1, cutoff=0.0)
            raise DataError(f"{where}: unknown key {key!r}; the nearest valid one is {near[0]!r}.")
    for key in _KEYS[kind]:
        if key not in table and key not in _OPTIONAL:
            raise DataError(f"{where}: key {key!r} is missing. The file is incomplete or was cut off; write it again.")


def _tables(content: dict[str, Any], kind: str) -> list[dict[str, Any]]:
    tables, count = content[kind], content[f"{kind}_count"]
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise DataError(f"{kind}: must be a list of [[{kind}]] tables.")
    if len(tables) != count:
        raise DataError(
            f"{len(tables)} [[{kind}]] tables, but {kind}_count = {count!r}. The file is incomplete, was cut off, or "
            "the count was not changed with it."
        )
    for i, table in enumerate(tables):
        _check_keys(table, kind, f"{kind} {i + 1}")
    return tables


def _numbers(value: Any, where: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    try:
        array = np.array(value)
    except ValueError as error:
        raise DataError(f"{where}: rows of different length. Give three numbers in each row.") from error
    if array.dtype.kind not in "if":
        raise DataError(f"{where}: {str(value)[:40]!r} is not made of numbers.")
    return array.astype(float)


def _column(tables: list[dict[str, Any]], kind: str, key: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    rows = [_numbers(table[key], f"{kind} {i + 1}, {key}") for i, table in enumerate(tables)]
    for i, row in enumerate(rows):
        if row.shape != rows[0].shape:
            raise DataError(f"{kind} {i + 1}, {key}: shape {row.shape}, the first one has {rows[0].shape}.")
    return np.array(rows)


def write_superelement(path: Path, superelement: Superelement) -> None:
    """Write a modal superelement: to a temporary file in the same folder, renamed when it is complete.

    Args:
        path: file to write.
        superelement: what to write; every number is written with all its digits.

    Raises:
        OutputError: the file cannot be written.
    """
    text = "\n".join(_lines(superelement)) + "\n"
    temporary = ""
    try:
        with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, encoding="utf-8") as file:
            temporary = file.name
            file.write(text)
        Path(temporary).chmod(0o644)  # a temporary file is private, a data file is not
        Path(temporary).replace(path)
    except OSError as error:
        if temporary:
            Path(temporary).unlink(missing_ok=True)
        raise OutputError(
            f"{path}: cannot be written ({error}). Check the folder, its permissions and space."
        ) from error


def _lines(body: Superelement) -> Iterable[str]:
    text = json.dumps  # a JSON string or list of numbers is valid TOML
    yield "# Vehicle frame: x to the rear, y to the driver's right, z up. SI units."
    yield f"format = {text(_FORMAT)}"
    yield f"name = {text(body.name)}"
    yield f"provenance = {text(body.provenance)}"
    yield f"node_count = {len(body.nodes)}"
    yield f"mode_count = {len(body.frequencies)}"
    yield f"hardpoint_tolerance_m = {text(body.hardpoint_tolerance)}"
    yield "edges = ["
    yield from (f"  {text([body.nodes[a], body.nodes[b]])}," for a, b in body.edges.tolist())
    yield "]"
    for i, name in enumerate(body.nodes):
        yield "\n[[node]]"
        yield f"name = {text(name)}"
        yield f"position_m = {text(body.positions[i].tolist())}"
        yield f"mass_kg = {text(float(body.node_mass[i]))}"
        if name in body.attachment_stiffness:
            yield f"attachment_stiffness_n_per_m = {text(body.attachment_stiffness[name].tolist())}"
    for i, name in enumerate(body.mode_names):
        yield "\n[[mode]]"
        yield f"name = {text(name)}"
        yield f"frequency_hz = {text(float(body.frequencies[i]))}"
        yield f"damping_ratio = {text(float(body.damping_ratio[i]))}"
        yield "shape_per_sqrt_kg = ["
        yield from (f"  {text(row)}," for row in body.shapes[i].tolist())
        yield "]"
