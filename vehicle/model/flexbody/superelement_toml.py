"""A modal superelement as TOML with a unit in every key, read strictly."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable
from typing import Any

import numpy as np

from vehicle.errors import DataError
from vehicle.model.flexbody.beam import FloatArray
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement

FORMAT = "modal superelement 2"
_OLDER = "modal superelement 1"
_KEYS = {
    "": (
        *("format", "name", "provenance", "node_count", "mode_count", "hardpoint_tolerance_m", "edges", "node", "mode"),
        *("mass_kg", "cog_m", "inertia_kg_m2"),
    ),
    "node": (
        *("name", "position_m", "mass_kg", "attachment_stiffness_n_per_m"),
        *("residual_flexibility_m_per_n", "rotation_per_m_sqrt_kg"),
    ),
    "mode": ("name", "frequency_hz", "damping_ratio", "shape_per_sqrt_kg"),
}
RIGID = ("mass_kg", "cog_m", "inertia_kg_m2")
_OPTIONAL = {"hardpoint_tolerance_m", "edges", "residual_flexibility_m_per_n", "rotation_per_m_sqrt_kg", *RIGID}
_OF_VERSION_1 = "attachment_stiffness_n_per_m"


def of_tables(content: dict[str, Any]) -> Superelement:
    """The superelement of the content of a file.

    Raises:
        DataError: incomplete, an unknown key, or refused by `check_superelement`.
    """
    found = content.get("format")
    if found not in (FORMAT, _OLDER):
        raise DataError(f"format is {found!r}; {FORMAT!r} and {_OLDER!r} can be read.")
    older = found == _OLDER
    _check_keys(content, "", "top level", older)
    nodes, modes = (_tables(content, kind, older) for kind in ("node", "mode"))
    names = tuple(str(node["name"]) for node in nodes)
    tolerance = numbers(content.get("hardpoint_tolerance_m", 1e-3), "hardpoint_tolerance_m")
    if tolerance.shape != ():
        raise DataError(f"hardpoint_tolerance_m: found {tolerance.tolist()}, needed is one number.")
    index = {name: i for i, name in enumerate(names)}
    edges = []
    listed = content.get("edges", [])
    for edge in listed if isinstance(listed, list) else [listed]:
        if not (isinstance(edge, list) and len(edge) == 2 and all(str(end) in index for end in edge)):
            raise DataError(f"edges: {edge!r} is no pair of node names.")
        edges.append([index[str(end)] for end in edge])
    for i, mode in enumerate(modes):
        shape = numbers(mode["shape_per_sqrt_kg"], f"mode {i + 1}, shape_per_sqrt_kg").shape
        if shape != (len(names), 3):
            raise DataError(
                f"mode {i + 1}, shape_per_sqrt_kg: {shape[0] if shape else 0} rows; {len(names)} nodes need "
                f"{len(names)} rows of three numbers."
            )
    residual = {}
    for node in nodes:
        where = f"node {node['name']!r}"
        if _OF_VERSION_1 in node:
            residual[str(node["name"])] = _of_stiffness(numbers(node[_OF_VERSION_1], f"{where}, {_OF_VERSION_1}"))
        elif "residual_flexibility_m_per_n" in node:
            key = "residual_flexibility_m_per_n"
            residual[str(node["name"])] = numbers(node[key], f"{where}, {key}")
    return Superelement(
        name=str(content["name"]),
        nodes=names,
        positions=_column(nodes, "node", "position_m"),
        edges=np.array(edges, dtype=int).reshape(-1, 2),
        node_mass=_column(nodes, "node", "mass_kg") if _all_or_none(nodes, "node", "mass_kg") else None,
        mass_properties=given_rigid({key: content[key] for key in RIGID if key in content}),
        frequencies=_column(modes, "mode", "frequency_hz"),
        damping_ratio=_column(modes, "mode", "damping_ratio"),
        shapes=_column(modes, "mode", "shape_per_sqrt_kg"),
        rotations={
            str(node["name"]): numbers(node[key], f"node {node['name']!r}, {key}")
            for node in nodes
            if (key := "rotation_per_m_sqrt_kg") in node
        },
        residual=residual,
        mode_names=tuple(str(mode["name"]) for mode in modes),
        provenance=str(content["provenance"]),
        hardpoint_tolerance=float(tolerance),
    )


def _of_stiffness(stiffness: FloatArray) -> FloatArray:
    """Flexibility of three springs along the axes [m/N], shape (3, 3)."""
    if stiffness.shape != (3,) or not np.all(np.isfinite(stiffness) & (stiffness > 0.0)):
        raise DataError(
            f"{_OF_VERSION_1}: {stiffness.tolist()} N/m; three positive finite numbers are needed. Leave the node out "
            "where it is rigid."
        )
    return np.diag(1.0 / stiffness)


def given_rigid(given: dict[str, Any]) -> MassProperties | None:
    """Mass properties, complete or left out."""
    if not given:
        return None
    for key in RIGID:
        if key not in given:
            raise DataError(f"top level: key {key!r} is missing; {', '.join(RIGID)} belong together.")
    mass, cog, inertia = (numbers(given[key], key) for key in RIGID)
    for key, array, shape in zip(RIGID, (mass, cog, inertia), ((), (3,), (3, 3)), strict=True):
        if array.shape != shape:
            raise DataError(f"{key}: shape {array.shape}, needed is {shape}.")
    return MassProperties(mass=float(mass), cog=cog, inertia=inertia)


def _check_keys(table: dict[str, Any], kind: str, where: str, older: bool) -> None:
    known = [key for key in _KEYS[kind] if older or key != _OF_VERSION_1]
    for key in table:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1, cutoff=0.0)
            raise DataError(f"{where}: unknown key {key!r}; the nearest valid one is {near[0]!r}.")
    for key in known:
        if key not in table and key not in _OPTIONAL and key != _OF_VERSION_1:
            raise DataError(f"{where}: key {key!r} is missing. The file is incomplete or was cut off; write it again.")


def _tables(content: dict[str, Any], kind: str, older: bool) -> list[dict[str, Any]]:
    tables, count = content[kind], content[f"{kind}_count"]
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise DataError(f"{kind}: must be a list of [[{kind}]] tables.")
    if len(tables) != count:
        raise DataError(
            f"{len(tables)} [[{kind}]] tables, but {kind}_count = {count!r}. The file is incomplete, was cut off, or "
            "the count was not changed with it."
        )
    if not tables:
        raise DataError(f"{kind}_count is 0; at least 1 {kind} is needed. A rigid body is body.flexible = false.")
    for i, table in enumerate(tables):
        # A body of masses at its nodes needs them all; one with mass properties of its own needs none.
        free = {"mass_kg": 0.0} if kind == "node" and "mass_kg" in content and not older else {}
        _check_keys({**free, **table}, kind, f"{kind} {i + 1}", older)
    return tables


def _all_or_none(tables: list[dict[str, Any]], kind: str, key: str) -> bool:
    having = [key in table for table in tables]
    if any(having) and not all(having):
        raise DataError(f"{kind} {having.index(False) + 1}: key {key!r} is missing; give it for each {kind}, or none.")
    return all(having)


def numbers(value: Any, where: str) -> FloatArray:
    """A regular array of numbers; a DataError names where it is none."""
    try:
        array = np.array(value)
    except ValueError as error:
        raise DataError(f"{where}: rows of different length. Give three numbers in each row.") from error
    if array.dtype.kind not in "if":
        raise DataError(f"{where}: {str(value)[:40]!r} is not made of numbers.")
    return array.astype(float)


def _column(tables: list[dict[str, Any]], kind: str, key: str) -> FloatArray:
    rows = [numbers(table[key], f"{kind} {i + 1}, {key}") for i, table in enumerate(tables)]
    for i, row in enumerate(rows):
        if row.shape != rows[0].shape:
            raise DataError(f"{kind} {i + 1}, {key}: shape {row.shape}, the first one has {rows[0].shape}.")
    return np.array(rows)


def head_of(body: Superelement) -> dict[str, Any]:
    """What stands above nodes and modes; the mass properties where the nodes do not have them."""
    head: dict[str, Any] = {"format": FORMAT, "name": body.name, "provenance": body.provenance}
    head |= {"hardpoint_tolerance_m": body.hardpoint_tolerance}
    if body.node_mass is None:
        head |= {"mass_kg": body.mass, "cog_m": body.cog.tolist(), "inertia_kg_m2": body.inertia.tolist()}
    return head


def lines(body: Superelement) -> Iterable[str]:
    """The lines of a file, every number with all its digits."""
    text = json.dumps  # a JSON string or list of numbers is valid TOML
    yield "# Vehicle frame: x to the rear, y to the driver's right, z up. SI units."
    head = head_of(body)
    for key in ("format", "name", "provenance"):
        yield f"{key} = {text(head.pop(key))}"
    yield f"node_count = {len(body.nodes)}"
    yield f"mode_count = {len(body.frequencies)}"
    yield from (f"{key} = {text(value)}" for key, value in head.items())
    yield "edges = ["
    yield from (f"  {text([body.nodes[a], body.nodes[b]])}," for a, b in body.edges.tolist())
    yield "]"
    for i, name in enumerate(body.nodes):
        yield "\n[[node]]"
        yield f"name = {text(name)}"
        yield f"position_m = {text(body.positions[i].tolist())}"
        if body.node_mass is not None:
            yield f"mass_kg = {text(float(body.node_mass[i]))}"
        if name in body.residual:
            yield f"residual_flexibility_m_per_n = {text(body.residual[name].tolist())}"
        if name in body.rotations:
            yield f"rotation_per_m_sqrt_kg = {text(body.rotations[name].tolist())}"
    for i, name in enumerate(body.mode_names):
        yield "\n[[mode]]"
        yield f"name = {text(name)}"
        yield f"frequency_hz = {text(float(body.frequencies[i]))}"
        yield f"damping_ratio = {text(float(body.damping_ratio[i]))}"
        yield "shape_per_sqrt_kg = ["
        yield from (f"  {text(row)}," for row in body.shapes[i].tolist())
        yield "]"
