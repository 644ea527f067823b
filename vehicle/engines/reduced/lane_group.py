"""A group of cars in the lanes: what is read of them, and their march, block by block."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import numpy.typing as npt

from vehicle.engines.linear.matrices import CarMatrices
from vehicle.engines.reduced.lane_factors import CarFactors
from vehicle.engines.reduced.lane_rows import ELEMENT, INNER, LANES, PAST, TILE, Reading, aligned
from vehicle.engines.reduced.lane_tables import LaneTable, Table, damper_lane
from vehicle.engines.reduced.plate_samples import plate_samples
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.validity import Validity, bend_outputs, left_pieces, samples_of_a_look, turning_bodies
from vehicle.engines.simulation.recorded_acceleration import AHEAD, WEIGHTS
from vehicle.model.parameters.elements import Damper
from vehicle.signals.excitation.signal import Signal

Vector = npt.NDArray[np.float64]

BLOCK = 64 * INNER
"""Samples whose plates are made at once."""


class Group:
    """Up to eight cars in the lanes.

    Args:
        models, factors: of the cars.
        signal: displacement of the plates.
        interval: between two samples [s].
        timestep: [s].
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
        """Fill the rows of the cars.

        Args:
            table: (channels, all cars, samples).
            cars: rows of these cars.
            channels: their names.
            dampers, tyre_load: of these cars.

        Returns:
            What the motion of each car has shown.
        """
        system, bends = self.models[0].matrices.system, self.models[0].matrices.bends
        bodies = turning_bodies(self.models[0].matrices)
        lanes = LaneTable(self.factors, dampers, self.start)
        count = len(dampers[0])
        # In a sample: positions, all tyre loads and bends, damper velocities, damper forces.
        moved = [name for name in channels if name in system.outputs]
        tyres = {f"tyre_{wheel}_force_z": wheel for wheel in system.inputs}
        levels = TILE * -(-len(moved) // TILE)
        ends = levels + TILE * -(-(len(tyres) + len(bends)) // TILE)
        rows = {name: row for row, name in enumerate(moved)} | {name: levels + row for row, name in enumerate(tyres)}
        rest = np.zeros((len(channels), LANES))
        for index, wheel in enumerate(system.inputs[:count]):
            rows |= {f"damper_{wheel}_velocity": ends + index, f"damper_{wheel}_force": ends + count + index}
        for row, name in enumerate(channels):
            if name in tyres:
                rest[row, : len(cars)] = [load[tyres[name]] for load in tyre_load]
            elif rows.get(name, 0) >= ends + count:
                rest[row, : len(cars)] = [
                    damper_lane(own[rows[name] - ends - count])[0]["rest_force"] for own in dampers
                ]
            elif name not in rows:
                table[row, cars] = self._plate(name, table.shape[2])
        linear = [model.outputs([*tyres]) + bend_outputs(model) for model in self.models]
        shapes = [car.weights(model.modal) for car, model in zip(self.factors, self.models, strict=True)]
        places, turns = (
            [rows_of(model.matrices) @ shape for model, shape in zip(self.models, shapes, strict=True)]
            for rows_of in (partial(_places, names=moved), partial(_turns, bodies=bodies))
        )
        reading = Reading(
            positions=lanes.tiles(places),
            levels=lanes.tiles([car.weights_of(one) for car, one in zip(self.factors, linear, strict=True)]),
            turns=lanes.tiles(turns),
            loads=len(tyres),
            every=samples_of_a_look(self.interval),
            always=bool(bends) or any(name in tyres for name in channels),
            wanted=np.array([rows.get(name, -1) for name in channels], dtype=np.int64),
            rest=rest,
            weights=(np.cumsum(WEIGHTS[::-1])[::-1][1:] / self.interval**2).astype(ELEMENT),
        )
        y = aligned((PAST + INNER) * (ends + 2 * count))
        for lane, one in enumerate(linear):
            # The first sample: a car that has not yet moved, over plates that may stand anywhere.
            chosen = self.factors[lane].columns
            begin = np.hstack([one.height[:, chosen], one.velocity[:, chosen]]) @ self.start.ravel()
            y[(PAST - 1) * (ends + 2 * count) + levels :, lane][: len(begin)] = begin
        peaks = aligned(len(bodies) + 2 * (ends - levels))
        self._march(lanes, reading, y, peaks, table, cars, count)
        return [
            self._judge(peaks[:, lane].astype(float), model, bodies, static)
            for lane, (model, static) in enumerate(zip(self.models, tyre_load, strict=True))
        ]

    def _plate(self, channel: str, samples: int) -> Vector | float:
        """Displacement of a plate at the samples."""
        for column, wheel in enumerate(self.driven):
            if channel == f"plate_{wheel}_displacement":
                return self.plates[: samples * self.every : self.every][:, 2 * column]
        return 0.0

    def _march(
        self,
        lanes: LaneTable,
        reading: Reading,
        y: Table,
        peaks: Table,
        table: Vector,
        cars: Sequence[int],
        count: int,
    ) -> None:
        """Block by block; arguments as of `vehicle.engines.reduced.lanes.march`."""
        from vehicle.engines.reduced.lanes import compiled_lanes

        march, m, every = compiled_lanes(), lanes.plates, self.every
        x, own = aligned((INNER + 1) * lanes.states), np.array(cars, dtype=np.int64)
        x[: len(lanes.begin)] = lanes.begin
        tuples = (0.0,) * (2 * (count + m)), (0.0,) * count
        done, end = 1, table.shape[2] + AHEAD
        while done < end:
            size, first = min(BLOCK, end - done), (done - 1) * every
            piece = self.plates[first : first + size * every + 1]
            rates = np.zeros((len(piece), 2 * m), dtype=ELEMENT)
            rates[:, :m] = piece[:, 1::2]
            rates[:-1, m:] = np.diff(piece[:, 0::2], axis=0) / self.timestep
            ends = piece[::every, 0::2]
            heights = np.hstack([ends[1:], np.diff(ends, axis=0)]).astype(ELEMENT)
            march(lanes.table, lanes.rows, lanes.laws, rates, heights, every, reading, x, y, peaks, table, done, own,
                  *tuples)  # fmt: skip
            done += size

    @staticmethod
    def _judge(seen: Vector, model: PoleModel, bodies: Sequence[str], tyre_load: Mapping[str, float]) -> Validity:
        """What the motion of a car has shown; its peaks are those of `vehicle.engines.reduced.lanes.march`."""
        turned, low, high = seen[: len(bodies)], seen[len(bodies) :: 2], seen[len(bodies) + 1 :: 2]
        wheels, bends = model.matrices.system.inputs, model.matrices.bends
        own = slice(len(wheels), len(wheels) + len(bends))
        return Validity(
            angles=dict(zip(bodies, np.sqrt(turned).tolist(), strict=True)),
            loads={wheel: tyre_load[wheel] + load for wheel, load in zip(wheels, low.tolist(), strict=False)},
            one_sided=model.matrices.one_sided,
            left=left_pieces(bends, low[own], high[own]),
        )


def _places(matrices: CarMatrices, names: Sequence[str]) -> Vector:
    """Rows of places on the coordinates, of which `vehicle.engines.simulation.recorded_acceleration` makes channels."""
    size = matrices.system.size
    return np.array([matrices.system.outputs[name][:size] for name in names]).reshape(-1, size)


def _turns(matrices: CarMatrices, bodies: Sequence[str]) -> Vector:
    """Rows of the rotations of bodies about three axes on the coordinates."""
    return np.concatenate([matrices.body_rows[body][3:] for body in bodies])
