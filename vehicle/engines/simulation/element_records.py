"""The elements of a car as records that compiled code takes: in which rows they are, and the constants of their laws.

Arrays are contiguous, of 64 bits, with the number of dimensions that their types say: `Vector` and `Index` one, `Table`
and `Indices` two, `Tables3` three.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]
Table = npt.NDArray[np.float64]
Tables3 = npt.NDArray[np.float64]
Index = npt.NDArray[np.int64]
Indices = npt.NDArray[np.int64]
Records = npt.NDArray[Any]
Settings = npt.NDArray[Any]


class Bushings(NamedTuple):
    """The n elements with a law along three axes.

    Attributes:
        rows: rows of their translations; (n, 3).
        carriers: body whose axes the law follows; (n,).
        stiffness, damping: K [N/m] and B [N s/m]; (n, 3).
        branch_stiffness, branch_time: Maxwell branch K2 [N/m] and tau [s]; (n, 3).
        further: further numbers of the laws, padded with zeros; (n, those of the longest law).
        averaged: 1 where the stiffness is averaged over three steps; (n,).
        one_sided: positions of the k elements that do not pull along z; (k,).
        oblique: elements whose rows follow directions of their own; (k,).
        directions: these directions in the axes of the carrier, a row each, P row by row; (k, 9).
    """

    rows: Indices
    carriers: Index
    stiffness: Table
    damping: Table
    branch_stiffness: Table
    branch_time: Table
    further: Table
    averaged: Index
    one_sided: Index
    oblique: Index
    directions: Table


class Rotations(NamedTuple):
    """The m elements that resist rotations.

    Attributes:
        sites: of the moving part and of the carrier; (m, 2).
        stiffness: K_rot [N m/rad]; (m,).
        turning: element, velocity coordinate, and 1 or -1 where it turns the moving part or the carrier; a row each.
        nodes: element and side (0 moving, 1 carrier) of the k at nodes whose rotation is known; (k, 2).
        shapes: rotations of these nodes in the modes, about x of all modes, y, z [rad m^-1 kg^-1/2]; (k, 3 modes).
    """

    sites: Indices
    stiffness: Vector
    turning: Indices
    nodes: Indices
    shapes: Table


class Springs(NamedTuple):
    """The s main springs.

    Attributes:
        rows: (s,). stiffness: [N/m]; (s,). lengths: in the design position [m]; (s,).
        sites: lower and upper site; (s, 2).
        shapes: modal shapes at the upper seats, x of all modes, y, z; (s, 3 modes).
        dofs: what moves the ends: spring, end (0 lower, 1 upper), velocity coordinate, its tree; a row each.
    """

    rows: Index
    stiffness: Vector
    lengths: Vector
    sites: Indices
    shapes: Table
    dofs: Indices


class Dampers(NamedTuple):
    """The w dampers.

    Attributes:
        laws: records of `vehicle.model.laws.damper`; (w,).
        rows, frictions: equality and friction rows; (w,).
        dofs, places: velocity and position coordinates; (w,).
        valves: further friction rows, one for each steeper piece of a damper's curve, and which damper that is.
        pieces: their e [N s/m], m [m/s] and limit [N], as of `vehicle.model.laws.curve`; a row each.
    """

    laws: Records
    rows: Index
    frictions: Index
    dofs: Index
    places: Index
    valves: Indices
    pieces: Table


class Controls(NamedTuple):
    """The k controlled dampers among the w.

    Attributes:
        dampers: which they are; (k,).
        laws: records of `vehicle.model.laws.semi_active`; (k,).
        sites: of the sensors, on the wheel and on the body; (k, 2).
        shapes: modal shapes there, x of all modes, y, z; (2 k, 3 modes).
        dofs: what moves them: control, sensor (0 wheel, 1 body), velocity coordinate, its tree; a row each.
    """

    dampers: Index
    laws: Settings
    sites: Indices
    shapes: Table
    dofs: Indices


class Tables(NamedTuple):
    """The t laws over displacement that are curves (`vehicle.model.laws.curve`): F(at + x) - F(at) in place of K x.

    Attributes:
        kinds: 0 an axis of a bushing, 1 a spring, 2 the stop of a damper; (t,).
        elements, axes: which one of its kind, and its axis; (t,).
        at: displacement in the design position [m], with the tangent K there in the record of the element; (t,).
        edges, slopes, offsets: upper edges (the last infinite), slopes and offsets of the pieces; (t, pieces).
    """

    kinds: Index
    elements: Index
    axes: Index
    at: Vector
    edges: Table
    slopes: Table
    offsets: Table


class Modes(NamedTuple):
    """The flexible body and the rows at its g nodes.

    Attributes:
        body: its id. size: number of modes.
        first_velocity, first_position: where the modal coordinates begin.
        turns: velocity coordinates that turn the body; (3,).
        rows: rows that touch a flexible node; (3, g).
        node_shapes: signed shapes of these nodes in body axes [kg^-1/2]; (3, g modes).
        mode_shapes: the same, a row for each mode: x of all nodes, y, z; (modes, 3 g).
    """

    body: int
    size: int
    first_velocity: int
    first_position: int
    turns: Index
    rows: Indices
    node_shapes: Table
    mode_shapes: Table

    @property
    def velocities(self) -> slice:
        """Columns of the modal coordinates."""
        return slice(self.first_velocity, self.first_velocity + self.size)

    @property
    def positions(self) -> slice:
        """Their generalised positions."""
        return slice(self.first_position, self.first_position + self.size)


class ModalSpace(NamedTuple):
    """The n modal coordinates that the callbacks integrate themselves (`vehicle.engines.simulation.modal_space`), or
    none.

    Attributes:
        mass, stiffness, damping, rest: of the modes as a step has them, and where their springs rest; (n,).
        spread: S, modal coordinates by the r that the model holds; (n, r).
    """

    mass: Vector
    stiffness: Vector
    damping: Vector
    rest: Vector
    spread: Table


class Rolling(NamedTuple):
    """The w tyres that roll, and the hold of the course; none where the tyres stand.

    Attributes:
        tyres, plates: positions among the bushings, and among the plates; (w,).
        sites, hubs: points of the hubs at the patches, and the hubs; (w,).
        spins: velocity coordinates about the axles; (w,).
        arms: wheel centre from the patch in the axes of the hub [m]; (w, 3).
        speeds, trails, inertias: V [m/s], trail [m], inertia of what turns about the axle [kg m2]; (w,).
        dofs: what moves the hubs: wheel, velocity coordinate, its tree; a row each.
        course: velocity coordinates of the trimmed body along x, y and in yaw, positions along x and y; (5,) or none.
        rest: these positions at rest; (2,).
        hold: stiffness and damping of the hold along x, y and in yaw, and how far behind the body its y acts; (7,).
    """

    tyres: Index
    plates: Index
    sites: Index
    hubs: Index
    spins: Index
    arms: Table
    speeds: Vector
    trails: Vector
    inertias: Vector
    dofs: Indices
    course: Index
    rest: Vector
    hold: Vector

    def course_rows(self, size: int) -> Table:
        """What the hold resists over the velocity coordinates: x, y and yaw; (3, size)."""
        rows = np.zeros((3, size))
        rows[np.arange(3), self.course[:3]] = 1.0
        rows[1, self.course[2]] = self.hold[6]
        return rows


class Layout(NamedTuple):
    """The elements of a car in its rows.

    Attributes:
        bushings, rotations, springs, dampers, controls, tables, modes, space, rolling: see there.
        joints: rows of the ideal ball joints without a law; (k, 3).
        tyres: positions among the bushings of those on a plate, in the order of the plates; (t,).
        reach: where rows with explicit forces are not zero: first row, number of rows (3 or 1), first column, end.
        row_count, velocity_count: number of constraint rows, and of velocity coordinates.
    """

    bushings: Bushings
    rotations: Rotations
    springs: Springs
    dampers: Dampers
    controls: Controls
    tables: Tables
    modes: Modes
    space: ModalSpace
    rolling: Rolling
    joints: Indices
    tyres: Index
    reach: Indices
    row_count: int
    velocity_count: int
