"""What a step works on beside the elements: fields of mjData, weights of the step, state of the laws."""

from __future__ import annotations

from typing import NamedTuple

from vehicle.engines.simulation.element_records import Index, Layout, Table, Vector


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
        heading: of the rolling wheels [rad] now and at the time before; (2, w).
        turning: angular velocity of their hubs [rad/s] now, x, y, z, and at the time before; (w, 6).
        slope: what acts on their hubs beside the rows: force along x [N], moment [N m]; (w, 4).
        push: all such forces on the coordinates; (nv,), none where the tyres stand.
        contact: elastic force of the one-sided elements [N], and their r' at the last evaluation [m/s]; (2, k).
        coefficient: what the dampers have in place of D v, F = c v [N s/m]; (w,).
        sensed: velocities at the sensors in the middle of the past step and of the one before it [m/s]; (2 k, 2).
        past: what controlled dampers remember, as of `vehicle.model.laws.semi_active`; (k, ...).
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
    heading: Table
    turning: Table
    slope: Table
    push: Vector
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
