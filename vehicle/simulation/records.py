"""The records that the row laws work on: elements in their rows, weights of a step, state, fields of mjData.

They are taken by compiled code as they are: contiguous arrays of 64 bits with the number of dimensions that their types
say, `Vector` and `Index` one, `Table` and `Indices` two, `Tables3` three.
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
        laws: records of `vehicle.laws.damper`; (w,).
        rows, frictions: equality and friction rows; (w,).
        dofs, places: velocity and position coordinates; (w,).
        valves: further friction rows, one for each steeper piece of a damper's curve, and which damper that is.
        pieces: their e [N s/m], m [m/s] and limit [N], as of `vehicle.laws.curve`; a row each.
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
        laws: records of `vehicle.laws.semi_active`; (k,).
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
    """The t laws over displacement that are curves (`vehicle.laws.curve`): F(at + x) - F(at) in place of K x.

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
    """The n modal coordinates that the callbacks integrate themselves (`vehicle.simulation.modal_space`), or none.

    Attributes:
        mass, stiffness, damping, rest: of the modes as a step has them, and where their springs rest; (n,).
        spread: S, modal coordinates by the r that the model holds; (n, r).
    """

    mass: Vector
    stiffness: Vector
    damping: Vector
    rest: Vector
    spread: Table


class Layout(NamedTuple):
    """The elements of a car in its rows.

    Attributes:
        bushings, rotations, springs, dampers, controls, tables, modes, space: see there.
        joints: rows of the ideal ball joints without a law; (k, 3).
        tyres: positions among the bushings of those on a plate, in the order of the plates; (t,).
        reach: where rows with explicit forces are not zero: first row, number of rows (3 or 1), first column, end.
        row_count: number of constraint rows.
    """

    bushings: Bushings
    rotations: Rotations
    springs: Springs
    dampers: Dampers
    controls: Controls
    tables: Tables
    modes: Modes
    space: ModalSpace
    joints: Indices
    tyres: Index
    reach: Indices
    row_count: int


class Fields(NamedTuple):
    """Fields of mjData at fixed places, by their names there."""

    qpos: Vector
    qvel: Vector
    xmat: Table
    site_xpos: Table
    site_xmat: Table
    subtree_com: Table
    cdof: Table
    qfrc_applied: Vector
    actuator_velocity: Vector


class Efc(NamedTuple):
    """Fields of mjData over the constraint rows, which each step may put elsewhere; `efc_` and these names there."""

    J: Table
    KBIP: Table
    pos: Vector
    vel: Vector
    aref: Vector
    D: Vector
    R: Vector
    frictionloss: Vector


class Weights(NamedTuple):
    """What the rows hold for one time step; arrays over the elements as in `Layout`.

    `preload` holds the static force of every row in element axes [N], and behind them the static torques of the
    rotations in the axes of their carriers [N m]; (rows + 3 m,). `decay`, `gain`, `slope` and `average` are those of
    the Maxwell branches, (n, 3); `inertial` is the averaged stiffness of the tyres beta K h2, (t, 3).
    """

    timestep: float
    preload: Vector
    decay: Table
    gain: Table
    slope: Table
    average: Table
    impedance: Table
    inertial: Table
    spring_impedance: Vector
    damper_impedance: Vector
    valve_impedance: Vector


class State(NamedTuple):
    """What the laws remember and leave behind; arrays over the elements as in `Layout`.

    Attributes:
        plate_velocity, plate_acceleration: of the plates, given from outside; (t, 3).
        branch_past: part of the branch forces f2 known before the acceleration of the step is; (n, 3).
        branch_force: f2 at the last completed step; (n, 3).
        last_rate: r' there; (n, 3). last_time: when that was, -1 at rest; (1,).
        residual, rate: r [m] and r' [m/s] in element axes; (n, 3).
        explicit: f0 of every row [N]; (rows,).
        force: f0 of the elements in their own axes; (n, 3). torque: of the rotations in world axes; (m, 3).
        frame: of the sides at nodes whose rotation is known, row by row; (k, 9).
        ends, line: lower and upper ends of the main springs with their modal displacement, and their directions.
        stretch: displacement of the laws that are curves; (t,).
        deflection: modal displacement and velocity of the nodes in body axes; (2, 3 g).
        modal: modal coordinates and their velocities at the last evaluation; (2, modes).
        modal_force, modal_rate, modal_pull: of the coordinates that stand for them: force of their springs, velocity,
            and what the attachments pulled over the last step; (r,), none where the model holds the modes.
        contact: elastic force of the one-sided elements [N], and their r' at the last evaluation [m/s]; (2, k).
        coefficient: what the dampers have in place of D v, F = c v [N s/m]; (w,).
        sensed: velocities at the sensors in the middle of the past step and of the one before it [m/s]; (2 k, 2).
        past: what controlled dampers remember, as of `vehicle.laws.semi_active`; (k, ...).
        steps: number of the present step; (1,).
    """

    plate_velocity: Table
    plate_acceleration: Table
    branch_past: Table
    branch_force: Table
    last_rate: Table
    last_time: Vector
    residual: Table
    rate: Table
    explicit: Vector
    force: Table
    torque: Table
    frame: Table
    ends: Table
    line: Table
    stretch: Vector
    deflection: Table
    modal: Table
    modal_force: Vector
    modal_rate: Vector
    modal_pull: Vector
    contact: Table
    coefficient: Vector
    sensed: Table
    past: Table
    steps: Vector


class Ticket(NamedTuple):
    """How a compiled callback finds and checks its state.

    Attributes:
        model: address of its mjModel.
        rows: number of constraint rows that the records were made for.
        row_count, time: byte offsets of `nefc` and `time` in mjData.
        efc: byte offsets of the pointers of `Efc`, in its order; (8,).
    """

    model: int
    rows: int
    row_count: int
    time: int
    efc: Index


class Simulation(NamedTuple):
    """Everything a compiled callback works on."""

    ticket: Ticket
    fields: Fields
    layout: Layout
    weights: Weights
    state: State
