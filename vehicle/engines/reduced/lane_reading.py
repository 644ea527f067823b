"""Outputs of eight cars at once from the states at samples, and what is watched and made of them.

An output is a sum over all states, and its weights fill more than the nearest cache. So some outputs, a tile, are read
at some samples together: each weight is fetched once for all.

This module imports numba at its head: it is loaded only by a run that compiles.
"""

from __future__ import annotations

from typing import Any

from vehicle.engines.reduced.lane_rows import PAST, TILE, Reading
from vehicle.engines.reduced.lane_step import part, section
from vehicle.engines.reduced.vector import alike, larger, load, smaller, spread, store
from vehicle.engines.simulation.recorded_acceleration import AHEAD

TOGETHER = 4
"""Samples that are read together: their tiles and what they are made of fill the registers."""


@part
def together(first: int, stride: int, size: int) -> Any:
    """Samples from `first` on, and the first again beyond the last."""
    return (
        first,
        first + stride if first + stride < size else first,
        first + 2 * stride if first + 2 * stride < size else first,
        first + 3 * stride if first + 3 * stride < size else first,
    )


@part
def add(tiles: Any, row: int, values: Any, sums: Any) -> Any:
    """Add what a state gives a tile at each sample; values and sums of the samples."""
    return (
        spread(tiles, row, values[0], sums[0]),
        spread(tiles, row, values[1], sums[1]),
        spread(tiles, row, values[2], sums[2]),
        spread(tiles, row, values[3], sums[3]),
    )


@part
def read(
    tiles: Any, row: int, x: Any, states: int, samples: Any, heights: Any, done: int, moved: bool, zero: Any
) -> Any:
    """A tile of outputs at some samples, or of their differences from the samples before.

    Args:
        tiles: weights, (rows, LANES).
        row: first of the tile.
        x: states of samples, the sample before the first comes first.
        states: number of states.
        samples: which.
        heights: of the plates and their differences; (samples, 2 plates).
        done: row of the first sample in them.
        moved: whether differences are read.
        zero: a tile of zeros.
    """
    sums, plates = (zero, zero, zero, zero), heights.shape[1] // 2
    a, b, c, d = (
        (samples[0] + 1) * states,
        (samples[1] + 1) * states,
        (samples[2] + 1) * states,
        (samples[3] + 1) * states,
    )
    if moved:
        for k in range(states):
            values = (
                load(x, a + k) - load(x, a + k - states),
                load(x, b + k) - load(x, b + k - states),
                load(x, c + k) - load(x, c + k - states),
                load(x, d + k) - load(x, d + k - states),
            )
            sums = add(tiles, row + k * TILE, values, sums)
    else:
        for k in range(states):
            values = load(x, a + k), load(x, b + k), load(x, c + k), load(x, d + k)
            sums = add(tiles, row + k * TILE, values, sums)
    for k in range(plates):
        column = plates + k if moved else k
        values = (
            alike(heights[done + samples[0], column]),
            alike(heights[done + samples[1], column]),
            alike(heights[done + samples[2], column]),
            alike(heights[done + samples[3], column]),
        )
        sums = add(tiles, row + (states + k) * TILE, values, sums)
    return sums


@part
def keep(y: Any, row: int, values: Any) -> None:
    """Write a tile of outputs into rows."""
    store(y, row, values[0])
    store(y, row + 1, values[1])
    store(y, row + 2, values[2])


@section
def fill(
    tiles: Any,
    x: Any,
    states: int,
    heights: Any,
    done: int,
    moved: bool,
    zero: Any,
    begin: int,
    stride: int,
    size: int,
    y: Any,
    width: int,
    first: int,
) -> None:
    """Read all tiles of outputs, or of their differences.

    Args:
        tiles, x, states, heights, done, moved, zero: as of `read`.
        begin, stride, size: samples: the first, from one to the next, and their end.
        y: outputs of PAST samples before and of these; changed in place.
        width: rows of a sample in it.
        first: first of these in a sample.
    """
    weights = (states + heights.shape[1] // 2) * TILE
    for sample in range(begin, size, TOGETHER * stride):
        samples = together(sample, stride, size)
        for tile in range(tiles.shape[0] // weights):
            found = read(tiles, tile * weights, x, states, samples, heights, done, moved, zero)
            row = PAST * width + first + tile * TILE
            keep(y, row + samples[0] * width, found[0])
            keep(y, row + samples[1] * width, found[1])
            keep(y, row + samples[2] * width, found[2])
            keep(y, row + samples[3] * width, found[3])


@part
def turned(values: Any, most: Any) -> Any:
    """The larger of the square of a rotation and what it was before."""
    return larger(values[0] * values[0] + values[1] * values[1] + values[2] * values[2], most)


@section
def watch(
    reading: Reading,
    x: Any,
    states: int,
    heights: Any,
    done: int,
    zero: Any,
    look: int,
    size: int,
    y: Any,
    width: int,
    first: int,
    peaks: Any,
) -> None:
    """Take rotations and levels into the peaks of the run.

    Args:
        reading: what is read.
        x, states, heights, done, zero, size, y, width: as of `fill`.
        look: first sample that is looked at.
        first: first level in a sample of the outputs, which end with the next multiple of a tile.
        peaks: as of `vehicle.engines.reduced.lanes.march`; changed in place.
    """
    weights = (states + heights.shape[1] // 2) * TILE
    bodies, levels = reading.turns.shape[0] // weights, reading.levels.shape[0] // weights * TILE
    for sample in range(look, size, TOGETHER * reading.every):
        samples = together(sample, reading.every, size)
        for body in range(bodies):
            found = read(reading.turns, body * weights, x, states, samples, heights, done, False, zero)
            most = turned(found[1], turned(found[0], load(peaks, body)))
            store(peaks, body, turned(found[3], turned(found[2], most)))
    for sample in range(0 if reading.always else look, size, 1 if reading.always else reading.every):
        # Tyre loads come first, and are looked at with the rotations.
        looking = (sample - look) % reading.every == 0
        for k in range(0 if looking else reading.loads, levels):
            value, low = load(y, (PAST + sample) * width + first + k), bodies + 2 * k
            store(peaks, low, smaller(value, load(peaks, low)))
            store(peaks, low + 1, larger(value, load(peaks, low + 1)))


@section
def channels(
    reading: Reading,
    y: Any,
    width: int,
    positions: int,
    early: int,
    late: int,
    room: Any,
    out: Any,
    begin: int,
    cars: Any,
) -> None:
    """Write what is complete: AHEAD samples behind the newest.

    Args:
        reading: what is read.
        y, width: as of `fill`.
        positions: number of rows of a sample that are positions.
        early, late: samples of the block whose channels are written AHEAD samples earlier.
        room: rows for a channel; changed in place.
        out: channels of all cars; (channels, cars, samples).
        begin: where in it the sample `early` belongs.
        cars: which of them are in the lanes.
    """
    for channel in range(reading.wanted.shape[0]):
        row = reading.wanted[channel]
        if row < 0:
            continue
        for sample in range(late - early):
            middle = PAST - AHEAD + early + sample
            value = load(y, middle * width + row)
            if row < positions:
                value = alike(reading.weights[0]) * load(y, (middle - AHEAD + 1) * width + row)
                for k in range(1, PAST):
                    value = value + alike(reading.weights[k]) * load(y, (middle - AHEAD + 1 + k) * width + row)
            store(room, sample, value)
        for lane in range(cars.shape[0]):
            target, rest = out[channel, cars[lane], begin : begin + late - early], reading.rest[channel, lane]
            for sample in range(target.shape[0]):
                target[sample] = rest + room[sample, lane]
