"""Measured time histories that the car shall meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from vehicle.errors import ConfigurationError, DataError
from vehicle.names import channel_units
from vehicle.runs.car import Car, Run
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.records.table import Record

Vector = npt.NDArray[np.float64]

KEPT = 2.0
"""Samples kept for each period of the low-pass frequency: white noise then stays nearly white."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RecordTarget:
    """Time histories of one signal.

    Residuals, one row for each channel: (y - ym) over the RMS of y in the window, both after the same low-pass filter.
    How large the noise of a channel really is the fit finds from the residuals. Without the filter the jumps of an
    acceleration at the end of stick are edges between two samples: most of what the record seems to tell would come
    from single samples, and the sum of squares would be rough where an edge moves across one.

    Attributes:
        name: of the record, for reports.
        signal: plate displacement.
        record: the measured channels, in the units and at the times of the recording of the car.
        window: begin and end of the part that counts [s].
        lowpass: Butterworth low-pass of order 4 forwards and backwards, -6 dB at this frequency [Hz]; two samples are
            kept for each of its periods, so that the noise of neighbours stays nearly independent.
    """

    name: str
    signal: Signal
    record: Record
    window: tuple[float, float]
    lowpass: float = 100.0

    def __post_init__(self) -> None:
        count, step = self.record.time.size, self.record.step
        if not 0.0 < self.lowpass <= 0.4 / step:
            raise ConfigurationError(
                f"{self.name}: found a low-pass of {self.lowpass:g} Hz for {count} samples; allowed is up to 0.4 times "
                "the sampling rate"
            )
        if not self.record.channels:
            raise DataError(f"{self.name}: no time history; give at least one channel")
        for channel, values in self.record.channels.items():
            channel_units([channel])
            if not np.any(values[self.inside]):
                raise DataError(f"{self.name}: {channel} is zero throughout {self.window[0]:g} to {self.window[1]:g} s")

    @property
    def kept(self) -> npt.NDArray[np.int64]:
        """Indices of the samples that count after the filter."""
        every = max(int(1.0 / (KEPT * self.lowpass * self.record.step) + 1e-9), 1)
        return np.flatnonzero(self.inside)[::every]

    @property
    def inside(self) -> npt.NDArray[np.bool_]:
        """Which samples count, (n,)."""
        return np.asarray((self.record.time >= self.window[0]) & (self.record.time <= self.window[1]))

    @property
    def rows(self) -> tuple[str, ...]:
        """What each row of the residuals is."""
        return tuple(f"{self.name}, {channel}" for channel in self.record.channels)

    def measured(self) -> Vector:
        """The filtered data in the window, (channels, samples)."""
        return self._filtered(np.array(list(self.record.channels.values())))

    def model_histories(self, model: Car | Run) -> Vector:
        """Those of a car by the reduced engine, or of a run of the signal, filtered, (channels, samples).

        Raises:
            DataError: the run is not sampled as the data.
        """
        names, time = tuple(self.record.channels), self.record.time
        run = model if isinstance(model, Run) else model.run(self.signal, engine="reduced", channels=names)
        if run.time.size != time.size or abs(run.time[-1] - time[-1]) > 1e-6:
            raise DataError(
                f"{self.name}: {time.size} samples to {time[-1]:g} s, the model gives {run.time.size} to "
                f"{run.time[-1]:g} s; resample the record to solver.record_rate"
            )
        return self._filtered(np.array([run[name] for name in names]))

    def residuals(self, model: Car | Run) -> Vector:
        """(y - ym) over the RMS of y, (channels, samples); ym as of `model_histories`."""
        measured = self.measured()
        return np.asarray(
            (measured - self.model_histories(model)) / np.sqrt(np.mean(measured**2, axis=1, keepdims=True))
        )

    def _filtered(self, histories: Vector) -> Vector:
        sections = scipy.signal.butter(4, 2.0 * self.record.step * self.lowpass, output="sos")
        return np.asarray(scipy.signal.sosfiltfilt(sections, histories, axis=1)[:, self.kept])
