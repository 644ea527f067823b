"""Many cars on one signal: eight at once, in single precision, with longer steps than one car alone.

Linear parts are exact at any step, and a stuck damper is of third order in it, so the step only places the instants of
sticking and slipping. At `COARSE_STEP` comfort values agree with those of a single run within 0.15 % and slip shares
within 0.1 points; instants of the first slip and peaks of damper tops need `vehicle.engines.reduced.run.LONGEST_STEP`.
"""

from __future__ import annotations

import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from vehicle.engines.reduced.lane_factors import car_factors
from vehicle.engines.reduced.lane_group import Group
from vehicle.engines.reduced.lane_rows import LANES
from vehicle.engines.reduced.march import MISSING, has_compiler
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.run import simulate_reduced
from vehicle.engines.simulation.recording import Recording, Statistics
from vehicle.errors import ConfigurationError, MissingPartError
from vehicle.model.parameters.force_elements import Damper
from vehicle.names import channel_units
from vehicle.signals.excitation.signal import Signal, uniform_time

Vector = npt.NDArray[np.float64]

COARSE_STEP = 5e-4
"""Longest step [s] for comfort and slip."""


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
            present_load=False,
        )
        statistics[car] = run.statistics
        table[:, car] = [run[name] for name in channels]
    # Like ones together: the longest list of poles in a group is that of all.
    together = sorted(factors, key=lambda car: (factors[car].pairs, factors[car].reals))
    for first in range(0, len(together), LANES):
        cars = together[first : first + LANES]
        started = clock.perf_counter()
        run_of = Group([models[car] for car in cars], [factors[car] for car in cars], signal, interval, timestep)
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
