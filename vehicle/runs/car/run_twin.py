"""Channels of the linear twin of a finished run, on a road that repeats after the evaluated span.

The twin (`vehicle.engines.reduced.twin_run`) drives over the same road. The random phases of the road act on both
alike, so the difference between run and twin gives the error of a value of the run
(`vehicle.signals.analysis.comfort_error`). Other roads have no twin, nor cams, which follow the upper envelope of the
road. A twin of controlled dampers, or of stops, has their energy too; the share that it explains tells how alike it is.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.twin_run import damping_of_run, twin_run
from vehicle.engines.simulation.recording import Recording
from vehicle.engines.simulation.static_trim import StaticTrim
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.signals.excitation.iso_road import RISE_S
from vehicle.signals.excitation.rest import half_cosine_at
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


def twin_channels(
    car: TwinCar, period: Period, record: Mapping[str, Vector], timestep: float, names: Iterable[str]
) -> dict[str, Vector]:
    """Return channels of the twin of a run, with a rise from rest in the lead-in, where the run has it too.

    Args:
        car: car of the run.
        period: period of the road.
        record: channels of the run.
        timestep: sampling interval of the channels [s].
        names: names of channels; those that the twin has are returned.

    Returns:
        Histories as long as the record; empty without the forces or velocities of all dampers.
    """
    needed = damper_channels(car.vehicle)
    if not needed or not {*needed} <= {*record}:
        return {}
    first, samples = round(period.begin / timestep), round(period.length / timestep)
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    damping = damping_of_run(car.poles, laws, record, slice(first, first + samples))
    loads = {f"tyre_{wheel}_force_z": load for wheel, load in car.static.tyre_load.items()}
    chosen = [name for name in names if name in needed or name in loads or "_acc_" in name]
    histories = twin_run(car.poles, damping, period.plates, period.length, chosen, samples)
    # The lead-in is the end of the same period.
    index = np.arange(len(record[needed[0]])) - first
    rise = half_cosine_at(np.asarray((index + first) * timestep), RISE_S)
    return {name: history[index % samples] * rise + loads.get(name, 0.0) for name, history in histories.items()}


def twin_accelerations(
    car: TwinCar, signal: Signal, recording: Recording, begin: float, points: Sequence[str]
) -> list[Vector] | None:
    """Return the accelerations of the twin of a run in x, y, z at points, (3, n) each; None without a twin.

    Args:
        car, signal, recording: of the run.
        begin: start of the evaluated span [s].
        points: output points.
    """
    period, step = signal_period(signal), recording.timestep
    if period is None or round(abs(begin - period.begin) / step):
        return None
    names = [[f"{point}_acc_{axis}" for axis in AXES] for point in points]
    twin = twin_channels(car, period, recording.channels, step, [name for each in names for name in each])
    return [np.stack([twin[name] for name in each]) for each in names] if twin else None
