"""Inputs of many runs from what a user names: files, roads, signals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from vehicle.errors import ConfigurationError, DataError
from vehicle.model.parameters.vehicle import load_vehicle
from vehicle.runs.car import Car
from vehicle.runs.car.road import Road
from vehicle.signals.excitation.evaluation_start import evaluation_start
from vehicle.signals.excitation.input_files import find_input
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.sweeps.case import Input, SignalFile, signal_of

Source = Input | Road | Path | str
"""An input of a run: a file or the name of a shipped one, a road, a signal, or an input of your own."""

START_S = 2.0
"""Default start of the evaluation on plate signals [s]: the car starts at rest."""


def inputs_of(car: Car, sources: Source | Sequence[Source]) -> list[Input]:
    """Return the inputs of the runs of a car.

    Args:
        car: the car, which says where its wheels are on a road.
        sources: one or several.

    Returns:
        Inputs in the order of the sources; the name of a road contains its seed where another seed is among them.

    Raises:
        ConfigurationError: no input, no such file, or a road that the car cannot drive over.
        DataError: an input cannot be read, or was sampled below 125 Hz.
    """
    listed = list(sources) if isinstance(sources, Sequence) and not isinstance(sources, str) else [sources]
    if not listed:
        raise ConfigurationError("inputs: none is given; give a file, or a road, as Road('C', speed=80)")
    found: list[Input] = []
    for source in listed:
        if isinstance(source, Road):
            found.append(source.under(car.vehicle, car.overrides))
        elif isinstance(source, str | Path):
            found.append(SignalFile(path=find_input(source).resolve(), wheel=car.vehicle.shaker_wheel))
        else:
            found.append(source)
    for one in found:
        if isinstance(one, SignalFile | Signal) and (highest := signal_of(one).highest) is not None:
            raise DataError(
                f"{one.name}: holds vibration up to {highest:g} Hz alone, comfort in 2 to 50 Hz needs a record "
                "of at least 125 Hz; run `python -m vehicle shaker`, whose results end at that frequency"
            )
    return [_tagged(one, found) for one in found]


def _tagged(one: Input, others: Sequence[Input]) -> Input:
    """Return a road with its seed in its name, where the same road has another seed too."""
    if not isinstance(one, RoadDrive):
        return one
    seeds = {other.seed for other in others if isinstance(other, RoadDrive) and other.name == one.name}
    return replace(one, tagged=True) if len(seeds) > 1 else one


def common_start(inputs: Sequence[Input], skip: float | None) -> float:
    """Return the start of the evaluation, the same for all inputs [s].

    Args:
        inputs: the inputs.
        skip: requested start [s]; None for the latest default of the roads, or `START_S` without a road.

    Raises:
        ConfigurationError: negative, not finite, or not shorter than an input.
        DataError: an input cannot be read.
    """
    defaults = [float(start) for one in inputs if (start := getattr(one, "skip", None)) is not None]
    durations = {one.name: signal_of(one).duration for one in inputs}
    return evaluation_start(durations, skip, max(defaults, default=START_S))


def file_of(car: Car) -> Path | None:
    """Return the vehicle file of a car, for workers that load it again; None for that of the Focus.

    Raises:
        ConfigurationError: the car was not loaded from a file, or changed since.
    """
    file = car.origin["file"]
    path = None if file is None else Path(str(file))
    if load_vehicle(path, car.overrides).table != car.vehicle.table:
        raise ConfigurationError(
            f"{car.vehicle.name}: many runs need a car that was loaded from a file; load it by Car.load(FILE)"
        )
    return path
