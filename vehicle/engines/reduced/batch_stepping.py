"""Compiled time stepping of eight cars at once, and their channels, block by block; see `pole_stepping` for one car.

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from vehicle.compiler import numba_module, stamp
from vehicle.engines.reduced.batch_layout import ELEMENT, INNER_BLOCK, PAST, TILE, OutputTiles, TableRows
from vehicle.engines.reduced.batch_outputs import fill_outputs, update_peaks, write_channels
from vehicle.engines.reduced.batch_step import EXACT, advance_batch, compiled_once
from vehicle.engines.reduced.simd_vector import broadcast, load, load_tuple, store
from vehicle.engines.simulation.recorded_acceleration import AHEAD

numba = numba_module()

_TILE = (0.0,) * TILE
"""Tuple with the length of a tile."""


@compiled_once
def step_batch(
    t: Any,
    r: TableRows,
    laws: Any,
    rates: Any,
    plate_z: Any,
    every: int,
    reading: OutputTiles,
    x: Any,
    y: Any,
    peaks: Any,
    out: Any,
    first: int,
    cars: Any,
    inputs: Any,
    dampers: Any,
) -> None:
    """Advance eight cars over a block and write their channels, except for the last AHEAD samples.

    Args:
        t: table of the cars, see `TableRows`; changed in place.
        r: sections of the table.
        laws: records of the dampers if a friction limit depends on the velocity, (dampers, LANES); otherwise empty.
        rates: (z' at the beginning, mean z') of the steps; (steps + 1, 2 plates).
        plate_z: plate displacements at the samples and their differences; (samples, 2 plates).
        every: steps between two samples.
        reading: output tiles.
        x: states of the previous sample and of INNER_BLOCK samples: poles, mean forces, their slopes, z'; changed in
            place.
        y: outputs of PAST previous samples and of INNER_BLOCK samples; changed in place.
        peaks: squares of rotations, minimum and maximum of each level; changed in place.
        out: channels of all cars; (channels, cars, samples).
        first: index of the first sample.
        cars: indices of the cars in the lanes.
        inputs, dampers: tuples with the lengths of the inputs of a step and of the dampers.
    """
    count, plates = len(dampers), rates.shape[1] // 2
    poles = 2 * r.pairs + r.reals
    states = poles + 2 * count + plates
    weights = (states + plates) * TILE
    positions = TILE * (reading.positions.shape[0] // weights)
    # Rows of a sample: positions, levels, damper velocities, damper forces.
    speeds = positions + TILE * (reading.levels.shape[0] // weights)
    width = speeds + 2 * count
    half, zero_vector = broadcast(ELEMENT(0.5)), broadcast(ELEMENT(0.0))
    for i in range(TILE):
        store(t, r.work + i, zero_vector)
    zero = load_tuple(t, r.work, _TILE)
    done, step = 0, 0
    while done < plate_z.shape[0]:
        size = min(INNER_BLOCK, plate_z.shape[0] - done)
        # A single loop over all steps, so that the step is compiled once.
        for k in range(size * every):
            sample, phase = k // every, k % every
            at = (sample + 1) * states
            advance_batch(t, r, x, at - states if phase == 0 else at, at, rates, laws, step, inputs, dampers)
            step += 1
            row = (PAST + sample) * width + speeds
            if phase == 0:
                for i in range(count):
                    force = row - width + count + i
                    store(y, force, load(y, force) - half * load(t, r.inputs + i))
            if phase < every - 1:
                continue
            for i in range(2 * count):
                store(x, at + poles + i, load(t, r.inputs + i))
            for i in range(plates):
                store(x, at + poles + 2 * count + i, broadcast(rates[step, i]))
            for i in range(count):
                # The force of a step belongs to its middle: the force at a sample is the mean of both adjacent steps.
                speed = load(t, r.velocity + i)
                store(y, row + i, speed)
                store(y, row + count + i, load(t, r.viscous + i) * speed - half * load(t, r.inputs + i))
        first_check = (1 - first - done) % reading.every
        fill_outputs(reading.positions, x, states, plate_z, done, True, zero, 0, 1, size, y, width, 0)
        begin, stride = (0, 1) if reading.always else (first_check, reading.every)
        fill_outputs(reading.levels, x, states, plate_z, done, False, zero, begin, stride, size, y, width, positions)
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
def compiled_batch_stepping() -> Any:
    """Return the compiled form of `step_batch`."""
    mark = stamp()

    # Closure variables are part of the key of numba's cache.
    def entry(*arguments: Any) -> None:
        if mark:
            step_batch(*arguments)

    return numba.njit(cache=True, nogil=True, **EXACT)(entry)
