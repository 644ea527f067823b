"""The march of eight cars at once: `vehicle.reduced.march` for every lane, and its channels, block by block.

A pole is marched as its difference y from the place where the plates would hold it at rest, xi = y - (b_z/s) z:

    y' = s y + (b_c + b_z/s) z' + e f.

Small numbers alone are left of a car that rides over hills, so that single precision loses nothing. z' is a quadratic
over a step, from its ends and its mean. A damper force is f_n in the mean over step n, and where the damper stuck in
that step and in the last it is a line of the slope (f_n - f_(n-1))/h: of third order in the step. Sliding, it is
constant but for the curve of the damper, which acts in the mean of both ends. Forces answer the velocities at the end
of the step, by turns, each by the inverse of its own law (`vehicle.reduced.lane_tables`).

This module imports numba at its head: it is loaded only by a run that compiles.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from vehicle.compiler import OPTIONS, numba_module, stamp
from vehicle.laws.damper import friction_limit
from vehicle.reduced.lane_rows import ELEMENT, INNER, LANES, PAST, TILE, Reading, Rows
from vehicle.reduced.validity import LOOK_EVERY
from vehicle.reduced.vector import alike, below, combined, larger, load, loads, smaller, spread, store
from vehicle.simulation.acceleration import AHEAD

numba = numba_module()

# Sums in the order of the source: a lane must not depend on how many poles its neighbours have.
EXACT = OPTIONS | {"fastmath": {"contract"}}


def part(function: Callable[..., Any]) -> Any:
    """A function of the march: only the march calls it, and it counts no references."""
    return numba.njit(no_cpython_wrapper=True, _nrt=False, **EXACT)(function)


TURNS = 2
"""Turns among the dampers: the error is the third power of their coupling, which is `LOOSEST` at most."""

_TILE = (0.0, 0.0, 0.0, 0.0)
"""As long as a tile."""


@part
def solve(t: Any, r: Rows, dampers: Any) -> None:
    """Damper velocities and forces of a step, from the velocities without its forces in the first rows of the room."""
    count = len(dampers)
    step, old = r.room + count, r.inputs
    nodes = r.pieces + 1
    width = 3 * nodes
    kept = step + count  # forces of the last step
    work = kept + count  # of each damper: nodes of the inverse law: arriving velocity, 1/length, force, rise of force
    for i in range(count):
        force = load(t, old + i)
        store(t, kept + i, force)
        stick = load(t, r.stick + i)
        own = load(t, r.gain + i * count + i) + stick * load(t, r.ramp + i * count + i)
        store(t, step + i, own)
        arriving = load(t, r.room + i) - own * load(t, r.hold + i)
        limit = load(t, r.limit + i)
        at, law = work + 4 * nodes * i, r.law + width * i
        for j in range(nodes):
            here = load(t, law + 3 * j + 1) + load(t, law + 3 * j + 2) * limit
            store(t, at + 4 * j, load(t, law + 3 * j) + own * here)
            store(t, at + 4 * j + 2, here)
        for j in range(r.pieces):
            store(t, at + 4 * j + 1, alike(ELEMENT(1.0)) / (load(t, at + 4 * j + 4) - load(t, at + 4 * j)))
            store(t, at + 4 * j + 3, load(t, at + 4 * j + 6) - load(t, at + 4 * j + 2))
        for j in range(count):
            arriving = arriving - load(t, r.stick + j) * load(t, r.ramp + i * count + j) * load(t, old + j)
        store(t, r.room + i, arriving)
    zero, one = alike(ELEMENT(0.0)), alike(ELEMENT(1.0))
    for turn in range(TURNS):
        for i in range(count):
            arriving = load(t, r.room + i)
            for j in range(count):
                if j != i:
                    row = i * count + j
                    other = load(t, r.gain + row) + load(t, r.stick + j) * load(t, r.ramp + row)
                    arriving = arriving + other * load(t, old + j)
            at, law = work + 4 * nodes * i, r.law + width * i
            force, hold = load(t, at + 2), load(t, law + 1)
            for j in range(r.pieces):
                share = (arriving - load(t, at + 4 * j)) * load(t, at + 4 * j + 1)
                share = smaller(larger(share, zero), one)
                force = force + load(t, at + 4 * j + 3) * share
                hold = hold + (load(t, law + 3 * j + 4) - load(t, law + 3 * j + 1)) * share
            store(t, r.velocity + i, arriving - load(t, step + i) * force)
            store(t, old + i, zero - force - load(t, r.hold + i))
            if turn == TURNS - 1:
                store(t, step + i, hold)
    for i in range(count):
        stick = load(t, r.stick + i)
        store(t, old + count + i, stick * (load(t, old + i) - load(t, kept + i)))
        store(t, r.hold + i, load(t, step + i))
        speed = load(t, r.velocity + i)
        stuck = below(larger(speed, zero - speed), load(t, r.full + i))
        store(t, r.stick + i, stuck * load(t, r.stuck + i))
        store(t, r.stuck + i, stuck)


@part
def read(tiles: Any, tile: int, states: int, x: Any, at: int, before: int, heights: Any, sample: int, sums: Any) -> Any:
    """A tile of outputs: of a sample, or with `before` of its difference from another.

    Args:
        tiles: weights, (tiles (states + plates) TILE, LANES).
        tile: which.
        states: number of states.
        x: states of samples.
        at, before: first rows of the samples; none where `before` is negative.
        heights: of the plates and their differences; (samples, 2 plates).
        sample: row of the heights.
        sums: zeros.
    """
    plates = heights.shape[1] // 2
    row, column = tile * (states + plates) * TILE, 0 if before < 0 else plates
    # Two sums by turns: one would wait for itself. Pairs have two numbers, and real poles are even in number, so
    # that each state belongs to the same sum however many poles there are.
    more, even = sums, states - states % 2
    if before < 0:
        for k in range(0, even, 2):
            sums = spread(tiles, row + k * TILE, load(x, at + k), sums)
            more = spread(tiles, row + (k + 1) * TILE, load(x, at + k + 1), more)
        for k in range(even, states):
            sums = spread(tiles, row + k * TILE, load(x, at + k), sums)
    else:
        for k in range(0, even, 2):
            sums = spread(tiles, row + k * TILE, load(x, at + k) - load(x, before + k), sums)
            more = spread(tiles, row + (k + 1) * TILE, load(x, at + k + 1) - load(x, before + k + 1), more)
        for k in range(even, states):
            sums = spread(tiles, row + k * TILE, load(x, at + k) - load(x, before + k), sums)
    for k in range(plates):
        sums = spread(tiles, row + (states + k) * TILE, alike(heights[sample, column + k]), sums)
    return sums[0] + more[0], sums[1] + more[1], sums[2] + more[2], sums[3] + more[3]


@part
def keep_tile(y: Any, row: int, values: Any) -> None:
    """Write a tile of outputs into rows."""
    store(y, row, values[0])
    store(y, row + 1, values[1])
    store(y, row + 2, values[2])
    store(y, row + 3, values[3])


@part
def advance(t: Any, r: Rows, rates: Any, laws: Any, step: int, inputs: Any, dampers: Any) -> None:
    """A step; rates: z' at the beginning and mean z' of each plate, (steps + 1, 2 plates)."""
    count, plates = len(dampers), rates.shape[1] // 2
    size = len(inputs)
    pair_rows, real_rows = 4 + 2 * size + 2 * count, 2 + size + count
    for k in range(plates):
        store(t, r.inputs + 2 * count + k, alike(rates[step, k]))
        store(t, r.inputs + 2 * count + plates + k, alike(rates[step, plates + k]))
    for i in range(count):
        arriving = alike(ELEMENT(0.0))
        for k in range(plates):
            arriving = arriving + load(t, r.slip + i * plates + k) * alike(rates[step + 1, k])
        store(t, r.room + i, arriving)
        store(t, r.room + count + i, alike(ELEMENT(0.0)))
    u = loads(t, r.inputs, inputs)
    w, more = loads(t, r.room, dampers), loads(t, r.room + count, dampers)
    for p in range(r.pairs):
        at = p * pair_rows
        a, b, decay, turn = load(t, at), load(t, at + 1), load(t, at + 2), load(t, at + 3)
        x = combined(t, at + 4, u, decay * a - turn * b)
        y = combined(t, at + 4 + size, u, decay * b + turn * a)
        store(t, at, x)
        store(t, at + 1, y)
        w = spread(t, at + 4 + 2 * size, x, w)
        more = spread(t, at + 4 + 2 * size + count, y, more)
    for q in range(r.reals):
        at = r.real + q * real_rows
        x = combined(t, at + 2, u, load(t, at + 1) * load(t, at))
        store(t, at, x)
        w = spread(t, at + 2 + size, x, w)
    for i in range(count):
        store(t, r.room + i, w[i] + more[i])
    if laws.shape[0] > 0:
        for i in range(count):
            # The velocity in the middle of the step, from those at the ends of the last one.
            now = load(t, r.velocity + i)
            store(t, r.limit + i, now + alike(ELEMENT(0.5)) * (now - load(t, r.earlier + i)))
            store(t, r.earlier + i, now)
            for lane in range(LANES):
                t[r.limit + i, lane] = friction_limit(laws[i, lane], t[r.limit + i, lane])
    solve(t, r, dampers)


@part
def keep_states(t: Any, r: Rows, rates: Any, step: int, x: Any, at: int, inputs: Any, dampers: Any) -> None:
    """States at a sample, which is the end of a step: poles, mean forces, slopes, z'."""
    count, plates = len(dampers), rates.shape[1] // 2
    pair_rows, real_rows = 4 + 2 * len(inputs) + 2 * count, 2 + len(inputs) + count
    for p in range(r.pairs):
        store(x, at + 2 * p, load(t, p * pair_rows))
        store(x, at + 2 * p + 1, load(t, p * pair_rows + 1))
    at += 2 * r.pairs
    for q in range(r.reals):
        store(x, at + q, load(t, r.real + q * real_rows))
    at += r.reals
    for i in range(2 * count):
        store(x, at + i, load(t, r.inputs + i))
    for k in range(plates):
        store(x, at + 2 * count + k, alike(rates[step + 1, k]))


