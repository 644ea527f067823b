"""Many cars on one signal: eight at once, in single precision, with longer steps than one car alone.

Linear parts are exact at any step, and a stuck damper is of third order in it, so the step only places the instants of
sticking and slipping. At `COARSE_STEP` comfort values agree with those of a single run within 0.15 % and slip shares
within 0.1 points; instants of the first slip and peaks of damper tops need `vehicle.reduced.run.LONGEST_STEP`.
"""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.excitation.signal import Signal, uniform_time
from vehicle.names import channel_units
from vehicle.parameters.elements import Damper
from vehicle.reduced.lane_factors import CarFactors, car_factors
from vehicle.reduced.lane_rows import ELEMENT, INNER, LANES, PAST, TILE, Reading, aligned
from vehicle.reduced.lane_tables import LaneTable, Table, damper_lane
from vehicle.reduced.march import MISSING, has_compiler
from vehicle.reduced.plate_samples import plate_samples
from vehicle.reduced.pole_model import PoleModel
from vehicle.reduced.run import simulate_reduced
from vehicle.reduced.validity import (
    Validity,
    bend_outputs,
    left_pieces,
    rotation_outputs,
    turning_bodies,
)
from vehicle.simulation.acceleration import AHEAD, WEIGHTS
from vehicle.simulation.recording import Recording, Statistics

Vector = npt.NDArray[np.float64]

COARSE_STEP = 5e-4
"""Longest step [s] for comfort and slip."""

