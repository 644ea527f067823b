"""What the plates do in a command of many runs: files of signals, or roads."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from vehicle.commands.input_options import drives_on_road
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import CORNERS

if TYPE_CHECKING:
    from vehicle.excitation.signal import Signal
    from vehicle.parameters.vehicle import Vehicle
    from vehicle.sweeps.case import Input


def chosen_inputs(options: argparse.Namespace, vehicle: Vehicle) -> list[Input]:
    """The inputs that the options ask for.

    Args:
        options: as of `signal_options` with several.
        vehicle: the car.

    Raises:
        ConfigurationError: none, two of one name, or a speed for no road.
        DataError: an input cannot be read, or was sampled below 125 Hz.
    """
    from vehicle.sweeps.case import signal_of

    if drives_on_road(options):
        return _roads(options, vehicle)
    inputs = _files(options, vehicle)
    for source in inputs:
        if (highest := signal_of(source).highest) is not None:
            raise DataError(
                f"{source.name}: holds vibration up to {highest:g} Hz alone, comfort in 2 to 50 Hz needs a record "
                "of at least 125 Hz; run `python -m vehicle shaker`, whose results end at that frequency"
            )
    return inputs


def chosen_skip(options: argparse.Namespace, inputs: Mapping[str, Input | Signal], of_a_file: float) -> float:
    """Return the start of the evaluation, the same for all inputs.

    Args:
        options: as of `skip_option`.
        inputs: name to input.
        of_a_file: default where no road is driven [s].

    Returns:
        --skip, or the latest default of the roads [s].

    Raises:
        ConfigurationError: negative, not finite, or not shorter than an input.
        DataError: an input cannot be read.
    """
    from vehicle.excitation.recorded_road import RecordedDrive
    from vehicle.excitation.road_drive import RoadDrive
    from vehicle.excitation.signal import Signal
    from vehicle.sweeps.case import signal_of

    drives = [one for one in inputs.values() if isinstance(one, RoadDrive | RecordedDrive)]
    skip = max((one.skip for one in drives), default=of_a_file) if options.skip is None else options.skip
    for name, source in inputs.items():
        duration = source.duration if isinstance(source, Signal) else signal_of(source).duration
        if not 0.0 <= skip < duration:
            default = " (the default)" if options.skip is None else ""
            raise ConfigurationError(f"--skip {skip:g} s{default}: allowed is 0 s to less than {name}, {duration:g} s")
    return float(skip)


def _roads(options: argparse.Namespace, vehicle: Vehicle) -> list[Input]:
    from vehicle.commands.road import class_or_profile, road_drive
    from vehicle.excitation.road_drive import RoadDrive

    speeds = options.speed or [None]
    if len(speeds) not in (1, len(options.road)):
        raise ConfigurationError(
            f"--speed: given {len(speeds)} times for {len(options.road)} roads; give one for all, or one for each"
        )
    each = speeds * len(options.road) if len(speeds) == 1 else speeds
    seeds = options.seed or [None]
    if len(set(seeds)) < len(seeds):
        raise ConfigurationError(f"--seed {' '.join(map(str, seeds))}: a seed is given twice; give each once")
    drives = [
        road_drive(
            class_or_profile(road), argparse.Namespace(**{**vars(options), "speed": speed, "seed": seed}), vehicle
        )
        for road, speed in zip(options.road, each, strict=True)
        for seed in seeds
    ]
    profile = next((drive for drive in drives if isinstance(drive.road, Path)), None)
    if len(seeds) > 1 and profile is not None:
        raise ConfigurationError(f"--seed: given {len(seeds)} times, and {profile.road} is a measured profile")
    return [replace(drive, tagged=len(seeds) > 1) if isinstance(drive, RoadDrive) else drive for drive in drives]


def _files(options: argparse.Namespace, vehicle: Vehicle) -> list[Input]:
    from vehicle.excitation.input_files import find_input
    from vehicle.sweeps.case import SignalFile

    wheel = CORNERS[options.wheel] if options.wheel else vehicle.shaker_wheel
    paths = [find_input(name).resolve() for name in options.input]
    return [SignalFile(path=path, wheel=wheel, accept_implausible=options.any_level) for path in paths]