@part
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
        x: states of the sample before and of INNER samples; changed in place.
        y: outputs of PAST samples before, and room for INNER; changed in place.
        peaks: of the run: squares of rotations, lowest and highest of each level; changed in place.
        out: channels of all cars; (channels, cars, samples).
        first: number of the first sample.
        cars: which of them are in the lanes.
        inputs, dampers: tuples as long as the inputs of a step and the dampers.
    """
    count, plates = len(dampers), rates.shape[1] // 2
    states = 2 * r.pairs + r.reals + 2 * count + plates
    weight = (states + plates) * TILE
    position_tiles, level_tiles = reading.positions.shape[0] // weight, reading.levels.shape[0] // weight
    bodies = reading.turns.shape[0] // weight
    width = TILE * (position_tiles + level_tiles) + 2 * count
    kept = TILE * (position_tiles + level_tiles)
    half = alike(ELEMENT(0.5))
    # Not literals, or what takes them would be compiled once more.
    done, step, none_before = 0, np.int64(0), np.int64(-1)
    zero = alike(ELEMENT(0.0))
    for i in range(TILE):
        store(t, r.room + i, zero)
    none = loads(t, r.room, _TILE)
    if first == 1:
        # Over plates that stand anywhere, the poles of a car in its design position are not zero.
        keep_states(t, r, rates, none_before, x, step, inputs, dampers)
    while done < heights.shape[0]:
        size = min(INNER, heights.shape[0] - done)
        for sample in range(size):
            for phase in range(every):
                advance(t, r, rates, laws, step, inputs, dampers)
                step += 1
                if phase == 0:
                    row = (PAST + sample - 1) * width + kept + count
                    for i in range(count):
                        store(y, row + i, load(y, row + i) - half * load(t, r.inputs + i))
            keep_states(t, r, rates, step - 1, x, (sample + 1) * states, inputs, dampers)
            row = (PAST + sample) * width + kept
            for i in range(count):
                # The force of a step belongs to its middle: at a sample it is the mean of the steps on both sides.
                speed = load(t, r.velocity + i)
                store(y, row + i, speed)
                store(y, row + count + i, load(t, r.viscous + i) * speed - half * load(t, r.inputs + i))
        for sample in range(size):
            at, row = (sample + 1) * states, (PAST + sample) * width
            for tile in range(position_tiles):
                found = read(reading.positions, tile, states, x, at, at - states, heights, done + sample, none)
                keep_tile(y, row + tile * TILE, found)
            row += TILE * position_tiles
            looking = (first + done + sample - 1) % LOOK_EVERY == 0
            for tile in range(level_tiles if looking or reading.always else 0):
                found = read(reading.levels, tile, states, x, at, none_before, heights, done + sample, none)
                keep_tile(y, row + tile * TILE, found)
                for k in range(tile * TILE, (tile + 1) * TILE):
                    # Tyre loads come first, and are looked at now and then.
                    if looking or k >= reading.loads:
                        value, low = load(y, row + k), bodies + 2 * k
                        store(peaks, low, smaller(value, load(peaks, low)))
                        store(peaks, low + 1, larger(value, load(peaks, low + 1)))
            for tile in range(bodies if looking else 0):
                turn = read(reading.turns, tile, states, x, at, none_before, heights, done + sample, none)
                angle = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]
                store(peaks, tile, larger(angle, load(peaks, tile)))
        for k in range(states):
            store(x, k, load(x, size * states + k))
        # What is AHEAD samples behind the newest is complete; the states before it are needed no more.
        begin = first + done - AHEAD
        early, late = max(0, -begin), min(size, out.shape[2] - begin)
        for channel in range(reading.wanted.shape[0]):
            row = reading.wanted[channel]
            if row < 0:
                continue
            for sample in range(early, late):
                middle = PAST + sample - AHEAD
                value = load(y, middle * width + row)
                if row < TILE * position_tiles:
                    value = zero
                    for k in range(PAST):
                        past = load(y, (middle - AHEAD + 1 + k) * width + row)
                        value = value + alike(reading.weights[k]) * past
                store(x, states + sample, value)
            for lane in range(cars.shape[0]):
                target, rest = out[channel, cars[lane]], reading.rest[channel, lane]
                for sample in range(early, late):
                    target[begin + sample] = rest + x[states + sample, lane]
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
