"""The march of eight cars at once: `vehicle.engines.reduced.march` for every lane, and its channels, block by block.

This module imports numba at its head: it is loaded only by a run that compiles.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from vehicle.compiler import numba_module, stamp
from vehicle.engines.reduced.lane_reading import channels, fill, watch
from vehicle.engines.reduced.lane_rows import ELEMENT, INNER, PAST, TILE, Reading, Rows
from vehicle.engines.reduced.lane_step import EXACT, advance, section
from vehicle.engines.reduced.vector import alike, load, loads, store
from vehicle.engines.simulation.recorded_acceleration import AHEAD

numba = numba_module()

_TILE = (0.0,) * TILE
"""As long as a tile."""


@section
def march(
    t: Any,
    r: Rows,
    laws: Any,
    rates: Any,
    heights: Any,
    every: int,
    reading: Reading,
    x: Any,
    y: Any,
    peaks: Any,
    out: Any,
    first: int,
    cars: Any,
    inputs: Any,
    dampers: Any,
) -> None:
    """March over a block and fill its channels, up to AHEAD samples behind.

    Args:
        t: table of the cars, as of `Rows`; changed in place.
        r: its sections.
        laws: records of the dampers where a limit varies with the velocity, (dampers, LANES); else none.
        rates: (z' at the beginning, mean z') of the steps; (steps + 1, 2 plates).
        heights: z of the plates at the samples and their differences; (samples, 2 plates).
        every: steps between two samples.
        reading: what is read.
        x: states of the sample before and of INNER samples: poles, mean forces, their slopes, z'; changed in place.
        y: outputs of PAST samples before, and room for INNER; changed in place.
        peaks: of the run: squares of rotations, lowest and highest of each level; changed in place.
        out: channels of all cars; (channels, cars, samples).
        first: number of the first sample.
        cars: which of them are in the lanes.
        inputs, dampers: tuples as long as the inputs of a step and the dampers.
    """
    count, plates = len(dampers), rates.shape[1] // 2
    poles = 2 * r.pairs + r.reals
    states = poles + 2 * count + plates
    weights = (states + plates) * TILE
    positions = TILE * (reading.positions.shape[0] // weights)
    # Of a sample: positions, levels, damper velocities, damper forces.
    speeds = positions + TILE * (reading.levels.shape[0] // weights)
    width = speeds + 2 * count
    half, none = alike(ELEMENT(0.5)), alike(ELEMENT(0.0))
    for i in range(TILE):
        store(t, r.room + i, none)
    zero = loads(t, r.room, _TILE)
    done, step = 0, 0
    while done < heights.shape[0]:
        size = min(INNER, heights.shape[0] - done)
        # One loop over all steps, so that the compiler holds a step once.
        for k in range(size * every):
            sample, phase = k // every, k % every
            at = (sample + 1) * states
            advance(t, r, x, at - states if phase == 0 else at, at, rates, laws, step, inputs, dampers)
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
                store(x, at + poles + 2 * count + i, alike(rates[step, i]))
            for i in range(count):
                # The force of a step belongs to its middle: at a sample it is the mean of the steps on both sides.
                speed = load(t, r.velocity + i)
                store(y, row + i, speed)
                store(y, row + count + i, load(t, r.viscous + i) * speed - half * load(t, r.inputs + i))
        look = (1 - first - done) % reading.every
        fill(reading.positions, x, states, heights, done, True, zero, 0, 1, size, y, width, 0)
        begin, stride = (0, 1) if reading.always else (look, reading.every)
        fill(reading.levels, x, states, heights, done, False, zero, begin, stride, size, y, width, positions)
        watch(reading, x, states, heights, done, zero, look, size, y, width, positions, peaks)
        for k in range(states):
            store(x, k, load(x, size * states + k))
        # What is AHEAD samples behind the newest is complete; the states before it are needed no more.
        newest = first + done - AHEAD
        early, late = max(0, -newest), min(size, out.shape[2] - newest)
        channels(reading, y, width, positions, early, late, x[states:], out, newest + early, cars)
        for k in range(PAST * width):
            store(y, k, load(y, size * width + k))
        done += size


@cache
def compiled_lanes() -> Any:
    """The compiled march."""
    mark = stamp()

    # What it closes over is part of the key of the compiler's cache.
    def entry(*arguments: Any) -> None:
        if mark:
            march(*arguments)

    return numba.njit(cache=True, nogil=True, **EXACT)(entry)
