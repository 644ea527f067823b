"""Drives of drawn cars over drawn roads by the batch engine: their features and their unknowns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.batch_simulation import BatchRuns, simulate_batch
from vehicle.engines.reduced.pole_model import PoleModel
from vehicle.engines.reduced.table_layout import LANES
from vehicle.runs.car import Car
from vehicle.signals.excitation.iso_road import Side
from vehicle.signals.excitation.signal import Signal
from vehicle.studies.diagnosis import roughness
from vehicle.studies.diagnosis.drawn_car import CarPrior, DrawnCar
from vehicle.studies.diagnosis.drawn_road import DrawnRoad
from vehicle.studies.diagnosis.driven_modes import ModeValues, damper_channels, driven_modes, equivalent_constants
from vehicle.studies.diagnosis.features import HIGHEST, Bands, related_pairs, rows_of_points
from vehicle.studies.diagnosis.roughness import PieceFit
from vehicle.threads import one_blas_thread

RATE, STEP = 250.0, 2e-3
"""Sampling rate [Hz] and largest time step [s]. Densities up to 40 Hz differ by less than 1 % from those at 0.5 ms."""

ROAD_HIGHEST = 2.0 * HIGHEST
"""Highest frequency of the roads [Hz]."""

SETTLING = 4.0
"""Time at the start of a drive that is left out [s]."""

SETTLED = round(SETTLING * RATE)
"""Samples of this time."""

MODE_DRIVES = 240
"""Drives with modes, each 8 ms of processor time: with 480 the errors are 2 to 14 % smaller."""

NOMINAL_S = 60.0
"""Length of the drive of the car that is not worn [s]: damping ratios of two roads differ by 2 %."""

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
        modes: modes of the first drives by motion.
        pieces: fit of the roughness index of pieces of 100 m, of the first set of sensors; None for shorter drives.
    """

    features: tuple[Vector, ...]
    names: tuple[str, ...]
    values: Vector
    modes: tuple[Mapping[str, ModeValues], ...] = ()
    pieces: PieceFit | None = None

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
    values, names, levels, ratios = list[list[float]](), tuple[str, ...](), list[Vector](), list[Vector]()
    modes = list[Mapping[str, ModeValues]]()
    upward = [rows[0][row] for row in roughness.vertical(sensors[0])]
    groups = USES * -(-count // TOGETHER)
    for group in range(groups):
        number = group // USES % len(priors)
        prior, (slowest, fastest) = priors[number], speeds[number]
        cut = roughness.Pieces.of(RATE, float(np.sqrt(slowest * fastest)), highest)
        if group % USES == 0:
            drawn = [prior.draw(rng) for _ in range(LANES)]
        cars = [prior.with_dampers(car, rng) for car in drawn]
        road = drawn_road(prior.car, float(rng.uniform(slowest, fastest)) * SPEED ** rng.uniform(-1.0, 1.0), rng)
        plates = plates_of(road, prior.car, duration, rng)
        # As many drives as the modes need.
        batch = simulated(cars, plates, channels, prior.car.poles if len(modes) < MODE_DRIVES else None)
        histories = recorded(batch, channels, rng)
        if len(modes) < MODE_DRIVES:
            constants = equivalent_constants(batch, prior.car.poles, SETTLED)
            modes += [driven_modes(car.poles, each) for car, each in zip(cars, constants, strict=True)]
        tracks = {wheel.side: wheel.name for wheel in reversed(prior.car.vehicle.composition.wheels)}.values()
        index, of_pieces = roughness.road_index(plates, [*tracks], road.speed / RATE, SETTLED)
        for car, samples in zip(cars, histories, strict=True):
            for table, chosen, related in zip(features, rows, pairs, strict=True):
                table.append(bands.features([samples[chosen]], *related))
            levels.append(cut.levels([samples[upward]]))
            ratios.append(of_pieces)
            of_road = {"waviness": road.waviness, "speed": road.speed, "roughness": index}
            unknowns = {**car.values, **of_road, "level": float(np.log10(road.level))}
            names = tuple(unknowns)
            values.append([float(value) for value in unknowns.values()])
        if progress is not None:
            progress((group + 1) / groups)
    # With an unknown speed the places of the pieces are unknown.
    pieces = PieceFit.of(levels, ratios) if len(priors) == 1 else None
    return Drives(
        features=tuple(map(np.array, features)), names=names, values=np.array(values), modes=tuple(modes), pieces=pieces
    )


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


def nominal_modes(prior: CarPrior, speed: float, level: float, waviness: float) -> dict[str, ModeValues]:
    """Return the modes of the car that is not worn, at a speed [m/s] on a road with a level [m3] and a waviness."""
    rng = np.random.Generator(np.random.PCG64(1))
    usual = float(np.mean(VARIATION))
    road = replace(drawn_road(prior.car, speed, rng), level=level, waviness=waviness, variation=usual)
    car = DrawnCar(values={}, poles=prior.car.poles, dampers=prior.nominal, tyre_load=prior.car.static.tyre_load)
    batch = simulated([car], plates_of(road, prior.car, NOMINAL_S, rng), (), car.poles)
    return driven_modes(car.poles, equivalent_constants(batch, car.poles, SETTLED)[0])


def drive(
    cars: Sequence[DrawnCar],
    road: DrawnRoad,
    car: Car,
    channels: Sequence[str],
    duration: float,
    rng: np.random.Generator,
) -> Vector:
    """Return the records of sensors on cars that drive over a road [m/s2]; (cars, channels, n)."""
    return recorded(simulated(cars, plates_of(road, car, duration, rng), channels), channels, rng)


def plates_of(road: DrawnRoad, car: Car, duration: float, rng: np.random.Generator) -> Signal:
    """Return the heights of a road under the wheels of a car, from `SETTLING` before the record on."""
    placed = car.vehicle.composition.wheels
    front = min(wheel.patch[0] for wheel in placed)
    wheels: dict[str, tuple[float, Side]] = {
        wheel.name: (wheel.patch[0] - front, "right" if wheel.side > 0.0 else "left") for wheel in placed
    }
    return road.signal(wheels, SETTLING + duration, RATE, ROAD_HIGHEST, rng)


def simulated(
    cars: Sequence[DrawnCar], plates: Signal, channels: Sequence[str], poles: PoleModel | None = None
) -> BatchRuns:
    """Return channels of cars on a road; with `poles` also velocities and forces of their dampers."""
    dampers = () if poles is None else damper_channels(poles)
    return simulate_batch(
        [each.poles for each in cars],
        plates,
        dampers=[each.dampers for each in cars],
        record_rate=RATE,
        tyre_load=[each.tyre_load for each in cars],
        channels=(*channels, *dampers),
        step=STEP,
    )


def recorded(batch: BatchRuns, channels: Sequence[str], rng: np.random.Generator) -> Vector:
    """Return the records of sensors with random gain and noise [m/s2]; (cars, channels, n)."""
    histories = np.stack([batch.channels[name] for name in channels], axis=1)[:, :, SETTLED:]
    size = histories.shape[:2]
    gain = GAIN ** rng.uniform(-1.0, 1.0, size)
    noise = NOISE[0] * (NOISE[1] / NOISE[0]) ** rng.random(size[0])
    return np.asarray(histories * gain[:, :, None] + noise[:, None, None] * rng.standard_normal(histories.shape))
