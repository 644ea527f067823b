"""The bumps with many seeds of their noise, which is not published, and the same with a part of the model changed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from scenarios.bump.runs import SHOWN_S, SIZES, Record, damper_velocity, relative_acceleration
from scenarios.car_runs import CarRuns
from scenarios.comfort_runs import changes
from scenarios.signals.bump import BUMP_START_S, NOISE_RMS, Reading, bump
from vehicle.arrays import Vector
from vehicle.names import AXES
from vehicle.runs.car import SATURATED_VELOCITY, Car
from vehicle.signals.excitation.band import SHAKER_EDGE_HZ
from vehicle.signals.excitation.signal import Signal

SEEDS = 8
"""Seeds of the noise of each row: the standard deviation is known to a quarter."""

RECORD = Record(start=3.0, noisy=3.0 + SHOWN_S + 0.5, quiet=0.0, film=0.0)
"""Noise for about two time constants of the slowest rigid body mode, what the figures show, and the taper."""

EXPERIMENTS: Mapping[str, tuple[str, ...]] = {
    "body rigid": ("body.flexible=false",),
    "Ixx 1200": ("body.inertia.ixx=1200",),
    "tyre z -20 %": ("bushings.tyre.stiffness.z=200000.0",),
    "D +33 %": ("damper.viscous=3000",),
}
"""Modifications that test the reason of a disagreement, in addition to the other reading, no noise, another band."""

LOW_EDGE_HZ = 1.5
"""Alternative lower edge of the noise [Hz]: the level is printed, the band is not."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class BumpSeeds:
    """Values of the bump runs over all seeds."""

    # (amplitude A of the bump [m], key of the point) to lowest and highest acceleration [m/s2], (n, 2)
    extremes: Mapping[tuple[float, str], Vector]
    # amplitude A to the largest velocity of the damper over the shaker plate [m/s], (n,)
    fastest: Mapping[float, Vector]
    # friction limit [N] to the end of sticking for a high bump that begins at 5 s [s], (n,); infinite without slip
    stick_end: Mapping[float, Vector]
    engine: str  # engine of the runs

    @property
    def count(self) -> int:
        """Return the number of seeds."""
        return len(self.fastest[SIZES[0]])

    def data(self) -> dict[str, Any]:
        """Return the entries of `results.json`."""
        return {
            "extremes_over_seeds": {
                row_key(size, point, word): values[:, column].tolist()
                for (size, point), values in self.extremes.items()
                for column, word in enumerate(("lowest", "highest"))
            },
            "stick_end_over_seeds_s": {f"{limit:g} N": times.tolist() for limit, times in self.stick_end.items()},
        }


def many_seeds(runs: CarRuns, reading: Reading, frictions: Sequence[float], count: int = SEEDS) -> BumpSeeds:
    """Run both bumps with many seeds of the noise, and the high bump also with other friction limits [N].

    With the reduced engine: the parts rotate by less than its limit of validity.
    """
    engine = "reduced"
    ends: dict[float, list[float]] = {friction: [] for friction in frictions}
    kept: dict[tuple[float, str], list[tuple[float, float]]] = {}
    fastest: dict[float, list[float]] = {size: [] for size in SIZES}
    nominal = runs.car()
    cars = {limit: runs.car(changes(nominal.vehicle, "damper.coulomb_friction", limit)) for limit in frictions}
    for seed in range(count):
        for size in SIZES:
            signal = _signal(nominal, size, reading, seed)
            recorded = motions(nominal, signal, engine)
            fastest[size].append(float(np.max(np.abs(recorded["velocity"]))))
            for point, values in recorded.items():
                kept.setdefault((size, point), []).append((float(np.min(values)), float(np.max(values))))
        for friction, car in cars.items():  # `found`: of the high bump
            speed = np.abs((recorded if car is nominal else motions(car, signal, engine))["velocity"])
            above = np.flatnonzero(speed > SATURATED_VELOCITY)
            ends[friction].append(BUMP_START_S + above[0] * signal.timestep if above.size else np.inf)
    return BumpSeeds(
        extremes={key: np.array(values) for key, values in kept.items()},
        fastest={size: np.array(values) for size, values in fastest.items()},
        stick_end={friction: np.array(values) for friction, values in ends.items()},
        engine=engine,
    )


def experiments(runs: CarRuns, reading: Reading, other: Reading, seeds: BumpSeeds) -> dict[str, Mapping[str, float]]:
    """Return label of a modification to means of the extremes by "A in mm, key of the point, word"."""
    changed = {label: runs.car(changes) for label, changes in EXPERIMENTS.items()}
    trials: dict[str, tuple[Car, Reading, float, float]] = {
        f"{other} reading": (runs.car(), other, NOISE_RMS, SHAKER_EDGE_HZ),
        "no noise": (runs.car(), reading, 0.0, SHAKER_EDGE_HZ),
        f"noise from {LOW_EDGE_HZ:g} Hz on": (runs.car(), reading, NOISE_RMS, LOW_EDGE_HZ),
        **{label: (car, reading, NOISE_RMS, SHAKER_EDGE_HZ) for label, car in changed.items()},
    }
    extremes: dict[str, Mapping[str, float]] = {}
    for label, (car, modification, noise, edge) in trials.items():
        values: dict[str, list[float]] = {}
        for size in SIZES:
            for seed in range(seeds.count if noise else 1):
                for point, motion in motions(
                    car, _signal(car, size, modification, seed, noise, edge), seeds.engine
                ).items():
                    values.setdefault(row_key(size, point, "lowest"), []).append(float(np.min(motion)))
                    values.setdefault(row_key(size, point, "highest"), []).append(float(np.max(motion)))
        extremes[label] = {key: float(np.mean(samples)) for key, samples in values.items()}
    return extremes


def row_key(size: float, point: str, word: str) -> str:
    """Return the key of `scenarios.evidence` of an end of a panel."""
    return f"bump_{'7p5' if size == SIZES[1] else '1p5'}_{point}_{word}"


def motions(car: Car, signal: Signal, engine: str) -> dict[str, Vector]:
    """Return accelerations [m/s2] by key of the point, and damper velocity over the plate [m/s], 3 s from the bump."""
    (wheel,) = signal.displacement
    channels = {
        "seat_rail_x": "seat_rail_acc_x",
        "seat_rail_y": "seat_rail_acc_y",
        "seat_rail_z": "seat_rail_acc_z",
        "seat_z": "seat_acc_z",
        "knuckle_z": f"knuckle_{wheel}_acc_z",
        "engine_z": "engine_acc_z",
        "roof_z": "roof_right_rear_acc_z",
    }
    strut = [f"{strut_end}_{wheel}_acc_{axis}" for strut_end in ("damper_top", "knuckle") for axis in AXES]
    run = car.run(signal, engine=engine, channels=[*channels.values(), *strut, f"damper_{wheel}_velocity"])
    shown = (run.time >= RECORD.start) & (run.time <= RECORD.start + SHOWN_S)
    recorded = {point: run[channel][shown] for point, channel in channels.items()}
    return {**recorded, "relative": relative_acceleration(run)[shown], "velocity": damper_velocity(run)[shown]}


def _signal(
    car: Car, size: float, reading: Reading, seed: int, noise: float = NOISE_RMS, edge: float = SHAKER_EDGE_HZ
) -> Signal:
    return bump(
        amplitude=size,
        reading=reading,
        duration=RECORD.noisy,
        start=RECORD.start,
        noise_rms=noise,
        noise_edge=edge,
        seed=seed,
        wheel=car.vehicle.shaker_wheel,
    )
