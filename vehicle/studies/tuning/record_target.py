"""Measured time histories as a target of a fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import channel_units
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.records.table import Record
from vehicle.studies.tuning.road_car import RoadCar

Vector = npt.NDArray[np.float64]

KEPT = 2.0
"""Samples per period of the low-pass frequency after decimation: white noise then stays nearly white."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordTarget:
    """Target of a fit: time histories on one signal.

    Residuals have one row for each channel: (y - ym) over the RMS of y in the window, both after the same low-pass
    filter. The fit estimates the noise of a channel from the residuals. Without the filter an acceleration jumps
    between two samples at the end of stick: single samples would dominate the sum of squares, which would be rough
    where a jump moves across a sample.

    Attributes:
        name: name of the record, for reports.
        signal: plate displacement, of a rig or of the road.
        record: the measured channels, in the units and at the times of the recording of the car.
        window: begin and end of the included part [s].
        lowpass: -6 dB frequency of a Butterworth low-pass of order 4, forwards and backwards [Hz]; two samples are kept
            for each period, so that the noise of neighbouring samples stays nearly independent.
        road: car on the road of the record; None for a signal of a rig.
    """

    name: str
    signal: Signal
    record: Record
    window: tuple[float, float]
    lowpass: float = 100.0
    road: RoadCar | None = None

    def __post_init__(self) -> None:
        count, step = self.record.time.size, self.record.step
        if not 0.0 < self.lowpass <= 0.4 / step:
            raise ConfigurationError(
                f"{self.name}: found a low-pass of {self.lowpass:g} Hz for {count} samples, must be at most 0.4 times "
                "the sampling rate"
            )
        if not self.record.channels:
            raise DataError(f"{self.name}: no time history; specify at least one channel")
        for channel, values in self.record.channels.items():
            channel_units([channel])
            if not np.any(values[self.inside]):
                raise DataError(
                    f"{self.name}: {channel} is zero throughout {self.window[0]:g} to {self.window[1]:g} s; leave it "
                    "out, or choose another part of the record"
                )

    @property
    def kept(self) -> npt.NDArray[np.int64]:
        """Return the indices of the samples in the window after decimation, (samples,)."""
        every = max(int(1.0 / (KEPT * self.lowpass * self.record.step) + 1e-9), 1)
        return np.flatnonzero(self.inside)[::every]

    @property
    def inside(self) -> npt.NDArray[np.bool_]:
        """Return the mask of the samples in the window, (n,)."""
        return np.asarray((self.record.time >= self.window[0]) & (self.record.time <= self.window[1]))

    @property
    def rows(self) -> tuple[str, ...]:
        """Return the names of the rows of the residuals."""
        return tuple(f"{self.name}, {channel}" for channel in self.record.channels)

    @property
    def recorded(self) -> tuple[str, ...]:
        """Return the names of the channels of a run that the target needs."""
        return tuple(self.record.channels)

    def measured(self) -> Vector:
        """Return the filtered measured data in the window, (channels, samples)."""
        return self._filtered(np.array(list(self.record.channels.values())))

    def run(self, car: Car, engine: str = "reduced", channels: Sequence[str] = ()) -> Run:
        """Return the run of a car on the signal, on a road with turning wheels.

        Args:
            car: variant of the car of the fit.
            engine: engine of the run.
            channels: recorded channels; those of the record by default.
        """
        driven = car if self.road is None else self.road.variant(car)
        return driven.run(self.signal, engine=engine, channels=tuple(channels) or self.recorded)

    def model_histories(self, model: Car | Run) -> Vector:
        """Return filtered histories of a run of the signal, or of a car by the reduced engine; (channels, samples).

        Raises:
            DataError: the run has other sampling times than the data.
        """
        names, time = self.recorded, self.record.time
        run = model if isinstance(model, Run) else self.run(model)
        if run.time.size != time.size or abs(run.time[-1] - time[-1]) > 1e-6:
            raise DataError(
                f"{self.name}: {time.size} samples to {time[-1]:g} s, the model gives {run.time.size} to "
                f"{run.time[-1]:g} s; resample the record to solver.record_rate"
            )
        return self._filtered(np.array([run[name] for name in names]))

    def residuals(self, model: Car | Run) -> Vector:
        """Return (y - ym) over the RMS of y, (channels, samples), with ym from `model_histories`."""
        measured = self.measured()
        return np.asarray(
            (measured - self.model_histories(model)) / np.sqrt(np.mean(measured**2, axis=1, keepdims=True))
        )

    def _filtered(self, histories: Vector) -> Vector:
        sections = scipy.signal.butter(4, 2.0 * self.record.step * self.lowpass, output="sos")
        return np.asarray(scipy.signal.sosfiltfilt(sections, histories, axis=1)[:, self.kept])
