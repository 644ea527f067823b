"""Layout of the tables of a batch: one column for each of eight cars, one row for each number."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.recorded_acceleration import AHEAD

ELEMENT = np.float32
"""Number type: single precision."""

LANES = 8
"""Cars in a SIMD vector: 32 bytes, a register of AVX2; tables of more cars would not fit in the L1 cache."""

ALIGNMENT = 32
"""Alignment of the first row of a table [byte]."""

INNER_BLOCK = 64
"""Samples in an inner block, after which outputs are computed: their states fit in the cache of a core."""

TILE = 3
"""Outputs that are computed together: those of three axes."""

PAST = 2 * AHEAD
"""Samples before a block that are needed for the accelerations in the block."""


class TableRows(NamedTuple):
    """First rows of the sections of a table of cars, and their sizes.

    Attributes:
        pairs, reals: numbers of pole pairs and real poles; the table begins with the factors of the pairs.
        real: first row of the factors of the real poles.
        slip: contribution of z' at the end of a step to the damper velocities, dampers by plates.
        gain, ramp: contributions of mean forces and of their slopes, dampers by dampers each.
        law: `pieces` + 1 breakpoints (x, F_c/2, friction over its limit) of each damper.
        pieces: number of segments of the laws.
        limit, full: friction limits; velocities of full friction.
        inputs: forces, slopes, z' and mean z' of a step.
        viscous: damping constants in the poles.
        velocity, earlier: current velocities and those of the last step.
        hold, stuck, stick: current halves of F_c, 1 if the damper was stuck at the end of the last step, 1 if stuck
            during the whole step.
        work: work space for the solution of a step.
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
    work: int


class OutputTiles(NamedTuple):
    """Weights of the outputs of a sample, in tiles, and their use.

    Attributes:
        positions, levels: tiles of the positions of acceleration channels, and of forces and displacements.
        rotations: one tile of rotations for each body.
        loads: number of the levels that are tyre loads, which come first.
        every: samples from one check of rotations and tyre loads to the next.
        always: compute levels at every sample; otherwise only at the checks.
        wanted: row of a sample for each channel, positions first; -1 for channels that are not computed here.
        offset: static value of each channel; (channels, LANES).
        weights: weights of the differences of positions for `acceleration`; (2 AHEAD,).
    """

    positions: Any
    levels: Any
    rotations: Any
    loads: int
    every: int
    always: bool
    wanted: Any
    offset: Any
    weights: Any


def aligned_table(rows: int) -> npt.NDArray[Any]:
    """Return an aligned table (rows, LANES) of zeros; `simd_vector.load` and `store` need the alignment."""
    size = rows * LANES * np.dtype(ELEMENT).itemsize
    buffer = np.zeros(size + ALIGNMENT, dtype=np.uint8)
    start = -buffer.ctypes.data % ALIGNMENT
    return buffer[start : start + size].view(ELEMENT).reshape(rows, LANES)
