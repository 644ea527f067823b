"""Periodic states of a car on a sinusoidal input, its plates or a force, over frequency and level."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from vehicle.arrays import Complex, Indices, Mask, Vector
from vehicle.engines.linear.load_rows import LoadRows
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.validity import rotating_bodies, rotation_outputs
from vehicle.engines.steady.car_ports import CarPorts, car_ports
from vehicle.engines.steady.certificate import one_state
from vehicle.engines.steady.channel_rows import channel_rows, plain_rows, tyre_rows
from vehicle.engines.steady.cycle import Cycle
from vehicle.engines.steady.law_ports import Play, Polygon, Port, Stribeck
from vehicle.engines.steady.plant import Plant, Responses
from vehicle.engines.steady.points import Points
from vehicle.engines.steady.splitting import PeriodicForces, PresentLoad
from vehicle.model.parameters.force_elements import Damper

POINTS = 256
"""Number of points that are iterated together: more no longer fit into the cache of a processor."""

DIFFERENT = 1e-3
"""Difference of two states over their largest force from which there are two states: between two iterations for one
state it is below 1e-6."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LevelStates:
    """Figures of c channels and d dampers at f frequencies and l levels; NaN at points that have not ended.

    Attributes:
        frf: first harmonic of each channel over the level, complex; (c, f, l).
        rms: root mean square of a period without its mean; (c, f, l).
        peak: largest absolute value; (c, f, l).
        distortion: RMS of the higher harmonics divided by the RMS of the first; (c, f, l).
        unresolved: share of the RMS in the upper half of the harmonics; (c, f, l).
        slip: share of the period in which each damper slips, faster than its friction line; NaN for a damper without
            one; (d, f, l).
        energy: energy of each damper in a period [J]; (d, f, l).
        equivalent: damping constant of the same energy, mean(F v)/mean(v^2) [N s/m]; (d, f, l).
        effort: largest force of a stuck damper over its friction limit, above 1 while it slips; (d, f, l).
        first: level at which each damper begins to slip if all others are stuck, in closed form; (d, f).
        angle: largest rotation of a part, by the first harmonic [rad]; (f, l).
        load: smallest tyre load over its static value [-]; (f, l).
        ended: True for the points that have converged; (f, l).
        iterations: iterations of each point; (f, l).
        unique: True at the frequencies at which no other periodic state of the period exists; (f,).
        branches: FRFs of the states that are followed from the lowest level up and from the highest level down; NaN
            where a state is proven to be the only one, and for laws that never fall; (2, c, f, l).
        several: True for points at which both differ; (f, l).
    """

    frf: Complex
    rms: Vector
    peak: Vector
    distortion: Vector
    unresolved: Vector
    slip: Vector
    energy: Vector
    equivalent: Vector
    effort: Vector
    first: Vector
    angle: Vector
    load: Vector
    ended: Mask
    iterations: Indices
    unique: Mask
    branches: Complex
    several: Mask

    @property
    def certificate(self) -> list[str]:
        """Return for each frequency whether a state is the only one: "yes", "no" or "not proven"; (f,)."""
        pairs = np.stack([self.unique, self.several.any(axis=1)], axis=1)
        return ["no" if more else "yes" if proven else "not proven" for proven, more in pairs]


