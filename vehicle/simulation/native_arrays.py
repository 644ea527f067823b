"""The arrays a compiled callback works on: fields of mjData, and constants and state of `ElementRows`.

All are two-dimensional. The order of the names is the order of the columns in the table of addresses.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.simulation.element_rows import ElementRows

Vector = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


class Fields(NamedTuple):
    """Fields of mjData, by their names there."""

    qpos: Vector
    qvel: Vector
    xmat: Vector
    site_xpos: Vector
    site_xmat: Vector
    subtree_com: Vector
    cdof: Vector
    efc_J: Vector
    efc_pos: Vector
    efc_vel: Vector
    efc_aref: Vector
    efc_D: Vector
    efc_R: Vector
    efc_frictionloss: Vector
    efc_KBIP: Vector
    qfrc_applied: Vector


class Indices(NamedTuple):
    """Rows, bodies, sites and joints; as in `Elements`."""

    rows: Integers
    carriers: Integers
    rotation_sites: Integers
    turning: Integers
    """Element, velocity coordinate, and 1 or -1 where it turns the moving part or the carrier; a row each."""
    hard_rows: Integers
    springs: Integers
    spring_sites: Integers
    spring_dofs: Integers
    dampers: Integers
    frictions: Integers
    valves: Integers
    damper_dofs: Integers
    tyres: Integers
    node_rows: Integers
    reach: Integers
    body_turns: Integers
    modal: Integers
    """Body, number of modes, first velocity and first position of the modal coordinates."""


class Constants(NamedTuple):
    """Constants of the laws; as in `ElementRows`."""

    element_preload: Vector
    hard_preload: Vector
    rotation_preload: Vector
    spring_preload: Vector
    stiffness: Vector
    damping: Vector
    rotation_stiffness: Vector
    spring_stiffness: Vector
    spring_lengths: Vector
    decay: Vector
    branch_gain: Vector
    branch_slope: Vector
    branch_average: Vector
    impedance: Vector
    spring_impedance: Vector
    damper_impedance: Vector
    valve_impedance: Vector
    valve_limit: Vector
    inertial: Vector
    viscous: Vector
    smoothing: Vector
    sliding_limit: Vector
    static_limit: Vector
    stribeck_velocity: Vector
    exponent: Vector
    node_shapes: Vector
    mode_shapes: Vector
    """The same, a row for each mode: x of all nodes, y of all nodes, z of all nodes."""
    spring_shapes: Vector
    scalars: Vector
    """Time step, least impedance, and one where the friction limits depend on the velocity."""


class State(NamedTuple):
    """What the callback leaves behind; as in `ElementRows`."""

    plate_velocity: Vector
    plate_acceleration: Vector
    branch_past: Vector
    branch_force: Vector
    last_rate: Vector
    residual: Vector
    rate: Vector
    explicit: Vector
    limits: Vector
    last_time: Vector
    force: Vector
    """Explicit forces of the elements, in world axes."""
    torque: Vector
    """Torques of the rotations, in world axes."""
    ends: Vector
    """Lower and upper end of each main spring, the upper one with its modal displacement."""
    line: Vector
    """Directions of the main springs."""
    deflection: Vector
    """Modal displacement and velocity of the nodes, in body axes."""


def _plane(values: npt.ArrayLike) -> Vector:
    """A contiguous array with two dimensions."""
    array = np.ascontiguousarray(values, dtype=np.float64)
    return array.reshape(len(array), -1) if array.size else np.zeros((len(array), 1))


def _whole(values: npt.ArrayLike) -> Integers:
    array = np.ascontiguousarray(values, dtype=np.int64)
    return array.reshape(len(array), -1) if array.size else np.zeros((len(array), 1), dtype=np.int64)


def indices_of(rows: ElementRows) -> Indices:
    """The indices of the element rows."""
    e = rows.elements
    own = ("rows", "carriers", "rotation_sites", "hard_rows", "springs", "spring_sites", "dampers", "frictions")
    values = {name: _whole(getattr(e, name)) for name in (*own, "valves", "damper_dofs", "tyres", "node_rows")}
    values |= {name: _whole(getattr(e, name)) for name in ("spring_dofs", "reach", "body_turns")}
    pairs = np.argwhere(e.rotation_dofs)
    values["turning"] = _whole(np.column_stack([pairs, e.rotation_dofs[tuple(pairs.T)]]))
    columns = e.modal_columns
    modal = _whole([e.body, columns.stop - columns.start, columns.start, rows.modal_positions.start])
    return Indices(**values, modal=modal)


def constants_of(rows: ElementRows, empty: float) -> Constants:
    """The constants of the element rows; `empty` is the least impedance [kg]."""
    values = {}
    for name in Constants._fields:
        if name not in ("scalars", "mode_shapes"):
            values[name] = _plane(getattr(rows, name) if hasattr(rows, name) else getattr(rows.elements, name))
    e = rows.elements
    nodes = e.node_rows.shape[1]
    by_mode = e.node_shapes.reshape(3, nodes, -1).transpose(2, 0, 1) if nodes else np.zeros((0, 0))
    values["mode_shapes"] = _plane(by_mode)
    scalars = _plane([rows.step, empty, float(rows.stribeck)])
    return Constants(**values, scalars=scalars)


def share_state(rows: ElementRows) -> State:
    """Give the element rows arrays of their own that a compiled callback changes in place.

    Args:
        rows: element rows at rest; what reads them goes on as before.

    Returns:
        The same memory, two-dimensional.
    """
    rows.reset()
    values = {}
    for name in State._fields:
        if name not in ("last_time", "force", "torque", "ends", "line", "deflection"):
            array = np.ascontiguousarray(getattr(rows, name), dtype=np.float64)
            setattr(rows, name, array)
            values[name] = array.reshape(1, -1) if array.ndim == 1 else array
    own = {
        "force": rows.elements.rows.shape,
        "torque": (max(len(rows.rotation_preload), 1), 3),
        "ends": (max(2 * len(rows.elements.springs), 1), 3),
        "line": (max(len(rows.elements.springs), 1), 3),
        "deflection": (2, max(rows.elements.node_rows.size, 1)),
    }
    values |= {name: np.zeros(shape) for name, shape in own.items()}
    return State(**values, last_time=np.full((1, 1), rows.last_time))
