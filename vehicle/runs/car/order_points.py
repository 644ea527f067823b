"""Orders at steady points: a car run at each of several speeds of its crankshaft or of its drive.

Each point is one run at constant speed. Its amplitudes at the orders come from `vehicle.signals.analysis.order_lines`.
The amplitudes of the linear car in which all friction holds, and of that without friction, are its limits
(`vehicle.engines.linear.forced_response`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vehicle.arrays import Complex, Indices
from vehicle.drawing.notebook.frames import plain_frame
from vehicle.engines.linear.car_modes import Mode, car_modes
from vehicle.engines.linear.forced_response import force_amplitudes, forced_response, without_bushing_friction
from vehicle.engines.linear.mode_shares import forced_mode_shares
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.applied_force import CRANK
from vehicle.model.parameters.channel_words import channels_named
from vehicle.runs.car.road import Road
from vehicle.signals.analysis.order_lines import order_lines
from vehicle.signals.analysis.samples import Vector

if TYPE_CHECKING:
    from vehicle.runs.car.car import Car
    from vehicle.runs.car.run import Run


MOST = 400
"""Maximum number of points."""

SEGMENT = 2.0
"""Length of the Hann windows of the map [s]: lines 1 Hz wide."""

RESONANT = 0.2
"""Minimum share of a mode in resonance that is named as the cause of an order [-]."""

LARGEST_SHARE = 1.5
"""Share of a mode above which it is no cause: others cancel a third of it or more."""

ACCURACY = 1e-5
"""Smallest amplitude that is a result, over the largest of all accelerations of the linear car by the same forces.
Orders without a force of a car that sticks, which are rounding, had 2e-6 to 8e-6 of order 1 in both engines."""

NAMED = 8
"""Maximum number of modes that are named."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NamedMode:
    """Mode that the forces of the car excite at a channel.

    Attributes:
        frequency: natural frequency with locked dampers [Hz].
        damping_ratio: damping ratio [-].
        name: its main motion.
        share: its share in the amplitude of an order, see `vehicle.engines.linear.mode_shares`; NaN in the map [-].
        resonant: True if the order lies within its full width at half power around it.
    """

    frequency: float
    damping_ratio: float
    name: str
    share: float = math.nan
    resonant: bool = False


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class OrderPoints:
    """Amplitudes of a channel at orders of a turning part over steady points.

    Attributes:
        angle: what turns: "crank", or a wheel, as "wheel_fr".
        points: speeds [1/min] of the crankshaft, or [km/h] of the car; (k,).
        turns: turns of the angle per second [Hz]; (k,).
        orders: the orders; (o,).
        channel, unit: name and unit of the channel.
        amplitude: complex amplitudes X of Re(X exp(i order angle)); (o, k).
        error: their standard errors; (o, k).
        stuck, free: amplitudes of the linear car in which the friction of dampers and bushings holds, and without their
            friction; NaN in an order without a force; (o, k).
        slip: largest share of the time in slip of a damper; (k,).
        frequency: frequencies of the map [Hz]; (f,).
        spectrum: amplitude spectrum at each point, for the map; (k, f).
        modes: modes that the forces excite at this channel, in the range of the orders, by frequency.
        parts: for each order the mode in resonance where the order is largest, if there is one, then the mode with the
            largest share there, if it is another; dampers as in most of that run, bushings that hold or slide. Empty
            for an order without a force.
        floor: smallest amplitude that is a result, see `ACCURACY` [m/s2]; (k,).
        frictions: what has friction: "dampers", or "dampers and bushings".
    """

    angle: str
    points: Vector
    turns: Vector
    orders: Vector
    channel: str
    unit: str
    amplitude: Complex
    error: Vector
    stuck: Vector
    free: Vector
    slip: Vector
    frequency: Vector
    spectrum: Vector
    modes: tuple[NamedMode, ...]
    parts: tuple[tuple[NamedMode, ...], ...]
    floor: Vector
    frictions: str

    def __repr__(self) -> str:
        """Return the peak of each order."""
        texts = []
        for row, order in enumerate(self.orders):
            top = int(np.argmax(np.abs(self.amplitude[row])))
            texts.append(
                f"order {order:g} largest at {self.points[top]:g} {self.point_unit} with "
                f"{np.abs(self.amplitude[row, top]):.3g} {self.unit}"
            )
        return (
            f"Orders of {self.angle} over {len(self.points)} points, {self.channel} [{self.unit}]: {', '.join(texts)}"
        )

    @property
    def point_unit(self) -> str:
        """Unit of the points: 1/min or km/h."""
        return "1/min" if self.angle == CRANK else "km/h"

    def columns(self) -> tuple[list[str], list[Vector]]:
        """Return the columns of a table with a row for each order and point, and their heads with units."""
        count, size = len(self.points), len(self.orders)
        columns = {
            "order [-]": np.repeat(self.orders, count),
            "rpm [1/min]" if self.angle == CRANK else "speed [km/h]": np.tile(self.points, size),
            "frequency [Hz]": np.outer(self.orders, self.turns).ravel(),
            f"amplitude [{self.unit}]": np.abs(self.amplitude).ravel(),
            "phase [deg]": np.degrees(np.angle(self.amplitude)).ravel(),
            f"standard_error [{self.unit}]": self.error.ravel(),
            f"stuck [{self.unit}]": self.stuck.ravel(),
            f"without_friction [{self.unit}]": self.free.ravel(),
            "slip_share [-]": np.tile(self.slip, size),
        }
        return list(columns), list(columns.values())

    def rows(self) -> list[dict[str, float | None]]:
        """Return the rows of the table with names without units; None for a value that is not known."""
        heads, columns = self.columns()
        names = [head.partition(" ")[0] for head in heads]
        return [
            {name: float(value) if np.isfinite(value) else None for name, value in zip(names, row, strict=True)}
            for row in zip(*columns, strict=True)
        ]

    def to_dataframe(self) -> Any:
        """Return a pandas table: a row for each order and point, with amplitude, phase [deg] and both limits."""
        return plain_frame(self.rows())


