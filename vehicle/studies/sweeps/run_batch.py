"""Batch of runs of several cars on one signal, the argument of a measure."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.runs.car import Run


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Runs:
    """Time histories of r runs.

    Attributes:
        time: sampling times [s]; (n,).
        channels: name to samples of all runs, contiguous for each run; (r, n).
        vehicles: parameters of each car.
        tyre_load: wheel to static tyre loads [N]; (r,).
        random: False for one event, whose values have no standard error, see `Signal`.
    """

    time: Vector
    channels: Mapping[str, Vector]
    vehicles: tuple[Vehicle, ...]
    tyre_load: Mapping[str, Vector]
    random: bool = True

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
    def slip_velocity(self) -> Vector:
        """Return the minimum velocity of slip of each car [m/s]; (r,)."""
        return np.array([vehicle.damper.slip_velocity for vehicle in self.vehicles])


def single(run: Run) -> Runs:
    """Return a batch of a single run."""
    recording = run.recording
    return Runs(
        time=recording.time,
        channels={name: values[None] for name, values in recording.channels.items()},
        vehicles=(run.car.vehicle,),
        tyre_load={wheel: np.array([load]) for wheel, load in run.car.static.tyre_load.items()},
        random=run.signal.random,
    )
