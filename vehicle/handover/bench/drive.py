"""Input of the bench: a short excerpt of a signal or a road, and inputs with random phases for its FRFs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car, Road
from vehicle.runs.car.road import Drive
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.phase_averages import PhaseInputs, phase_inputs
from vehicle.signals.excitation.road_drive import BEFORE_S, RoadDrive
from vehicle.signals.excitation.signal import Signal, uniform_time

SECONDS = 10.0
"""Default length of the evaluated excerpt [s]."""

SHORTEST, LONGEST = 5.0, 60.0
"""Limits of the length [s]: longer than a period of the FRF, and two updates a second."""

RISE = 2.0
"""Time before an excerpt from the middle of a record [s], in which the plates rise and the car settles."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BenchDrive:
    """Input of the bench."""

    record: Signal  # excerpt, with the time before it
    skip: float  # time before the evaluated excerpt [s]
    inputs: PhaseInputs  # inputs of the FRFs, with the density of the excerpt
    probe: Signal  # the same as a signal
    overrides: tuple[str, ...]  # parameters that the input sets on its car: the speed of rolling tyres
    road: Mapping[str, object] | None  # description of the road for files of a run; None for a signal
    label: str  # description of the input
    speed: float | None = None  # speed on the road [m/s]; None for a signal
    # time in the record at which the moving picture begins [s]: the evaluated part, or an obstacle in it
    shown: float = 0.0
    # source, drive: the road with its length, and the drive of a car over it; None for a signal
    source: Road | None = None
    drive: Drive | None = None

    def under(self, car: Car) -> BenchDrive:
        """Return the input of a variant of the car: on a road, its wheels may be at other points.

        Args:
            car: variant of the car, with the overrides of the input.
        """
        if self.source is None:
            return self
        drive = self.source.under(car.vehicle, [text for text in car.overrides if text not in self.overrides])
        return self if drive == self.drive else _road_drive(self.source, drive, self.inputs.time_step)


def bench_drive(car: Car, source: Signal | Road, *, begin: float = 0.0, seconds: float | None = None) -> BenchDrive:
    """Return the input of the bench for a signal or a road.

    In the inputs of the FRFs all plates move alike, on a road each axle after its delay, x / V.

    Args:
        source: plate displacements, or a road.
        begin: begin of the excerpt of a signal [s].
        seconds: length of the evaluated excerpt [s]; by default `SECONDS`, and to 3 s after an obstacle.

    Raises:
        ConfigurationError: a length or a begin out of range, or a recorded road.
        DataError: the signal is too short, or no plate moves.
    """
    if seconds is not None and not SHORTEST <= seconds <= LONGEST:
        raise ConfigurationError(f"--seconds {seconds:g}: must be {SHORTEST:g} to {LONGEST:g} s")
    interval = 1.0 / car.vehicle.solver.record_rate
    if isinstance(source, Road):
        if isinstance(source.speed, str):
            raise ConfigurationError("bench: a road recorded over time has no constant speed; use a class or a profile")
        drive = source.under(car.vehicle, car.overrides)
        if source.duration is not None and seconds is not None:
            raise ConfigurationError(f"--seconds {seconds:g}: --duration {source.duration:g} sets the length; omit one")
        if source.duration is not None and not SHORTEST <= source.duration - drive.skip <= LONGEST:
            raise ConfigurationError(
                f"--duration {source.duration:g}: must be {SHORTEST + drive.skip:g} to {LONGEST + drive.skip:g} s, of "
                f"which the first {drive.skip:g} s are not evaluated"
            )
        if source.duration is None:
            source = replace(source, duration=drive.skip + (seconds or _usual_length(drive, drive.skip)))
            drive = source.under(car.vehicle, car.overrides)
        return _road_drive(source, drive, interval)
    record, skip = excerpt(source, begin, seconds or SECONDS)
    inputs, probe = _probe(record, skip, interval)
    return BenchDrive(
        record=record,
        skip=skip,
        inputs=inputs,
        probe=probe,
        overrides=(),
        road=None,
        label=f"{source.source.rpartition('/')[2]}, {begin:g} to {begin + record.duration - skip:g} s",
        shown=skip,
    )


