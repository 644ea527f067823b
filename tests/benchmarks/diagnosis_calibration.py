"""Does the probability of a diagnosis hold? Drives with known dampers, of cars inside and outside the prior.

    python -m tests.benchmarks.diagnosis_calibration [inside N] [outside N] [mujoco N] [healthy N] [knee N] [seed N]

Without arguments all of them run. One training of drives with a phone at the seat rail, and one with eight sensors
at wheels and strut tops, serve all: the sedan at 79 km/h for 39 s.

inside: cars of the prior, few on each road: ranks of the true factors, 90 % intervals, AUC for "below 0.6", road class.
outside: springs, stabilizers and mounts +-30 % of each side apart, and other laws than those of the training.
mujoco: records of the MuJoCo engine, other roads (constant amplitudes of the lines), empty and laden.
healthy: how many of 4 N healthy dampers are called worn, at the threshold that finds 80 % of dampers at half force.
knee: N roads of class D, a rear damper whose slope falls at a velocity, with the force of 0.7 or 1.0 at 0.13 m/s.
Wrong inputs are in `tests.benchmarks.diagnosis_wrong_inputs`.
"""

import sys
import time
from dataclasses import replace
from typing import Any

import numpy as np
import scipy

from vehicle import Car, road
from vehicle.errors import DataError
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.studies.diagnosis.car_diagnosis import SURE, WORN
from vehicle.studies.diagnosis.diagnosis import Diagnostics
from vehicle.studies.diagnosis.drawn_car import CarPrior, DrawnCar
from vehicle.studies.diagnosis.drive_record import DriveRecord, Parts
from vehicle.studies.diagnosis.simulated_drives import RATE, drawn_road, drive

WHEELS = ("fr", "fl", "rr", "rl")
"""In the order of the car."""
PHONE = tuple(f"seat_rail_acc_{axis}" for axis in "xyz")
EIGHT = tuple(f"{point}_{wheel}_acc_z" for point in ("knuckle", "damper_top") for wheel in WHEELS)
SPEED, SECONDS = 22.0, 39.0
SEED = 20260163
"""Seed of the drives with known dampers, if none is given; the training has another."""


def both(car, speed=SPEED, count=None):
    """Diagnostics of a car with the phone and with the eight sensors."""
    return {
        name: Diagnostics.of(car, channels, (speed, speed), SECONDS, highest=40.0, count=count)
        for name, channels in {"phone": PHONE, "eight": EIGHT}.items()
    }


def record_of(samples, channels, rate=RATE):
    """Record of samples (channels, n), all of which are used."""
    record = DriveRecord(name="made", channels=tuple(channels), samples=samples, rate=rate, highest=40.0,
                         speeds=(SPEED, SPEED))  # fmt: skip
    count = samples.shape[1]
    return record, Parts(spans=((0, count),), seconds=count / rate, speeds=(SPEED, SPEED), left_out={})


def judged(diagnostics, samples, rate=RATE):
    """Diagnosis of samples of the phone, then the eight sensors; None where it is refused."""
    found = {}
    for name, each in diagnostics.items():
        chosen = samples[: len(PHONE)] if name == "phone" else samples[len(PHONE) :]
        try:
            found[name] = each.diagnosis(*record_of(chosen, each.channels, rate))
        except DataError:
            found[name] = None
    return found


