"""Results of a run: channels over time, energies, poses for the film, solver statistics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.mapped_table import release


@dataclass(frozen=True, kw_only=True, slots=True)
class Energies:
    """Energy balance of a run [J]: work_in = dissipated + stored + residual."""

    work_in: float
    dissipated: float
    stored: float

    @property
    def residual(self) -> float:
        """Return |work_in - dissipated - stored| / |work_in| [-]; 0 without work."""
        if self.work_in == 0.0:
            return 0.0
        return abs(self.work_in - self.dissipated - self.stored) / abs(self.work_in)


@dataclass(frozen=True, kw_only=True, slots=True)
class Statistics:
    """Solver, computing time and validity of a run.

    Attributes:
        engine: "mujoco" or "reduced".
        callback: form of the element laws: "native", compiled code.
        timestep: time step [s].
        steps: number of steps.
        wall_time: computing time [s].
        warnings: messages about the validity of the results.
        energies: energy balance; None for the reduced engine, whose matrices contain no parts.
        notices: messages about the computation.
        within_validity: False for a motion outside the valid range of the engine, which needs another engine.
        errors: relative error of the RMS of each channel from linear geometry, with its sign; empty if unknown.
    """

    engine: str
    callback: str
    timestep: float
    steps: int
    wall_time: float
    warnings: tuple[str, ...]
    energies: Energies | None
    notices: tuple[str, ...] = ()
    within_validity: bool = True
    errors: Mapping[str, float] = field(default_factory=dict)

    @property
    def realtime_factor(self) -> float:
        """Return the simulated time over the computing time [-]."""
        return self.steps * self.timestep / self.wall_time


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Recording:
    """Time histories of a run.

    Attributes:
        time: (n,) [s].
        channels: channel name to (n,) array; names and units are those of `vehicle.names`.
        units: channel name to unit.
        excited: wheels with a moving plate.
        pose_time: times of the stored poses [s], (f,).
        poses: generalised positions of MuJoCo at `pose_time`, (f, nq).
        statistics: solver statistics.
    """

    time: Vector
    channels: Mapping[str, Vector]
    units: Mapping[str, str]
    excited: tuple[str, ...]
    pose_time: Vector
    poses: Vector
    statistics: Statistics

    def __repr__(self) -> str:
        """One line."""
        return f"Recording({len(self.time)} samples, {len(self.channels)} channels, {self.statistics.engine})"

    def __getitem__(self, channel: str) -> Vector:
        """Return the time history of a channel; the pages of the others leave the memory."""
        try:
            values = self.channels[channel]
        except KeyError:
            raise ConfigurationError(f"no channel {channel!r}; the recording has {', '.join(self.channels)}") from None
        release(values)
        return values

    def stacked(self, channels: Sequence[str]) -> Vector:
        """Return a copy of channels in memory; (channels, n)."""
        rows = np.stack([self[name] for name in channels])
        release(self.channels[channels[0]])
        return rows

    def only(self, channels: Sequence[str]) -> Recording:
        """Return the recording with a subset of its channels."""
        return replace(
            self, channels={name: self[name] for name in channels}, units={name: self.units[name] for name in channels}
        )

    @property
    def timestep(self) -> float:
        """Return the sampling interval of the channels [s]."""
        return float(self.time[1] - self.time[0])
