"""Modal superelement as TOML with a unit in every key; unknown or missing keys are errors."""

import json
from collections.abc import Iterable
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import DataError
from vehicle.model.flexbody.mass_properties import MassProperties
from vehicle.model.flexbody.superelement import Superelement
from vehicle.wording import did_you_mean

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
    """Build a superelement from the parsed content of a TOML file.

    Raises:
        DataError: a key is missing or unknown, or a check of `check_superelement` failed.
    """
    file_format = content.get("format")
    if file_format not in (FORMAT, _OLDER):
        raise DataError(f"format is {file_format!r} but must be {FORMAT!r} or {_OLDER!r}.")
    older = file_format == _OLDER
    _check_keys(content, "", "top level", older)
    nodes, modes = (_tables(content, table_type, older) for table_type in ("node", "mode"))
    names = tuple(str(node["name"]) for node in nodes)
    tolerance = numbers(content.get("hardpoint_tolerance_m", 1e-3), "hardpoint_tolerance_m")
    if tolerance.shape != ():
        raise DataError(f"hardpoint_tolerance_m: must be a single number, not {tolerance.tolist()}.")
    index = {name: i for i, name in enumerate(names)}
    edges = []
    edge_list = content.get("edges", [])
    for edge in edge_list if isinstance(edge_list, list) else [edge_list]:
        if not (isinstance(edge, list) and len(edge) == 2 and all(str(end) in index for end in edge)):
            raise DataError(f"edges: {edge!r} is not a pair of node names.")
        edges.append([index[str(end)] for end in edge])
    for i, mode in enumerate(modes):
        shape = numbers(mode["shape_per_sqrt_kg"], f"mode {i + 1}, shape_per_sqrt_kg").shape
        if shape != (len(names), 3):
            raise DataError(
                f"mode {i + 1}, shape_per_sqrt_kg: found {shape[0] if shape else 0} rows, must be {len(names)} "
                "rows of three numbers, a row for each node."
            )
    residual, with_mass = {}, ["mass_kg" in node for node in nodes]
    for node in nodes:
        where = f"node {node['name']!r}"
        for key in (_OF_VERSION_1, "residual_flexibility_m_per_n"):
            if key in node:
                values = numbers(node[key], f"{where}, {key}")
                residual[str(node["name"])] = _of_stiffness(values) if key == _OF_VERSION_1 else values
                break
    if any(with_mass) and not all(with_mass):
        raise DataError(
            f"node {with_mass.index(False) + 1}: key 'mass_kg' is missing; give it for every node or for no node."
        )
    return Superelement(
        name=str(content["name"]),
        nodes=names,
        positions=_column(nodes, "node", "position_m"),
        edges=np.array(edges, dtype=int).reshape(-1, 2),
        node_mass=_column(nodes, "node", "mass_kg") if all(with_mass) else None,
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


def _of_stiffness(stiffness: Vector) -> Vector:
    """Return the flexibility of three springs along the axes [m/N], shape (3, 3)."""
    if stiffness.shape != (3,) or not np.all(np.isfinite(stiffness) & (stiffness > 0.0)):
        raise DataError(
            f"{_OF_VERSION_1}: found {stiffness.tolist()} N/m, must be three positive finite numbers. Leave the "
            "key out for a rigid attachment."
        )
    return np.diag(1.0 / stiffness)


def given_rigid(table: dict[str, Any]) -> MassProperties | None:
    """Return mass properties from the keys `RIGID`, which must be complete; None if all are absent."""
    if not table:
        return None
    for key in RIGID:
        if key not in table:
            raise DataError(f"top level: key {key!r} is missing; set all of {', '.join(RIGID)}.")
    mass, cog, inertia = (numbers(table[key], key) for key in RIGID)
    for key, array, shape in zip(RIGID, (mass, cog, inertia), ((), (3,), (3, 3)), strict=True):
        if array.shape != shape:
            raise DataError(f"{key}: must have the shape {shape}, not {array.shape}.")
    return MassProperties(mass=float(mass), cog=cog, inertia=inertia)


def _check_keys(table: dict[str, Any], table_type: str, where: str, older: bool) -> None:
    valid_keys = [key for key in _KEYS[table_type] if older or key != _OF_VERSION_1]
    for key in table:
        if key not in valid_keys:
            raise DataError(f"{where}: unknown key {key!r}{did_you_mean(key, valid_keys)}")
    for key in valid_keys:
        if key not in table and key not in _OPTIONAL and key != _OF_VERSION_1:
            raise DataError(f"{where}: key {key!r} is missing. The file is incomplete or truncated; export it again.")


def _tables(content: dict[str, Any], table_type: str, older: bool) -> list[dict[str, Any]]:
    tables, count = content[table_type], content[f"{table_type}_count"]
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise DataError(f"{table_type}: must be written as sections [[{table_type}]].")
    if len(tables) != count:
        raise DataError(
            f"found {len(tables)} sections [[{table_type}]], but {table_type}_count = {count!r}. The file is "
            "truncated, or the count is outdated; export it again, or correct the count."
        )
    if not tables:
        raise DataError(f"{table_type}_count is 0 but must be at least 1. For a rigid body, set body.flexible = false.")
    for i, table in enumerate(tables):
        # Node masses are optional if the file has mass properties of the whole body.
        free = {"mass_kg": 0.0} if table_type == "node" and "mass_kg" in content and not older else {}
        _check_keys({**free, **table}, table_type, f"{table_type} {i + 1}", older)
    return tables


def numbers(value: Any, where: str) -> Vector:
    """Convert a value to a regular array of numbers.

    Raises:
        DataError: rows of different length, or entries other than numbers.
    """
    try:
        array = np.array(value)
    except ValueError as error:
        raise DataError(f"{where}: the rows have different lengths. Give three numbers in each row.") from error
    if array.dtype.kind not in "if":
        raise DataError(f"{where}: must be numbers, not {str(value)[:40]!r}.")
    return array.astype(float)


def _column(tables: list[dict[str, Any]], table_type: str, key: str) -> Vector:
    rows = [numbers(table[key], f"{table_type} {i + 1}, {key}") for i, table in enumerate(tables)]
    for i, row in enumerate(rows):
        if row.shape != rows[0].shape:
            raise DataError(
                f"{table_type} {i + 1}, {key}: shape {row.shape}, must be {rows[0].shape} as in the first {table_type}."
            )
    return np.array(rows)


def head_of(body: Superelement) -> dict[str, Any]:
    """Return the top-level entries of a file: format, name, provenance, tolerance, and mass properties if needed."""
    head: dict[str, Any] = {"format": FORMAT, "name": body.name, "provenance": body.provenance}
    head |= {"hardpoint_tolerance_m": body.hardpoint_tolerance}
    if body.node_mass is None:
        head |= {"mass_kg": body.mass, "cog_m": body.cog.tolist(), "inertia_kg_m2": body.inertia.tolist()}
    return head


def lines(body: Superelement) -> Iterable[str]:
    """Yield the lines of a TOML file, with all digits of every number."""
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
