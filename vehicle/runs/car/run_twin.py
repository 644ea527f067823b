"""Lines of the linear twin of a finished run, on a road that repeats after the evaluated span.

The twin (`vehicle.engines.reduced.twin_run`) drives over the same road. The random phases of the road act on both
alike, so the difference between run and twin gives the error of a value of the run
(`vehicle.signals.analysis.comfort_error`). Other roads have no twin, nor cams, which follow the upper envelope of the
road. A twin of controlled dampers, or of stops, has their energy too; the explained share measures how alike it is.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from vehicle.arrays import Complex, Vector
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.twin_run import damping_of_run, twin_lines
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES, across
from vehicle.signals.analysis.comfort_lines import comfort_lines
from vehicle.signals.analysis.ride_comfort import PHASE
from vehicle.signals.excitation.road_drive import SHORTEST_SPAN_S
from vehicle.signals.excitation.signal import Signal


class TwinCar(Protocol):
    """Car of a run, see `vehicle.runs.car.car.Car`."""

    @property
    def vehicle(self) -> Vehicle:
        """Return its parameters."""

    @property
    def static(self) -> StaticTrim:
        """Return its static equilibrium."""

    @property
    def poles(self) -> PoleModel:
        """Return its pole model."""


class Period(NamedTuple):
    """One period of a road that repeats after the evaluated span.

    Attributes:
        plates: wheel to displacement [m].
        begin: start of the period and of the evaluated span [s].
        length: length of the period [s].
    """

    plates: Mapping[str, Vector]
    begin: float
    length: float

    def begins_at(self, start: float, timestep: float) -> bool:
        """Return True if the evaluation of a record starts at the period."""
        return round(abs(start - self.begin) / timestep) == 0


class TwinLines(NamedTuple):
    """Lines k/T of the twins of r runs in their steady state, where |line|^2 = S df."""

    frequency: Vector
    """Lines [Hz]; (m,)."""
    channels: Mapping[str, Complex]
    """Name to lines; (r, m)."""
    mirrored: Mapping[str, Complex]
    """The same with left and right track exchanged; empty on one track."""

    @property
    def roads(self) -> tuple[TwinLines, ...]:
        """Return the lines on this road and on the mirrored one; on one track only the first."""
        return (self, TwinLines(self.frequency, self.mirrored, {})) if self.mirrored else (self,)

    def comfort(
        self, points: Sequence[str], *, band: tuple[float, float], contact: str = "seat", axes: bool = False
    ) -> dict[str, Vector]:
        """Return the comfort values of the twins, see `comfort_lines`, and their `PHASE`.

        On the lines of a road, mean and difference of the tracks make the parts Y_M and Y_D of a vibration, so that
        W^2 = sum |Y_M|^2 + |Y_D|^2 +- 2 Re(Y_M^H Y_D), with - on the mirrored road. The first two terms are the mean
        over the phases of the road, the last one is what a single road adds: half of the difference of both roads.

        Args:
            points: the seat rail or another output point, then the cushion of a seat.
            band, contact, axes: see `comfort_lines`.
        """
        of_roads = []
        for road in self.roads:
            lines = [np.stack([road.channels[f"{point}_acc_{axis}"] for axis in AXES], axis=1) for point in points]
            of_roads.append(comfort_lines(self.frequency, *lines, band=band, contact=contact, axes=axes))
        values, mirrored = of_roads[0], of_roads[-1]
        phases = {f"{name}{PHASE}": 0.5 * (values[name] - mirrored[name]) for name in values if "_wave_" not in name}
        return values | phases


def last_period(plates: Mapping[str, Vector], timestep: float, length: float | None) -> Period | None:
    """Return the last period of a record, whose last sample is the first of the next period.

    Args:
        plates: wheel to displacement [m]; (n,).
        timestep: sampling interval [s].
        length: period of the road [s]; None for another road.

    Returns:
        The period; None without one, and for a shorter one than `SHORTEST_SPAN_S`, for which the errors would cover
        0.85 (`tests.benchmarks.coverage`).
    """
    if length is None or length < SHORTEST_SPAN_S * (1.0 - 1e-9) or not plates:
        return None
    end = next(iter(plates.values())).size - 1
    first = end - round(length / timestep)
    return Period({wheel: values[first:end] for wheel, values in plates.items()}, first * timestep, length)


def signal_period(signal: Signal) -> Period | None:
    """Return the last period of a signal; None on a road without a twin."""
    return last_period(signal.displacement, signal.timestep, None if signal.slope_velocity else signal.repeats_after)


def repeats_after(road: Mapping[str, object] | None) -> float | None:
    """Return the period [s] of the road in the summary of a run; None without a period or with cams."""
    length = (road or {}).get("repeats_after_s")
    return length if isinstance(length, float) and "tyre_contact" not in (road or {}) else None


def damper_channels(vehicle: Vehicle) -> tuple[str, ...]:
    """Return the channels that a run must record for its twin; empty for a car without dampers, which has none."""
    dampers = vehicle.composition.dampers
    return tuple(f"{damper.name}_{quantity}" for damper in dampers for quantity in ("velocity", "force"))


def twin_lines_of(
    cars: Sequence[TwinCar], period: Period, channels: Mapping[str, Vector], timestep: float, names: Iterable[str]
) -> TwinLines | None:
    """Return lines of the twins of r runs over one period of the road.

    Args:
        cars: cars of the runs.
        period: period of the road.
        channels: channels of the runs; (r, n).
        timestep: sampling interval of the channels [s].
        names: names of channels; those that a twin has are returned.

    Returns:
        The lines, 0 for a car without a twin; None if no car has one, or without the forces or velocities of dampers.
    """
    needed = [damper_channels(car.vehicle) for car in cars]
    first, samples = round(period.begin / timestep), round(period.length / timestep)
    loads = {f"tyre_{wheel}_force_z" for wheel in cars[0].static.tyre_load}
    chosen = [name for name in names if name in next(filter(None, needed), ()) or name in loads or "_acc_" in name]
    other_side = {wheel: period.plates.get(across(wheel)) for wheel in period.plates}
    mirrored = {wheel: plate for wheel, plate in other_side.items() if plate is not None}
    roads = [period.plates, mirrored] if len(mirrored) == len(period.plates) else [period.plates]
    by_poles: dict[PoleModel, dict[int, Vector]] = {}
    for number, (car, recorded) in enumerate(zip(cars, needed, strict=True)):
        if not recorded or not {*recorded} <= {*channels}:
            continue
        model, record = car.poles, {name: channels[name][number] for name in recorded}
        laws = [damper.law for damper in car.vehicle.composition.dampers]
        damping = damping_of_run(model, laws, record, slice(first, first + samples))
        # Cars that differ in friction share their poles.
        by_poles.setdefault(model, {})[number] = damping
    lines: Complex = np.empty(0, dtype=np.complex128)
    for model, dampings in by_poles.items():
        frequency, found = twin_lines(model, [*dampings.values()], roads, period.length, chosen, samples)
        if not lines.size:
            lines = np.zeros((len(roads), len(chosen), len(cars), frequency.size), dtype=np.complex128)
        lines[:, :, [*dampings]] = np.moveaxis(found, 0, 2)
    if not by_poles:
        return None
    channels_of, *of_mirrored = (dict(zip(chosen, of_road, strict=True)) for of_road in lines)
    return TwinLines(frequency, channels_of, next(iter(of_mirrored), {}))


def twin_comfort(
    car: TwinCar,
    signal: Signal,
    recording: Recording,
    begin: float,
    points: Sequence[str],
    *,
    band: tuple[float, float],
    contact: str,
) -> dict[str, Vector] | None:
    """Return the comfort values of the twin of a run, see `TwinLines.comfort`; None without a twin.

    Args:
        car, signal, recording: of the run.
        begin: start of the evaluated span [s].
        points: the seat rail or another output point, then the cushion of a seat.
        band: band of the unweighted value [Hz].
        contact: point of contact at the first point.
    """
    period, step = signal_period(signal), recording.timestep
    if period is None or not period.begins_at(begin, step):
        return None
    names = [f"{point}_acc_{axis}" for point in points for axis in AXES]
    rows = {name: history[None] for name, history in recording.channels.items()}
    twin = twin_lines_of([car], period, rows, step, names)
    if twin is None:
        return None
    return twin.comfort(points, band=band, contact=contact, axes=True)
