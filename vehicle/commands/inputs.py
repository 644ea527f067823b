"""What the plates do in a command of many runs: files of signals, or roads."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from vehicle.commands.input_options import drives_on_road
from vehicle.errors import ConfigurationError, DataError
from vehicle.names import CORNERS

if TYPE_CHECKING:
    from vehicle.parameters.vehicle import Vehicle
    from vehicle.sweeps.case import Input


def chosen_inputs(options: argparse.Namespace, vehicle: Vehicle) -> list[Input]:
    """The inputs that the options ask for, each longer than what is left out at its start.

    Args:
        options: as of `signal_options` with several, and `skip_option`.
        vehicle: the car.

    Raises:
        ConfigurationError: none, two of one name, a speed for no road, or a --skip that leaves nothing.
        DataError: an input cannot be read, or was sampled below 125 Hz.
    """
    from vehicle.sweeps.case import signal_of

    inputs = _roads(options, vehicle) if drives_on_road(options) else _files(options)
    for source in inputs:
        signal = signal_of(source)
        if signal.highest is not None:
            raise DataError(
                f"{source.name}: holds vibration up to {signal.highest:g} Hz alone, comfort in 2 to 50 Hz needs a "
                "record of at least 125 Hz; run `python -m vehicle shaker`, whose results end at that frequency"
            )
        duration = signal.duration
        if not 0.0 <= options.skip < duration:
            raise ConfigurationError(
                f"--skip {options.skip:g} s: allowed is 0 s to less than {source.name}, {duration:g} s"
            )
    return inputs


def _roads(options: argparse.Namespace, vehicle: Vehicle) -> list[Input]:
    from vehicle.commands.road import class_or_profile, road_drive

    if not all(options.road):
        raise ConfigurationError("--road: names no road here; give a class of ISO 8608, A to H, or FILE.csv")
    speeds = options.speed or [None]
    if len(speeds) not in (1, len(options.road)):
        raise ConfigurationError(
            f"--speed: given {len(speeds)} times for {len(options.road)} roads; give one for all, or one for each"
        )
    each = speeds * len(options.road) if len(speeds) == 1 else speeds
    return [
        road_drive(class_or_profile(road), argparse.Namespace(**{**vars(options), "speed": speed}), vehicle)
        for road, speed in zip(options.road, each, strict=True)
    ]


def _files(options: argparse.Namespace) -> list[Input]:
    from vehicle.excitation.input_files import find_input
    from vehicle.sweeps.case import SignalFile

    wheel, levels = CORNERS[options.wheel or "front_right"], options.road is not None
    paths = [find_input(name).resolve() for name in options.input]
    return [SignalFile(path=path, wheel=wheel, accept_implausible=levels) for path in paths]
