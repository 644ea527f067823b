"""One step of a run around `mj_step`: the plates in, the sample out. The loop does this compiled or as it stands."""

from __future__ import annotations

from typing import NamedTuple

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Index, Indices, ModalSpace, Table, Tables3, Vector
from vehicle.engines.simulation.modal_space import modal_acceleration


class Plates(NamedTuple):
    """Motion of the plates over the steps (steps, t), and the places it goes to."""

    height: Table
    velocity: Table
    acceleration: Table
    mocap: Index
    mocap_position: Table
    row_velocity: Table
    row_acceleration: Table


class Sources(NamedTuple):
    """What is read after a step: views of mjData and of the state of the rows, and which sites and dampers.

    `bodies` are those whose frames the loads need, none in a run without loads, `springs` places and velocity
    coordinates of joints with a spring.
    """

    position: Vector
    velocity: Vector
    acceleration: Vector
    orientation: Table
    site_positions: Table
    coefficient: Vector
    actuator: Vector
    explicit: Vector
    rate: Table
    branch: Table
    modal: Table
    modal_force: Vector
    sites: Index
    dampers: Index
    origins: Table
    bodies: Index
    springs: Indices
    contact: Table
    heading: Table
    push: Vector
    space: ModalSpace


class Samples(NamedTuple):
    """Where it goes: buffers with one row a sample, and poses."""

    places: Table
    turn: Table
    modal_position: Table
    modal_velocity: Table
    modal_pull: Vector
    damper_velocity: Table
    coefficient: Table
    actuator: Table
    solved: Table
    explicit: Table
    rate: Tables3
    branch: Tables3
    poses: Table
    frames: Table
    springs: Table
    contact: Table
    heading: Table
    pushed: Vector


class Order(NamedTuple):
    """Addresses of `mj_step`, mjModel and mjData, offset of the constraint forces, steps to a sample, samples to a
    pose, the flexible body and the first velocity of its modes, half a step back [s]."""

    step: int
    model: int
    data: int
    force_offset: int
    every: int
    pose_every: int
    body: int
    first_velocity: int
    half: float


class Loop(NamedTuple):
    """Everything that the compiled loop works on."""

    order: Order
    plates: Plates
    sources: Sources
    samples: Samples


@jitable
def copy_row(row: Vector, values: Vector) -> None:
    """Copy numbers one by one: an assignment of arrays compiles its error messages, which takes as long as all else."""
    for entry in range(values.shape[0]):
        row[entry] = values[entry]


@jitable
def move_plates(index: int, p: Plates) -> None:
    """Put the plates where they are at a step, and tell the tyre rows."""
    for plate in range(p.mocap.shape[0]):
        p.mocap_position[p.mocap[plate], 2] = p.height[index, plate]
        p.row_velocity[plate, 2] = p.velocity[index, plate]
        p.row_acceleration[plate, 2] = p.acceleration[index, plate]


@jitable
def keep_modes(row: int, order: Order, s: Sources, b: Samples) -> None:
    """Copy the modal coordinates of the last evaluation, and their velocities half a step later."""
    q, v, pull, first = s.modal[0], s.modal[1], b.modal_pull, order.first_velocity
    for j in range(pull.shape[0]):
        pull[j] = s.acceleration[first + j] - s.modal_force[j]
    for mode in range(q.shape[0]):
        b.modal_position[row, mode] = q[mode]
        if pull.shape[0] == 0:
            faster = s.acceleration[first + mode]
        else:
            faster = modal_acceleration(mode, q, v, pull, s.space)
        b.modal_velocity[row, mode] = v[mode] - order.half * faster


@jitable
def keep_sample(row: int, half: float, order: Order, s: Sources, solved: Vector, b: Samples) -> None:
    """Copy the present time's forces, rates and positions.

    MuJoCo's velocity is that of the middle of a step: `half` a step of acceleration carries it to the present.
    """
    for place in range(s.sites.shape[0]):
        for axis in range(3):
            b.places[row, 3 * place + axis] = s.site_positions[s.sites[place], axis]
    copy_row(b.turn[row], s.orientation[order.body])
    keep_modes(row, order, s, b)
    for damper in range(s.dampers.shape[0]):
        dof = s.dampers[damper]
        b.damper_velocity[row, damper] = s.velocity[dof] + half * s.acceleration[dof]
    copy_row(b.coefficient[row], s.coefficient)
    copy_row(b.actuator[row], s.actuator)
    copy_row(b.solved[row], solved)
    copy_row(b.explicit[row], s.explicit)
    for element in range(s.rate.shape[0]):
        copy_row(b.rate[row, element], s.rate[element])
        copy_row(b.branch[row, element], s.branch[element])
    copy_row(b.contact[row], s.contact[0])
    copy_row(b.heading[row], s.heading[0])
    b.pushed[row] = 0.0
    for dof in range(s.push.shape[0]):
        b.pushed[row] += s.push[dof] * (s.velocity[dof] + half * s.acceleration[dof])
    for body in range(s.bodies.shape[0]):
        for axis in range(3):
            b.frames[row, 12 * body + axis] = s.origins[s.bodies[body], axis]
        for entry in range(9):
            b.frames[row, 12 * body + 3 + entry] = s.orientation[s.bodies[body], entry]
    for spring in range(s.springs.shape[0]):
        place, dof = s.springs[spring, 0], s.springs[spring, 1]
        b.springs[row, 2 * spring] = s.position[place]
        b.springs[row, 2 * spring + 1] = s.velocity[dof] + half * s.acceleration[dof]
