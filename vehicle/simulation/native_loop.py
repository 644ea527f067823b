"""Many steps in one call: plates in, `mj_step`, and what the recorder reads out, without Python in between."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numba
import numpy as np
import numpy.typing as npt

from vehicle.simulation.native_callback import NativeCallback, stamp
from vehicle.simulation.native_pointer import call_step, floats, integers
from vehicle.simulation.plate_arrays import PlateArrays
from vehicle.simulation.recorder import CHUNK, Recorder

Vector = npt.NDArray[np.float64]


class Plates(NamedTuple):
    """Motion of the plates over the steps (steps, 2), and the places it goes to."""

    height: Vector
    velocity: Vector
    acceleration: Vector
    mocap_position: Vector
    row_velocity: Vector
    row_acceleration: Vector


class Sources(NamedTuple):
    """What is read after a step; views of mjData and of the state of the callback."""

    position: Vector
    velocity: Vector
    acceleration: Vector
    orientation: Vector
    sites: Vector
    actuator: Vector
    explicit: Vector
    rate: Vector
    branch: Vector


class Buffers(NamedTuple):
    """Where it goes: the buffers of the recorder with one row a sample, and poses."""

    places: Vector
    turn: Vector
    modal_position: Vector
    modal_velocity: Vector
    damper_velocity: Vector
    actuator: Vector
    solved: Vector
    explicit: Vector
    rate: Vector
    branch: Vector
    poses: Vector


class Order(NamedTuple):
    """Addresses of `mj_step`, mjModel and mjData, offset of the constraint forces, steps to a sample and to a pose."""

    step: int
    model: int
    data: int
    force_offset: int
    every: int
    pose_every: int
    body: int
    first_mode: int
    first_position: int
    half: float


@functools.cache
def compile_loop(mark: int) -> Any:
    """The compiled loop; `mark` makes the compiler's cache notice a change of the sources."""

    def advance(
        order: Order,
        first: int,
        last: int,
        row: int,
        plates: Plates,
        plate_ids: npt.NDArray[np.int64],
        dampers: npt.NDArray[np.int64],
        sites: npt.NDArray[np.int64],
        s: Sources,
        b: Buffers,
    ) -> int:
        """Take the steps first..last and return the number of poses that were kept."""
        if mark == 0:
            return 0
        posed = 0
        modes, rows = b.modal_velocity.shape[1], b.solved.shape[1]
        for index in range(first, last + 1):
            for plate in range(len(plate_ids)):
                plates.mocap_position[plate_ids[plate], 2] = plates.height[index, plate]
                plates.row_velocity[plate, 2] = plates.velocity[index, plate]
                plates.row_acceleration[plate, 2] = plates.acceleration[index, plate]
            recorded = index % order.every == 0
            if recorded and (index // order.every) % order.pose_every == 0:
                b.poses[posed] = s.position
                posed += 1
            if recorded:
                for mode in range(modes):
                    b.modal_position[row, mode] = s.position[order.first_position + mode]
            call_step(order.step, order.model, order.data)
            if not recorded:
                continue
            for place in range(len(sites)):
                for axis in range(3):
                    b.places[row, 3 * place + axis] = s.sites[sites[place], axis]
            b.turn[row] = s.orientation[order.body]
            for mode in range(modes):
                dof = order.first_mode + mode
                b.modal_velocity[row, mode] = s.velocity[dof] + order.half * s.acceleration[dof]
            for damper in range(len(dampers)):
                dof = dampers[damper]
                b.damper_velocity[row, damper] = s.velocity[dof] + order.half * s.acceleration[dof]
            b.actuator[row] = s.actuator
            # The constraint forces live in the arena, where each step may put them elsewhere.
            b.solved[row] = floats(integers(order.data + order.force_offset, 1, 1)[0, 0], 1, rows)[0]
            b.explicit[row] = s.explicit
            b.rate[row] = s.rate
            b.branch[row] = s.branch
            row += 1
        return posed

    options = {"cache": True, "fastmath": False, "boundscheck": False, "error_model": "numpy", "nogil": True}
    return numba.njit(**options)(advance)


class NativeLoop:
    """The compiled loop of one run.

    Args:
        callback: its compiled callbacks.
        recorder: collects the samples.
        motion: motion of the plates.
        heights: heights of the plates (steps, 2) [m].
        plates: their mocap indices.
    """

    def __init__(
        self,
        callback: NativeCallback,
        recorder: Recorder,
        motion: PlateArrays,
        heights: Vector,
        plates: list[int],
    ) -> None:
        data, model, rows, state = recorder.data, recorder.model, recorder.rows, callback.state
        self.recorder = recorder
        self.plate_ids = np.array(plates, dtype=np.int64)
        self.dampers = np.array(recorder.dampers, dtype=np.int64)
        self.sites = np.array(recorder.sites, dtype=np.int64)
        self.plates = Plates(
            height=np.ascontiguousarray(heights),
            velocity=np.ascontiguousarray(motion.row_velocity),
            acceleration=np.ascontiguousarray(motion.acceleration),
            mocap_position=data.mocap_pos,
            row_velocity=state.plate_velocity,
            row_acceleration=state.plate_acceleration,
        )
        self.sources = Sources(
            position=data.qpos,
            velocity=data.qvel,
            acceleration=data.qacc,
            orientation=data.xmat,
            sites=data.site_xpos,
            actuator=data.actuator_force,
            explicit=state.explicit.reshape(-1),
            rate=state.rate.reshape(-1),
            branch=state.branch_past.reshape(-1),
        )
        poses = np.zeros((CHUNK, model.nq))
        self.buffers = Buffers(
            **{name: array.reshape(CHUNK, -1) for name, array in recorder.buffers.items()}, poses=poses
        )
        self.order = Order(
            step=callback.step_address,
            model=model._address,
            data=data._address,
            force_offset=callback.offsets["efc_force"],
            every=recorder.every,
            pose_every=recorder.pose_every,
            body=rows.elements.body,
            first_mode=recorder.modes.start,
            first_position=rows.modal_positions.start,
            half=-0.5 * recorder.step,
        )
        self.run = compile_loop(stamp())
        # No step at all: compiling is no part of the time of the run.
        self._advance(1, 0)

    def advance(self, first: int, last: int) -> None:
        """Take the steps first..last, the last of them a recorded one, and keep their samples in the recorder."""
        recorder, order = self.recorder, self.order
        samples = np.arange(recorder.done + recorder.filled, last // order.every + 1)
        posed = self._advance(first, last)
        recorder.keep(len(samples), self.buffers.poses[:posed], samples[samples % order.pose_every == 0])

    def _advance(self, first: int, last: int) -> int:
        row, ids = self.recorder.filled, self.plate_ids
        places = (self.plates, ids, self.dampers, self.sites)
        return int(self.run(self.order, first, last, row, *places, self.sources, self.buffers))