BLOCK = 64 * INNER
"""Samples whose plates are made at once."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ManyRuns:
    """Time histories of many cars on one signal.

    Attributes:
        time: (n,) [s].
        channels: name to (cars, n); names and units are those of `vehicle.names`.
        units: name to unit.
        excited: wheels whose plates were driven.
        statistics: of each car; its computing time is its share of that of all.
    """

    time: Vector
    channels: Mapping[str, Vector]
    units: Mapping[str, str]
    excited: tuple[str, ...]
    statistics: tuple[Statistics, ...]

    def __len__(self) -> int:
        """Number of cars."""
        return len(self.statistics)

    def recording(self, car: int) -> Recording:
        """What one car has left, as of a single run; its channels are views."""
        return Recording(
            time=self.time,
            channels={name: values[car] for name, values in self.channels.items()},
            units=self.units,
            excited=self.excited,
            pose_time=np.zeros(0),
            poses=np.zeros((0, 0)),
            statistics=self.statistics[car],
        )


def simulate_many(
    models: Sequence[PoleModel],
    signal: Signal,
    *,
    dampers: Sequence[Sequence[Damper]],
    record_rate: float,
    tyre_load: Sequence[Mapping[str, float]],
    channels: Sequence[str],
    step: float = COARSE_STEP,
) -> ManyRuns:
    """Run many cars of one topology on the same plates with the reduced engine.

    The row of a car is the same, bit for bit, whatever the others are and however many. A car that the lanes do
    not know (`car_factors`) is run alone, as `simulate_reduced` does it.

    Args:
        models: the cars as sums over their poles: the same wheels, dampers, bodies and channels; any numbers.
        signal: displacement of the plates.
        dampers: laws of each car, one for each damper.
        record_rate: rate of the samples [Hz].
        tyre_load: static tyre loads [N] of each car by wheel.
        channels: names of the recorded channels, without loads.
        step: longest time step [s].

    Returns:
        The channels of all cars.

    Raises:
        MissingPartError: numba is not installed.
        ConfigurationError: there are no cars.
    """
    if not has_compiler():
        raise MissingPartError(MISSING)
    if not models:
        raise ConfigurationError("simulate_many: no cars were given")
    interval = 1.0 / record_rate
    timestep = interval / int(np.ceil(interval / step - 1e-9))
    samples = int(np.floor(signal.duration / interval + 1e-6)) + 1
    table = np.empty((len(channels), len(models), samples))
    statistics: dict[int, Statistics] = {}
    wheels = models[0].matrices.system.inputs
    factors = car_factors(models, dampers, timestep, [wheels.index(wheel) for wheel in signal.wheels])
    for car in {*range(len(models))} - {*factors}:
        run = simulate_reduced(
            models[car],
            signal,
            dampers=dampers[car],
            record_rate=record_rate,
            tyre_load=tyre_load[car],
            channels=channels,
        )
        statistics[car] = run.statistics
        table[:, car] = [run[name] for name in channels]
    together = list(factors)
    for first in range(0, len(together), LANES):
        cars = together[first : first + LANES]
        started = clock.perf_counter()
        run_of = _Group([models[car] for car in cars], [factors[car] for car in cars], signal, interval, timestep)
        found = run_of.fill(table, cars, channels, [dampers[car] for car in cars], [tyre_load[car] for car in cars])
        wall = (clock.perf_counter() - started) / len(cars)
        for car, validity in zip(cars, found, strict=True):
            statistics[car] = Statistics(
                engine="reduced",
                callback="native",
                timestep=timestep,
                steps=(samples - 1) * round(interval / timestep),
                wall_time=wall,
                warnings=validity.warnings(),
                within_validity=validity.held,
                energies=None,
            )
    return ManyRuns(
        time=uniform_time(samples=samples, timestep=interval),
        channels=dict(zip(channels, table, strict=True)),
        units=channel_units(tuple(channels)),
        excited=tuple(wheel for wheel in signal.wheels if np.any(signal.displacement[wheel] != 0.0)),
        statistics=tuple(statistics[car] for car in range(len(models))),
    )


class _Group:
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
        outputs = [
            model.outputs([*moved, *tyres]) + bend_outputs(model) + rotation_outputs(model, bodies)
            for model in self.models
        ]
        weights = [car.weights(one) for car, one in zip(self.factors, outputs, strict=True)]
        parts = np.cumsum([0, len(moved), len(tyres) + len(bends), 3 * len(bodies)]).tolist()
        reading = Reading(
            positions=lanes.tiles(weights, slice(*parts[0:2])),
            levels=lanes.tiles(weights, slice(*parts[1:3])),
            turns=lanes.tiles(weights, slice(*parts[2:4]), each=3),
            loads=len(tyres),
            always=bool(bends) or any(name in tyres for name in channels),
            wanted=np.array([rows.get(name, -1) for name in channels], dtype=np.int64),
            rest=rest,
            weights=(np.cumsum(WEIGHTS[::-1])[::-1][1:] / self.interval**2).astype(ELEMENT),
        )
        y = aligned((PAST + INNER) * (ends + 2 * count))
        for lane, one in enumerate(outputs):
            # The first sample: a car that has not yet moved, over plates that may stand anywhere.
            own, chosen = slice(*parts[1:3]), self.factors[lane].columns
            begin = np.hstack([one.height[own][:, chosen], one.velocity[own][:, chosen]]) @ self.start.ravel()
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
        """Block by block; arguments as of `vehicle.reduced.lanes.march`."""
        from vehicle.reduced.lanes import compiled_lanes

        march, m, every = compiled_lanes(), lanes.plates, self.every
        x, own = aligned((INNER + 1) * lanes.states), np.array(cars, dtype=np.int64)
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
        """What the motion of a car has shown; its peaks are those of `vehicle.reduced.lanes.march`."""
        turned, low, high = seen[: len(bodies)], seen[len(bodies) :: 2], seen[len(bodies) + 1 :: 2]
        wheels, bends = model.matrices.system.inputs, model.matrices.bends
        own = slice(len(wheels), len(wheels) + len(bends))
        return Validity(
            angles=dict(zip(bodies, np.sqrt(turned).tolist(), strict=True)),
            loads={wheel: tyre_load[wheel] + load for wheel, load in zip(wheels, low.tolist(), strict=False)},
            one_sided=model.matrices.one_sided,
            left=left_pieces(bends, low[own], high[own]),
        )