def level_states(
    model: PoleModel,
    dampers: Sequence[Damper],
    *,
    tyre_load: Mapping[str, float],
    loads: LoadRows,
    shares: Complex,
    frequency: Vector,
    level: Vector,
    channels: Sequence[str],
    samples: int = 128,
    progress: Callable[[float], None] | None = None,
) -> LevelStates:
    """Return the periodic states at all pairs of frequency and level.

    Args:
        model: pole model; one with applied forces has these as inputs, otherwise its plates.
        dampers: laws of the dampers.
        tyre_load: static tyre loads by wheel [N].
        loads: rows of all load channels.
        shares: amplitude of each input over the level, with its phase [m or N over the unit of the level]; (f, i).
        frequency: frequencies [Hz]; (f,).
        level: levels in their unit; (l,).
        channels: names of the channels.
        samples: samples of a period.
        progress: called with the finished fraction.
    """
    study = PeriodicCar(model, dampers, tyre_load=tyre_load, loads=loads, channels=channels, samples=samples)
    size, parts = max(1, POINTS // len(level)), []
    for start in range(0, len(frequency), size):
        part = slice(start, start + size)
        parts.append(study.part(frequency[part], level, shares[part]))
        if progress is not None:
            progress(min(1.0, (start + size) / len(frequency)))
    # The frequencies are the second to last axis, of `first` and of `unique` the last.
    axes = {name: -1 if name in ("first", "unique") else -2 for name in LevelStates.__slots__}
    return LevelStates(**{name: np.concatenate([part[name] for part in parts], axis) for name, axis in axes.items()})


class PeriodicCar:
    """Car with its ports and channels in periodic states; arguments as in `level_states`."""

    def __init__(
        self,
        model: PoleModel,
        dampers: Sequence[Damper],
        *,
        tyre_load: Mapping[str, float],
        loads: LoadRows,
        channels: Sequence[str],
        samples: int,
        odd: bool = True,
    ) -> None:
        self.model, self.dampers = model, dampers
        self.laws: CarPorts = car_ports(model.without_forces(), dampers)
        self.ports: list[Port] = self.laws.ports
        wheels = model.matrices.system.inputs
        self.static = np.array([tyre_load[wheel] for wheel in wheels])
        # The force of the present load on a slope needs a motion of the plate.
        self.rolling = model.slope.shape[1] > 0 and not model.applied.shape[1]
        self.cycle = Cycle(samples, odd and not self.rolling and all(port.odd for port in self.ports))
        rows = tyre_rows(model, wheels) + channel_rows(model, channels, loads)
        self.plant = Plant(model, self.laws.moved, rows)
        rotations = rotation_outputs(model, rotating_bodies(model.matrices))
        self.turning = Plant(model, self.laws.moved, plain_rows(model, rotations))
        self.at = [port.base for port in self.ports]
        self.fundamental = int(np.flatnonzero(self.cycle.harmonics == 1)[0])
        self.owners = np.concatenate([np.arange(len(dampers)), model.matrices.sliders.dampers])

    def part(self, frequency: Vector, level: Vector, shares: Complex) -> dict[str, Any]:
        """Return the figures at some frequencies and all levels."""
        first_line, count = self.fundamental, len(frequency)
        table = self.responses(frequency, shares)
        at, height = np.repeat(np.arange(count), len(level)), np.tile(level, count)
        sine = np.zeros((len(at), len(self.cycle.harmonics)), dtype=complex)
        sine[:, first_line] = height
        rates = 2j * np.pi * frequency[at, None, None] * shares[at][..., None] * sine[:, None]
        points = self.points(table, at, sine, rates, slice(first_line, first_line + 1))
        periodic = points.states(self.ports, self.cycle)
        rows, amplitudes = self.rows(table, at, points, periodic), self.cycle.amplitudes(periodic.force)
        forces, drive = table.forces[:, self.at][:, :, self.at], table.inputs[:, :, 0]
        figures = self._channels(rows, height) | self._dampers(
            rows, periodic, amplitudes, np.repeat(frequency, len(level))
        )
        figures["angle"] = self._angles(frequency, shares, height, at, periodic, amplitudes)
        hidden = ~periodic.ended
        for name, values in figures.items():
            values[..., hidden] = np.nan
            figures[name] = values.reshape(*values.shape[:-1], count, len(level))
        figures["ended"], figures["iterations"] = (
            values.reshape(count, len(level)) for values in (periodic.ended, periodic.iterations)
        )
        figures["first"] = self._first(forces[..., first_line], drive[:, :, first_line])
        unique = one_state(self.ports, forces, self._speeds(frequency), self.cycle, rolling=self.rolling)
        figures["unique"] = unique
        branches = np.full((2, *figures["frf"].shape), np.nan, dtype=complex)
        several = np.zeros(periodic.ended.shape, dtype=bool)
        if not unique.all() and any(isinstance(port, Stribeck) for port in self.ports):
            states = points.branches(self.ports, self.cycle, count)
            ended = states[0].ended & states[1].ended & ~unique[at]
            largest = np.abs(states[0].force).max(axis=(1, 2))
            several = ended & (np.abs(states[0].force - states[1].force).max(axis=(1, 2)) > DIFFERENT * largest)
            for branch, state in enumerate(states):
                harmonic = self.rows(table, at, points, state)[:, self.plant.base + len(self.static) :, first_line]
                response = np.where(ended[:, None], harmonic / height[:, None], np.nan)
                branches[branch] = response.T.reshape(branches.shape[1:])
        figures["branches"], figures["several"] = branches, several.reshape(count, len(level))
        return figures

    def responses(self, frequency: Vector, shares: Complex) -> Responses:
        """Return the responses at the harmonics of some frequencies, to the inputs in their shares; (f, ..., k)."""
        return _by_frequency(self.plant.responses(self._speeds(frequency).ravel()), shares)

    def points(self, table: Responses, at: Indices, lines: Complex, rates: Complex, scaled: slice) -> Points:
        """Return what the iteration needs of n points.

        Args:
            table: responses, see `responses`.
            at: index of the frequency of each point; (n,).
            lines: harmonics of the input of each point in the unit of the level; (n, k).
            rates: harmonics of the velocities of the plates, for rolling tyres; (n, w, k).
            scaled: harmonics at which the response of a port sets its scaling lambda.
        """
        forces = table.forces[:, self.at][:, :, self.at]
        mobility = np.abs(forces[:, range(len(self.at)), range(len(self.at)), scaled])
        effect = np.exp(np.log(np.maximum(mobility, 1e-30)).mean(axis=-1))
        scaling = np.stack([port.scaling(effect[:, index]) for index, port in enumerate(self.ports)], axis=1)
        linear = table.inputs[at, :, 0] * lines[:, None]
        present = self._present(rates, at, table, linear) if self.rolling else None
        return Points(effects=forces[at], linear=linear, at=self.at, scaling=scaling[at], present=present)

    def rows(self, table: Responses, at: Indices, points: Points, state: PeriodicForces) -> Complex:
        """Return the harmonics of all rows in periodic states; (n, r, k)."""
        amplitudes = self.cycle.amplitudes(state.force)
        rows = points.linear - np.einsum("nrik,nik->nrk", table.forces[:, :, self.at][at], amplitudes)
        return np.asarray(rows + np.einsum("nrwk,nwk->nrk", table.slopes[at], state.slope) if self.rolling else rows)

    def _speeds(self, frequency: Vector) -> Vector:
        """Return the angular frequencies of the harmonics [rad/s]; (f, k)."""
        return np.asarray(2.0 * np.pi * frequency[:, None] * self.cycle.harmonics)

    def _present(self, rates: Complex, at: Indices, table: Responses, linear: Complex) -> PresentLoad:
        """Return the forces of rolling tyres by their present load."""
        tyres = slice(self.plant.base, self.plant.base + len(self.static))
        return PresentLoad(
            ports=table.slopes[:, self.at][at],
            tyres=table.forces[:, tyres][:, :, self.at][at],
            slopes=table.slopes[:, tyres][at],
            plates=linear[:, tyres],
            rate=self.cycle.histories(rates),
            load=self.static,
        )

    def _channels(self, rows: Complex, height: Vector) -> dict[str, Any]:
        """Return the figures of the channels and the smallest tyre load."""
        first_line, k = self.fundamental, self.cycle.harmonics
        tyres = slice(self.plant.base, self.plant.base + len(self.static))
        channels = np.moveaxis(rows[:, tyres.stop :], 0, 1)
        power = 0.5 * np.abs(channels) ** 2 * (k > 0)
        total, first = power.sum(axis=-1), power[..., first_line]
        upper = power[..., k >= self.cycle.samples // 4].sum(axis=-1)
        lowest = 1.0 + (self.cycle.histories(rows[:, tyres]) / self.static[:, None]).min(axis=(1, 2))
        if self.cycle.odd:
            lowest = 1.0 - np.abs(self.cycle.histories(rows[:, tyres]) / self.static[:, None]).max(axis=(1, 2))
        with np.errstate(divide="ignore", invalid="ignore"):
            return {
                "frf": channels[..., first_line] / height,
                "rms": np.sqrt(total),
                "peak": np.abs(self.cycle.histories(channels)).max(axis=-1),
                "distortion": np.sqrt((total - first) / first),
                "unresolved": np.sqrt(upper / total),
                "load": lowest,
            }

    def _dampers(
        self, rows: Complex, periodic: PeriodicForces, amplitudes: Complex, frequency: Vector
    ) -> dict[str, Any]:
        """Return the figures of the dampers."""
        count, points = len(self.dampers), len(rows)
        velocity = rows[:, :count]
        force = self.model.matrices.viscous[:, None] * velocity
        slip, effort = np.full((2, count, points), np.nan)
        for index, port in enumerate(self.ports):
            if port.base < len(self.owners):
                force[:, self.owners[port.base]] += amplitudes[:, index]
            if (full := full_velocity(port, self.dampers)) is not None:
                motion = np.abs(periodic.motion[:, index])
                slip[port.base] = np.mean(motion > full, axis=-1)
                effort[port.base] = motion.max(axis=-1) / full
        power = 0.5 * (force * velocity.conj()).real.sum(axis=-1).T
        square = 0.5 * (np.abs(velocity) ** 2).sum(axis=-1).T
        with np.errstate(divide="ignore", invalid="ignore"):
            return {"slip": slip, "effort": effort, "energy": power / frequency, "equivalent": power / square}

    def _angles(
        self,
        frequency: Vector,
        shares: Complex,
        height: Vector,
        at: Indices,
        periodic: PeriodicForces,
        amplitudes: Complex,
    ) -> Vector:
        """Return the largest rotation of a part about an axis, by the first harmonic."""
        first_line = self.fundamental
        table = _by_frequency(self.turning.responses(2.0 * np.pi * frequency), shares)
        table = Responses(forces=table.forces[..., 0], slopes=table.slopes[..., 0], inputs=table.inputs[..., 0])
        rows = table.inputs[at, :, 0] * height[:, None]
        rows -= np.einsum("nri,ni->nr", table.forces[:, :, self.at][at], amplitudes[..., first_line])
        if self.rolling:
            rows += np.einsum("nrw,nw->nr", table.slopes[at], periodic.slope[..., first_line])
        return np.asarray(np.abs(rows[:, self.turning.base :]).max(axis=1))

    def _first(self, forces: Complex, drive: Complex) -> Vector:
        """Return the levels at which the dampers begin to slip; (d, f).

        While all stick the car is linear, with the slopes C of the laws at rest: w = (1 + G C)^-1 W0.
        """
        slopes = np.array([slope_at_rest(port) for port in self.ports])
        motion = np.linalg.solve(np.eye(len(slopes)) + forces * slopes, drive[:, self.at, None])[..., 0]
        result = np.full((len(self.dampers), len(drive)), np.nan)
        for index, port in enumerate(self.ports):
            if (full := full_velocity(port, self.dampers)) is not None:
                result[port.base] = full / np.abs(motion[:, index])
        return result


def _by_frequency(table: Responses, shares: Complex) -> Responses:
    """Return responses with the frequencies first, and to the inputs in their shares (f, i); (f, rows, columns, k)."""
    forces, slopes, inputs = (
        np.moveaxis(each.reshape(*each.shape[:2], len(shares), each.shape[2] // len(shares)), 2, 0)
        for each in (table.forces, table.slopes, table.inputs)
    )
    inputs = np.einsum("frik,fi->frk", inputs, shares)[:, :, None]
    return Responses(forces=np.ascontiguousarray(forces), slopes=np.ascontiguousarray(slopes), inputs=inputs)


def full_velocity(port: Port, dampers: Sequence[Damper]) -> float | None:
    """Return the velocity at which the friction line of a damper ends; None for a damper without a line."""
    if not port.of_velocity or dampers[port.base].friction_law == "presliding":
        return None
    if not dampers[port.base].static_friction:
        return None
    return float(0.5 * np.pi / dampers[port.base].smoothing)


def slope_at_rest(port: Port) -> float:
    """Return d phi/dw at w = 0, the larger of two at a breakpoint."""
    if isinstance(port, Play):
        return float(port.stiffness.sum()) - port.kept
    if isinstance(port, Stribeck):
        return slope_at_rest(port.static)
    assert isinstance(port, Polygon)
    beside = {int(np.searchsorted(port.knots, 0.0, side)) for side in ("left", "right")}
    return float(max(port.slopes[index] for index in beside))