class Score:
    """Truths against diagnoses of one set of sensors."""

    def __init__(self, title):
        self.title, self.truth, self.rank, self.inside, self.worn, self.deviation = title, [], [], [], [], []
        self.refused, self.classes, self.widened = 0, [], []

    def add(self, diagnosis, truth, level=None):
        if diagnosis is None:
            self.refused += 1
            return
        posteriors = [diagnosis.damper(wheel) for wheel in WHEELS]
        self.truth.append(truth)
        self.rank.append([each.below(true) for each, true in zip(posteriors, truth, strict=True)])
        ends = [(each.quantile(0.05), each.quantile(0.95)) for each in posteriors]
        self.inside.append([low <= true <= high for (low, high), true in zip(ends, truth, strict=True)])
        self.worn.append([each.below(WORN) for each in posteriors])
        self.deviation.append([each.mean - true for each, true in zip(posteriors, truth, strict=True)])
        self.widened.append(diagnosis.widened)
        if level is not None:
            right = min(CLASSES, key=lambda letter: abs(np.log(CLASSES[letter] / level)))
            self.classes.append(diagnosis.road.letter == right)

    def show(self):
        truth, worn = np.array(self.truth), np.array(self.worn)
        below = truth < WORN
        auc = [_auc(worn[:, k], below[:, k]) for k in range(len(WHEELS))]
        p = [scipy.stats.chisquare(np.histogram(np.array(self.rank)[:, k], 10, (0.0, 1.0))[0]).pvalue for k in range(4)]
        sure, clear = worn >= SURE, worn <= 1.0 - SURE
        print(
            f"{self.title}: n {len(truth)}, refused {self.refused}, widened {np.mean(np.array(self.widened) > 1.0):.2f}"
            f"; 90 % holds {_list(np.mean(self.inside, axis=0))}; p of ranks {_list(p)}; "
            f"RMS {_list(np.sqrt(np.mean(np.square(self.deviation), axis=0)))}; AUC {_list(auc)}, all "
            f"{_auc(worn.ravel(), below.ravel()):.3f}",
            flush=True,
        )
        print(
            f"    called worn {sure.sum()}, of these wrong {(sure & ~below).sum()}; called good {clear.sum()}, of "
            f"these wrong {(clear & below).sum()}"
            + (f"; class right {np.mean(self.classes):.2f} of {len(self.classes)}" if self.classes else ""),
            flush=True,
        )


def _auc(score, positive):
    ranks, count = scipy.stats.rankdata(score), int(positive.sum())
    return float((ranks[positive].sum() - count * (count + 1) / 2) / (count * (len(ranks) - count)))


def _list(values):
    return " ".join(f"{value:.3f}" for value in values)


