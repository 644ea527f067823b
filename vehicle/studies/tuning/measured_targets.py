"""Targets of a fit from measurement files: frequency responses and time histories, with the signals behind them."""

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
"""Default band of a fit [Hz]: shaker signals drive the car well from 3 Hz on, and its body model ends at 43 Hz."""

SPACING = 0.3
"""Default distance of the fitted frequencies [Hz]: 17 lines of 1/60 Hz, from which an estimate of 60 s is made."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredTarget:
    """Target of a fit, the signal it was measured with, and messages on the file."""

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
    turned: Collection[str] = (),
    fitted: Sequence[str] = (),
    band: tuple[float, float] = BAND,
    spacing: float = SPACING,
    window: float | None = None,
) -> MeasuredTarget:
    """Read measured FRFs of one excitation level as a target of a fit.

    Args:
        car: its channels are the names of the model.
        file: FRFs, or accelerations with their plate as time histories, of any format.
        signal: displacement that they were measured with; a file, or the name of a shipped one.
        channels: channel of the model to channel of the file; by default equal names.
        stuck: the dampers stick at this level: the linear car is compared, straight from its matrices.
        choice: units, rate and excerpt of the file.
        turned: channels that were measured in the other direction.
        fitted: channels that count; by default all of `channels`.
        band: lowest and highest frequency [Hz].
        spacing: minimum distance of the frequencies [Hz].
        window: length of the Hann windows of the estimate [s]; by default the local rational model.

    Returns:
        The target; without a measured coherence all lines count alike.

    Raises:
        ConfigurationError: no such file, or a channel that the model does not have.
        DataError: bad data, no FRF, or too few frequencies.
    """
    path = Path(file)
    measured = _read(car, path, channels, choice, turned, window)
    found = measured.frf
    if found is None:
        raise DataError(
            f"{path}: holds no FRFs, and no plate beside accelerations to estimate them from; for time histories give "
            "--record FILE --signal FILE"
        )
    data = found.select(tuple(fitted) or found.channels, band=band, spacing=spacing)
    unknown = ~np.isfinite(data.coherence).any(axis=1, keepdims=True)
    data.coherence[:] = np.where(unknown, 1.0, data.coherence)
    given = _signal(signal, car)
    target = FrfTarget(name=path.stem, data=data, signal=given, window=window, wheel=given.wheels[0])
    if stuck:
        target = replace(target, signal=None)
    return MeasuredTarget(target=target, signal=given, notices=_notices(path, measured, []))


def measured_histories(
    car: Car,
    file: Path | str,
    signal: Signal | Path | str,
    channels: Mapping[str, str] | None = None,
    *,
    choice: Choice | None = None,
    turned: Collection[str] = (),
    fitted: Sequence[str] = (),
    delay: float = 0.0,
    drift: float = 0.0,
    stretch: tuple[float, float] | None = None,
    lowpass: float = 100.0,
    window: float | None = None,
) -> MeasuredTarget:
    """Read measured time histories as a target of a fit, at the times of a run.

    Args:
        car: car at the start of the fit; it tells wrong clocks, signs and units of the file.
        file: time histories, of any format.
        signal: displacement of the plate; a file, or the name of a shipped one.
        channels, choice, turned: as in `measured_responses`.
        fitted: channels that count; by default all but those of plates.
        delay: the record began this long after the signal [s].
        drift: the clock of the record is slow by this share [-].
        stretch: part of the signal that counts, from and to [s]; by default all that was measured.
        lowpass: model and measurement are compared below this frequency [Hz].
        window: as in `measured_responses`, where the file has FRFs too.

    Returns:
        The target.

    Raises:
        ConfigurationError: no such file, a channel that the model does not have, or a low-pass out of range.
        DataError: bad data, no time history, or nothing in common with the signal.
    """
    path, source = Path(file), signal
    measured, signal = _read(car, path, channels, choice, turned, window), _signal(source, car)
    held = None if measured.record is None else measured.record
    names = [] if held is None else [one for one in held.channels if not one.startswith("plate_")]
    if held is None or not names:
        raise DataError(f"{path}: holds no time history beside that of a plate; choose with --map CHANNEL=NAME")
    if fitted:
        there = ", ".join(names)
        names = [one for one in names if one in fitted]
        if not names:
            raise DataError(f"{path}: holds no time history of --channel {' '.join(fitted)}; found {there}")
    step = 1.0 / car.vehicle.solver.record_rate
    grid = uniform_axis(int(signal.duration / step + 1e-6) + 1, step)
    times = run_times(held, delay, drift, measured.start)
    inside = np.flatnonzero((grid >= times[0] - 1e-9) & (grid <= times[-1] + 1e-9))
    if inside.size < 3:
        name = source if isinstance(source, str) else signal.source
        raise DataError(
            f"{path}: measured from {times[0]:.6g} to {times[-1]:.6g} s of the signal {name}, which ends at "
            f"{signal.duration:.6g} s: nothing in common; give --delay S, which is added to the measured times"
        )
    histories = {}
    for one in names:
        values = at_times(times, held.channels[one], grid[inside], step)
        histories[one] = np.interp(np.arange(grid.size), inside, values)  # constant beyond: it does not count
    window_s = (float(grid[inside[0]]), float(grid[inside[-1]]))
    if stretch is not None:
        window_s = (max(stretch[0], window_s[0]), min(stretch[1], window_s[1]))
    units = {one: held.units[one] for one in names}
    record = Record(time=grid, channels=histories, units=units)
    target = RecordTarget(name=path.stem, signal=signal, record=record, window=window_s, lowpass=lowpass)
    # The car where the fit begins tells the clock, the signs and the units of the measurement.
    run = car.run(signal, engine="reduced", channels=names)
    parts = counterparts(
        Record(time=held.time, channels={one: held.channels[one] for one in names}, units=units),
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
    turned: Collection[str],
    window: float | None,
) -> Measured:
    """Return the chosen channels of a file under the names of the model."""
    known = (*car.vehicle.channels, *car.vehicle.load_channels)
    asked = choice or Choice()
    asked = replace(asked, channels={**asked.channels, **(channels or {})})
    return read_measured(file, known, asked, inverted=turned, window=window)


def _signal(source: Signal | Path | str, car: Car) -> Signal:
    """Return a signal, a file of one plate under the shaker wheel; a name without an ending is a shipped file."""
    if isinstance(source, Signal):
        return source
    return read_signal(find_input(source if "." in str(source) else f"{source}.csv"), wheel=car.vehicle.shaker_wheel)


def _notices(file: Path, measured: Measured, more: Sequence[str]) -> tuple[str, ...]:
    """Return the messages on a file, with its name."""
    return tuple(f"{file.name}: {text}" for text in (*measured.notices, *more))
