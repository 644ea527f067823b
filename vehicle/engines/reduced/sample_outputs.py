"""Outputs of the cars in a vector from the states at samples: channels and peaks.

An output is a sum over all states, and its weights do not fit in the L1 cache. Therefore a tile of outputs is computed
at several samples together: each weight is loaded once for all of them.

This module imports numba at the top, so only runs that compile import it.
"""

from __future__ import annotations

from typing import Any

from vehicle.engines.reduced.inlining import compiled_once, inlined
from vehicle.engines.reduced.simd_vector import add_scaled, broadcast, load, maximum, minimum, of_cars, store
from vehicle.engines.reduced.table_layout import PAST, TILE, OutputTiles
from vehicle.engines.simulation.recorded_acceleration import AHEAD

TOGETHER = 4
"""Samples that are computed together: their tiles and inputs fill the registers."""


@inlined
def sample_group(first: int, stride: int, size: int) -> Any:
    """Return four samples from `first` on; the first replaces samples after the end."""
    return (
        first,
        first + stride if first + stride < size else first,
        first + 2 * stride if first + 2 * stride < size else first,
        first + 3 * stride if first + 3 * stride < size else first,
    )


@inlined
def accumulate(tiles: Any, row: int, values: Any, sums: Any) -> Any:
    """Add the contribution of a state to a tile at each sample; `values` and `sums` have one entry for each sample."""
    return (
        add_scaled(tiles, row, values[0], sums[0]),
        add_scaled(tiles, row, values[1], sums[1]),
        add_scaled(tiles, row, values[2], sums[2]),
        add_scaled(tiles, row, values[3], sums[3]),
    )


@inlined
def read_tile(
    tiles: Any,
    row: int,
    x: Any,
    changes: Any,
    states: int,
    poles: int,
    samples: Any,
    plate_z: Any,
    done: int,
    differences: bool,
    zero: Any,
) -> Any:
    """Return a tile of outputs at four samples, or of their differences from the previous samples.

    Args:
        tiles: weights, (rows, columns).
        row: first row of the tile.
        x: states of the samples, beginning with the sample before the first.
        changes: changes of the poles from sample to sample, likewise.
        states: number of states.
        poles: number of first states whose differences are in `changes`.
        samples: indices of the samples.
        plate_z: plate displacements and their differences; (samples, 2 plates).
        done: row of the first sample in `plate_z`.
        differences: return differences.
        zero: tile of zeros.
    """
    sums, plates = (zero, zero, zero, zero), plate_z.shape[1] // 2
    a, b, c, d = (
        (samples[0] + 1) * states,
        (samples[1] + 1) * states,
        (samples[2] + 1) * states,
        (samples[3] + 1) * states,
    )
    if differences:
        for k in range(poles):
            values = (
                load(changes, (samples[0] + 1) * poles + k),
                load(changes, (samples[1] + 1) * poles + k),
                load(changes, (samples[2] + 1) * poles + k),
                load(changes, (samples[3] + 1) * poles + k),
            )
            sums = accumulate(tiles, row + k * TILE, values, sums)
        for k in range(poles, states):
            values = (
                load(x, a + k) - load(x, a + k - states),
                load(x, b + k) - load(x, b + k - states),
                load(x, c + k) - load(x, c + k - states),
                load(x, d + k) - load(x, d + k - states),
            )
            sums = accumulate(tiles, row + k * TILE, values, sums)
    else:
        for k in range(states):
            values = load(x, a + k), load(x, b + k), load(x, c + k), load(x, d + k)
            sums = accumulate(tiles, row + k * TILE, values, sums)
    for k in range(plates):
        column = plates + k if differences else k
        values = (
            broadcast(plate_z[done + samples[0], column]),
            broadcast(plate_z[done + samples[1], column]),
            broadcast(plate_z[done + samples[2], column]),
            broadcast(plate_z[done + samples[3], column]),
        )
        sums = accumulate(tiles, row + (states + k) * TILE, values, sums)
    return sums


@inlined
def store_tile(y: Any, row: int, values: Any) -> None:
    """Store a tile of outputs of the cars in rows."""
    store(y, row, of_cars(values[0]))
    store(y, row + 1, of_cars(values[1]))
    store(y, row + 2, of_cars(values[2]))


