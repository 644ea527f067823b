"""Drives of drawn cars over drawn roads by the batch engine: their features and their unknowns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.batch_simulation import simulate_batch
from vehicle.engines.reduced.table_layout import LANES
from vehicle.runs.car import Car
from vehicle.signals.excitation.iso_road import Side
from vehicle.studies.diagnosis.drawn_car import CarPrior, DrawnCar
from vehicle.studies.diagnosis.drawn_road import DrawnRoad
from vehicle.studies.diagnosis.features import HIGHEST, Bands, related_pairs, rows_of_points
from vehicle.threads import one_blas_thread

RATE, STEP = 250.0, 2e-3
"""Sampling rate [Hz] and largest time step [s]. Densities up to 40 Hz differ by less than 1 % from those at 0.5 ms."""

ROAD_HIGHEST = 2.0 * HIGHEST
"""Highest frequency of the roads [Hz]."""

SETTLING = 4.0
"""Time at the start of a drive that is left out [s]."""

LEVELS = (6e-6, 3e-3)
"""Range of the level G(0.1 cycles/m) of roads [m3], logarithmic: from the smooth end of class A (8e-6) to the rough end
of class D (2e-3), with a margin."""

WAVINESS, VARIATION, TRACK = (1.7, 2.3), (0.0, 0.4), 1.5
"""Ranges of the waviness and of the variation of the level along the road; ratio of the distance of the tracks."""

USES = 2
"""Drives of each drawn car, each with other dampers on another road: new poles take longer than a drive of 60 s."""

TOGETHER = USES * LANES
"""Successive drives that share cars or a road, and are left out together."""

SPEED = 1.02
"""Ratio of true and stated speed."""

NOISE, GAIN = (0.005, 0.1), 1.03
"""Noise of a sensor and hum of the car [m/s2], RMS at 250 Hz; ratio of the gain of a sensor."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Drives:
    """Simulated drives.

    Attributes:
        features: features of each drive, for each set of sensors; (drives, features).
        names: names of the unknowns.
        values: unknowns of each drive; (drives, unknowns).
    """

    features: tuple[Vector, ...]
    names: tuple[str, ...]
    values: Vector

    def of(self, name: str) -> Vector:
        """Return the values of an unknown; (drives,)."""
        return np.asarray(self.values[:, self.names.index(name)])


@one_blas_thread()
def simulated_drives(
    priors: Sequence[CarPrior],
    speeds: Sequence[tuple[float, float]],
    sensors: Sequence[Sequence[str]],
    *,
    free: Sequence[str] = (),
    highest: float,
    count: int,
    duration: float,
    seed: int,
    progress: Callable[[float], None] | None = None,
) -> Drives:
    """Simulate drives of drawn cars.

    Args:
        priors: cars at one or several speeds.
        speeds: range of the speed for each of them [m/s].
        sensors: sets of accelerations, each of which gives features.
        free: points whose horizontal axes have any direction.
        highest: highest frequency of the features [Hz].
        count: number of drives, rounded up to whole vectors of cars.
        duration: length of the record [s].
        seed: seed of all random numbers.
        progress: called with the share that is done.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    bands, drawn = Bands.of(RATE, highest), list[DrawnCar]()
    channels = tuple(dict.fromkeys(channel for each in sensors for channel in each))
    rows = [[channels.index(channel) for channel in each] for each in sensors]
    pairs = [(related_pairs(each), rows_of_points(each, free)) for each in sensors]
    features: list[list[Vector]] = [[] for _ in sensors]
    values, names = list[list[float]](), tuple[str, ...]()
    groups = USES * -(-count // TOGETHER)
    for group in range(groups):
        number = group // USES % len(priors)
        prior, (slowest, fastest) = priors[number], speeds[number]
        if group % USES == 0:
            drawn = [prior.draw(rng) for _ in range(LANES)]
        cars = [prior.with_dampers(car, rng) for car in drawn]
        road = drawn_road(prior.car, float(rng.uniform(slowest, fastest)) * SPEED ** rng.uniform(-1.0, 1.0), rng)
        histories = drive(cars, road, prior.car, channels, duration, rng)
        for car, samples in zip(cars, histories, strict=True):
            for table, chosen, related in zip(features, rows, pairs, strict=True):
                table.append(bands.features([samples[chosen]], *related))
            of_road = {"waviness": road.waviness, "speed": road.speed, "level": float(np.log10(road.level))}
            unknowns = {**car.values, **of_road}
            names = tuple(unknowns)
            values.append([float(value) for value in unknowns.values()])
        if progress is not None:
            progress((group + 1) / groups)
    return Drives(features=tuple(map(np.array, features)), names=names, values=np.array(values))


def drawn_road(car: Car, speed: float, rng: np.random.Generator) -> DrawnRoad:
    """Return a road drawn at random for a speed [m/s]."""
    wheels = car.vehicle.composition.wheels
    track = 2.0 * sum(abs(wheel.patch[1]) for wheel in wheels) / len(wheels)
    return DrawnRoad(
        level=float(np.exp(rng.uniform(*np.log(LEVELS)))),
        waviness=float(rng.uniform(*WAVINESS)),
        track=track * float(TRACK ** rng.uniform(-1.0, 1.0)),
        variation=float(rng.uniform(*VARIATION)),
        speed=speed,
    )


def drive(
    cars: Sequence[DrawnCar],
    road: DrawnRoad,
    car: Car,
    channels: Sequence[str],
    duration: float,
    rng: np.random.Generator,
) -> Vector:
    """Return the records of sensors on cars that drive over a road [m/s2]; (cars, channels, n)."""
    placed = car.vehicle.composition.wheels
    front = min(wheel.patch[0] for wheel in placed)
    wheels: dict[str, tuple[float, Side]] = {
        wheel.name: (wheel.patch[0] - front, "right" if wheel.side > 0.0 else "left") for wheel in placed
    }
    signal = road.signal(wheels, SETTLING + duration, RATE, ROAD_HIGHEST, rng)
    batch = simulate_batch(
        [each.poles for each in cars],
        signal,
        dampers=[each.dampers for each in cars],
        record_rate=RATE,
        tyre_load=[each.tyre_load for each in cars],
        channels=channels,
        step=STEP,
    )
    histories = np.stack([batch.channels[name] for name in channels], axis=1)[:, :, int(SETTLING * RATE) :]
    size = histories.shape[:2]
    gain = GAIN ** rng.uniform(-1.0, 1.0, size)
    noise = NOISE[0] * (NOISE[1] / NOISE[0]) ** rng.random(size[0])
    return np.asarray(histories * gain[:, :, None] + noise[:, None, None] * rng.standard_normal(histories.shape))
