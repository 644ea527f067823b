"""Targets of a fit from measurement files: FRFs and time histories, with their plate signals."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vehicle.errors import DataError
from vehicle.runs.car import Car
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.excitation.signal_file import read_signal
from vehicle.signals.records.channel import uniform_axis
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.counterpart import clock_advice, counterparts, run_times, sign_and_unit
from vehicle.signals.records.measured import Measured, read_measured
from vehicle.signals.records.resampled import at_times
from vehicle.signals.records.table import Record
from vehicle.studies.tuning.frf_target import FrfTarget
from vehicle.studies.tuning.record_target import RecordTarget

BAND = (3.0, 45.0)
"""Default band of a fit [Hz]: shaker signals excite the car well above 3 Hz, and the body model ends at 43 Hz."""

SPACING = 0.3
"""Default distance of the fitted frequencies [Hz]: a record of 60 s has 17 lines of 1/60 Hz in this distance, from
which the FRF is estimated."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredTarget:
    """Target of a fit with the plate signal of the measurement and the notices on the file."""

    target: FrfTarget | RecordTarget
    signal: Signal
    notices: tuple[str, ...] = ()


def measured_responses(
    car: Car,
    file: Path | str,
    signal: Signal | Path | str,
    channels: Mapping[str, str] | None = None,
    *,
    stuck: bool = False,
    choice: Choice | None = None,
    inverted: Collection[str] = (),
    fitted: Sequence[str] = (),
    band: tuple[float, float] = BAND,
    spacing: float = SPACING,
    window: float | None = None,
) -> MeasuredTarget:
    """Read measured FRFs of one excitation level as a target of a fit.

    Args:
        car: the car, with the channel names of the model.
        file: measurement file of any format, with FRFs, or with time histories of accelerations and their plate.
        signal: plate displacement of the measurement: a signal, a file, or the name of a shipped file.
        channels: channel of the model to channel of the file; by default equal names.
        stuck: True if the dampers stick at this level: the FRFs of the linear car follow from its matrices.
        choice: units, rate and excerpt of the file.
        inverted: channels measured with the opposite sign.
        fitted: channels to be fitted; by default all of `channels`.
        band: lowest and highest frequency [Hz].
        spacing: minimum distance of the frequencies [Hz].
        window: length of the Hann windows of the estimate [s]; by default the whole record is evaluated.

    Returns:
        The target; without a measured coherence all lines have equal weights.

    Raises:
        ConfigurationError: the file does not exist, or the model lacks a channel.
        DataError: bad data, no FRF, or too few frequencies.
    """
    path = Path(file)
    measured = _read(car, path, channels, choice, inverted, window)
    frf = measured.frf
    if frf is None:
        raise DataError(
            f"{path}: contains no FRFs, and no plate with accelerations to estimate FRFs from; for time histories use "
            "--record FILE --signal FILE"
        )
    data = frf.select(tuple(fitted) or frf.channels, band=band, spacing=spacing)
    unknown = ~np.isfinite(data.coherence).any(axis=1, keepdims=True)
    data.coherence[:] = np.where(unknown, 1.0, data.coherence)
    plate_signal = _signal(signal, car)
    target = FrfTarget(name=path.stem, data=data, signal=plate_signal, window=window, wheel=plate_signal.wheels[0])
    if stuck:
        target = replace(target, signal=None)
    return MeasuredTarget(target=target, signal=plate_signal, notices=_notices(path, measured, []))


