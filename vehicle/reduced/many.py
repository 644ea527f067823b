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

from vehicle.errors import MissingPartError
from vehicle.excitation.signal import Signal, uniform_time
from vehicle.laws.damper import pack
from vehicle.names import channel_units
from vehicle.parameters.elements import Damper
from vehicle.reduced.lane_rows import INNER, LANES, PAST, TILE, Reading, aligned
from vehicle.reduced.lane_tables import CarFactors, LaneTable, fits
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
    tyre_outputs,
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
    not know (`fits`) is run alone, as `simulate_reduced` does it.

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
    """
    if not has_compiler():
        raise MissingPartError(MISSING)
    interval = 1.0 / record_rate
    samples = int(np.floor(signal.duration / interval + 1e-6)) + 1
    found = {name: np.empty((len(models), samples)) for name in channels}
    statistics: dict[int, Statistics] = {}
    timestep = interval / int(np.ceil(interval / step - 1e-9))
    together = [car for car, laws in enumerate(dampers) if fits(models[car], laws, timestep)]
    for car in sorted({*range(len(models))} - {*together}):
        run = simulate_reduced(
            models[car],
            signal,
            dampers=dampers[car],
            record_rate=record_rate,
            tyre_load=tyre_load[car],
            channels=channels,
        )
        statistics[car] = run.statistics
        for name in channels:
            found[name][car] = run[name]
    for first in range(0, len(together), LANES):
        cars = together[first : first + LANES]
        group = _Group([models[car] for car in cars], [dampers[car] for car in cars], signal, interval, step)
        for name, values in group.run(channels, [tyre_load[car] for car in cars]).items():
            found[name][cars] = values
        statistics.update(zip(cars, group.statistics(), strict=True))
    return ManyRuns(
        time=uniform_time(samples=samples, timestep=interval),
        channels=found,
        units=channel_units(tuple(channels)),
        excited=tuple(wheel for wheel in signal.wheels if np.any(signal.displacement[wheel] != 0.0)),
        statistics=tuple(statistics[car] for car in range(len(models))),
    )


class _Group:
    """Up to eight cars in the lanes.

    Args:
        models, dampers: of the cars.
        signal, step: as of `simulate_many`.
        interval: between two samples [s].
    """

    def __init__(
        self,
        models: Sequence[PoleModel],
        dampers: Sequence[Sequence[Damper]],
        signal: Signal,
        interval: float,
        step: float,
    ) -> None:
        self.started = clock.perf_counter()
        self.models, self.dampers, self.driven, self.interval = models, dampers, signal.wheels, interval
        self.wheels = models[0].matrices.system.inputs
        self.every = int(np.ceil(interval / step - 1e-9))
        self.samples = int(np.floor(signal.duration / interval + 1e-6)) + 1
        self.timestep = interval / self.every
        self.plates = plate_samples(signal, self.timestep, (self.samples - 1) * self.every, AHEAD * self.every)
        columns = [self.wheels.index(wheel) for wheel in signal.wheels]
        cars = [CarFactors(model, self.timestep, columns) for model in models]
        self.start = self.plates[:1].reshape(-1, 2).T
        self.lanes = LaneTable(cars, dampers, self.start)
        self.validity: list[Validity] = []

    def run(self, channels: Sequence[str], tyre_load: Sequence[Mapping[str, float]]) -> dict[str, Vector]:
        """The channels of the cars; (cars, samples) each."""
        models, lanes, used, wheels = self.models, self.lanes, len(self.models), self.wheels
        tyres = {f"tyre_{wheel}_force_z": index for index, wheel in enumerate(wheels)}
        moved = [name for name in channels if name in models[0].matrices.system.outputs]
        bodies = turning_bodies(models[0].matrices)
        # All tyres and bends, so that no digit depends on what is asked for.
        reading = Reading(
            positions=lanes.tiles([model.outputs(moved) for model in models]),
            levels=lanes.tiles([tyre_outputs(model) + bend_outputs(model) for model in models]),
            turns=lanes.tiles([rotation_outputs(model, bodies) for model in models], each=3),
            loads=len(tyres),
            always=any(name in tyres for name in channels) or bool(models[0].matrices.bends),
            wanted=np.zeros(0, dtype=np.int64),
            accelerations=len(moved),
            weights=(np.cumsum(WEIGHTS[::-1])[::-1][1:] / self.interval**2).astype(np.float32),
        )
        levels = TILE * -(-len(moved) // TILE)
        dampers = levels + TILE * -(-(len(tyres) + len(models[0].matrices.bends)) // TILE)
        count = len(self.dampers[0])
        rows = {name: row for row, name in enumerate(moved)}
        rows |= {name: levels + row for name, row in tyres.items() if name in channels}
        for row, wheel in enumerate(wheels[:count]):
            if {f"damper_{wheel}_velocity", f"damper_{wheel}_force"} & set(channels):
                rows |= {f"damper_{wheel}_velocity": dampers + row}
            if f"damper_{wheel}_force" in channels:
                rows |= {f"damper_{wheel}_force": dampers + count + row}
        reading = reading._replace(wanted=np.array(list(rows.values()), dtype=np.int64))
        out = np.empty((len(rows), used, self.samples))
        peaks = self._march(reading, levels, dampers + 2 * count, out)
        found = dict(zip(rows, out, strict=True))
        for name, index in tyres.items():
            if name in found:
                found[name] += np.array([[load[wheels[index]]] for load in tyre_load])
        for row, wheel in enumerate(wheels[:count]):
            name = f"damper_{wheel}_force"
            if name in found:
                viscous = np.array([[model.matrices.viscous[row]] for model in models])
                rest = np.array([[pack(own[row])["rest_force"]] for own in self.dampers])
                found[name] = viscous * found[f"damper_{wheel}_velocity"] - found[name] + rest
        for wheel in wheels:
            if f"plate_{wheel}_displacement" in channels:
                height = np.zeros(self.samples)
                if wheel in self.driven:
                    column = 2 * self.driven.index(wheel)
                    height = self.plates[: self.samples * self.every : self.every][:, column]
                found[f"plate_{wheel}_displacement"] = np.tile(height, (used, 1))
        self._judge(peaks, bodies, tyre_load)
        return {name: found[name] for name in channels}

    def _march(self, reading: Reading, levels: int, width: int, out: Vector) -> Vector:
        """Fill the channels block by block; returns the peaks."""
        from vehicle.reduced.lanes import compiled_lanes

        march, lanes, every, count = compiled_lanes(), self.lanes, self.every, len(self.dampers[0])
        m = lanes.plates
        x, y = aligned((INNER + 1) * lanes.states), aligned((PAST + INNER) * width)
        for lane, model in enumerate(self.models):
            # The first sample: a car that has not yet moved, over plates that may stand anywhere.
            own = tyre_outputs(model) + bend_outputs(model)
            begin = own.height[:, lanes.cars[lane].chosen] @ self.start[0]
            begin += own.velocity[:, lanes.cars[lane].chosen] @ self.start[1]
            y[(PAST - 1) * width + levels :][: len(begin), lane] = begin
        peaks = aligned(len(reading.turns) // lanes.states // TILE + 2 * (width - 2 * count - levels))
        tuples = (0.0,) * (2 * (count + m)), (0.0,) * count
        done, end = 1, self.samples + AHEAD
        while done < end:
            size = min(BLOCK, end - done)
            first = (done - 1) * every
            piece = self.plates[first : first + size * every + 1]
            rates = np.zeros((len(piece), 2 * m), dtype=np.float32)
            rates[:, :m] = piece[:, 1::2]
            rates[:-1, m:] = np.diff(piece[:, 0::2], axis=0) / self.timestep
            ends = piece[::every, 0::2]
            heights = np.hstack([ends[1:], np.diff(ends, axis=0)]).astype(np.float32)
            march(lanes.table, lanes.rows, lanes.laws, rates, heights, every, reading, x, y, peaks, out, done,
                  len(self.models), *tuples)  # fmt: skip
            done += size
        return peaks

    def _judge(self, peaks: Vector, bodies: Sequence[str], tyre_load: Sequence[Mapping[str, float]]) -> None:
        """What the motion of each car has shown."""
        for lane, (model, static) in enumerate(zip(self.models, tyre_load, strict=True)):
            seen = peaks[:, lane].astype(float)
            turned, low, high = seen[: len(bodies)], seen[len(bodies) :: 2], seen[len(bodies) + 1 :: 2]
            bends, wheels = model.matrices.bends, len(self.wheels)
            own = slice(wheels, wheels + len(bends))
            self.validity.append(
                Validity(
                    angles=dict(zip(bodies, np.sqrt(turned).tolist(), strict=True)),
                    loads={wheel: static[wheel] + float(low[k]) for k, wheel in enumerate(self.wheels)},
                    one_sided=model.matrices.one_sided,
                    left=left_pieces(bends, low[own], high[own]),
                )
            )

    def statistics(self) -> list[Statistics]:
        """Of each car."""
        wall = (clock.perf_counter() - self.started) / len(self.models)
        return [
            Statistics(
                engine="reduced",
                callback="native",
                timestep=self.timestep,
                steps=(self.samples - 1) * self.every,
                wall_time=wall,
                warnings=validity.warnings(),
                within_validity=validity.held,
                energies=None,
            )
            for validity in self.validity
        ]
