"""Time histories of which figures are computed: recorded channels, tyre loads, damper velocities and travels."""

from collections.abc import Callable, Sequence

import numpy as np
import scipy

from vehicle.errors import ConfigurationError
from vehicle.model.parameters.vehicle import Vehicle
from vehicle.names import AXES
from vehicle.runs.car.run_twin import TwinLines
from vehicle.runs.figures.figure import Details, Rows
from vehicle.runs.figures.run_batch import Runs
from vehicle.signals.analysis.samples import Complex, Vector
from vehicle.signals.analysis.weighting import weighted_record, weighting

SEAT = "seat"
"""Weighting of a seat: Wd along x and y, Wk along z (ISO 2631-1)."""


def axis_weighting(weighting: str, channel: str) -> str:
    """Return the weighting of a channel: itself, or that of its axis on a seat.

    Args:
        weighting: name of a weighting, or `SEAT`.
        channel: name of the channel, which ends with its axis.

    Raises:
        ConfigurationError: a seat weighting for a channel without an axis.
    """
    if weighting != SEAT:
        return weighting
    if channel[-2:] not in (f"_{axis}" for axis in AXES):
        raise ConfigurationError(f"weighting {SEAT!r}: {channel} has no axis x, y or z; set Wk or Wd")
    return "Wk" if channel.endswith("_z") else "Wd"


def recorded(names: Sequence[str], weighting: str, runs: Runs) -> Vector:
    """Return the evaluated samples of channels, weighted if asked for; (r, channels, n)."""
    if not weighting:
        return runs.stacked(*names)[:, :, runs.evaluated]
    # The filter runs over the whole record, so that it has settled where the evaluation begins.
    first, end = runs.evaluated.start, runs.evaluated.stop
    weighted = [
        [weighted_record(runs.timestep, history[:end], axis_weighting(weighting, name)) for history in runs[name]]
        for name in names
    ]
    return np.stack(weighted, axis=1)[:, :, first:]


def wheels_of(details: Details, car_wheels: Sequence[str], part: str = "tyre") -> tuple[str, ...]:
    """Return the wheels of a figure; by default all.

    Args:
        details: details of the figure.
        car_wheels: wheels of the car with the part.
        part: "tyre" or "damper".

    Raises:
        ConfigurationError: the car lacks the wheel or the part.
    """
    if missing := [wheel for wheel in details.wheels if wheel not in car_wheels]:
        raise ConfigurationError(f"wheels: found {', '.join(missing)}, must be among {', '.join(car_wheels)}")
    if not car_wheels:
        raise ConfigurationError(f"the car has no {part}")
    return details.wheels or tuple(car_wheels)


def _force_names(details: Details, vehicle: Vehicle) -> tuple[str, ...]:
    return tuple(f"tyre_{wheel}_force_z" for wheel in wheels_of(details, vehicle.wheels))


def _velocity_names(details: Details, vehicle: Vehicle) -> tuple[str, ...]:
    return tuple(f"damper_{wheel}_velocity" for wheel in wheels_of(details, vehicle.damped_wheels, "damper"))


def _loads(details: Details, runs: Runs) -> Vector:
    """Return the tyre load over the static load, F / F0 [-]."""
    wheels = wheels_of(details, tuple(runs.tyre_load))
    loads = [runs[f"tyre_{wheel}_force_z"][:, runs.evaluated] / runs.tyre_load[wheel][:, None] for wheel in wheels]
    return np.stack(loads, axis=1)


def _load_forces(details: Details, runs: Runs) -> Vector:
    """Return the dynamic tyre load F - F0 [N]."""
    wheels = wheels_of(details, tuple(runs.tyre_load))
    forces = [runs[f"tyre_{wheel}_force_z"][:, runs.evaluated] - runs.tyre_load[wheel][:, None] for wheel in wheels]
    return np.stack(forces, axis=1)


def velocities(details: Details, runs: Runs) -> Vector:
    """Return the whole damper velocities [m/s]; (r, dampers, n)."""
    wheels = wheels_of(details, runs.dampers, "damper")
    return np.stack([runs[f"damper_{wheel}_velocity"] for wheel in wheels], axis=1)


def _travels(details: Details, runs: Runs) -> Vector:
    """Return the travel of the dampers from rest [m], the integral of their velocities."""
    whole = scipy.integrate.cumulative_trapezoid(velocities(details, runs), dx=runs.timestep, axis=2, initial=0.0)
    return np.asarray(whole)[:, :, runs.evaluated]


def unread(channels: Callable[[Details, Vehicle], tuple[str, ...]]) -> Rows:
    """Return the rows of a figure whose reduction reads the runs itself.

    Args:
        channels: names of its channels.
    """
    return Rows(channels=channels, of=lambda _, runs: np.empty((len(runs.vehicles), 0, 0)))


def _channel_lines(details: Details, _: Runs, twin: TwinLines) -> Complex:
    """Return the lines of channels, weighted if asked for; (r, channels, m)."""
    lines = np.stack([twin.channels[name] for name in details.channels], axis=1)
    if not details.weighting:
        return lines
    names = [axis_weighting(details.weighting, name) for name in details.channels]
    return np.stack([weighting(name).transfer_function(twin.frequency) for name in names]) * lines


def _force_lines(details: Details, runs: Runs, twin: TwinLines) -> Complex:
    """Return the lines of the dynamic tyre loads [N]; (r, wheels, m)."""
    wheels = wheels_of(details, tuple(runs.tyre_load))
    return np.stack([twin.channels[f"tyre_{wheel}_force_z"] for wheel in wheels], axis=1)


def _variation_lines(details: Details, runs: Runs, twin: TwinLines) -> Complex:
    """Return the lines of F / F0 - 1 [-]; (r, wheels, m)."""
    static = np.stack([runs.tyre_load[wheel] for wheel in wheels_of(details, tuple(runs.tyre_load))], axis=1)
    return np.asarray(_force_lines(details, runs, twin) / static[:, :, None])


CHANNELS = Rows(
    channels=lambda details, _: (*details.channels, *details.over),
    of=lambda details, runs: recorded(details.channels, details.weighting, runs),
    page="channels",
    lines=_channel_lines,
)
LOADS = Rows(channels=_force_names, of=_loads, page="loads")
LOAD_VARIATIONS = Rows(
    channels=_force_names,
    of=lambda details, runs: _loads(details, runs) - 1.0,
    page="load_variations",
    lines=_variation_lines,
)
LOAD_FORCES = Rows(channels=_force_names, of=_load_forces, page="load_forces", lines=_force_lines)
VELOCITIES = Rows(
    channels=_velocity_names,
    of=lambda details, runs: velocities(details, runs)[:, :, runs.evaluated],
    page="velocities",
)
TRAVELS = Rows(channels=_velocity_names, of=_travels, page="travels")
