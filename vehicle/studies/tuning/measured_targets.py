"""Targets of a fit from measurement files: FRFs and time histories, with their plate signals."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.runs.comparison.plate_signal import plate_choices, plate_signal
from vehicle.settings import with_settings
from vehicle.signals.analysis.response_name import ResponseName, plates_of
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.channel import uniform_axis
from vehicle.signals.formats.table import Record
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.counterpart import run_times
from vehicle.signals.records.delays import split_delay
from vehicle.signals.records.finding import Finding, FindingError, findings_of
from vehicle.signals.records.measured import Measured, read_measured
from vehicle.signals.records.resampled import at_times
from vehicle.signals.records.run_findings import beside_run
from vehicle.signals.records.settling import settling_time
from vehicle.studies.tuning.fit_result import LEAST_VALUES
from vehicle.studies.tuning.fit_settings import HistorySettings, LevelSettings, ReadingSettings, ResponseSettings
from vehicle.studies.tuning.frf_target import FrfTarget, motions_of, to_driven_plates
from vehicle.studies.tuning.level_target import LevelTarget, level_target
from vehicle.studies.tuning.record_target import KEPT, RecordTarget, RoadCar, signal_until
from vehicle.studies.tuning.response_delays import ResponseDelays, response_delays

LEVEL_WINDOW = 4.0
"""Default length of the windows of classes of the input level [s]: four periods at 1 Hz, and short enough for the level
of a road to be nearly constant."""

AFTER = 5.0
"""Length of the run after the compared part, in periods of the low-pass frequency: the filter then forgets to 1e-5."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredTarget:
    """Target of a fit with the plate signal of the measurement and the notices on the file.

    Stuck dampers need no signal: their FRFs follow from the linear car.
    """

    target: FrfTarget | RecordTarget | LevelTarget
    signal: Signal | None
    notices: tuple[str, ...] = ()


@with_settings(ResponseSettings)
def measured_responses(car: Car, file: Path | str, settings: ResponseSettings) -> MeasuredTarget:
    """Read measured FRFs of one excitation level as a target of a fit.

    Args:
        car: the car, with the channel names of the model.
        file: measurement file of any format, with FRFs, or with time histories of accelerations and their plate.

    Returns:
        The target; without a measured coherence all lines have equal weights.

    Raises:
        ConfigurationError: the file does not exist, or the model lacks a channel.
        DataError: bad data, no FRF, or too few frequencies.
    """
    path = Path(file)
    signal = settings.signal
    if isinstance(signal, Road):
        raise ConfigurationError(
            f"{path}: contains FRFs, which need the signal of a plate, but a road is given; give --signal FILE, "
            "or time histories"
        )
    asked, plates = plate_choices(_asked(settings), path, signal)
    measured = _read(car, path, asked, settings.inverted, settings.window)
    frf = measured.frf
    if frf is None:
        raise DataError(
            f"{path}: contains no FRFs, and no plate with accelerations to estimate FRFs from; for time histories use "
            "--record FILE"
        )
    data = frf.select(tuple(settings.fitted) or frf.channels, band=settings.band, spacing=settings.spacing)
    unknown = ~np.isfinite(data.coherence).any(axis=1, keepdims=True)
    data.coherence[:] = np.where(unknown, 1.0, data.coherence)
    driving = None if settings.stuck else plate_signal(signal, car, path, measured, asked, settings.inverted, plates)
    if driving is not None:
        data = to_driven_plates(data, motions_of(driving), str(path))
    else:
        shaker = plates_of({car.vehicle.shaker_wheel: 1.0})
        data = data.renamed([name if name.motion else ResponseName(name.output, shaker) for name in data.names])
    sample = 0.0 if not measured.estimator or measured.record is None else measured.record.step
    delays = response_delays(measured, tuple(dict.fromkeys(data.channels)), asked.delays, contained=signal is None)
    target = FrfTarget(
        name=path.stem,
        data=data,
        signal=driving,
        window=settings.window,
        averages=settings.averages,
        delays=delays,
        sample=sample,
    )
    findings: tuple[Finding, ...] = ()
    if measured.record is not None and driving is not None and signal is None:
        record, times = measured.record, measured.record.time - measured.record.time[0]
        run = car.run(driving, engine="reduced", channels=tuple(record.channels), stated_errors=False)
        findings = _findings(measured, record, run, times, delays, contained=True)
    return MeasuredTarget(target=target, signal=driving, notices=_notices(path, measured, findings))


@with_settings(HistorySettings)
def measured_histories(car: Car, file: Path | str, settings: HistorySettings) -> MeasuredTarget:
    """Read measured time histories as a target of a fit, at the times of a run.

    Args:
        car: car at the start of the fit; a run of this car shows wrong clocks, signs and units of the file.
        file: measurement file of any format with time histories.

    Returns:
        The target.

    Raises:
        ConfigurationError: the file does not exist, the model lacks a channel, or the low-pass is out of range.
        DataError: bad data, no time history, no plate signal, no overlap with the signal, or a record that is too
            short.
    """
    target, notices = _histories(car, file, settings)
    return MeasuredTarget(target=target, signal=target.signal, notices=notices)