def measured_histories(
    car: Car,
    file: Path | str,
    signal: Signal | Path | str,
    channels: Mapping[str, str] | None = None,
    *,
    choice: Choice | None = None,
    inverted: Collection[str] = (),
    fitted: Sequence[str] = (),
    delay: float = 0.0,
    drift: float = 0.0,
    stretch: tuple[float, float] | None = None,
    lowpass: float = 100.0,
    window: float | None = None,
) -> MeasuredTarget:
    """Read measured time histories as a target of a fit, at the times of a run.

    Args:
        car: car at the start of the fit; a run of this car shows wrong clocks, signs and units of the file.
        file: measurement file of any format with time histories.
        signal: plate displacement: a signal, a file, or the name of a shipped file.
        channels, choice, inverted: see `measured_responses`.
        fitted: channels to be fitted; by default all except plates.
        delay: start of the record after the start of the signal [s].
        drift: relative lag of the clock of the record [-].
        stretch: begin and end of the included part of the signal [s]; by default the measured part.
        lowpass: maximum frequency of the comparison of model and measurement [Hz].
        window: see `measured_responses`; used if the file also contains FRFs.

    Returns:
        The target.

    Raises:
        ConfigurationError: the file does not exist, the model lacks a channel, or the low-pass is out of range.
        DataError: bad data, no time history, or no overlap with the signal.
    """
    path, source = Path(file), signal
    measured, signal = _read(car, path, channels, choice, inverted, window), _signal(source, car)
    held = None if measured.record is None else measured.record
    names = [] if held is None else [channel for channel in held.channels if not channel.startswith("plate_")]
    if held is None or not names:
        raise DataError(f"{path}: contains no time history except that of a plate; choose with --map CHANNEL=NAME")
    if fitted:
        there = ", ".join(names)
        names = [channel for channel in names if channel in fitted]
        if not names:
            raise DataError(f"{path}: contains no time history of --channel {' '.join(fitted)}; found {there}")
    step = 1.0 / car.vehicle.solver.record_rate
    grid = uniform_axis(int(signal.duration / step + 1e-6) + 1, step)
    times = run_times(held, delay, drift, measured.start)
    inside = np.flatnonzero((grid >= times[0] - 1e-9) & (grid <= times[-1] + 1e-9))
    if inside.size < 3:
        name = source if isinstance(source, str) else signal.source
        raise DataError(
            f"{path}: measured from {times[0]:.6g} to {times[-1]:.6g} s of the signal {name}, which ends at "
            f"{signal.duration:.6g} s: no overlap; set --delay S, which is added to the measured times"
        )
    histories = {}
    for channel in names:
        values = at_times(times, held.channels[channel], grid[inside], step)
        histories[channel] = np.interp(np.arange(grid.size), inside, values)  # constant outside the window: excluded
    window_s = (float(grid[inside[0]]), float(grid[inside[-1]]))
    if stretch is not None:
        window_s = (max(stretch[0], window_s[0]), min(stretch[1], window_s[1]))
    units = {channel: held.units[channel] for channel in names}
    record = Record(time=grid, channels=histories, units=units)
    target = RecordTarget(name=path.stem, signal=signal, record=record, window=window_s, lowpass=lowpass)
    # A run with the start values shows errors of clock, signs and units of the measurement.
    run = car.run(signal, engine="reduced", channels=names)
    parts = counterparts(
        Record(time=held.time, channels={channel: held.channels[channel] for channel in names}, units=units),
        Record(time=run.time, channels=run.recording.channels, units=run.recording.units),
        times,
    )
    advice = [*clock_advice(parts, step, delay, drift), *sign_and_unit(parts)]
    return MeasuredTarget(target=target, signal=signal, notices=_notices(path, measured, advice))


def _read(
    car: Car,
    file: Path,
    channels: Mapping[str, str] | None,
    choice: Choice | None,
    inverted: Collection[str],
    window: float | None,
) -> Measured:
    """Return the chosen channels of a file under the names of the model."""
    model_channels = (*car.vehicle.channels, *car.vehicle.load_channels)
    asked = choice or Choice()
    asked = replace(asked, channels={**asked.channels, **(channels or {})})
    return read_measured(file, model_channels, asked, inverted=inverted, window=window)


def _signal(source: Signal | Path | str, car: Car) -> Signal:
    """Return a signal; read a file with one plate for the shaker wheel; a name without suffix is a shipped file."""
    if isinstance(source, Signal):
        return source
    return read_signal(find_input(source if "." in str(source) else f"{source}.csv"), wheel=car.vehicle.shaker_wheel)


def _notices(file: Path, measured: Measured, more: Sequence[str]) -> tuple[str, ...]:
    """Return the notices of reading a file and further ones, each with the file name in front."""
    return tuple(f"{file.name}: {text}" for text in (*measured.notices, *more))
