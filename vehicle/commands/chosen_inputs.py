"""Inputs of a sweep or a search from the command line: files of signals, or roads."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from vehicle.commands.input_options import drives_on_road
from vehicle.errors import ConfigurationError
from vehicle.names import CORNERS

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle
    from vehicle.runs.car.road import Road
    from vehicle.studies.sweeps.case import SignalFile


def chosen_inputs(options: argparse.Namespace, vehicle: Vehicle) -> list[Road] | list[SignalFile]:
    """Return the inputs of the options --input or --road.

    Raises:
        ConfigurationError: no input, a file that does not exist, or a speed without a road.
    """
    return _roads(options) if drives_on_road(options) else _files(options, vehicle)


def _roads(options: argparse.Namespace) -> list[Road]:
    from vehicle.commands.road import class_or_profile, road_of

    speeds = options.speed or [None]
    if len(speeds) not in (1, len(options.road)):
        raise ConfigurationError(
            f"--speed: given {len(speeds)} times for {len(options.road)} roads; give one speed, or "
            "a speed for each road"
        )
    each = speeds * len(options.road) if len(speeds) == 1 else speeds
    seeds = options.seed or [None]
    if len(set(seeds)) < len(seeds):
        raise ConfigurationError(f"--seed {' '.join(map(str, seeds))}: a seed is given twice; give each once")
    roads = [
        road_of(class_or_profile(road), argparse.Namespace(**{**vars(options), "speed": speed, "seed": seed}))
        for road, speed in zip(options.road, each, strict=True)
        for seed in seeds
    ]
    profile = next((road.file for road in roads if road.file is not None), None)
    if len(seeds) > 1 and profile is not None:
        raise ConfigurationError(
            f"--seed: given {len(seeds)} times, and {profile} is a measured profile, without a seed; leave it out"
        )
    return roads


def _files(options: argparse.Namespace, vehicle: Vehicle) -> list[SignalFile]:
    from vehicle.signals.excitation.input_files import find_input
    from vehicle.studies.sweeps.case import SignalFile

    wheel = CORNERS[options.wheel] if options.wheel else vehicle.shaker_wheel
    paths = [find_input(name).resolve() for name in options.input]
    return [SignalFile(path=path, wheel=wheel, accept_implausible=options.any_level) for path in paths]