@with_settings(LevelSettings)
def measured_levels(car: Car, file: Path | str, settings: LevelSettings) -> MeasuredTarget:
    """Read measured time histories as FRFs in classes of the input level, see `LevelTarget`.

    Args:
        car, file: see `measured_histories`.

    Raises:
        ConfigurationError, DataError: see `measured_histories` and `level_target`; an unknown reference.
    """
    target, notices = _histories(car, file, settings, keep=settings.reference)
    wheels = target.signal.wheels
    wheel = car.vehicle.shaker_wheel if car.vehicle.shaker_wheel in wheels else wheels[0]
    reference = settings.reference or f"plate_{wheel}_displacement"
    plates = [f"plate_{name}_displacement" for name in wheels]
    if reference not in (*plates, *target.record.channels):
        raise ConfigurationError(
            f"--reference {reference}: must be one of {', '.join([*plates, *target.record.channels])}"
        )
    # The plates are the input, without noise: the same in a run of any car.
    if reference in target.record.channels:  # the delay of its group is not fitted
        reference_group = target.delays.fitted.get(reference)
        others = {name: group for name, group in target.delays.fitted.items() if group != reference_group}
        target = replace(target, delays=replace(target.delays, fitted=others))
    front = [name for name in plates if name[len("plate_")] == wheel[0]]
    run = target.run(car, channels=list(dict.fromkeys([*front, *(name for name in plates if name == reference)])))
    excitation = target.record.channels[reference] if reference in target.record.channels else run[reference]
    classes = level_target(
        target,
        reference,
        np.asarray(excitation),
        np.array([run[name] for name in front]),
        levels=settings.levels or 0,
        window=settings.window or LEVEL_WINDOW,
        band=settings.band,
        spacing=settings.spacing,
    )
    return MeasuredTarget(target=classes, signal=target.signal, notices=notices)


def _histories(
    car: Car, file: Path | str, settings: HistorySettings, keep: str | None = None
) -> tuple[RecordTarget, tuple[str, ...]]:
    """Return the target of `measured_histories`, which also reads the channel `keep`, and the notices."""
    path, contained, stretch, lowpass = Path(file), settings.signal is None, settings.stretch, settings.lowpass
    begin, _ = split_delay(settings.delay)
    asked, plates = plate_choices(_asked(settings), path, settings.signal)
    measured = _read(car, path, asked, settings.inverted, None, histories_only=True)
    held = _compared_channels(path, measured.record, settings.fitted, keep)
    names, step = list(held.channels), 1.0 / car.vehicle.solver.record_rate
    if contained and (begin, settings.drift) != (0.0, 0.0):
        raise ConfigurationError(
            f"{path}: --delay S and --drift align the clock with a signal from another file, but this record contains "
            "the plate signal. Remove both, or add --signal FILE; --delay GROUP=TIME is for sensors that lag the "
            "plate"
        )
    signal, road, settled = _driven_input(car, path, measured, asked, settings, plates)
    delays = response_delays(measured, tuple(names), asked.delays, contained=contained)
    grid = uniform_axis(int(signal.duration / step + 1e-6) + 1, step)
    times = run_times(held, begin, settings.drift, float(held.time[0]) if contained else measured.start)
    inside = np.flatnonzero((grid >= times[0] - 1e-9) & (grid <= times[-1] + 1e-9))
    if inside.size < 3:
        raise DataError(
            f"{path}: measured from {times[0]:.6g} to {times[-1]:.6g} s of the signal {signal.source}, which "
            f"ends at {signal.duration:.6g} s, so they do not overlap; set --delay S, which is added to the "
            "measured times"
        )
    window, more = (float(grid[inside[0]]), float(grid[inside[-1]])), list[str]()
    if stretch is not None:
        # From the times of the file to the times of the signal.
        asked_for = [float(times[0] + (t - held.time[0]) * (1.0 + settings.drift)) for t in stretch]
        if asked_for[0] >= window[1] or asked_for[1] <= window[0]:
            raise DataError(
                f"{path}: --stretch {stretch[0]:g}:{stretch[1]:g} is outside the record, which has "
                f"{held.time[0]:.6g} to {held.time[-1]:.6g} s; set times of the file"
            )
        window = (max(asked_for[0], window[0]), min(asked_for[1], window[1]))
    elif settled > window[0]:
        window = (settled, window[1])
        more = [f"begins in motion: the first {settled:g} s are left out; --stretch FROM:TO sets other times"]
    length, shortest = max(window[1] - window[0], 0.0), LEAST_VALUES / (KEPT * lowpass)
    if length < shortest:
        raise DataError(
            f"{path}: {length:.3g} s of the record are evaluated, but at least {shortest:.3g} s are needed "
            f"({LEAST_VALUES} independent values below {lowpass:g} Hz); use a longer record or --stretch FROM:TO"
        )
    signal = signal_until(signal, window[1] + AFTER / lowpass)
    count = int(signal.duration / step + 1e-6) + 1
    histories = {}
    for channel, values in held.channels.items():
        on_grid = at_times(times, values, grid[inside], step)
        histories[channel] = np.interp(np.arange(count), inside, on_grid)  # constant outside the window: excluded
    target = RecordTarget(
        name=path.stem, signal=signal, record=Record(time=grid[:count], channels=histories, units=held.units),
        window=window, lowpass=lowpass, road=road, delays=delays, sample=held.step,
    )  # fmt: skip
    judged = measured.record if contained and measured.record is not None else held
    run = target.run(car, channels=tuple(judged.channels))
    findings = _findings(
        measured, judged, run, times, target.delays, contained=contained, begin=begin, drift=settings.drift
    )
    if any(each.options for each in findings if each.kind in ("gravity", "offset")):  # a car has no mean acceleration
        raise FindingError(path, findings)
    return target, _notices(path, measured, [*more, *findings])


