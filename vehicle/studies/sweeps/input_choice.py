"""Inputs of a sweep or a search by names: files of signals, or roads with their speeds and seeds."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from vehicle.errors import ConfigurationError
from vehicle.names import CORNERS
from vehicle.runs.car.road import Road, road_of
from vehicle.settings import Settings, part
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.input_settings import DriveInput
from vehicle.signals.excitation.road_settings import RoadSettings
from vehicle.studies.sweeps.case import SignalFile


@dataclass(frozen=True, kw_only=True, slots=True)
class InputChoice(Settings):
    """Inputs of a sweep or a search: files of signals, or roads.

    Attributes:
        input: files, or the names of shipped files.
        wheel: wheel that a column without a wheel in its name moves; None for that of the vehicle file.
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

    def inputs(self) -> list[Road] | list[SignalFile]:
        """Return the inputs, those of files for the shaker wheel of any car.

        Raises:
            ConfigurationError: no input, a file that does not exist, or a speed without a road.
        """
        if self.road and self.input:
            named = " ".join(f"--road {road}" for road in self.road)
            raise ConfigurationError(f"{named} and --input exclude each other; leave one of them out")
        if not self.road and not self.input:
            raise ConfigurationError(
                "the input is missing; set --input FILE, or a road, for example --road C --speed 80"
            )
        return self._roads() if self.road else self._files()

    def _roads(self) -> list[Road]:
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

    def _files(self) -> list[SignalFile]:
        wheel = CORNERS[self.wheel] if self.wheel else ""
        paths = [find_input(name).resolve() for name in self.input]
        return [SignalFile(path=path, wheel=wheel, accept_implausible=self.any_level) for path in paths]
