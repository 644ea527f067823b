"""Runs of candidates on all inputs with the reduced engine, many cars side by side, and the numbers read off them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from scenarios.evidence import COMFORT_ENDS, LEVELS
from scenarios.inputs.make_inputs import LEVELS as SHAKER_RMS
from scenarios.levels import WHEEL_BAND
from scenarios.rigid_modes import led_by, roll_mode
from scenarios.signals.bump import BUMP_START_S, NOISE_RMS, bump
from scenarios.signals.exact_road import LEAD_S, RATE_HZ, ROAD_RMS, road
from scenarios.signals.random_road import random_road
from scenarios.source_choice.candidates import (
    NOISE_LEVELS,
    PLATES,
    ROAD_EDGES,
    SHAKER_EDGES,
    SLIP_STEPS,
    SLIP_VELOCITIES,
    Rig,
    vehicle_file,
)
from vehicle.arrays import Vector
from vehicle.engines.reduced.batch_simulation import COARSE_STEP, simulate_batch
from vehicle.names import AXES
from vehicle.runs.car import Car
from vehicle.signals.analysis.comfort import comfort_values
from vehicle.signals.analysis.peaks import phase_resonance
from vehicle.signals.excitation.band import SHAKER_ROLL_OFF_ORDER
from vehicle.signals.excitation.signal import Signal

FINE_STEP = 1.25e-4
"""Step of the bumps [s]: the instant of breaking away, and what the damper top does then."""

TOGETHER = 32
"""Most cars in memory at once."""

WINDOW = round(0.5 * RATE_HZ)
"""Samples of the half second of figures 4.1 to 4.10."""

SWING_S = 30.0
"""Length of figure 2.6 [s]."""

SWING_RMS = 0.05
"""RMS of the road of figure 2.6 [m], section 2.3.1."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """Plan of the inputs of all candidates."""

    seeds: int = 8  # number of records of each input
    # shaker_edges, road_edges: band edges of `candidates`, or a subset [Hz]
    shaker_edges: tuple[float, ...] = SHAKER_EDGES
    road_edges: tuple[float, ...] = ROAD_EDGES
    shaker_s: float = 60.0  # shaker_s, road_s: duration of the records [s]
    road_s: float = 60.0


BUMP_LEAD_S, SHOWN_S, BUMP_TAIL_S = 3.0, 3.0, 0.5
"""Noise before the bump, what the figures show from its beginning, and the taper at the end [s]."""

BUMPS: Mapping[str, tuple[float, str]] = {
    "7p5": (7.5e-3, "0.05 mm with both bumps"),
    "1p5": (1.5e-3, "0.05 mm with both bumps"),
    "1p5 scaled": (1.5e-3, "in proportion to the bump"),
}
"""Bump to its A [m] and the level of its noise."""

POINTS = ("seat_rail_x", "seat_rail_y", "seat_rail_z", "seat_z", "knuckle_z", "relative", "engine_z", "roof_left_z",
          "roof_right_z")  # fmt: skip
"""Points whose extremes are kept."""

ENDS = tuple(dict.fromkeys((name, value) for name, _, _, _, value, _ in COMFORT_ENDS))
"""Parameter and value of the cars at the ends of the comfort curves."""

PATHS = {
    "coulomb_friction": "damper.coulomb_friction",
    "mount_damping": "bushings.suspension_mount.damping.z",
    "mount_stiffness": "bushings.suspension_mount.stiffness.z",
}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Readings:
    """Values of one rig, including both roof points."""

    shaker: Vector  # slip shares, (edges, levels, seeds, [plate, other side], `SLIP_STEPS`, slip velocities)
    extremes: Vector  # lowest and highest of `POINTS` [m/s2], (edges of the noise, seeds, bumps, points, 2)
    stick_end: Vector  # end of sticking for a 7.5 mm bump that begins at 5 s [s], (edges, seeds); infinite without slip
    fastest: Vector  # largest velocity of the damper over the plate [m/s], (edges, seeds, bumps)
    comfort: Vector  # relative comfort value of `ENDS`, (road edges, roads, seeds, ends)
    road: Vector  # slip shares of the damper over the plate, (edges, roads, seeds, `SLIP_STEPS`, slip velocities)
    # largest |seat rail, vertical| over the cars of `evidence.LEVELS` in every half second [m/s2], (edges, figures,
    # seeds * windows)
    levels: Vector
    modes: Vector  # frequencies [Hz] of wheel, roll, highest rigid body mode, lowest and highest engine mode

    def without(self, seed: int) -> Readings:
        """Return the readings without one seed."""
        seeds = self.stick_end.shape[1]
        windows = self.levels.reshape(*self.levels.shape[:2], seeds, -1)
        return Readings(
            shaker=np.delete(self.shaker, seed, 2),
            extremes=np.delete(self.extremes, seed, 1),
            stick_end=np.delete(self.stick_end, seed, 1),
            fastest=np.delete(self.fastest, seed, 1),
            comfort=np.delete(self.comfort, seed, 2),
            road=np.delete(self.road, seed, 2),
            levels=np.delete(windows, seed, 2).reshape(*self.levels.shape[:2], -1),
            modes=self.modes,
        )


def readings(rigs: Sequence[Rig], plan: Plan, folder: Path) -> list[Readings]:
    """Run rigs with the plate on the same side and return their readings.

    A batch of eight takes little more time than a single rig.
    """
    wheel = PLATES[rigs[0].plate]
    every = [entry for rig in rigs for entry in _cars(folder, rig.hydromount, rig.brackets, rig.overrides())]
    cars = every[:: 1 + len(ENDS)]
    shaker = np.array(
        [[[_shares(cars, s, wheel) for s in row] for row in rows] for rows in _shaker_signals(plan, wheel)]
    )
    per_plan = [_bumps(cars, signals, wheel) for signals in _bump_signals(plan, wheel)]
    extremes, stick_end, fastest = (np.array([entry[part] for entry in per_plan]) for part in range(3))
    on_road = [_roads(every, plan, edge, wheel) for edge in plan.road_edges]
    comfort, road_shares, levels = (np.array([entry[part] for entry in on_road]) for part in range(3))
    return [
        Readings(
            shaker=shaker[:, :, :, number],
            extremes=extremes[:, :, :, number],
            stick_end=stick_end[:, :, 0, number],
            fastest=fastest[:, :, :, number],
            comfort=comfort[:, :, :, number],
            road=road_shares[:, :, :, number],
            levels=levels[:, :, number],
            modes=_modes(cars[number], wheel),
        )
        for number in range(len(rigs))
    ]


# The plate and the roof point are no part of the car; building one costs as much as minutes on the road.
@lru_cache(maxsize=64)
def _cars(folder: Path, hydromount: str, brackets: str, changes: tuple[str, ...]) -> tuple[Car, ...]:
    """Return a car, and the cars at the ends of its comfort curves."""
    car = Car.load(vehicle_file(folder, hydromount, brackets), changes)
    return car, *(car.with_([f"{PATHS[name]}={value!r}"]) for name, value in ENDS)


def _march(
    cars: Sequence[Car], signal: Signal, channels: Sequence[str], step: float = COARSE_STEP
) -> Iterator[tuple[slice, Mapping[str, Vector]]]:
    """Simulate cars in batches on a signal; yield the slice of each batch and its channels (cars, n)."""
    for first in range(0, len(cars), TOGETHER):
        batch = cars[first : first + TOGETHER]
        simulated = simulate_batch(
            [car.poles for car in batch],
            signal,
            dampers=[[damper.law for damper in car.vehicle.composition.dampers] for car in batch],
            record_rate=RATE_HZ,
            tyre_load=[car.static.tyre_load for car in batch],
            channels=channels,
            step=step,
        )
        yield slice(first, first + len(batch)), simulated.channels


def _shaker_signals(plan: Plan, wheel: str) -> list[list[list[Signal]]]:
    """Return the shaker signals, (edges, levels, seeds)."""
    return [
        [
            [
                random_road(
                    rms=rms,
                    seed=seed,
                    wheel=wheel,
                    duration=plan.shaker_s,
                    lower_band_edge=edge,
                    roll_off_order=SHAKER_ROLL_OFF_ORDER,
                )
                for seed in range(plan.seeds)
            ]
            for rms in SHAKER_RMS.values()
        ]
        for edge in plan.shaker_edges
    ]


def _velocities(wheel: str) -> tuple[str, str]:
    return f"damper_{wheel}_velocity", f"damper_{'fl' if wheel == 'fr' else 'fr'}_velocity"


def _above(velocity: Vector) -> Vector:
    """Return the share of the samples above each slip velocity times each factor, (..., steps, velocities)."""
    speed, limits = np.sort(np.abs(velocity), axis=-1), np.outer(SLIP_STEPS, SLIP_VELOCITIES)
    below = [np.searchsorted(row, limits, side="right") for row in speed.reshape(-1, speed.shape[-1])]
    return np.asarray(1.0 - np.array(below).reshape(*speed.shape[:-1], *limits.shape) / speed.shape[-1])


def _shares(cars: Sequence[Car], signal: Signal, wheel: str) -> Vector:
    """Return slip shares, (cars, [plate, other], steps, velocities)."""
    channels = _velocities(wheel)
    return np.concatenate(
        [
            _above(np.stack([recordings[name] for name in channels], axis=1))
            for _, recordings in _march(cars, signal, channels)
        ]
    )


def _bump_signals(plan: Plan, wheel: str) -> list[list[list[Signal]]]:
    """Return the bump signals, (edges, seeds, bumps)."""
    duration = BUMP_LEAD_S + SHOWN_S + BUMP_TAIL_S
    return [
        [
            [
                bump(
                    amplitude=size,
                    wheel=wheel,
                    duration=duration,
                    start=BUMP_LEAD_S,
                    noise_rms=NOISE_RMS * NOISE_LEVELS[level],
                    seed=seed,
                    noise_edge=edge,
                )
                for size, level in BUMPS.values()
            ]
            for seed in range(plan.seeds)
        ]
        for edge in plan.shaker_edges
    ]


def _bumps(cars: Sequence[Car], signals: Sequence[Sequence[Signal]], wheel: str) -> tuple[Vector, Vector, Vector]:
    """Return extremes (seeds, bumps, cars, points, 2), end of sticking and largest velocity (seeds, bumps, cars)."""
    strut = [f"{point}_{wheel}_acc_{axis}" for point in ("damper_top", "knuckle") for axis in AXES]
    body = ["seat_rail_acc_x", "seat_rail_acc_y", "seat_rail_acc_z", "seat_acc_z"]
    others = ["engine_acc_z", "roof_left_rear_acc_z", "roof_right_rear_acc_z"]
    speed, _ = _velocities(wheel)
    shape = (len(signals), len(signals[0]), len(cars))
    extremes, stick_end, fastest = np.empty((*shape, len(POINTS), 2)), np.empty(shape), np.empty(shape)
    first, last = (round(t * RATE_HZ) for t in (BUMP_LEAD_S, BUMP_LEAD_S + SHOWN_S))
    points = cars[0].vehicle.points
    axis = np.array(points[f"strut_top_{wheel}"]) - np.array(points[f"damper_bottom_{wheel}"])
    axis /= np.linalg.norm(axis)
    for i, row in enumerate(signals):
        for j, signal in enumerate(row):
            for cut, recordings in _march(cars, signal, [*strut, *body, *others, speed], FINE_STEP):
                shown = {name: values[:, first : last + 1] for name, values in recordings.items()}
                top, knuckle = (
                    sum(axis[n] * shown[name] for n, name in enumerate(part)) for part in (strut[:3], strut[3:])
                )
                rows = [
                    *(shown[name] for name in body),
                    shown[strut[5]],
                    top - knuckle,
                    *(shown[name] for name in others),
                ]
                extremes[i, j, cut, :, 0] = np.min(rows, axis=2).T
                extremes[i, j, cut, :, 1] = np.max(rows, axis=2).T
                moving = np.abs(shown[speed])
                fastest[i, j, cut] = np.max(moving, axis=1)
                over = moving > 1e-3
                instant = BUMP_START_S + np.argmax(over, axis=1) / RATE_HZ
                stick_end[i, j, cut] = np.where(over.any(axis=1), instant, np.inf)
    return extremes, stick_end, fastest


def _roads(every: Sequence[Car], plan: Plan, edge: float, wheel: str) -> tuple[Vector, Vector, Vector]:
    """Return comfort (roads, seeds, cars, ends), slip (.., steps, velocities) and levels (figures, cars, windows).

    `every` has each car followed by those at the ends of its comfort curves; the lower edge of the records is in Hz.
    """
    count = 1 + len(ENDS)
    rail, (speed, _) = [f"seat_rail_acc_{axis}" for axis in AXES], _velocities(wheel)
    record = slice(round(LEAD_S * RATE_HZ) + 1, None)
    shape = (len(ROAD_RMS), plan.seeds, len(every))
    comfort, shares = np.empty(shape), np.empty((*shape, len(SLIP_STEPS), len(SLIP_VELOCITIES)))
    largest = np.empty((*shape, round(plan.road_s * RATE_HZ) // WINDOW))
    for i, rms in enumerate(ROAD_RMS.values()):
        for seed in range(plan.seeds):
            signal = road(rms=rms, seed=seed, wheel=wheel, duration=plan.road_s, lower_band_edge=edge)
            for cut, recordings in _march(every, signal, [*rail, speed]):
                kept = np.stack([recordings[name][:, record] for name in rail], axis=1)
                comfort[i, seed, cut] = comfort_values(1.0 / RATE_HZ, kept).overall
                vertical = np.abs(kept[:, 2, : largest.shape[-1] * WINDOW])
                largest[i, seed, cut] = np.max(vertical.reshape(len(kept), -1, WINDOW), axis=2)
                shares[i, seed, cut] = _above(recordings[speed][:, record])
    number = len(every) // count
    by_car = comfort.reshape(*shape[:2], number, count)
    largest = largest.reshape(*shape[:2], number, count, -1)
    figures = []
    for _, name, road_name, _, _ in LEVELS:
        members = [0, *(1 + n for n, (parameter, _) in enumerate(ENDS) if parameter == name)]
        entry = np.max(largest[list(ROAD_RMS).index(road_name)][:, :, members], axis=2)
        figures.append(np.swapaxes(entry, 0, 1).reshape(number, -1))
    ratios = by_car[..., 1:] / by_car[..., :1]
    by_rig = shares.reshape(*shape[:2], number, count, *shares.shape[3:])
    return ratios, by_rig[:, :, :, 0], np.array(figures)


def swings(edge: float, plan: Plan) -> Vector:
    """Return highest minus lowest displacement of 30 s of a road of 50 mm RMS [m], for each seed and window."""
    record = slice(round(LEAD_S * RATE_HZ) + 1, None)
    largest = []
    for seed in range(plan.seeds):
        signal = road(rms=SWING_RMS, seed=seed, wheel="fl", duration=plan.road_s, lower_band_edge=edge)
        plate = signal.displacement["fl"][record]
        samples = min(round(SWING_S * RATE_HZ), plate.size)
        largest.append(np.ptp(plate[: plate.size // samples * samples].reshape(-1, samples), axis=1))
    return np.concatenate(largest)


def _modes(car: Car, wheel: str) -> Vector:
    """Return wheel, roll, highest rigid body, lowest and highest engine mode [Hz], dampers stuck."""
    lines = np.arange(WHEEL_BAND[0], WHEEL_BAND[1], 0.05)
    (knuckle,) = car.matrix_frf([f"knuckle_{wheel}_acc_z"], lines, wheel=wheel)
    modes = car.modes("stuck")
    rigid, engine = ([mode.frequency for mode in led_by(modes, part)] for part in ("body", "engine"))
    wheel_hz = phase_resonance(lines, knuckle)
    return np.array([wheel_hz, roll_mode(car).frequency, sorted(rigid)[5], min(engine), max(engine)])
