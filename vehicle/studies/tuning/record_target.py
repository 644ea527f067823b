"""Measured time histories as a target of a fit."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.arrays import Mask, Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import channel_units
from vehicle.runs.car import Car, Run
from vehicle.runs.car.fast_run import fast_run
from vehicle.signals.analysis.phase_delay import PhaseDelay
from vehicle.signals.analysis.time_shift import time_shift
from vehicle.signals.excitation.signal import MINIMUM_SAMPLES, Signal
from vehicle.signals.formats.table import Record
from vehicle.signals.records.counterpart import SAME_MOTION
from vehicle.studies.tuning.response_delays import ResponseDelays

KEPT = 2.0
"""Samples per period of the low-pass frequency after decimation: white noise then stays nearly white."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RoadCar:
    """Car of a fit on a road, and its variants with other parameters.

    A variant is made from the car on the road: the terms of its matrices are computed once for all variants
    (`Car.varied`).
    """

    start: Car  # car at the start of the fit, with standing tyres or the speed of its file
    rolling: Car  # the same car with the parameters that the road sets, for example driving.speed

    def variant(self, car: Car) -> Car:
        """Return a variant, from `start.varied`, on the road."""
        return self.rolling.with_(car.overrides[len(self.start.overrides) :])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordTarget:
    """Target of a fit: time histories on one signal.

    Residuals have one row for each channel: (y - ym) over the RMS of y in the window, both after the same low-pass
    filter. The fit estimates the noise of a channel from the residuals. Without the filter an acceleration jumps
    between two samples at the end of stick: single samples would dominate the sum of squares, which would be rough
    where a jump moves across a sample.
    """

    name: str  # name of the record, for reports
    signal: Signal  # plate displacement, of a rig or of the road
    record: Record  # the measured channels, in the units and at the times of the recording of the car
    window: tuple[float, float]  # begin and end of the included part [s]
    # -6 dB frequency of a Butterworth low-pass of order 4, forwards and backwards [Hz]; two samples are kept for each
    # period, so that the noise of neighbouring samples stays nearly independent
    lowpass: float = 100.0
    road: RoadCar | None = None  # car on the road of the record; None on a rig
    # delays of the channels against the signal: the run is compared at the earlier time t - d, so that the noise of the
    # measurement is not differentiated
    delays: ResponseDelays = ResponseDelays()
    sample: float = 0.0  # sampling interval of the measurement [s]; by default from the record

    def __post_init__(self) -> None:
        count, step = self.record.time.size, self.record.step
        if not 0.0 < self.lowpass <= 0.4 / step:
            raise ConfigurationError(
                f"{self.name}: found a low-pass of {self.lowpass:g} Hz for {count} samples, must be at most 0.4 times "
                "the sampling rate"
            )
        if not self.record.channels:
            raise DataError(f"{self.name}: contains no time history; give at least one channel")
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
    def inside(self) -> Mask:
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

    @property
    def half_sample(self) -> float:
        """Return half the sampling interval of the measurement [s]."""
        return 0.5 * (self.sample or self.record.step)

    def measured(self) -> Vector:
        """Return the filtered measured data in the window, (channels, samples)."""
        return self._filtered(np.array(list(self.record.channels.values())))[:, self.kept]

    def run(self, car: Car, engine: str = "reduced", channels: Sequence[str] = ()) -> Run:
        """Return the run of a car on the signal, on a road with turning wheels.

        Args:
            channels: recorded channels; by default all in the record.
        """
        return self._driven(car).run(self.signal, engine=engine, channels=tuple(channels) or self.recorded)

    def fast(self, car: Car, channels: Sequence[str] = ()) -> Run:
        """Return the run of a step of the fit, see `fast_run`; arguments as for `run`."""
        return fast_run(self._driven(car), self.signal, tuple(channels) or self.recorded)

    def _driven(self, car: Car) -> Car:
        """Return a car on the road, if there is one."""
        return car if self.road is None else self.road.variant(car)

    def response(self, model: Car | Run) -> Vector:
        """Return filtered histories of a run of the signal, or of a car by the reduced engine; (channels, n)."""
        names, time = self.recorded, self.record.time
        run = model if isinstance(model, Run) else self.fast(model)
        if run.time.size != time.size or abs(run.time[-1] - time[-1]) > 1e-6:
            raise DataError(
                f"{self.name}: {time.size} samples to {time[-1]:g} s, the model gives {run.time.size} to "
                f"{run.time[-1]:g} s; resample the record to solver.record_rate"
            )
        return self._filtered(np.array([run[name] for name in names]))

    def misfit(self, response: Vector, groups: Mapping[str, float], lags: Mapping[str, float]) -> Vector:
        """Return (ym - y(t - d)) over the RMS of ym, (channels, samples); 0 where the run has no value."""
        measured = self.measured()
        delays = self.delays.of(self.recorded, groups, lags)
        residuals = measured - self._delayed(response, delays)
        residuals[np.round(self.kept - delays[:, None] / self.record.step) > self.record.time.size - 1] = 0.0
        return np.asarray(residuals / np.sqrt(np.mean(measured**2, axis=1, keepdims=True)))

    def model_histories(self, model: Car | Run) -> Vector:
        """Return filtered histories of a run or a car in the window, with the known delays; (channels, samples)."""
        return self._delayed(self.response(model), self.delays.of(self.recorded, {}, {}))

    def settled(self, groups: Mapping[str, float]) -> Self:
        """Return the target with known delays of all groups [s]."""
        return replace(self, delays=self.delays.settled(groups))

    def residuals(self, model: Car | Run) -> Vector:
        """Return (ym - y) over the RMS of ym, (channels, samples), with y from `model_histories`."""
        return self.misfit(self.response(model), {}, {})

    def lags(self, model: Car) -> dict[str, PhaseDelay]:
        """Return the lag of best agreement with a car for each channel; only channels with the same motion."""
        lags = {}
        inside, step = np.flatnonzero(self.inside), self.record.step
        measured = self._filtered(np.array(list(self.record.channels.values())))[:, inside]
        for name, values, curve in zip(self.recorded, measured, self.response(model), strict=True):
            shift = time_shift(values, curve, step, -float(self.record.time[inside[0]]))
            if shift is not None and shift.correlation >= SAME_MOTION:
                error = shift.shift_error if np.isfinite(shift.shift_error) else step
                lags[name] = PhaseDelay(delay=-shift.shift, error=error, agreement=shift.correlation)
        return lags

    def _delayed(self, histories: Vector, delays: Vector) -> Vector:
        """Return y(t - d) at the kept samples, by a spline of degree 5; histories (channels, n) are band-limited."""
        rows = []
        for values, delay in zip(histories, delays, strict=True):
            index = np.clip(self.kept - delay / self.record.step, 0.0, values.size - 1)
            rows.append(
                values[self.kept]
                if delay == 0.0
                else scipy.ndimage.map_coordinates(values, index[None], order=5, mode="nearest")
            )
        return np.array(rows)

    def _filtered(self, histories: Vector) -> Vector:
        sections = scipy.signal.butter(4, 2.0 * self.record.step * self.lowpass, output="sos")
        return np.asarray(scipy.signal.sosfiltfilt(sections, histories, axis=1))


def signal_until(signal: Signal, end: float) -> Signal:
    """Return the beginning of a signal up to a time [s]."""
    count = int(np.ceil(end / signal.timestep - 1e-6)) + 1
    if count >= signal.time.size or count < MINIMUM_SAMPLES:
        return signal

    def beginning(columns: Mapping[str, Vector]) -> dict[str, Vector]:
        return {wheel: values[:count] for wheel, values in columns.items()}

    return replace(
        signal,
        time=signal.time[:count],
        displacement=beginning(signal.displacement),
        slope_velocity=beginning(signal.slope_velocity),
        profile=beginning(signal.profile),
    )
