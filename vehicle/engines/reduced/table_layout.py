"""Layout of the tables of a group: one row for each number, one column for each number of a SIMD vector.

In single precision a row has a number of each of eight cars. In double precision its four numbers belong to four parts
of one car: each part contains a quarter of the poles, and sums over poles are added over the parts.
"""

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
"""Outputs that are computed together: three axes."""

PAST = 2 * AHEAD
"""Samples before a block that are needed for the accelerations in the block."""


class Counts(NamedTuple):
    """Numbers of elements that fix the sections of a table.

    Attributes:
        dampers, plates: dampers; driven plates and histories of applied forces.
        inputs: numbers of a step: damper forces, their slopes, forces of groups and laws, z' and mean z', slope forces
            of rolling tyres, and z of the plates of slow poles.
        sensors, sides: sensors of `vehicle.engines.reduced.feedback`; side forces.
        pieces: segments of a damper law.
        groups, elements: groups of Jenkins elements; elements of a group.
        curves, corners: laws over displacement; breakpoints of a law.
        rubbers, layers: those laws that are rubber friction, which come last; elements of one of them in a column.
    """

    dampers: int
    plates: int
    inputs: int
    sensors: int
    sides: int
    pieces: int
    groups: int
    elements: int
    curves: int
    corners: int
    rubbers: int
    layers: int


def section_sizes(n: Counts) -> dict[str, int]:
    """Return the number of rows of each section of a table, in their order; Sections of the core has the first rows."""
    d, m, scalars = n.dampers, n.plates, n.groups + n.curves
    sliders, rubber = n.groups * n.elements, n.rubbers * n.layers
    # What acts on damper velocities and displacements of groups and laws: z' at the end of a step, by plates, and z on
    # the latter; mean forces of dampers, groups and laws, and slopes of damper forces.
    sizes = {"slip": (d + scalars) * m, "level": scalars * m, "gain": (d + scalars) ** 2, "ramp": (d + scalars) * d}
    # Velocities of full friction; damping constants in the poles.
    sizes |= {"full": d, "viscous": d}
    # Contributions of the inputs up to z', and of z, to each sensor; side forces at rest.
    sizes |= {"direct": n.sensors * (2 * (d + m) + scalars), "rest": n.sides}
    # Jenkins elements: stiffness k, 1/k (0 without), shares of the limit.
    sizes |= dict.fromkeys(("spring", "give", "share"), sliders)
    # Laws: side, breakpoint and slope change of each corner, over the displacement without the force of the law at the
    # end of the step; halves of the effects of the forces on their displacements, and contributions to each sensor.
    sizes |= {"corner": 3 * (n.curves - n.rubbers) * n.corners, "own": n.curves, "heard": n.sensors * n.curves}
    # Rubber friction: stiffness k and stroke x of the elements; shares, weights and half widths over the displacement
    # without their own force, see `scalar_elements.h` of the core.
    sizes |= dict.fromkeys(("stiff", "stroke", "part", "weight", "reach"), rubber)
    # The sections from here on change during a run: the state of a car without its poles.
    # Breakpoints (x, F_c/2, friction over its limit) of each damper; inputs of a step.
    sizes |= {"law": 3 * d * (n.pieces + 1), "inputs": n.inputs}
    # Dampers: friction limits, velocities now and in the last step, halves of F_c, 1 if stuck at the end of the last
    # step, 1 if stuck during the whole step.
    sizes |= dict.fromkeys(("limit", "velocity", "earlier", "hold", "stuck", "stick"), d)
    # Effect of its force on the velocity of each damper, and its limit, for which the work space has its inverse law.
    sizes |= {"inverse": 2 * d}
    # Sensors at the beginning of a step and of the last step; displacements of groups and forces of their elements at
    # the beginning of the step; forces g of the laws.
    sizes |= {"sensors": n.sensors, "past": n.sensors, "place": n.groups, "slider": sliders, "excess": n.curves}
    # Rubber friction: positions of the sliders, and middles over the displacement without their own force; further part
    # of the middles in a column, by the elements of the columns before.
    sizes |= {"anchor": rubber, "middle": rubber, "ahead": n.rubbers}
    # Work space for the solution of a step.
    sums = d + scalars + n.sensors
    return sizes | {"work": d * (2 + 4 * (n.pieces + 1)) + n.groups * (2 + 4 * n.elements) + sums}


def aligned_table(rows: int, element: np.dtype[Any]) -> npt.NDArray[Any]:
    """Return an aligned table (rows, columns) of zeros; the core needs the alignment."""
    size = rows * VECTOR_BYTES
    buffer = np.zeros(size + VECTOR_BYTES, dtype=np.uint8)
    start = -buffer.ctypes.data % VECTOR_BYTES
    return buffer[start : start + size].view(element).reshape(rows, VECTOR_BYTES // element.itemsize)