def _compared_channels(path: Path, record: Record | None, fitted: Sequence[str], keep: str | None) -> Record:
    """Return a record with the channels that are compared: all but plates, or the ones chosen by --channels."""
    names = [] if record is None else [channel for channel in record.channels if not channel.startswith("plate_")]
    if record is None or not names:
        raise DataError(f"{path}: contains no time history except of plates; name channels with --map CHANNEL=NAME")
    chosen = [channel for channel in names if channel in (*fitted, keep)] if fitted else names
    if not chosen:
        raise DataError(f"{path}: contains no time history of --channels {','.join(fitted)}; found {', '.join(names)}")
    return Record(
        time=record.time,
        channels={channel: record.channels[channel] for channel in chosen},
        units={channel: record.units[channel] for channel in chosen},
    )


def _driven_input(
    car: Car, path: Path, measured: Measured, asked: Choice, settings: HistorySettings, plates: Choice | None
) -> tuple[Signal, RoadCar | None, float]:
    """Return the signal of the plates, the car on its road, and the time after which the run follows the record [s]."""
    if isinstance(settings.signal, Road):
        drive = settings.signal.under(car.vehicle, car.overrides)
        return drive.signal(), RoadCar(start=car, rolling=car.with_(drive.overrides)), drive.skip
    signal = plate_signal(settings.signal, car, path, measured, asked, settings.inverted, plates)
    return signal, None, settling_time(signal.notices) if settings.signal is None else 0.0


def _findings(
    measured: Measured, record: Record, run: Run, times: Vector, delays: ResponseDelays, *, contained: bool,
    begin: float = 0.0, drift: float = 0.0,
) -> tuple[Finding, ...]:  # fmt: skip
    """Return the findings on a record, also against a run of the car at the start of the fit.

    The plates of a file have its clock. A delay of sensors is an unknown of the fit, and no finding.
    """
    simulated = Record(time=run.time, channels=run.recording.channels, units=run.recording.units)
    lags = dict(zip(record.channels, delays.of(list(record.channels), {}, {}).tolist(), strict=True))
    beside = beside_run(measured, record, simulated, times, delay=begin, drift=drift, sensor_delays=lags)
    findings = [*findings_of(measured.notices), *beside.findings]
    fitted = ("delay", "clock") if contained else ("delay",)
    return tuple(each for each in findings if each.kind not in fitted)


def _asked(settings: ReadingSettings) -> Choice:
    """Return the choice with further channels and delays."""
    asked, delays = settings.choice or Choice(), split_delay(settings.delay)[1]
    return replace(asked, channels={**asked.channels, **(settings.channels or {})}, delays={**asked.delays, **delays})


def _read(
    car: Car,
    file: Path,
    asked: Choice,
    inverted: Collection[str],
    window: float | None,
    *,
    histories_only: bool = False,
) -> Measured:
    """Return the chosen channels of a file under the names of the model."""
    model_channels = (*car.vehicle.channels, *car.vehicle.load_channels)
    asked = replace(asked, delays={})  # the model is delayed instead of the measurement
    return read_measured(file, model_channels, asked, inverted=inverted, window=window, histories_only=histories_only)


def _notices(file: Path, measured: Measured, more: Sequence[str]) -> tuple[str, ...]:
    """Return the notices of reading a file and further notices, with the file name in front."""
    return tuple(
        text.within(f"{file.name}: ") if isinstance(text, Finding) else f"{file.name}: {text}"
        for text in dict.fromkeys((*measured.notices, *more))
    )
