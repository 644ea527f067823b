"""Layout of the tables of a group: one row for each number, one column for each number of a SIMD vector.

In single precision a row has a number of each of eight cars. In double precision its four numbers belong to four parts
of one car: each part contains a quarter of the poles, and sums over poles are added over the parts.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from vehicle.engines.simulation.recorded_acceleration import AHEAD

SINGLE, DOUBLE = np.dtype(np.float32), np.dtype(np.float64)
"""Number types: eight cars, and one car in four parts."""

VECTOR_BYTES = 32
"""Size and alignment of a row [byte]: a register of AVX2; tables of more cars would not fit in the L1 cache."""

LANES = VECTOR_BYTES // SINGLE.itemsize
"""Cars in a SIMD vector in single precision."""

BLOCK = 8
"""States of a column in a block of `poles.c`; the states and changes of samples end with as many more rows."""

INNER_BLOCK = 64
"""Samples in an inner block, after which outputs are computed: their states fit in the cache of a core."""

TILE = 3
"""Outputs that are computed together: those of three axes."""

PAST = 2 * AHEAD
"""Samples before a block that are needed for the accelerations in the block."""


class TableRows(NamedTuple):
    """First rows of the sections of a table of cars, and their sizes: the record Sections of the core.

    Attributes:
        pairs: number of states of pole pairs in a column, a multiple of BLOCK; states: of all poles.
        iterations: Gauss-Seidel iterations over the forces.
        groups: number of groups of Jenkins elements. elements: number of elements of a group.
        curves: number of laws over displacement. corners: number of breakpoints of a law.
        rubbers: number of the laws that are rubber friction, which come last.
        layers: number of elements of a rubber friction in a column.
        slip: contribution of z' at the end of a step to the damper velocities and to the displacements of groups and
            laws, by plates. level: contribution of z to the latter.
        gain, ramp: contributions of the mean forces of dampers, groups and laws, and of the slopes of damper forces.
        law: `pieces` + 1 breakpoints (x, F_c/2, friction over its limit) of each damper.
        pieces: number of segments of the laws.
        limit, full: friction limits; velocities of full friction.
        inputs: damper forces, their slopes, forces of groups and laws, z' and mean z' of a step, slope forces of
            rolling tyres, and z of the plates of slow poles.
        viscous: damping constants in the poles.
        velocity, earlier: current velocities and those of the last step.
        hold, stuck, stick: current halves of F_c, 1 if the damper was stuck at the end of the last step, 1 if stuck
            during the whole step.
        inverse: effect of its force on the velocity of each damper and its limit, for which the work space has its
            inverse law.
        sensors, past: sensors of `vehicle.engines.reduced.feedback` at the beginning of a step and of the last step.
        direct: contributions of the inputs up to z', and of z, to each sensor.
        spring, give, share: stiffness k of the Jenkins elements, 1/k (0 without), and their shares of the limit.
        slider: forces of the elements at the beginning of the step.
        place: displacements of the groups there.
        rest: side forces at rest.
        corner: `corners` numbers (side, breakpoint, slope change) of each law, over the displacement without its force
            at the end of the step.
        own: halves of the effects of the forces of the laws on their displacements.
        excess: forces g of the laws. heard: contributions of these to each sensor.
        stiff, stroke: stiffness k and stroke x of the elements of rubber friction.
        part, weight, reach: shares, weights and half widths of these over the displacement without their own force, see
            `scalar_elements.h` of the core.
        anchor, middle: positions of their sliders, and the middles over that displacement. ahead: further part of the
            middles in a column, by the elements of the columns before.
        work: work space for the solution of a step.
    """

    pairs: int
    states: int
    iterations: int
    groups: int
    elements: int
    curves: int
    corners: int
    rubbers: int
    layers: int
    slip: int
    level: int
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
    inverse: int
    sensors: int
    past: int
    direct: int
    spring: int
    give: int
    share: int
    slider: int
    place: int
    rest: int
    corner: int
    own: int
    excess: int
    heard: int
    stiff: int
    stroke: int
    part: int
    weight: int
    reach: int
    anchor: int
    middle: int
    ahead: int
    work: int


class OutputTiles(NamedTuple):
    """Weights of the outputs of a sample, in tiles, and their use.

    Its arrays are those of the record March of the core.

    Attributes:
        positions, levels: tiles of the positions of acceleration channels, and of forces and displacements.
        rotations: one tile of rotations for each body.
        loads: number of the levels that are tyre loads, which come first.
        tyre_of: level of the tyre of each law over displacement; -1 for a law that is no tyre.
        watched: number of the levels whose extremes are kept, a multiple of TILE.
        check_every: samples from one check of rotations and tyre loads to the next.
        always: compute levels at every sample; otherwise only at the checks.
        wanted: row of a sample for each channel, positions first; -1 for channels that are not computed here.
        offset: static value of each channel; (channels, columns).
        weights: weights of the differences of positions in an acceleration; (1, 2 AHEAD).
    """

    positions: Any
    levels: Any
    rotations: Any
    loads: int
    tyre_of: Any
    watched: int
    check_every: int
    always: bool
    wanted: Any
    offset: Any
    weights: Any


def aligned_table(rows: int, element: np.dtype[Any]) -> npt.NDArray[Any]:
    """Return an aligned table (rows, columns) of zeros; the core needs the alignment."""
    size = rows * VECTOR_BYTES
    buffer = np.zeros(size + VECTOR_BYTES, dtype=np.uint8)
    start = -buffer.ctypes.data % VECTOR_BYTES
    return buffer[start : start + size].view(element).reshape(rows, VECTOR_BYTES // element.itemsize)