@compiled_once
def fill_outputs(
    tiles: Any,
    x: Any,
    changes: Any,
    states: int,
    poles: int,
    plate_z: Any,
    done: int,
    differences: bool,
    zero: Any,
    begin: int,
    stride: int,
    size: int,
    y: Any,
    width: int,
    first: int,
) -> None:
    """Compute all tiles of outputs, or of their differences.

    Args:
        tiles, x, changes, states, poles, plate_z, done, differences, zero: see
            `read_tile`.
        begin, stride, size: first sample, stride and end of the samples.
        y: outputs of PAST previous samples and of these; changed in place.
        width: rows of a sample in `y`.
        first: first row of these outputs in a sample.
    """
    weights = (states + plate_z.shape[1] // 2) * TILE
    for sample in range(begin, size, TOGETHER * stride):
        samples = sample_group(sample, stride, size)
        for tile in range(tiles.shape[0] // weights):
            sums = read_tile(
                tiles, tile * weights, x, changes, states, poles, samples, plate_z, done, differences, zero
            )
            row = PAST * width + first + tile * TILE
            store_tile(y, row + samples[0] * width, sums[0])
            store_tile(y, row + samples[1] * width, sums[1])
            store_tile(y, row + samples[2] * width, sums[2])
            store_tile(y, row + samples[3] * width, sums[3])


@inlined
def subtract_excess(
    reading: OutputTiles, laws: Any, begin: int, stride: int, size: int, y: Any, width: int, levels: int, forces: int
) -> None:
    """Subtract the forces g of the laws of tyres from their linear loads.

    Args:
        reading: output tiles.
        laws: tuple with the length of the laws over displacement.
        begin, stride, size: first sample, stride and end of the samples.
        y, width: see `fill_outputs`.
        levels, forces: first rows of the levels and of the forces of the laws in a sample of the outputs.
    """
    for i in range(len(laws)):
        if reading.tyres[i] < 0:
            continue
        for sample in range(begin, size, stride):
            row = (PAST + sample) * width
            level = row + levels + reading.tyres[i]
            store(y, level, load(y, level) - load(y, row + forces + i))


@inlined
def largest_rotation(values: Any, previous: Any) -> Any:
    """Return the maximum of the square of a rotation and its previous maximum."""
    x, y, z = of_cars(values[0]), of_cars(values[1]), of_cars(values[2])
    return maximum(x * x + y * y + z * z, previous)


@compiled_once
def update_peaks(
    reading: OutputTiles,
    x: Any,
    states: int,
    plate_z: Any,
    done: int,
    zero: Any,
    first_check: int,
    size: int,
    y: Any,
    width: int,
    first: int,
    peaks: Any,
) -> None:
    """Update the peaks of the run by rotations and levels.

    Args:
        reading: output tiles.
        x, states, plate_z, done, zero, size, y, width: see `fill_outputs`.
        first_check: first sample that is checked.
        first: first row of the levels in a sample of the outputs.
        peaks: see `vehicle.engines.reduced.time_stepping.step_cars`; changed in place.
    """
    weights = (states + plate_z.shape[1] // 2) * TILE
    bodies = reading.rotations.shape[0] // weights
    for sample in range(first_check, size, TOGETHER * reading.every):
        samples = sample_group(sample, reading.every, size)
        for body in range(bodies):
            sums = read_tile(reading.rotations, body * weights, x, x, states, 0, samples, plate_z, done, False, zero)
            largest = largest_rotation(sums[1], largest_rotation(sums[0], load(peaks, body)))
            store(peaks, body, largest_rotation(sums[3], largest_rotation(sums[2], largest)))
    for sample in range(0 if reading.always else first_check, size, 1 if reading.always else reading.every):
        # Tyre loads come first and are checked with the rotations.
        is_check = (sample - first_check) % reading.every == 0
        for k in range(0 if is_check else reading.loads, reading.watched):
            value, low = load(y, (PAST + sample) * width + first + k), bodies + 2 * k
            store(peaks, low, minimum(value, load(peaks, low)))
            store(peaks, low + 1, maximum(value, load(peaks, low + 1)))


@compiled_once
def write_channels(
    reading: OutputTiles,
    y: Any,
    width: int,
    positions: int,
    early: int,
    late: int,
    buffer: Any,
    out: Any,
    begin: int,
    cars: Any,
) -> None:
    """Write the channels of complete samples, which are AHEAD samples older than the newest.

    Args:
        reading: output tiles.
        y, width: see `fill_outputs`.
        positions: number of rows of a sample that are positions.
        early, late: range of samples of the block; the channels are written AHEAD samples earlier.
        buffer: work space for a channel; changed in place.
        out: channels of all cars; (channels, cars, samples).
        begin: index of the sample `early` in `out`.
        cars: indices of the cars in the columns.
    """
    for channel in range(reading.wanted.shape[0]):
        row = reading.wanted[channel]
        if row < 0:
            continue
        for sample in range(late - early):
            middle = PAST - AHEAD + early + sample
            value = load(y, middle * width + row)
            if row < positions:
                value = broadcast(reading.weights[0]) * load(y, (middle - AHEAD + 1) * width + row)
                for k in range(1, PAST):
                    value = value + broadcast(reading.weights[k]) * load(y, (middle - AHEAD + 1 + k) * width + row)
            store(buffer, sample, value)
        for lane in range(cars.shape[0]):
            target, offset = out[channel, cars[lane], begin : begin + late - early], reading.offset[channel, lane]
            for sample in range(target.shape[0]):
                target[sample] = offset + buffer[sample, lane]
