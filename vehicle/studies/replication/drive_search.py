"""Plate signals that make a car respond with measured accelerations (time waveform replication)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from vehicle.errors import ConfigurationError, SimulationError
from vehicle.names import CORNERS, in_order
from vehicle.runs.car import Car, Run
from vehicle.settings import with_settings
from vehicle.signals.excitation.signal import Signal
from vehicle.signals.formats.reader import read_record
from vehicle.signals.records.choice import Choice
from vehicle.signals.records.delays import split_delay
from vehicle.studies.replication.channel_delays import ChannelDelay, against_median, delays_between
from vehicle.studies.replication.drive_settings import DriveSettings
from vehicle.studies.replication.driven_car import DrivenCar
from vehicle.studies.replication.iteration import Replication, replicate
from vehicle.studies.replication.target import Target, read_target
from vehicle.threads import one_blas_thread


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FoundDrive:
    """Plate signals found from a measured response.

    Attributes:
        replication: drive, response and all iterations.
        plant: the car with its target and its last run.
    """

    replication: Replication
    plant: DrivenCar

    def __repr__(self) -> str:
        """Return wheels, error and outcome in a line."""
        count = len(self.replication.steps)
        return (
            f"FoundDrive({', '.join(self.plant.wheels)}, error {100.0 * self.error:.3g} % after {count} runs; "
            f"{self.replication.outcome})"
        )

    @property
    def signal(self) -> Signal:
        """Return the plate signals [m], as `Car.run` takes them."""
        return self.plant.signal(self.replication.drive)

    @property
    def error(self) -> float:
        """Return RMS of target minus response over RMS of the target, in the band [-]."""
        return self.replication.error

    @cached_property
    def delays(self) -> tuple[ChannelDelay, ...]:
        """Return the delay of each channel against the others; empty unless there are more channels than plates."""
        target, lines = self.plant.target, self.plant.target.lines
        frf = self.plant.frf(lines.frequency)
        estimates, errors = delays_between(target.values, self.replication.response, frf, lines)
        out = np.array([target.delays.get(channel, 0.0) for channel in target.channels])
        whole = against_median(estimates + out)
        return tuple(
            ChannelDelay(channel=channel, delay=delay, error=error, taken_out=part)
            for channel, delay, error, part in zip(
                target.channels, whole.tolist(), errors.tolist(), (whole - estimates).tolist(), strict=True
            )
            if math.isfinite(delay)
        )

    @property
    def notices(self) -> tuple[str, ...]:
        """Return the notices on the target, with the findings on its channels and their delays."""
        target = self.plant.target
        return (*target.notices, *(text for each in self.delays for text in each.advice(float(target.time[1]))))

    @property
    def run(self) -> Run:
        """Return the last run of the iteration."""
        assert self.plant.last is not None
        return self.plant.last


@with_settings(DriveSettings)
@one_blas_thread()
def replicate_drive(
    car: Car, target: Path | str, channels: Mapping[str, str] | Sequence[str], settings: DriveSettings
) -> FoundDrive:
    """Find the plate signals that make the car respond with measured accelerations.

    Args:
        car: the car.
        target: measured accelerations, of any format.
        channels: channel of the car to channel of the file, e.g. {"knuckle_fr_acc_z": "Dof 12 +Z"}; or a list of
            channels of the car if the file uses the same names or has a single channel. At least as many channels as
            plates.

    Returns:
        The best drive with its error; `save_drive` writes all files.

    Raises:
        ConfigurationError: a channel, wheel or number out of range.
        DataError: bad data, another quantity than acceleration, or nothing in the band.
        SimulationError: no drive responds better than plates at rest.
    """
    path, options = Path(target), settings.choice or Choice()
    begin, delays = split_delay(settings.delay or {})
    if begin:
        raise ConfigurationError(
            f"--delay {begin:g}: a delay of all channels only shifts the drive signals; name the channels that "
            "lag, for example --delay seat_rail_acc_z=12.3ms"
        )
    options = replace(options, delays={**options.delays, **delays})
    names = dict(channels) if isinstance(channels, Mapping) else named_channels(path, channels, options)
    car.vehicle.require_channels(names, car.vehicle.acceleration_channels)
    wanted = read_target(path, names, options, settings.band, car.vehicle.solver.record_rate)
    plant = DrivenCar(car, driven_wheels(settings.wheels, wanted, car.vehicle.shaker_wheel), wanted, settings.engine)
    plant.stated_errors = settings.stated_errors
    replication = replicate(plant, wanted.values, wanted.lines, settings)
    if not any(step.kept for step in replication.steps):
        raise SimulationError(
            f"{path}: no drive signal was better than plates at rest ({replication.outcome}); check units, signs "
            "and delays of the channels"
        )
    return FoundDrive(replication=replication, plant=plant)


def named_channels(file: Path, names: Sequence[str], choice: Choice) -> dict[str, str]:
    """Return channel of the car to channel of the file: of the same name, or the only channel of the file."""
    if isinstance(names, str):
        names = (names,)
    if len(names) == 1 and len(read_record(file, choice.databases).channels) == 1:
        return {names[0]: "1"}
    return {name: name for name in names}


def driven_wheels(asked: Sequence[str] | None, target: Target, shaker_wheel: str) -> tuple[str, ...]:
    """Return the wheels whose plates are driven.

    Args:
        asked: names of wheels; None for the wheels in the names of the channels, or else the wheel on the shaker.
    """
    named = {part for name in target.channels for part in name.split("_") if part in CORNERS.values()}
    driven = in_order(set(asked) if asked else named or {shaker_wheel})
    if len(driven) > len(target.channels):
        raise ConfigurationError(
            f"channels: found {len(target.channels)} for {len(driven)} plates ({', '.join(driven)}); use at least as "
            "many channels as plates"
        )
    return driven