def order_points(
    car: Car,
    channel: str = "seat rail z",
    *,
    rpm: Sequence[float] = (),
    speed: Sequence[float] = (),
    orders: Sequence[float] = (1.0, 2.0),
    angle: str | None = None,
    surface: str = "level",
    duration: float = 10.0,
    engine: str = "reduced",
) -> OrderPoints:
    """Run a car at each of several speeds, and return the amplitudes of a channel at orders.

    Args:
        car: a car with forces.
        channel: name or words of an acceleration channel, as "seat rail z".
        rpm: speeds of the crankshaft [1/min]; the car keeps its speed.
        speed: speeds of the car [km/h], in place of `rpm`.
        orders: multiples of the angle.
        angle: "crank", or a wheel, as "wheel_fr"; by default the crankshaft over `rpm` and the angle of the first force
            over `speed`.
        surface: road: "level", or a class of ISO 8608.
        duration: length of each run [s], of which the first two are not evaluated.
        engine: engine of the runs, see `Car.run`.

    Returns:
        Amplitudes at each point with their limits, the spectra, and the modes of the car.

    Raises:
        ConfigurationError: no points or both kinds, a value out of range, no force, or nothing of this name turns.
        DataError: a run is too short for its orders.
    """
    (points,) = order_points_at(
        car, [channel], rpm=rpm, speed=speed, orders=orders, angle=angle, surface=surface, duration=duration,
        engine=engine,
    )  # fmt: skip
    return points


