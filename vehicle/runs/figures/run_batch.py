"""Batch of runs of several cars on one signal, of which a figure is computed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Car, Run
from vehicle.runs.car.run_twin import Period, TwinLines, signal_period, twin_lines_of
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.ride_comfort import comfort_columns


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Runs:
    """Time histories of r runs.

    Attributes:
        time: sampling times [s]; (n,).
        channels: name to samples of all runs, contiguous for each run; (r, n).
        vehicles: parameters of each car.
        tyre_load: wheel to static tyre loads [N]; (r,).
        random: False for one event, whose values have no standard error, see `Signal`.
        left_obstacle: time at which the last wheel leaves an obstacle [s]; None without an obstacle.
        cars: the cars, for figures of their motions; may be empty.
        skip: time at the beginning that is not evaluated [s].
        band: band of unweighted comfort [Hz].
        errors: False leaves out standard errors.
        period: road that repeats after the evaluated span, for the linear twins; None without it.
    """

    time: Vector
    channels: Mapping[str, Vector]
    vehicles: tuple[Vehicle, ...]
    tyre_load: Mapping[str, Vector]
    random: bool = True
    left_obstacle: float | None = None
    cars: tuple[Car, ...] = ()
    skip: float = 0.0
    band: tuple[float, float] = COMFORT_BAND
    errors: bool = True
    period: Period | None = None
    _comfort: dict[tuple[str, str], dict[str, Vector]] = field(default_factory=dict, init=False)
    _twins: list[TwinLines | None] = field(default_factory=list, init=False)

    def __getitem__(self, channel: str) -> Vector:
        """Return the samples of a channel; (r, n)."""
        return self.channels[channel]

    def stacked(self, *channels: str) -> Vector:
        """Return the samples of several channels; (r, channels, n)."""
        return np.stack([self.channels[name] for name in channels], axis=1)

    @property
    def timestep(self) -> float:
        """Return the sampling interval [s]."""
        return float(self.time[1] - self.time[0])

    @property
    def evaluated(self) -> slice:
        """Return the evaluated samples."""
        return evaluated_span(self.time.size, self.timestep, self.skip)

    def slip_velocities(self, wheels: Sequence[str]) -> Vector:
        """Return the velocity above which the damper of each wheel slips [m/s]; (r, dampers)."""
        return np.array([[vehicle.slip_velocities[wheel] for wheel in wheels] for vehicle in self.vehicles])

    @property
    def dampers(self) -> tuple[str, ...]:
        """Return the wheels with a damper."""
        return self.vehicles[0].damped_wheels

    @property
    def twin(self) -> TwinLines | None:
        """Return the lines of the linear twins, see `vehicle.runs.car.run_twin`; a car without a twin is at rest.

        None on another road, for another evaluated span, or if no car has a twin. Computed once.
        """
        if self.period is None or not self.cars or not self.period.begins_at(self.skip, self.timestep):
            return None
        if not self._twins:
            self._twins.append(twin_lines_of(self.cars, self.period, self.channels, self.timestep, self.channels))
        return self._twins[0]

    def comfort(self, point: str, name: str) -> dict[str, Vector]:
        """Return the values of a comfort value and its axes, see `ride_comfort.comfort_columns`; computed once.

        Args:
            point: "seat_rail" or "seat".
            name: "unweighted" or "weighted".
        """
        if (point, name) not in self._comfort:
            records = self.stacked(*(f"{point}_acc_{axis}" for axis in "xyz"))
            self._comfort[point, name] = comfort_columns(
                self.timestep,
                records,
                skip=self.skip,
                band=self.band,
                names=[name],
                errors=self.errors,
                axes=self.errors,
            )
        return self._comfort[point, name]


def single(run: Run) -> Runs:
    """Return a batch of a single run."""
    recording = run.recording
    return Runs(
        time=recording.time,
        channels={name: values[None] for name, values in recording.channels.items()},
        vehicles=(run.car.vehicle,),
        tyre_load={wheel: np.array([load]) for wheel, load in run.car.static.tyre_load.items()},
        random=run.signal.random,
        left_obstacle=left_obstacle(run.road) if run.road is not None else run.signal.left_obstacle,
        cars=(run.car,),
        period=signal_period(run.signal),
    )


def evaluated(run: Run) -> Runs:
    """Return a batch of a single run with the start of its evaluation and its band, as in `Run.comfort`."""
    return replace(single(run), skip=run.skip, band=run.signal.band(COMFORT_BAND))


def left_obstacle(road: Mapping[str, object]) -> float | None:
    """Return the time at which the last wheel leaves an obstacle [s], from the entry "road" of a run; or None."""
    times = road.get("obstacle_s")
    return float(times[1]) if isinstance(times, list | tuple) else None
