"""Inputs of a sweep from files, names of shipped files, roads and signals."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.driving import require_speed_once
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.names import CORNERS
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road, road_of
from vehicle.runs.car.road_precision import with_duration
from vehicle.settings import Settings, part
from vehicle.signals.excitation.evaluation_start import evaluation_start
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.input_settings import DriveInput, on_road
from vehicle.signals.excitation.recorded_road import RecordedDrive
from vehicle.signals.excitation.road_drive import RoadDrive, evaluated_from
from vehicle.signals.excitation.road_settings import RoadSettings
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.sweeps.case import Input, SignalFile, signal_of


@dataclass(frozen=True, kw_only=True, slots=True)
class InputChoice(Settings):
    """Inputs of a sweep or a search: files of signals, or roads."""

    input: tuple[str, ...] = ()  # files, or the names of shipped files
    # wheel moved by a column without a wheel in its name; by default the one in the vehicle file
    wheel: str | None = None
    any_level: bool = False  # accept levels beyond a shaker
    road: tuple[str, ...] = ()  # roads in the forms of `shaker`
    speed: tuple[float | str, ...] = ()  # speed on all roads, or on each [km/h]
    seed: tuple[int, ...] = ()  # seeds of each random road
    settings: RoadSettings = part(RoadSettings)  # further settings of all roads

    def inputs(self) -> list[Road] | list[SignalFile]:
        """Return the inputs, those of files for the shaker wheel of any car.

        Raises:
            ConfigurationError: no input, a file that does not exist, or a speed without a road.
        """
        return self._roads() if on_road(self.road, self.input) else self._files()

    def _roads(self) -> list[Road]:
        speeds: Sequence[float | str | None] = self.speed or (None,)
        if len(speeds) not in (1, len(self.road)):
            raise ConfigurationError(
                f"--speed: given {len(speeds)} times for {len(self.road)} roads; give one speed, or one for each road"
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
            raise ConfigurationError(f"--seed: {profile} is a measured profile without a random seed; remove --seed")
        return roads

    def _files(self) -> list[SignalFile]:
        wheel = CORNERS[self.wheel] if self.wheel else ""
        paths = [find_input(name).resolve() for name in self.input]
        return [SignalFile(path=path, wheel=wheel, accept_implausible=self.any_level) for path in paths]


Source = Input | Road | Path | str
"""Input of a run: a file, the name of a shipped file, a road, a signal, or a user-defined input."""

Inputs = InputChoice | Source | Sequence[Source]
"""One or several inputs."""


def inputs_of(car: Car, sources: Inputs, skip: float | None = None) -> list[Input]:
    """Return the inputs of the runs of a car.

    Args:
        car: the car, with the positions of its wheels on a road.
        sources: one or several sources.
        skip: requested start of the evaluation [s]; by default see `common_start`.

    Returns:
        Inputs in the order of the sources; the name of a road contains the seed if the road appears with several seeds.
    """
    chosen = sources.inputs() if isinstance(sources, InputChoice) else sources
    listed = list(chosen) if isinstance(chosen, Sequence) and not isinstance(chosen, str) else [chosen]
    if not listed:
        raise ConfigurationError("inputs: none given; pass a file or a road, for example road('C', 80)")
    inputs: list[Input] = []
    for source in listed:
        if isinstance(source, Road):
            inputs.append(source.under(car.vehicle, car.overrides))
        elif isinstance(source, str | Path):
            inputs.append(SignalFile(path=find_input(source).resolve(), wheel=car.vehicle.shaker_wheel))
        elif isinstance(source, SignalFile) and not source.wheel:
            inputs.append(replace(source, wheel=car.vehicle.shaker_wheel))
        else:
            inputs.append(source)
    for entry in inputs:
        if isinstance(entry, SignalFile | Signal) and (highest := signal_of(entry).highest) is not None:
            raise DataError(
                f"{entry.name}: contains vibration only up to {highest:g} Hz; comfort in 2 to 50 Hz needs a record of "
                "at least 125 Hz. `python -m vehicle shaker` accepts it: its results end at that frequency"
            )
    # The car chooses the durations for a precision; all its variants drive them.
    start = max(_starts(inputs), default=0.0) if skip is None else skip
    tagged = [_tagged(entry, inputs) for entry in inputs]
    return [with_duration(car, evaluated_from(entry, start)) if _is_precise(entry) else entry for entry in tagged]


def require_speed_of_roads(inputs: Sequence[Input], changes: Iterable[Sequence[str]]) -> None:
    """Check that no variation gives the car another speed than its road; errors: see `require_speed_once`.

    Args:
        inputs: inputs of the runs.
        changes: texts "path=value" of each variation.
    """
    roads = [source for source in inputs if isinstance(source, RoadDrive | RecordedDrive)]
    if roads:
        texts = list(dict.fromkeys(text for change in changes for text in change))
        for road in roads:
            require_speed_once(texts, road.speed / 3.6 if isinstance(road, RoadDrive) else math.nan)


def _tagged(source: Input, others: Sequence[Input]) -> Input:
    """Return an input; add the seed to the name of a road if the same road appears with several seeds."""
    if not isinstance(source, RoadDrive):
        return source
    seeds = {other.seed for other in others if isinstance(other, RoadDrive) and other.name == source.name}
    return replace(source, tagged=True) if len(seeds) > 1 else source


def common_start(inputs: Sequence[Input], skip: float | None) -> float:
    """Return the common start of the evaluation for all inputs [s].

    Args:
        skip: requested start [s]; None for the latest default start of the roads, or 0 without a road,
            as in `Car.run`.

    Raises:
        ConfigurationError: the start is negative, not finite, or not before the end of every input.
        DataError: an input cannot be read.
    """
    durations = {source.name: signal_of(source).duration for source in inputs}
    return evaluation_start(durations, skip, max(_starts(inputs), default=0.0))


def _starts(inputs: Sequence[Input]) -> list[float]:
    """Return the default starts of the roads [s]."""
    return [float(start) for source in inputs if (start := getattr(source, "skip", None)) is not None]


def _is_precise(source: Input) -> bool:
    """Return True for a road whose duration follows from a precision."""
    return getattr(source, "precision", None) is not None


def file_of(car: Car) -> Path | None:
    """Return the vehicle file of a car, which workers load again; None for the Focus."""
    file = car.origin["file"]
    path = None if file is None else Path(str(file))
    if load_vehicle(path, car.overrides).table != car.vehicle.table:
        raise ConfigurationError(
            f"{car.vehicle.name}: a sweep needs a car loaded from a file; load the car with Car.load(FILE)"
        )
    return path