# A moved wheel is followed by a run, a picture and files, each with this input.
@lru_cache(maxsize=4)
def _road_drive(source: Road, drive: Drive, interval: float) -> BenchDrive:
    """Return the input of the bench for a drive over a road."""
    assert not isinstance(source.speed, str)
    speed, skip = source.speed / 3.6, drive.skip
    record = replace(drive.signal(), source=drive.name)
    summary = drive.summary(record)
    times = summary.get("obstacle_s")
    inputs, probe = _probe(record, skip, interval, {name: behind / speed for name, behind, _ in drive.wheels})
    return BenchDrive(
        record=record,
        skip=skip,
        inputs=inputs,
        probe=probe,
        overrides=drive.overrides,
        road=summary,
        label=f"road {source.file.name if source.file else source.road}, {source.speed:g} km/h, {skip:g} to "
        f"{record.duration:g} s",
        speed=speed,
        shown=max(skip, float(times[0]) - BEFORE_S) if isinstance(times, Sequence) else skip,
        source=source,
        drive=drive,
    )


def _probe(
    record: Signal, skip: float, interval: float, delays: Mapping[str, float] | None = None
) -> tuple[PhaseInputs, Signal]:
    """Return the inputs of the FRFs for a record, and the same as a signal; see `BenchDrive`."""
    part = evaluated_span(record.time.size, record.timestep, skip)
    moving = {name: z[part] for name, z in record.displacement.items() if np.any(z != z[0])}
    inputs = phase_inputs(record.timestep, moving or record.displacement, delays, interval=interval)
    size = next(iter(inputs.samples.values())).size
    probe = Signal(
        time=uniform_time(samples=size, timestep=interval),
        displacement=inputs.samples,
        source=f"random phases of {record.source}",
        highest=record.highest,
    )
    return inputs, probe


def _usual_length(drive: Drive, skip: float) -> float:
    """Return the default length of the evaluated excerpt of a road [s]."""
    if not isinstance(drive, RoadDrive) or drive.obstacle is None:
        return SECONDS
    return min(max(drive.signal().duration - skip, SHORTEST), LONGEST)


def excerpt(signal: Signal, begin: float, seconds: float) -> tuple[Signal, float]:
    """Return an excerpt of a signal, and the time before its evaluated part [s].

    From 0 s on it is the unchanged begin of the signal. Elsewhere it begins up to `RISE` earlier, and the plates rise
    smoothly from rest.

    Args:
        begin: begin of the evaluated part [s].
        seconds: length of the evaluated part [s]; less at the end of the signal.
    """
    last = min(begin + seconds, signal.duration)
    if not 0.0 <= begin <= signal.duration - SHORTEST + 1e-9:
        raise ConfigurationError(
            f"--from {begin:g}: {signal.source} has {signal.duration:g} s, and {SHORTEST:g} s are needed after it"
        )
    step = signal.timestep
    first = max(begin - RISE, 0.0)
    span = slice(round(first / step), round(last / step) + 1)
    time = uniform_time(samples=len(signal.time[span]), timestep=step)
    rise: Vector | float = 1.0
    if begin > 0.0:
        share = np.clip(time / (begin - first), 0.0, 1.0)
        rise = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)

    def part(values: Vector) -> Vector:
        middle = float(values[span].mean()) if begin > 0.0 else 0.0
        return np.asarray(rise * (values[span] - middle))

    return (
        replace(
            signal,
            time=time,
            displacement={name: part(values) for name, values in signal.displacement.items()},
            slope_velocity={name: part(values) for name, values in signal.slope_velocity.items()},
            profile={},
        ),
        begin - first,
    )
