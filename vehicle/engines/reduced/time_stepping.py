"""Compiled time stepping of the cars in a vector, and their channels, block by block.

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from vehicle.compiler import numba_module, stamp
from vehicle.engines.reduced.feedback import Feedback
from vehicle.engines.reduced.inlining import EXACT, compiled_once, inlined
from vehicle.engines.reduced.sample_outputs import fill_outputs, subtract_excess, update_peaks, write_channels
from vehicle.engines.reduced.simd_vector import broadcast, filled, less, load, load_tuple, store
from vehicle.engines.reduced.table_layout import INNER_BLOCK, PAST, TILE, OutputTiles, TableRows
from vehicle.engines.reduced.time_step import advance
from vehicle.engines.simulation.recorded_acceleration import AHEAD
from vehicle.model.laws.control_laws import PRESENT

numba = numba_module()

_TILE = (0.0,) * TILE
"""Tuple with the length of a tile."""


@inlined
def add_damper_outputs(t: Any, r: TableRows, feedback: Feedback, y: Any, row: int, count: int, side: float) -> None:
    """Add the half of the outputs of a sample that belongs to the step before or after it.

    The force of a step belongs to its middle: the force at a sample is the mean of both adjacent steps. A controlled
    damper has the force (c - cmin) v at the sample in the place of the mean over the step.

    Args:
        t, r, feedback, y: see `step_cars`.
        row: first row of the dampers in the sample: velocities, forces, friction, coefficients.
        count: number of dampers.
        side: 1 for the step that ends at the sample, -1 for the step that begins there.
    """
    half = filled(t, 0.5)
    for i in range(count):
        force = half * load(t, r.inputs + i)
        store(y, row + count + i, load(y, row + count + i) - force)
        store(y, row + 2 * count + i, load(y, row + 2 * count + i) + force)
    for group in range(len(r.groups)):
        i, force = feedback.owners[group], half * load(t, r.inputs + 2 * count + group)
        store(y, row + count + i, load(y, row + count + i) - force)
        store(y, row + 2 * count + i, load(y, row + 2 * count + i) + force)
    for k in range(feedback.dampers.shape[0]):
        i, c = feedback.dampers[k], feedback.memory[k, PRESENT]
        excess, coefficient = c - feedback.laws[k]["softest"], row + 3 * count + k
        difference = filled(t, 0.25 * side * excess) * (load(t, r.velocity + i) - load(t, r.earlier + i))
        store(y, row + count + i, load(y, row + count + i) + difference)
        store(y, coefficient, load(y, coefficient) + filled(t, 0.5 * c))


@inlined
def begin_damper_outputs(t: Any, r: TableRows, feedback: Feedback, y: Any, row: int, count: int) -> None:
    """Set the outputs of the dampers at a sample, without the means of both adjacent steps.

    The solution of a step belongs to a mean force, so the velocity of a stuck damper is that of the middle of the step;
    it is extrapolated to the end.

    Args:
        t, r, feedback, y, row, count: see `add_damper_outputs`.
    """
    zero, half = filled(t, 0.0), filled(t, 0.5)
    for i in range(count):
        speed = load(t, r.velocity + i)
        share = half * load(t, r.stick + i) * less(zero, load(t, r.limit + i))
        store(y, row + i, speed + share * (speed - load(t, r.earlier + i)))
        store(y, row + count + i, load(t, r.viscous + i) * speed)
        store(y, row + 2 * count + i, zero)
    for k in range(feedback.dampers.shape[0]):
        # The pole of the softest setting holds `viscous` = cmin; both halves of the excess follow.
        store(y, row + 3 * count + k, zero)


@compiled_once
def step_cars(
    t: Any,
    r: TableRows,
    laws: Any,
    feedback: Feedback,
    rates: Any,
    plate_z: Any,
    every: int,
    reading: OutputTiles,
    x: Any,
    changes: Any,
    y: Any,
    peaks: Any,
    out: Any,
    first: int,
    cars: Any,
    inputs: Any,
    sums: Any,
    dampers: Any,
) -> None:
    """Advance the cars over a block and write their channels, except for the last AHEAD samples.

    Args:
        t: table of the cars, see `TableRows`; changed in place.
        r: sections of the table.
        laws: records of the dampers if a friction limit depends on the velocity, (dampers, cars); otherwise empty.
        feedback: sensors and what acts by them; changed in place.
        rates: (z' at the beginning, mean z', z at the beginning, V tan(beta) - z') of the steps;
            (steps + 1, 4 plates).
        plate_z: plate displacements at the samples and their differences; (samples, 2 plates).
        every: steps between two samples.
        reading: output tiles.
        x: states of the previous sample and of INNER_BLOCK samples: poles, forces in the order of the inputs, z';
            changed in place.
        changes: zeros, then changes of the poles from the previous sample to each of INNER_BLOCK samples; changed in
            place. Empty if differences of the states are exact enough.
        y: outputs of PAST previous samples and of INNER_BLOCK samples; changed in place.
        peaks: squares of rotations, minimum and maximum of each watched level; changed in place.
        out: channels of all cars; (channels, cars, samples).
        first: index of the first sample.
        cars: indices of the cars in the columns.
        inputs, sums, dampers: tuples with the lengths of the inputs of a step, of the damper velocities and sensors,
            and of the dampers.
    """
    count, plates = len(dampers), rates.shape[1] // 4
    poles = 2 * r.pairs + r.reals
    forces = 2 * count + len(r.groups) + len(r.curves)
    states = poles + forces + plates
    weights = (states + plates) * TILE
    positions = TILE * (reading.positions.shape[0] // weights)
    # Rows of a sample: positions, levels, then of the dampers: velocities, forces, friction, coefficients, then the
    # forces of the laws over displacement.
    speeds = positions + TILE * (reading.levels.shape[0] // weights)
    curves = speeds + 3 * count + feedback.dampers.shape[0]
    width = curves + len(r.curves)
    for i in range(TILE):
        store(t, r.work + i, filled(t, 0.0))
    zero = load_tuple(t, r.work, _TILE)
    done, step = 0, 0
    while done < plate_z.shape[0]:
        size = min(INNER_BLOCK, plate_z.shape[0] - done)
        # A single loop over all steps, so that the step is compiled once.
        for k in range(size * every):
            sample, phase = k // every, k % every
            at = (sample + 1) * states
            before, now = at - states if phase == 0 else at, (sample + 1) * poles
            last = 0 if phase == 0 else now
            advance(t, r, x, changes, before, at, last, now, rates, laws, feedback, step, inputs, sums, dampers)
            step += 1
            row = (PAST + sample) * width + speeds
            if phase == 0:
                add_damper_outputs(t, r, feedback, y, row - width, count, -1.0)
            if phase < every - 1:
                continue
            for i in range(forces):
                store(x, at + poles + i, load(t, r.inputs + i))
            for i in range(plates):
                store(x, at + poles + forces + i, broadcast(rates[step, i]))
            for i in range(len(r.curves)):
                store(y, (PAST + sample) * width + curves + i, load(t, r.excess + i))
            begin_damper_outputs(t, r, feedback, y, row, count)
            add_damper_outputs(t, r, feedback, y, row, count, 1.0)
        first_check = (1 - first - done) % reading.every
        kept = poles if changes.shape[0] > 0 else 0
        fill_outputs(reading.positions, x, changes, states, kept, plate_z, done, True, zero, 0, 1, size, y, width, 0)
        begin, stride = (0, 1) if reading.always else (first_check, reading.every)
        fill_outputs(
            reading.levels, x, x, states, 0, plate_z, done, False, zero, begin, stride, size, y, width, positions
        )
        subtract_excess(reading, r.curves, begin, stride, size, y, width, positions, curves)
        update_peaks(reading, x, states, plate_z, done, zero, first_check, size, y, width, positions, peaks)
        for k in range(states):
            store(x, k, load(x, size * states + k))
        # Channels are complete up to AHEAD samples before the newest; older states are no longer needed.
        newest = first + done - AHEAD
        early, late = max(0, -newest), min(size, out.shape[2] - newest)
        write_channels(reading, y, width, positions, early, late, x[states:], out, newest + early, cars)
        for k in range(PAST * width):
            store(y, k, load(y, size * width + k))
        done += size


@cache
def compiled_stepping() -> Any:
    """Return the compiled form of `step_cars`; numba compiles it for each type of its arguments."""
    mark = stamp()

    # Closure variables are part of the key of numba's cache.
    def entry(*arguments: Any) -> None:
        if mark:
            step_cars(*arguments)

    return numba.njit(cache=True, nogil=True, **EXACT)(entry)