def order_points_at(
    car: Car,
    channels: Sequence[str],
    *,
    rpm: Sequence[float] = (),
    speed: Sequence[float] = (),
    orders: Sequence[float] = (1.0, 2.0),
    angle: str | None = None,
    surface: str = "level",
    duration: float = 10.0,
    engine: str = "reduced",
) -> tuple[OrderPoints, ...]:
    """Return the amplitudes of several channels from the same runs; arguments and errors as in `order_points`.

    Args:
        channels: names or words of acceleration channels.
    """
    if bool(len(rpm)) == bool(len(speed)):
        raise ConfigurationError("orders: give either speeds of the crankshaft [1/min] or speeds of the car [km/h]")
    points = np.array(rpm if len(rpm) else speed, dtype=float)
    if len(points) > MOST:
        raise ConfigurationError(f"orders: found {len(points)} points, must be at most {MOST}; use a larger step")
    names = list(dict.fromkeys(channels_named(each, car.vehicle.acceleration_channels)[0] for each in channels))
    chosen = angle or (CRANK if len(rpm) else None)
    if len(rpm) and chosen != CRANK:
        raise ConfigurationError(f"orders: {chosen} does not turn with the crankshaft; give speeds of the car")
    drive, results = 3.6 * car.vehicle.driving.speed, list[list[OrderPoints]]()
    # Channel and order to the largest amplitude, the car there, and the share of its time in slip.
    largest: dict[tuple[int, int], tuple[float, Car, float]] = {}
    for value in points:
        if len(rpm):
            run = _run(car.with_({"crank.rpm": float(value)}), surface, drive, duration, engine, names)
        else:
            run = _run(car, surface, float(value), duration, engine, names)
        results.append([_point(run, float(value), name, chosen, orders) for name in names])
        for channel, point in enumerate(results[-1]):
            for order, size in enumerate(np.abs(point.amplitude[:, 0]).tolist()):
                if size > largest.get((channel, order), (-1.0, run.car, 0.0))[0]:
                    largest[channel, order] = size, run.car, float(point.slip[0])
        if len(results) == 1 and not any(
            results[0][0].angle in (force.law.angle, force.name) for force in run.car.vehicle.composition.forces
        ):
            raise ConfigurationError(
                f"orders: {car.vehicle.name} has no force that turns with {results[0][0].angle}; add a section "
                "[engine.orders], [front.imbalance] or [force.NAME] to the vehicle file"
            )
    joined = []
    for channel, each in enumerate(zip(*results, strict=True)):
        tops = (largest[channel, order] for order in range(len(orders)))
        parts = [_main_modes(there, each[0].channel, each[0].angle, order, size, slip < 0.5)
                 for order, (size, there, slip) in zip(orders, tops, strict=True)]  # fmt: skip
        joined.append(_joined(each, run, tuple(parts)))
    return tuple(joined)


def _joined(results: Sequence[OrderPoints], run: Run, parts: tuple[tuple[NamedMode, ...], ...]) -> OrderPoints:
    """Return the amplitudes of a channel at all points; `run` is the last of them."""
    first, turns = results[0], np.concatenate([point.turns for point in results])
    highest, lowest = 1.1 * float(np.max(turns)) * first.orders.max(), 0.9 * float(np.min(turns)) * first.orders.min()
    shown = first.frequency <= highest
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(point, name) for point in results], axis=-1)
        for name in ("points", "turns", "amplitude", "error", "stuck", "free", "slip", "floor")
    }
    return replace(
        first,
        **columns,
        frequency=first.frequency[shown],
        spectrum=np.concatenate([point.spectrum[:, shown] for point in results]),
        modes=_excited_modes(run, first.channel, lowest, highest),
        parts=parts,
    )


def _run(car: Car, surface: str, speed: float, duration: float, engine: str, names: Sequence[str]) -> Run:
    channels = [*names, *(f"damper_{wheel}_velocity" for wheel in car.vehicle.damped_wheels)]
    # Only "auto" needs the errors, for its choice.
    stated = engine == "auto"
    return car.run(Road(surface, speed, duration=duration), engine=engine, channels=channels, stated_errors=stated)


def _point(run: Run, point: float, channel: str, angle: str | None, orders: Sequence[float]) -> OrderPoints:
    """Return the amplitudes of one run, without modes and parts."""
    vehicle = run.car.vehicle
    angle_name, speed = vehicle.composition.turning(angle)
    turns = speed / (2.0 * np.pi)
    lines = order_lines(run.time, run[channel][None], turns, orders, begin=run.skip)
    dampers = [damper.law for damper in vehicle.composition.dampers]
    limits, largest = [], 0.0
    every = [channel, *vehicle.acceleration_channels]
    for stuck in (True, False):
        of_forces = forced_response(run.car.matrices, every, dampers, stuck=stuck)
        amplitudes = np.abs(of_forces.sum(axis=0))
        largest = max(largest, float(np.max(amplitudes, initial=0.0)))
        columns = [_line(run.car, order * speed) for order in orders]
        limits.append(np.array([[amplitudes[0, each[0]] if each.size else np.nan] for each in columns]))
    frequency, spectrum = _amplitudes(run[channel][run.evaluated], run.recording.timestep)
    return OrderPoints(
        angle=angle_name,
        points=np.array([point]),
        turns=np.array([turns]),
        orders=np.array(orders, dtype=float),
        channel=channel,
        unit="m/s2",
        amplitude=lines.amplitude.T,
        error=lines.error.T,
        stuck=limits[0],
        free=limits[1],
        slip=np.array([max((run.slip_share(wheel) for wheel in vehicle.damped_wheels), default=0.0)]),
        frequency=frequency,
        spectrum=spectrum[None],
        modes=(),
        parts=(),
        floor=np.array([ACCURACY * largest]),
        frictions="dampers and bushings" if any(law.friction for law in run.car.matrices.laws) else "dampers",
    )