def drawn(prior, count, rng, on_road=4):
    """Yield samples, true factors and road of drives of drawn cars, `on_road` of them on each road."""
    for _ in range(-(-count // on_road)):
        cars = [prior.with_dampers(prior.draw(rng), rng) for _ in range(on_road)]
        where = drawn_road(prior.car, SPEED, rng)
        histories = drive(cars, where, prior.car, (*PHONE, *EIGHT), SECONDS, rng)
        for car, samples in zip(cars, histories, strict=True):
            yield samples, [car.values[f"damper {wheel}"] for wheel in WHEELS], where


def inside(diagnostics, prior, count, seed):
    scores = {name: Score(f"inside, {name}") for name in diagnostics}
    for samples, truth, where in drawn(prior, count, np.random.default_rng(seed)):
        for name, found in judged(diagnostics, samples).items():
            scores[name].add(found, truth, where.level)
    for score in scores.values():
        score.show()


def other_car(car, rng, chosen=None):
    """A car outside the prior and its factors: other laws, each spring, stabilizer and mount +-30 % on each side."""
    factors = dict(zip(WHEELS, rng.uniform(0.3, 1.15, 4) if chosen is None else chosen, strict=True))
    changes: dict[str, Any] = {}
    composition = car.vehicle.composition
    for damper in composition.dampers:
        instance, wheel = damper.path.partition(".")[0], damper.name.removeprefix("damper_")
        path = f"{instance}.{'left' if wheel.endswith('l') else 'right'}.damper"
        factor, law = float(factors[wheel]), damper.law
        if law.viscous_law == "table":
            # Progressive or degressive, with the same force at 0.13 m/s.
            bend = rng.uniform(-0.25, 0.25) if rng.random() < 0.7 else 0.0
            shape = [(max(abs(v), 1e-3) / 0.13) ** bend for v in law.velocity]
            changes[f"{path}.force"] = [factor * f * s for f, s in zip(law.force, shape, strict=True)]
        elif rng.random() < 0.5:
            changes[f"{path}.viscous"] = factor * law.viscous
        else:
            # Below 0.065 m/s 1.7 times as steep as above, with the same force at 0.13 m/s.
            slope = factor * law.viscous / 1.35
            changes |= {f"{path}.viscous_law": "degressive", f"{path}.viscous": slope,
                        f"{path}.degressive_viscous": 1.7 * slope, f"{path}.degressive_velocity": 0.065}  # fmt: skip
        friction = float(rng.uniform(0.6, 1.6)) * law.coulomb_friction
        changes[f"{path}.coulomb_friction"] = friction
        if (kind := rng.random()) < 0.35:
            changes |= {f"{path}.friction_law": "stribeck", f"{path}.stribeck_friction": 1.5 * friction,
                        f"{path}.stribeck_velocity": 0.01, f"{path}.stribeck_exponent": 1.0}  # fmt: skip
        elif kind < 0.5:
            changes |= {f"{path}.friction_law": "presliding", f"{path}.presliding_stiffness": 2e6}
    for connection in composition.connections:
        if connection.law is None:
            continue
        tyre, wheel = connection.name.startswith("tyre_"), connection.name[-3:]
        instance, _, rest = connection.path.partition(".")
        side = {"_l": ".left", "_r": ".right"}.get(wheel[0] + wheel[2:], "") if wheel[0] == "_" else ""
        share = rng.uniform(0.87, 1.13) if tyre else rng.uniform(0.7, 1.3)
        scaled = [(share if axis == 2 or not tyre else 1.0) * k for axis, k in enumerate(connection.law.stiffness)]
        changes[f"{instance}{side}.{rest}.stiffness"] = scaled
    for path, kind in composition.kinds.items():
        key = {"MainSpring": "stiffness", "Stabilizer": "torsional_stiffness"}.get(kind.__name__)
        if key:
            changes[f"{path}.{key}"] = car[f"{path}.{key}"].value * float(rng.uniform(0.7, 1.3))
    if rng.random() < 0.5:
        changes |= {"load.trunk.mass": float(rng.uniform(50.0, 220.0)), "load.trunk.at": [3.3, 0.1, 0.9]}
    changes |= {"load.driver.mass": float(rng.uniform(50.0, 95.0)), "load.driver.at": [1.9, -0.36, 0.8]}
    return car.with_(changes), [float(factors[wheel]) for wheel in WHEELS]


def as_drawn(car):
    """A car in the form of the batch engine."""
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    return DrawnCar(values={}, poles=car.poles, dampers=laws, tyre_load=car.static.tyre_load)


def others(car, count, rng, factors=lambda number: None, on_road=4):
    """Yield samples, factors and road of drives of cars outside the prior by the batch engine."""
    rolling = car.with_({"driving.speed": SPEED})
    for number in range(-(-count // on_road)):
        made = [other_car(rolling, rng, factors(number * on_road + k)) for k in range(on_road)]
        where = drawn_road(car, SPEED, rng)
        histories = drive([as_drawn(each) for each, _ in made], where, rolling, (*PHONE, *EIGHT), SECONDS, rng)
        for (_, truth), samples in zip(made, histories, strict=True):
            yield samples, truth, where


def outside(diagnostics, car, count, seed):
    scores = {name: Score(f"outside, {name}") for name in diagnostics}
    for samples, truth, where in others(car, count, np.random.default_rng(seed + 1)):
        for name, found in judged(diagnostics, samples).items():
            scores[name].add(found, truth, where.level)
    for score in scores.values():
        score.show()


def by_mujoco(diagnostics, car, count, _seed):
    # These 45 drives are those that were seen while the prior was chosen, whatever the seed.
    rng = np.random.default_rng(20260065)
    scores = {name: Score(f"MuJoCo, {name}") for name in diagnostics}
    for number in range(count):
        made, truth = other_car(car, rng)
        letter = "ABCD"[number % 4]
        ridden = road(letter, 3.6 * SPEED, duration=SECONDS + 4.0, seed=500 + number, period="record")
        run = made.run(ridden, channels=(*PHONE, *EIGHT))
        samples = np.array([run[name] for name in (*PHONE, *EIGHT)])[:, run.time >= 3.5]
        for name, found in judged(diagnostics, samples, 1.0 / (run.time[1] - run.time[0])).items():
            scores[name].add(found, truth, CLASSES[letter])
    for score in scores.values():
        score.show()


def healthy(diagnostics, car, count, seed):
    """False alarms on healthy cars at the threshold that finds 80 % of the cars with one damper at half its force."""
    rng = np.random.default_rng(seed + 3)

    def good(number):
        return rng.uniform(0.85, 1.15, 4)

    def at_half(number):
        return np.where(np.arange(4) == number % 4, 0.5, rng.uniform(0.85, 1.15, 4))

    found: dict[tuple[str, str], list[float]] = {}
    for kind, factors in (("good", good), ("half", at_half)):
        for number, (samples, _, _) in enumerate(others(car, count, rng, factors)):
            for name, diagnosis in judged(diagnostics, samples).items():
                worn = [0.0] * 4 if diagnosis is None else [diagnosis.worn(wheel) for wheel in WHEELS]
                found.setdefault((name, kind), []).append(worn[number % 4] if kind == "half" else max(worn))
    for name in diagnostics:
        threshold = float(np.quantile(found[name, "half"], 0.2))
        alarms = int(np.sum(np.array(found[name, "good"]) >= threshold))
        sure = [int(np.sum(np.array(found[name, kind]) >= SURE)) for kind in ("good", "half")]
        print(
            f"healthy, {name}: {alarms} of {len(found[name, 'good'])} healthy cars alarm at P {threshold:.2f}, which "
            f"finds 80 % of {len(found[name, 'half'])} dampers at half force; at P {SURE}: {sure[0]} and {sure[1]}",
            flush=True,
        )


def knee(diagnostics, car, count, seed):
    """Deviations of a damper whose slope below a velocity is the larger one, by a ratio."""
    rng, rolling = np.random.default_rng(seed + 4), car.with_({"driving.speed": SPEED})
    cases = [(factor, *bend) for factor in (0.7, 1.0) for bend in ((1.0, 0.13), (1.7, 0.065), (1.7, 0.13))]
    made, nominal = [], car["rear.left.damper.viscous"].value
    for factor, ratio, velocity in cases:
        slope = factor * nominal * 0.13 / (0.13 + (ratio - 1.0) * velocity)
        law = {"viscous_law": "degressive", "viscous": slope, "degressive_viscous": ratio * slope,
               "degressive_velocity": velocity}  # fmt: skip
        made.append(as_drawn(rolling.with_({f"rear.left.damper.{key}": value for key, value in law.items()})))
    found: dict[tuple[Any, ...], list[tuple[float, float]]] = {}
    for _ in range(count):
        where = replace(drawn_road(car, SPEED, rng), level=CLASSES["D"])
        for case, samples in zip(cases, drive(made, where, rolling, (*PHONE, *EIGHT), SECONDS, rng), strict=True):
            for name, diagnosis in judged(diagnostics, samples).items():
                if diagnosis is not None:
                    each = diagnosis.damper("rl").quantile(0.5) - case[0], diagnosis.worn("rl")
                    found.setdefault((name, *case), []).append(each)
    for (name, factor, ratio, velocity), pairs in found.items():
        apart, worn = np.array(pairs).T
        print(
            f"knee, {name}: force {factor:g}, slopes {ratio:g} to 1 at {velocity:g} m/s: n {len(pairs)}, median apart "
            f"{apart.mean():.2f} +-{apart.std():.2f}, P(worn) {worn.mean():.2f}, up to {worn.max():.2f}",
            flush=True,
        )


def main(words):
    """Run the parts that are named, with their numbers of cars."""
    numbers = {"inside": 400, "outside": 200, "mujoco": 45, "healthy": 100, "knee": 8}
    if words:
        numbers = {name: int(count) for name, count in zip(words[::2], words[1::2], strict=True)}
    seed = numbers.pop("seed", SEED)
    started = time.process_time()
    car = Car.load("sedan")
    diagnostics = both(car)
    print(f"training: {len(diagnostics['phone'].drives.values)} drives of {SECONDS:g} s in "
          f"{time.process_time() - started:.1f} s of processor time", flush=True)  # fmt: skip
    if "inside" in numbers:
        inside(diagnostics, CarPrior(car, SPEED), numbers["inside"], seed)
    for name, part in {"outside": outside, "mujoco": by_mujoco, "healthy": healthy, "knee": knee}.items():
        if name in numbers:
            part(diagnostics, car, numbers[name], seed)


if __name__ == "__main__":
    main(sys.argv[1:])
