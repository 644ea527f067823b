"""Plate motion before `mj_step` and sampling after it, for compiled code."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle.compiler import jitable
from vehicle.engines.simulation.element_records import Index, Indices, ModalSpace, Table, Tables3, Vector, copy_row
from vehicle.engines.simulation.modal_space import modal_acceleration


class Plates(NamedTuple):
    """Motion of the plates over the steps (steps, t), and its destination arrays."""

    height: Table
    velocity: Table
    acceleration: Table
    slope: Table
    mocap: Index
    mocap_position: Table
    row_velocity: Table
    row_acceleration: Table
    row_slope: Vector


class Sources(NamedTuple):
    """Arrays that a sample is copied from: views of mjData and of the state of the rows, and indices into them.

    Attributes:
        sites: ids of the sites of the measurement points; (p,).
        dampers: velocity coordinates of the dampers; (w,).
        spring_rates: velocity coordinates of the joints with a spring and of fluids, for the energy; (j,).
        load_bodies: ids of the bodies whose frames the loads need; none in a run without loads; (b,).
        load_springs: position and velocity coordinates of the dampers if one has a stop, then, in a run with loads, of
            the joints with a spring; (j, 2).
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
    spring_rates: Index
    load_bodies: Index
    load_springs: Indices
    contact: Table
    rubber: Table
    heading: Table
    push: Vector
    space: ModalSpace


class Samples(NamedTuple):
    """Buffers with a row for each sample; only load channels use `load_frames`, they and stops `load_springs`.

    `poses` has a row for each stored pose; `modal_pull` is a working array.
    """

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
    spring_rates: Table
    load_frames: Table
    load_springs: Table
    contact: Table
    rubber: Table
    heading: Table
    pushed: Vector


def empty_samples(count: int, s: Sources) -> Samples:
    """Return buffers for a number of samples from these sources, filled with zeros."""
    widths: dict[str, tuple[int, ...]] = {
        "places": (3 * len(s.sites),),
        "turn": s.orientation.shape[1:],
        "modal_position": s.modal.shape[1:],
        "modal_velocity": s.modal.shape[1:],
        "damper_velocity": s.dampers.shape,
        "coefficient": s.coefficient.shape,
        "actuator": s.actuator.shape,
        "solved": s.explicit.shape,
        "explicit": s.explicit.shape,
        "rate": s.rate.shape,
        "branch": s.branch.shape,
        "poses": s.position.shape,
        "spring_rates": s.spring_rates.shape,
        "load_frames": (12 * len(s.load_bodies),),
        "load_springs": (2 * len(s.load_springs),),
        "contact": s.contact.shape[1:],
        "rubber": s.rubber.shape[1:],
        "heading": s.heading.shape[1:],
        "pushed": (),
    }
    buffers = {name: np.zeros((count, *width)) for name, width in widths.items()}
    return Samples(modal_pull=np.zeros_like(s.modal_force), **buffers)


class Order(NamedTuple):
    """Constants of the loop.

    Attributes:
        step, model, data: addresses of `mj_step`, mjModel and mjData.
        force_offset: byte offset of the constraint forces in mjData.
        every, pose_every: steps between two samples, samples between two poses.
        body, first_velocity: id of the flexible body, first velocity coordinate of its modes.
        half: minus half a time step [s].
    """

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
    """Records of the compiled loop."""

    order: Order
    plates: Plates
    sources: Sources
    samples: Samples


@jitable
def move_plates(index: int, p: Plates) -> None:
    """Set the plate heights of a step, and the plate motion of the tyre rows."""
    for plate in range(p.mocap.shape[0]):
        p.mocap_position[p.mocap[plate], 2] = p.height[index, plate]
        p.row_velocity[plate, 2] = p.velocity[index, plate]
        p.row_acceleration[plate, 2] = p.acceleration[index, plate]
        p.row_slope[plate] = p.slope[index, plate]


@jitable
def keep_modes(row: int, order: Order, s: Sources, b: Samples) -> None:
    """Store the modal coordinates of the last evaluation, and their velocities half a step later."""
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
    """Store forces, rates and positions of the present time.

    MuJoCo's velocity is that of the middle of a step; `half` times the acceleration extrapolates to the present. After
    a step, with `half` negative, the positions of the joints are those of its end.
    """
    for point in range(s.sites.shape[0]):
        for axis in range(3):
            b.places[row, 3 * point + axis] = s.site_positions[s.sites[point], axis]
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
    copy_row(b.rubber[row], s.rubber[0])
    copy_row(b.heading[row], s.heading[0])
    b.pushed[row] = 0.0
    for dof in range(s.push.shape[0]):
        b.pushed[row] += s.push[dof] * (s.velocity[dof] + half * s.acceleration[dof])
    for spring in range(s.spring_rates.shape[0]):
        dof = s.spring_rates[spring]
        b.spring_rates[row, spring] = s.velocity[dof] + half * s.acceleration[dof]
    for body in range(s.load_bodies.shape[0]):
        for axis in range(3):
            b.load_frames[row, 12 * body + axis] = s.origins[s.load_bodies[body], axis]
        for entry in range(9):
            b.load_frames[row, 12 * body + 3 + entry] = s.orientation[s.load_bodies[body], entry]
    for spring in range(s.load_springs.shape[0]):
        point, dof = s.load_springs[spring, 0], s.load_springs[spring, 1]
        b.load_springs[row, 2 * spring] = s.position[point] + min(2.0 * half, 0.0) * s.velocity[dof]
        b.load_springs[row, 2 * spring + 1] = s.velocity[dof] + half * s.acceleration[dof]
