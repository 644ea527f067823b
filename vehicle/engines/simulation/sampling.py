"""Records of the stepping loop (`vehicle/core/source/stepping.h`): plate motion before a step, samples after it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vehicle.engines.simulation.element_records import Index, Indices, ModalSpace, Table, Tables3, Vector


class Plates(NamedTuple):
    """Motion of the plates over the steps (steps, t), applied forces (steps, f), and their destination arrays.

    `tread` and `tread_change` are (steps, 0) if no rolling radius varies.
    """

    height: Table
    velocity: Table
    acceleration: Table
    slope: Table
    tread: Table
    tread_change: Table
    mocap: Index
    mocap_position: Table
    row_velocity: Table
    row_acceleration: Table
    row_slope: Vector
    force: Table
    applied: Vector


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
    """Records of the loop."""

    order: Order
    plates: Plates
    sources: Sources
    samples: Samples
