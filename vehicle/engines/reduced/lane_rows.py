"""How eight cars lie in a table: one column each, a row for each number, and where the sections begin."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.recorded_acceleration import AHEAD

ELEMENT = np.float32
"""Single precision."""

LANES = 8
"""Cars in a vector: 32 bytes, a register of AVX2; tables of more would not stay in the nearest cache."""

ALIGNMENT = 32
"""Of the first row [byte]."""

INNER = 64
"""Samples between two readings of the states: they stay in the cache of a core."""

TILE = 3
"""Outputs that are read at once: those of three axes."""

PAST = 2 * AHEAD
"""Samples before a block that the accelerations in it need."""


class Rows(NamedTuple):
    """Where the sections of a table of cars begin, and how long they are.

    Attributes:
        pairs, reals: numbers of poles; the table begins with factors of the pairs, those of the real poles come next.
        real: first row of those.
        slip: what z' at the end of a step adds to the damper velocities, dampers by plates.
        gain, ramp: what mean forces and their slopes add, dampers by dampers each.
        law: of each damper, `pieces` + 1 times (x, F_c/2, friction as a share of its limit).
        pieces: of the laws.
        limit, full: friction limits; velocities at which the friction is full.
        inputs: forces, slopes, z' and mean z' of a step.
        viscous: damping constants that the poles hold.
        velocity, earlier: velocities now, and a step ago.
        hold, stuck, stick: halves of F_c now, 1 where the damper stuck at the end of the last step, 1 where in all of
            it.
        room: rows for the solution of a step.
    """

    pairs: int
    reals: int
    real: int
    slip: int
    gain: int
    ramp: int
    law: int
    pieces: int
    limit: int
    full: int
    inputs: int
    viscous: int
    velocity: int
    earlier: int
    hold: int
    stuck: int
    stick: int
    room: int


class Reading(NamedTuple):
    """What is read of the states at a sample.

    Attributes:
        positions, levels: tiles of places, of which accelerations are made, and of forces and displacements.
        turns: a tile of rotations for each body.
        loads: number of the levels that are tyre loads, which come first.
        every: samples from one look at rotations and tyre loads to the next.
        always: whether levels are needed at every sample; else at those looks.
        wanted: row of a sample that each channel is made of, positions first; -1 of one that is not made here.
        rest: what is added to it; (channels, LANES).
        weights: of the differences of positions, for `acceleration`; (2 AHEAD,).
    """

    positions: Any
    levels: Any
    turns: Any
    loads: int
    every: int
    always: bool
    wanted: Any
    rest: Any
    weights: Any


def aligned(rows: int) -> npt.NDArray[Any]:
    """A table (rows, LANES) of zeros as `load` and `store` of `vehicle.engines.reduced.vector` take it."""
    size = rows * LANES * np.dtype(ELEMENT).itemsize
    room = np.zeros(size + ALIGNMENT, dtype=np.uint8)
    start = -room.ctypes.data % ALIGNMENT
    return room[start : start + size].view(ELEMENT).reshape(rows, LANES)
