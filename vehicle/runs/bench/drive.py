"""Input of the bench: a short excerpt of a signal or a road, and inputs with random phases for its FRFs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from vehicle.errors import ConfigurationError
from vehicle.runs.car import Car, Road
from vehicle.runs.car.road import Drive
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
    """Input of the bench.

    Attributes:
        record: excerpt, with the time before it.
        skip: time before the evaluated excerpt [s].
        inputs: inputs of the FRFs, with the density of the excerpt.
        probe: the same as a signal.
        overrides: parameters that the input sets on its car: the speed of rolling tyres.
        road: description of the road for files of a run; None for a signal.
        label: description of the input.
        speed: speed on the road [m/s]; None for a signal.
        shown: time in the record at which the moving picture begins [s]: the evaluated part, or an obstacle in it.
    """

    record: Signal
    skip: float
    inputs: PhaseInputs
    probe: Signal
    overrides: tuple[str, ...]
    road: Mapping[str, object] | None
    label: str
    speed: float | None = None
    shown: float = 0.0


def bench_drive(car: Car, source: Signal | Road, *, begin: float = 0.0, seconds: float | None = None) -> BenchDrive:
    """Return the input of the bench for a signal or a road.

    In the inputs of the FRFs all plates move alike, on a road each axle after its delay, x / V.

    Args:
        car: the car.
        source: plate displacements, or a road.
        begin: begin of the excerpt of a signal [s].
        seconds: length of the evaluated excerpt [s]; by default `SECONDS`, and to 3 s after an obstacle.

    Raises:
        ConfigurationError: a length or a begin out of range, or a recorded road.
        DataError: the signal is too short, or no plate moves.
    """
    if seconds is not None and not SHORTEST <= seconds <= LONGEST:
        raise ConfigurationError(f"--seconds {seconds:g}: must be {SHORTEST:g} to {LONGEST:g} s")
    delays: dict[str, float] = {}
    overrides: tuple[str, ...] = ()
    summary: Mapping[str, object] | None = None
    shown: float | None = None
    speed: float | None = None
    if isinstance(source, Road):
        if isinstance(source.speed, str):
            raise ConfigurationError("bench: a road recorded over time has no constant speed; use a class or a profile")
        drive = source.under(car.vehicle, car.overrides)
        skip, overrides, label = drive.skip, drive.overrides, drive.name.replace("_", " ")
        speed = source.speed / 3.6
        if source.duration is None:
            length = seconds or _usual_length(drive, skip)
            drive = replace(source, duration=skip + length).under(car.vehicle, car.overrides)
        record = replace(drive.signal(), source=drive.name)
        summary = drive.summary(record)
        delays = {name: behind / speed for name, behind, _ in drive.wheels}
        if isinstance(times := summary.get("obstacle_s"), Sequence):
            shown = max(skip, float(times[0]) - BEFORE_S)
    else:
        record, skip = excerpt(source, begin, seconds or SECONDS)
        label = f"{source.source.rpartition('/')[2]}, {begin:g} to {begin + record.duration - skip:g} s"
    moving = {name: z[round(skip / record.timestep) :] for name, z in record.displacement.items() if np.any(z != z[0])}
    interval = 1.0 / car.vehicle.solver.record_rate
    inputs = phase_inputs(record.timestep, moving or record.displacement, delays, interval=interval)
    size = next(iter(inputs.samples.values())).size
    probe = Signal(
        time=uniform_time(samples=size, timestep=interval),
        displacement=inputs.samples,
        source=f"random phases of {label}",
        highest=record.highest,
    )
    return BenchDrive(
        record=record,
        skip=skip,
        inputs=inputs,
        probe=probe,
        overrides=overrides,
        road=summary,
        label=label,
        speed=speed,
        shown=skip if shown is None else shown,
    )


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
        signal: plate displacements.
        begin: begin of the evaluated part [s].
        seconds: length of the evaluated part [s]; less at the end of the signal.

    Raises:
        ConfigurationError: less than `SHORTEST` is left after `begin`.
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
    rise: npt.NDArray[np.float64] | float = 1.0
    if begin > 0.0:
        share = np.clip(time / (begin - first), 0.0, 1.0)
        rise = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)

    def part(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
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