def _line(car: Car, frequency: float) -> Indices:
    """Return the position of a frequency [rad/s] among those of the applied forces; empty if none has it."""
    forced = np.array(car.matrices.lines.frequencies)
    return np.flatnonzero(np.abs(forced - frequency) < 1e-9 * forced)


def _main_modes(car: Car, channel: str, angle: str, order: float, size: float, stuck: bool) -> tuple[NamedMode, ...]:
    """Return the modes that decide an order with an amplitude [m/s2], see `OrderPoints.parts`.

    Friction of bushings holds or not, as gives the amplitude of the linear car that is nearer to that of the run.
    """
    circular = order * car.vehicle.composition.turning(angle)[1]
    line, frequency = _line(car, circular), circular / (2.0 * np.pi)
    if not line.size:
        return ()
    forces = force_amplitudes(car.matrices)[:, line[0]]
    variants = (car.matrices, without_bushing_friction(car.matrices))
    results = [forced_mode_shares(each, channel, frequency, forces, stuck=stuck) for each in variants]
    nearer = int(np.argmin([abs(abs(each.acceleration[0]) - size) for each in results]))
    matrices, result = variants[nearer], results[nearer]
    natural = np.abs(result.poles) / (2.0 * np.pi)
    width = 2.0 * np.abs(result.poles.real) / (2.0 * np.pi)  # full width at half power
    near = (np.abs(natural - frequency) < width) & (result.shares > RESONANT) & (result.shares < LARGEST_SHARE)
    chosen = [int(np.argmax(np.where(near, result.shares, -np.inf)))] if near.any() else []
    chosen = [*dict.fromkeys([*chosen, int(np.argmax(result.shares))])]
    names = car.geometry.model.superelement.mode_names
    modes = car_modes(matrices, stuck=stuck, highest=1.01 * float(natural[chosen].max()), names=names)
    nearest = [min(modes, key=lambda each, at=at: abs(each.frequency - natural[at])) for at in chosen]  # type: ignore[misc]
    return tuple(
        replace(_named(mode, float(result.shares[at])), resonant=bool(near[at]))
        for at, mode in zip(chosen, nearest, strict=True)
    )


def _named(mode: Mode, share: float = math.nan) -> NamedMode:
    name = mode.description.split(" with ")[0].rpartition(" (")[0] or mode.description
    return NamedMode(frequency=mode.frequency, damping_ratio=mode.damping_ratio, name=name, share=share)


def _amplitudes(record: Vector, interval: float) -> tuple[Vector, Vector]:
    """Return frequencies and the amplitude spectrum over Hann windows that overlap by half, averaged in power."""
    length = min(round(SEGMENT / interval), record.size)
    window = np.hanning(length + 2)[1:-1]
    starts = range(0, record.size - length + 1, max(length // 2, 1))
    parts = np.array([record[start : start + length] for start in starts])
    spectra = np.abs(np.fft.rfft(window * (parts - parts.mean(axis=1, keepdims=True)), axis=1)) * 2.0 / window.sum()
    return np.asarray(np.fft.rfftfreq(length, interval), dtype=np.float64), np.asarray(
        np.sqrt(np.mean(spectra**2, axis=0))
    )


def _excited_modes(run: Run, channel: str, lowest: float, highest: float) -> tuple[NamedMode, ...]:
    """Return the modes between two frequencies [Hz] with the largest peaks at a channel by a unit of a force."""
    matrices = run.car.matrices
    row = matrices.system.output(channel)[0]
    modes = [mode for mode in run.car.modes(highest=highest) if mode.frequency > lowest and not mode.grows]
    sizes = [(_peak(mode, matrices.force_rows, row), mode) for mode in modes]
    largest = sorted(sizes, key=lambda entry: -entry[0])[:NAMED]
    return tuple(_named(mode) for _, mode in sorted(largest, key=lambda entry: entry[1].frequency))


def _peak(mode: Mode, force_rows: Vector, row: Vector) -> float:
    """Return the acceleration of a mode at its frequency by a unit of the force that excites it most."""
    driven = float(np.max(np.abs(force_rows @ mode.shape), initial=0.0))
    circular = 2.0 * np.pi * mode.frequency
    return float(abs(row @ mode.shape)) * driven * circular / (abs(mode.modal_a) * mode.damping_ratio)
