"""Targets of a fit from files of the user: FRFs and time histories of any format, and the signals that go with them."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from scenarios.tuning.data import CHANNELS, Measurement, driven_channels
from vehicle.car import Car
from vehicle.commands.compare import clock_of, measured_choice
from vehicle.errors import ConfigurationError, DataError
from vehicle.excitation.input_files import find_input
from vehicle.excitation.signal import Signal
from vehicle.excitation.signal_file import read_signal
from vehicle.parameters.idle import idle_parameters
from vehicle.parameters.paths import full_path
from vehicle.parameters.ranges import Range
from vehicle.parameters.vehicle import Vehicle
from vehicle.records.channel import uniform_axis
from vehicle.records.counterpart import clock_advice, counterparts, run_times, sign_and_unit
from vehicle.records.measured import Measured, read_measured
from vehicle.records.resampled import at_times
from vehicle.records.table import Record
from vehicle.tuning.frf_target import FrfTarget
from vehicle.tuning.record_target import RecordTarget

STUCK = "low"
"""Level at which the dampers stay stuck, so that the car is linear."""


def own_measurements(options: argparse.Namespace, car: Car) -> list[Measurement]:
    """Targets of the options --frf with --level, and --record with --signal.

    Args:
        options: of the study.
        car: tells the names of the channels, and the rate of its records.

    Raises:
        ConfigurationError: not one level or signal for each file, a band that is none, or a signal that does not exist.
        DataError: a file holds bad data.
    """
    for files, others, words in (
        (options.frf, options.level, "--frf and {} --level; each file of FRFs needs its level: " + repr(STUCK)),
        (options.record, options.signal, "--record and {} --signal; each file of time histories needs its signal"),
    ):
        if len(files) != len(others):
            raise ConfigurationError(
                f"found {len(files)} {words.format(len(others))}, or the displacement signal it was measured with"
                if files is options.frf
                else f"found {len(files)} {words.format(len(others))}: the displacement of the plate"
            )
    band = _numbers("--band", options.band, "LOW:HIGH in Hz, as in 3:45", least=1e-9)
    return [
        *(_responses(options, car, file, level, band) for file, level in zip(options.frf, options.level, strict=True)),
        *(_history(options, car, file, name) for file, name in zip(options.record, options.signal, strict=True)),
    ]


def _notices(file: Path, measured: Measured, more: list[str]) -> tuple[str, ...]:
    """What is odd about a file, with its name."""
    return tuple(f"{file.name}: {text}" for text in (*measured.notices, *more))


def _read(options: argparse.Namespace, car: Car, file: Path) -> Measured:
    known = (*car.vehicle.channels, *car.vehicle.load_channels)
    return read_measured(file, known, measured_choice(options), turned=options.turned, window=options.window)


def _signal(car: Car, name: str) -> Signal:
    return read_signal(find_input(name if "." in name else f"{name}.csv"), wheel=car.vehicle.shaker_wheel)


def _responses(options: argparse.Namespace, car: Car, file: Path, level: str, band: tuple[float, float]) -> Measurement:
    """FRFs of one level; where the file tells no coherence, all lines count alike."""
    measured = _read(options, car, file)
    found = measured.frf
    if found is None:
        raise DataError(
            f"{file}: holds no FRFs, and no plate beside accelerations to estimate them from; for time histories give "
            "--record FILE --signal FILE"
        )
    asked = tuple(options.channel) or (
        found.channels if options.mapping else driven_channels(CHANNELS, car.vehicle.shaker_wheel)
    )
    data = found.select(asked, band=band, spacing=options.spacing)
    untold = ~np.isfinite(data.coherence).any(axis=1, keepdims=True)
    data.coherence[:] = np.where(untold, 1.0, data.coherence)
    signal = _signal(car, level)
    target = FrfTarget(
        name=file.stem,
        data=data,
        signal=None if level == STUCK else signal,
        wheel=car.vehicle.shaker_wheel,
        window=options.window,
    )
    return Measurement(target=target, signal=signal, notices=_notices(file, measured, []))


def _history(options: argparse.Namespace, car: Car, file: Path, name: str) -> Measurement:
    """Time histories of one signal at the times of a run; what counts is what both have."""
    measured, signal = _read(options, car, file), _signal(car, name)
    held = None if measured.record is None else measured.record
    names = [] if held is None else [one for one in held.channels if not one.startswith("plate_")]
    if held is None or not names:
        raise DataError(f"{file}: holds no time history beside that of a plate; choose with --map CHANNEL=NAME")
    if options.channel:
        there = ", ".join(names)
        names = [one for one in names if one in options.channel]
        if not names:
            raise DataError(f"{file}: holds no time history of --channel {' '.join(options.channel)}; found {there}")
    step = 1.0 / car.vehicle.solver.record_rate
    grid = uniform_axis(int(signal.duration / step + 1e-6) + 1, step)
    delay, drift = clock_of(options)
    times = run_times(held, delay, drift, measured.start)
    inside = np.flatnonzero((grid >= times[0] - 1e-9) & (grid <= times[-1] + 1e-9))
    if inside.size < 3:
        raise DataError(
            f"{file}: measured from {times[0]:.6g} to {times[-1]:.6g} s of the signal {name}, which ends at "
            f"{signal.duration:.6g} s: nothing in common; give --delay S, which is added to the measured times"
        )
    histories = {}
    for one in names:
        values = at_times(times, held.channels[one], grid[inside], step)
        histories[one] = np.interp(np.arange(grid.size), inside, values)  # constant beyond: it does not count
    window = (float(grid[inside[0]]), float(grid[inside[-1]]))
    if options.stretch:
        low, high = _numbers("--stretch", options.stretch, "FROM:TO in s, as in 4.9:6.5", least=0.0)
        window = (max(low, window[0]), min(high, window[1]))
    units = {one: held.units[one] for one in names}
    record = Record(time=grid, channels=histories, units=units)
    target = RecordTarget(name=file.stem, signal=signal, record=record, window=window, lowpass=options.lowpass)
    # The car where the fit begins tells the clock, the signs and the units of the measurement.
    run = car.run(signal, engine="reduced", channels=names)
    parts = counterparts(
        Record(time=held.time, channels={one: held.channels[one] for one in names}, units=units),
        Record(time=run.time, channels=run.recording.channels, units=run.recording.units),
        times,
    )
    said = [*clock_advice(parts, step, delay, drift), *sign_and_unit(parts)]
    return Measurement(target=target, signal=signal, notices=_notices(file, measured, said))


def check_parameters(parameters: tuple[Range, ...], vehicle: Vehicle) -> None:
    """Refuse parameters that do nothing, and bounds within which no such damper can be.

    Args:
        parameters: to be fitted.
        vehicle: the car.

    Raises:
        ConfigurationError: a parameter of a law that is off, or a friction at rest that may fall below that of sliding.
    """
    idle = idle_parameters(vehicle, [f"{one.path}={one.start!r}" for one in parameters])
    if idle:
        raise ConfigurationError(f"--fit {idle[0]}; give --set with it")
    whole = {full_path(vehicle.table, one.path): one for one in parameters}
    for path, static in whole.items():
        sliding = whole.get(path.removesuffix("stribeck_friction") + "coulomb_friction")
        if path.endswith(".stribeck_friction") and sliding is not None and static.low < sliding.high:
            raise ConfigurationError(
                f"--fit {static.path}={static.low:g}:{static.high:g}: the friction at rest must stay at or above that "
                f"of sliding, {sliding.path}={sliding.low:g}:{sliding.high:g}; give bounds that do not overlap"
            )


def _numbers(option: str, text: str, needed: str, *, least: float) -> tuple[float, float]:
    try:
        low, high = (float(part) for part in text.split(":"))
    except ValueError:
        low, high = 1.0, 0.0
    if not least <= low < high:
        raise ConfigurationError(f"{option} {text}: needed is {needed}")
    return low, high
