"""Simulation of a group of up to eight cars, block by block."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.car_matrices import CarMatrices
from vehicle.engines.reduced.batch_factors import CarFactors
from vehicle.engines.reduced.batch_layout import ELEMENT, INNER_BLOCK, LANES, PAST, TILE, OutputTiles, aligned_table
from vehicle.engines.reduced.batch_tables import BatchTable, Table, damper_nodes
from vehicle.engines.reduced.plate_samples import plate_samples
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.validity import Validity, check_stride, exceeded_segments, rotating_bodies, segment_outputs
from vehicle.engines.simulation.recorded_acceleration import AHEAD, WEIGHTS
from vehicle.model.parameters.force_elements import Damper
from vehicle.signals.excitation.signal import Signal

Vector = npt.NDArray[np.float64]

BLOCK = 64 * INNER_BLOCK
"""Samples in a block of plate displacements."""


class BatchGroup:
    """Group of up to eight cars, one in each SIMD lane.

    Args:
        models, factors: pole models and factors of the cars.
        signal: displacement of the plates.
        interval: time between two samples [s].
        timestep: time step [s].
    """

    def __init__(
        self,
        models: Sequence[PoleModel],
        factors: Sequence[CarFactors],
        signal: Signal,
        interval: float,
        timestep: float,
    ) -> None:
        self.models, self.factors, self.driven = models, factors, signal.wheels
        self.every, self.interval, self.timestep = round(interval / timestep), interval, timestep
        steps = int(np.floor(signal.duration / interval + 1e-6)) * self.every
        self.plates = plate_samples(signal, timestep, steps, AHEAD * self.every)
        self.start = self.plates[:1].reshape(-1, 2).T

    def fill(
        self,
        table: Vector,
        cars: Sequence[int],
        channels: Sequence[str],
        dampers: Sequence[Sequence[Damper]],
        tyre_load: Sequence[Mapping[str, float]],
    ) -> list[Validity]:
        """Simulate the cars and fill their rows of the table.

        Args:
            table: time histories; (channels, all cars, samples).
            cars: rows of the cars of this group.
            channels: names of the channels.
            dampers, tyre_load: damper laws and static tyre loads of the cars.

        Returns:
            Validity of the motion of each car.
        """
        system, segments = self.models[0].matrices.system, self.models[0].matrices.segments
        bodies = rotating_bodies(self.models[0].matrices)
        batch_table = BatchTable(self.factors, dampers, self.start)
        count = len(dampers[0])
        # Rows of a sample: positions, all tyre loads and segments, damper velocities, damper forces.
        position_names = [name for name in channels if name in system.outputs]
        tyre_wheels = {f"tyre_{wheel}_force_z": wheel for wheel in system.inputs}
        levels = TILE * -(-len(position_names) // TILE)
        velocity_row = levels + TILE * -(-(len(tyre_wheels) + len(segments)) // TILE)
        rows = {name: row for row, name in enumerate(position_names)} | {
            name: levels + row for row, name in enumerate(tyre_wheels)
        }
        static_values = np.zeros((len(channels), LANES))
        for index, wheel in enumerate(system.inputs[:count]):
            rows |= {
                f"damper_{wheel}_velocity": velocity_row + index,
                f"damper_{wheel}_force": velocity_row + count + index,
            }
        for row, name in enumerate(channels):
            if name in tyre_wheels:
                static_values[row, : len(cars)] = [load[tyre_wheels[name]] for load in tyre_load]
            elif rows.get(name, 0) >= velocity_row + count:
                static_values[row, : len(cars)] = [
                    damper_nodes(car_dampers[rows[name] - velocity_row - count])[0]["rest_force"]
                    for car_dampers in dampers
                ]
            elif name not in rows:
                table[row, cars] = self._plate(name, table.shape[2])
        linear = [model.outputs([*tyre_wheels]) + segment_outputs(model) for model in self.models]
        modal_weights = [car.weights(model.modal) for car, model in zip(self.factors, self.models, strict=True)]
        positions, rotations = (
            [rows_of(model.matrices) @ shape for model, shape in zip(self.models, modal_weights, strict=True)]
            for rows_of in (partial(_position_rows, names=position_names), partial(_rotation_rows, bodies=bodies))
        )
        reading = OutputTiles(
            positions=batch_table.tiles(positions),
            levels=batch_table.tiles(
                [car.weights_of(outputs) for car, outputs in zip(self.factors, linear, strict=True)]
            ),
            rotations=batch_table.tiles(rotations),
            loads=len(tyre_wheels),
            every=check_stride(self.interval),
            always=bool(segments) or any(name in tyre_wheels for name in channels),
            wanted=np.array([rows.get(name, -1) for name in channels], dtype=np.int64),
            offset=static_values,
            weights=(np.cumsum(WEIGHTS[::-1])[::-1][1:] / self.interval**2).astype(ELEMENT),
        )
        output_buffer = aligned_table((PAST + INNER_BLOCK) * (velocity_row + 2 * count))
        for lane, outputs in enumerate(linear):
            # First sample: a car at rest over plates with any displacement.
            columns = self.factors[lane].columns
            initial = np.hstack([outputs.height[:, columns], outputs.velocity[:, columns]]) @ self.start.ravel()
            output_buffer[(PAST - 1) * (velocity_row + 2 * count) + levels :, lane][: len(initial)] = initial
        peaks = aligned_table(len(bodies) + 2 * (velocity_row - levels))
        self._step_blocks(batch_table, reading, output_buffer, peaks, table, cars, count)
        return [
            self._validity(peaks[:, lane].astype(float), model, bodies, static)
            for lane, (model, static) in enumerate(zip(self.models, tyre_load, strict=True))
        ]

    def _plate(self, channel: str, samples: int) -> Vector | float:
        """Return the displacement of a plate at the samples [m]."""
        for column, wheel in enumerate(self.driven):
            if channel == f"plate_{wheel}_displacement":
                return self.plates[: samples * self.every : self.every][:, 2 * column]
        return 0.0

    def _step_blocks(
        self,
        batch_table: BatchTable,
        reading: OutputTiles,
        y: Table,
        peaks: Table,
        table: Vector,
        cars: Sequence[int],
        count: int,
    ) -> None:
        """Advance the cars block by block; see `batch_stepping.step_batch` for the arguments."""
        from vehicle.engines.reduced.batch_stepping import compiled_batch_stepping

        stepping, m, every = compiled_batch_stepping(), batch_table.plates, self.every
        x, car_indices = aligned_table((INNER_BLOCK + 1) * batch_table.states), np.array(cars, dtype=np.int64)
        x[: len(batch_table.initial)] = batch_table.initial
        lengths = (0.0,) * (2 * (count + m)), (0.0,) * count
        sample, end = 1, table.shape[2] + AHEAD
        while sample < end:
            size, first = min(BLOCK, end - sample), (sample - 1) * every
            block_plates = self.plates[first : first + size * every + 1]
            rates = np.zeros((len(block_plates), 2 * m), dtype=ELEMENT)
            rates[:, :m] = block_plates[:, 1::2]
            rates[:-1, m:] = np.diff(block_plates[:, 0::2], axis=0) / self.timestep
            displacements = block_plates[::every, 0::2]
            plate_z = np.hstack([displacements[1:], np.diff(displacements, axis=0)]).astype(ELEMENT)
            tables = batch_table.table, batch_table.rows, batch_table.laws
            stepping(*tables, rates, plate_z, every, reading, x, y, peaks, table, sample, car_indices, *lengths)
            sample += size

    @staticmethod
    def _validity(
        car_peaks: Vector, model: PoleModel, bodies: Sequence[str], tyre_load: Mapping[str, float]
    ) -> Validity:
        """Return the validity of the motion of a car from its peaks; see `step_batch` for their order."""
        rotations, low, high = car_peaks[: len(bodies)], car_peaks[len(bodies) :: 2], car_peaks[len(bodies) + 1 :: 2]
        wheels, segments = model.matrices.system.inputs, model.matrices.segments
        segment_rows = slice(len(wheels), len(wheels) + len(segments))
        return Validity(
            angles=dict(zip(bodies, np.sqrt(rotations).tolist(), strict=True)),
            loads={wheel: tyre_load[wheel] + load for wheel, load in zip(wheels, low.tolist(), strict=False)},
            one_sided=model.matrices.one_sided,
            exceeded=exceeded_segments(segments, low[segment_rows], high[segment_rows]),
        )


def _position_rows(matrices: CarMatrices, names: Sequence[str]) -> Vector:
    """Return the rows of acceleration channels over the coordinates; see `recorded_acceleration`."""
    size = matrices.system.size
    return np.array([matrices.system.outputs[name][:size] for name in names]).reshape(-1, size)


def _rotation_rows(matrices: CarMatrices, bodies: Sequence[str]) -> Vector:
    """Return the rows of the rotations of bodies about three axes over the coordinates."""
    return np.concatenate([matrices.body_rows[body][3:] for body in bodies])
