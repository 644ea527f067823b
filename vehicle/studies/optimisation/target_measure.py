"""Measure of the figures of a targets file in a search, and the inputs of the figures."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.errors import ConfigurationError, DataError, VehicleError
from vehicle.model.parameters.channel_words import channels_named
from vehicle.runs.car import Car, Run
from vehicle.runs.car.road import Road
from vehicle.runs.targets.figure import Figure
from vehicle.runs.targets.values import Histories, value_of
from vehicle.signals.analysis.ride_comfort import ERROR
from vehicle.studies.sweeps.measure import STEP, of_one
from vehicle.studies.sweeps.run_batch import Runs


@dataclass(frozen=True, kw_only=True, slots=True)
class TargetMeasure:
    """Measure of the figures of one input.

    Attributes:
        figures: name and figure, with channels by name.
        wheels: wheels of the car.
        dampers: wheels with a damper.
        skip: excluded time at the beginning [s].
        left_obstacle: time at which the last wheel leaves an obstacle [s]; None without an obstacle.
        timestep: maximum step of the reduced engine [s].
        random: True for a class or a profile, whose figures have standard errors.
    """

    figures: tuple[tuple[str, Figure], ...]
    wheels: tuple[str, ...]
    dampers: tuple[str, ...]
    skip: float
    left_obstacle: float | None = None
    timestep: float = STEP
    random: bool = False

    @property
    def channels(self) -> tuple[str, ...]:
        """Return the required channels."""
        names: list[str] = []
        for _, figure in self.figures:
            names += [*figure.channels, *figure.over]
            if figure.quantity == "tyre_load":
                names += [f"tyre_{wheel}_force_z" for wheel in figure.wheels or self.wheels]
            elif figure.quantity in ("stick_share", "travel"):
                names += [f"damper_{wheel}_velocity" for wheel in figure.wheels or self.dampers]
        return tuple(dict.fromkeys(names))

    @property
    def units(self) -> Mapping[str, str]:
        """Return name of each figure, and of its standard error, to its unit."""
        units = {name: figure.unit for name, figure in self.figures}
        return units | {f"{name}{ERROR}": unit for name, unit in units.items()}

    def __call__(self, run: Run) -> dict[str, float]:
        """Return the figures of a run."""
        return of_one(self, run)

    def of(self, runs: Runs) -> dict[str, Vector]:
        """Return the figures of r runs and their standard errors, NaN without one; (r,) each."""
        columns: dict[str, list[float]] = {name: [] for name in self.units}
        for row, limit in enumerate(runs.slip_velocity if self.dampers else np.zeros(len(runs.vehicles))):
            samples = {channel: runs[channel][row] for channel in self.channels}
            ride = Histories(
                time=runs.time,
                of=samples.__getitem__,
                unit=str,
                named=tuple,
                skip=self.skip,
                tyre_load={wheel: float(loads[row]) for wheel, loads in runs.tyre_load.items()},
                dampers=self.dampers,
                slip_velocity=float(limit),
                left_obstacle=self.left_obstacle,
                random=self.random,
            )
            for name, figure in self.figures:
                # The unit was compared with the run of the unchanged car.
                value, error = value_of(figure, ride, checked=True)
                columns[name].append(value)
                columns[f"{name}{ERROR}"].append(math.nan if error is None else error)
        return {name: np.array(values) for name, values in columns.items()}


def measures_of(
    car: Car, figures: Mapping[str, Figure], duration: float | None
) -> list[tuple[str | Road, TargetMeasure]]:
    """Return each input of the figures and the measure of its figures."""
    groups: dict[tuple[str, float | None], list[tuple[str, Figure]]] = {}
    for name, figure in figures.items():
        if figure.run or not (figure.road or figure.obstacle or figure.signal):
            raise ConfigurationError(
                f"{name}: a search needs the input of the target; set road or obstacle with speed, or signal, "
                "and remove run"
            )
        if not figure.signal and figure.speed is None:
            raise ConfigurationError(f"{name}: speed [km/h] is missing; a search needs it")
        groups.setdefault((figure.road or figure.obstacle or figure.signal, figure.speed), []).append((name, figure))
    measures = []
    for (source_name, speed), group in groups.items():
        source: str | Road = source_name
        if speed is not None:
            source = Road(source_name, speed, duration=duration if len(source_name) == 1 else None)
        try:
            run = car.run(source, engine="reduced")
            chosen = tuple((name, _checked(name, figure, run)) for name, figure in group)
        except DataError as error:
            raise ConfigurationError(f"{source_name}: {error}") from None
        times = (run.road or {}).get("obstacle_s")
        measures.append(
            (
                source,
                TargetMeasure(
                    figures=chosen,
                    wheels=car.vehicle.wheels,
                    dampers=car.vehicle.damped_wheels,
                    skip=run.skip,
                    random=run.road is not None and run.signal.random,
                    left_obstacle=float(times[1]) if isinstance(times, Sequence) else None,
                ),
            )
        )
    return measures


def _checked(name: str, figure: Figure, run: Run) -> Figure:
    """Return a figure with its channels by name.

    Raises:
        ConfigurationError: a channel is not recorded, or the unit is wrong.
    """
    recorded = tuple(run.recording.channels)
    try:
        channels, over = (channels_named(texts, recorded) for texts in (figure.channels, figure.over))
    except VehicleError as error:
        raise ConfigurationError(f"{name}: {error}") from None
    units = {run.recording.units[channel] for channel in channels}
    if figure.quantity in ("rms", "peak", "peak_to_peak") and units != {figure.unit}:
        raise ConfigurationError(f"{name}: unit: found {figure.unit!r}, the channels have {', '.join(sorted(units))!r}")
    return replace(figure, channels=channels, over=over)
