"""Inputs of a sweep or a search from the command line: files of signals, or roads."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vehicle.commands.input_options import on_road
from vehicle.commands.options import read
from vehicle.errors import ConfigurationError
from vehicle.names import CORNERS
from vehicle.settings import Settings, part
from vehicle.signals.excitation.input_settings import DriveInput
from vehicle.signals.excitation.road_settings import RoadSettings

if TYPE_CHECKING:
    from vehicle.model.parameters.vehicle import Vehicle
    from vehicle.runs.car.road import Road
    from vehicle.studies.sweeps.case import SignalFile


@dataclass(frozen=True, kw_only=True, slots=True)
class InputChoice(Settings):
    """Inputs of a sweep or a search: files of signals, or roads.

    Attributes:
        input: files, or the names of shipped files.
        wheel: moves by a column without a wheel in its name; by default that of the vehicle file.
        any_level: accept levels beyond a shaker.
        road: roads in the forms of `shaker`.
        speed: speed on all roads, or on each [km/h].
        seed: seeds of each random road.
        settings: further settings of all roads.
    """

    input: tuple[str, ...] = ()
    wheel: str | None = None
    any_level: bool = False
    road: tuple[str, ...] = ()
    speed: tuple[float | str, ...] = ()
    seed: tuple[int, ...] = ()
    settings: RoadSettings = part(RoadSettings)

    def inputs(self, vehicle: Vehicle) -> list[Road] | list[SignalFile]:
        """Return the inputs.

        Raises:
            ConfigurationError: no input, a file that does not exist, or a speed without a road.
        """
        return self._roads() if on_road(self.road, self.input) else self._files(vehicle)

    def _roads(self) -> list[Road]:
        from vehicle.runs.car.road import road_of

        speeds: Sequence[float | str | None] = self.speed or (None,)
        if len(speeds) not in (1, len(self.road)):
            raise ConfigurationError(
                f"--speed: given {len(speeds)} times for {len(self.road)} roads; give one speed, or "
                "a speed for each road"
            )
        each = [*speeds] * len(self.road) if len(speeds) == 1 else speeds
        seeds: Sequence[int | None] = self.seed or (None,)
        if len(set(seeds)) < len(seeds):
            raise ConfigurationError(f"--seed {' '.join(map(str, seeds))}: a seed is given twice; give each once")
        roads = [
            road_of(DriveInput(road=road, speed=speed, settings=replace(self.settings, seed=seed)))
            for road, speed in zip(self.road, each, strict=True)
            for seed in seeds
        ]
        profile = next((road.file for road in roads if road.file is not None), None)
        if len(seeds) > 1 and profile is not None:
            raise ConfigurationError(
                f"--seed: given {len(seeds)} times, and {profile} is a measured profile, without a seed; leave it out"
            )
        return roads

    def _files(self, vehicle: Vehicle) -> list[SignalFile]:
        from vehicle.signals.excitation.input_files import find_input
        from vehicle.studies.sweeps.case import SignalFile

        wheel = CORNERS[self.wheel] if self.wheel else vehicle.shaker_wheel
        paths = [find_input(name).resolve() for name in self.input]
        return [SignalFile(path=path, wheel=wheel, accept_implausible=self.any_level) for path in paths]


def inputs_of(options: argparse.Namespace) -> InputChoice:
    """Return the inputs of parsed options, of which --input, --road, --speed and --seed may be repeated."""
    return read(options, InputChoice, settings=read(options, RoadSettings, seed=None))
