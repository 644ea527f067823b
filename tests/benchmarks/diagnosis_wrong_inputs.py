"""What does a diagnosis say of a wrong input: refused, widened, or a confident wrong statement?

    python -m tests.benchmarks.diagnosis_wrong_inputs [N]

N records of each kind (3), with a phone at the seat rail and with eight sensors at wheels and strut tops. No damper is
within 0.1 of the limit, 0.6: a statement with 90 % on the others is right or wrong for certain.
"""

import sys
from dataclasses import replace

import numpy as np
import scipy

from tests.benchmarks.diagnosis_calibration import EIGHT, PHONE, SECONDS, SPEED, WHEELS, as_drawn, both, judged
from vehicle import Car
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.studies.diagnosis.car_diagnosis import SURE, WORN
from vehicle.studies.diagnosis.drawn_car import CarPrior
from vehicle.studies.diagnosis.simulated_drives import RATE, drawn_road, drive

CHANNELS = (*PHONE, *EIGHT)
Z = [2, *range(3, 11)]
"""Rows of vertical accelerations."""
SEED = 20260167


class Makers:
    """Records of wrong kinds: samples of `CHANNELS` (11, n), and the factors of the dampers."""

    def __init__(self, car):
        self.car, self.prior, self.rng = car, CarPrior(car, SPEED), np.random.default_rng(SEED)

    def of_prior(self, **road):
        """A drive inside the prior, on a road with some other numbers."""
        truth = np.array([WORN])
        while np.min(np.abs(truth - WORN)) < 0.1:
            drawn = self.prior.with_dampers(self.prior.draw(self.rng), self.rng)
            truth = np.array([drawn.values[f"damper {wheel}"] for wheel in WHEELS])
        where = replace(drawn_road(self.car, SPEED, self.rng), **road)
        return drive([drawn], where, self.prior.car, CHANNELS, SECONDS, self.rng)[0], truth

    def of_car(self, car, truth=(1.0,) * 4):
        """A drive of another car."""
        rolling = car.with_({"driving.speed": SPEED})
        where = drawn_road(car, SPEED, self.rng)
        return drive([as_drawn(rolling)], where, rolling, CHANNELS, SECONDS, self.rng)[0], np.array(truth)

    def changed(self, change):
        """A drive inside the prior whose samples are changed."""
        samples, truth = self.of_prior()
        return change(samples.copy()), truth


def scaled(car, factor, kinds=(), **values):
    """The sedan with bushings and tyres of some kinds times a factor, and further numbers."""
    changes = dict(values)
    for connection in car.vehicle.composition.connections:
        if any(kind in connection.path for kind in kinds) and connection.tables:
            changes[f"{connection.tables[-1]}.stiffness"] = [factor * k for k in connection.law.stiffness]
    return car.with_(changes)


def rows_times(factor, rows):
    def change(samples):
        samples[rows] *= factor
        return samples

    return change


def filtered(kind, edges, order=2):
    sections = scipy.signal.butter(order, edges, kind, fs=RATE, output="sos")
    return lambda samples: scipy.signal.sosfilt(sections, samples, axis=1)


def loose(samples):
    """Sensors on a loose bracket: a resonance at 14 Hz with 8 % of critical damping."""
    w = 2.0 * np.pi * 14.0
    b, a = scipy.signal.bilinear([2.0 * 0.08 * w, w**2], [1.0, 2.0 * 0.08 * w, w**2], fs=RATE)
    return scipy.signal.lfilter(b, a, samples, axis=1)


def tilted(samples):
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    samples[[0, 2]] = np.array([[c, s], [-s, c]]) @ samples[[0, 2]]
    samples[3:] *= c
    return samples


def apart(samples):
    """Every second channel is 30 ms late."""
    samples[1::2] = np.roll(samples[1::2], round(0.03 * RATE), axis=1)
    return samples


def kinds(makers):
    """Titles and makers of records."""
    car, rng, changed = makers.car, makers.rng, makers.changed
    time = np.arange(round(SECONDS * RATE) + 1) / RATE
    engine = sum(np.sin(2.0 * np.pi * f * time) for f in (13.0, 26.0, 39.0))
    paths = [f"{axle}.main_spring.stiffness" for axle in ("front", "rear")]
    springs = {path: car[path].value for path in paths}
    van = {"body.mass": 1.5 * car["body.mass"].value} | {path: 1.7 * k for path, k in springs.items()}
    trunk = {"load.trunk.mass": 500.0, "load.trunk.at": [3.3, 0.0, 0.9]}
    dampers = [
        f"{damper.path.partition('.')[0]}.{'left' if damper.name.endswith('l') else 'right'}.damper"
        for damper in car.vehicle.composition.dampers
    ]
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    sticky = {f"{path}.coulomb_friction": 6.0 * law.coulomb_friction for path, law in zip(dampers, laws, strict=True)}
    gone = {f"{path}.viscous": 0.05 * law.viscous for path, law in zip(dampers[3:], laws[3:], strict=True)}

    def clipped(samples):
        limit = 1.2 * samples.std(axis=1, keepdims=True)
        return np.clip(samples, -limit, limit)

    def dead(samples):
        samples[[0, 3]] = 0.02 * rng.standard_normal((2, samples.shape[1]))
        return samples

    def unbalanced(samples):
        samples[[2, 3, 7]] += np.array([[0.2], [3.0], [1.0]]) * np.sin(2.0 * np.pi * SPEED / (2.0 * np.pi * 0.3) * time)
        return samples

    return {
        "the right input": makers.of_prior,
        "gravity in z": lambda: changed(lambda samples: samples + 9.81),
        "focus_road for the sedan": lambda: makers.of_car(Car.load("focus_road")),
        "body of 1.5 times the mass, springs of 1.7 times the stiffness": lambda: makers.of_car(car.with_(van)),
        "500 kg in the trunk": lambda: makers.of_car(car.with_(trunk)),
        "springs of twice the stiffness": lambda: makers.of_car(
            car.with_({path: 2.0 * k for path, k in springs.items()})
        ),
        "tyres of 0.6 times the stiffness": lambda: makers.of_car(scaled(car, 0.6, ("tyre",))),
        "mounts of 3 times the stiffness": lambda: makers.of_car(scaled(car, 3.0, ("mount", "arm", "pivot"))),
        "friction of 6 times": lambda: makers.of_car(car.with_(sticky)),
        "a damper without oil (5 %)": lambda: makers.of_car(car.with_(gone), (1.0, 1.0, 1.0, 0.05)),
        "100 km/h given as 79": lambda: makers.of_prior(speed=100.0 / 3.6),
        "60 km/h given as 79": lambda: makers.of_prior(speed=60.0 / 3.6),
        "87 km/h given as 79": lambda: makers.of_prior(speed=87.0 / 3.6),
        "g taken for m/s2": lambda: changed(lambda samples: samples / 9.81),
        "m/s2 taken for g": lambda: changed(lambda samples: 9.81 * samples),
        "mm/s2 taken for m/s2": lambda: changed(lambda samples: 1000.0 * samples),
        "velocity taken for acceleration": lambda: changed(
            lambda samples: filtered("highpass", 0.3)(np.cumsum(samples, axis=1) / RATE)
        ),
        "250 Hz taken for 200 Hz": lambda: changed(
            lambda samples: scipy.signal.resample(samples, round(1.25 * samples.shape[1]), axis=1)
        ),
        "x and z of the phone, front and rear wheels exchanged": lambda: changed(
            lambda samples: samples[[2, 1, 0, 5, 6, 3, 4, 9, 10, 7, 8]]
        ),
        "y and z of the phone, wheels and strut tops exchanged": lambda: changed(
            lambda samples: samples[[0, 2, 1, 7, 8, 9, 10, 3, 4, 5, 6]]
        ),
        "z of the phone and of the wheels upside down": lambda: changed(rows_times(-1.0, [2, 3, 4, 5, 6])),
        "one sensor upside down": lambda: changed(rows_times(-1.0, [0, 3])),
        "left and right exchanged": lambda: changed(
            lambda samples: rows_times(-1.0, [1])(samples[[0, 1, 2, 4, 3, 6, 5, 8, 7, 10, 9]])
        ),
        "tilted by 30 degrees": lambda: changed(tilted),
        "gain of one sensor of 1.5": lambda: changed(rows_times(1.5, [2, 3])),
        "one sensor without a signal": lambda: changed(dead),
        "clipped at 1.2 times the RMS": lambda: changed(clipped),
        "low-pass of 8 Hz in the sensor": lambda: changed(filtered("lowpass", 8.0)),
        "every second channel 30 ms late": lambda: changed(apart),
        "sensors on a loose bracket": lambda: changed(loose),
        "noise of 0.5 m/s2": lambda: changed(lambda samples: samples + 0.5 * rng.standard_normal(samples.shape)),
        "engine idles, the car stands": lambda: changed(lambda samples: 0.01 * samples + 0.3 * engine),
        "engine orders of 0.3 m/s2 in the drive": lambda: changed(lambda samples: samples + 0.3 * engine),
        "unbalanced wheel": lambda: changed(unbalanced),
        "road of class E": lambda: makers.of_prior(level=CLASSES["E"]),
        "road of class F": lambda: makers.of_prior(level=CLASSES["F"]),
        "road a tenth of class A": lambda: makers.of_prior(level=0.1 * CLASSES["A"]),
        "cobbles: waviness 1 at class D": lambda: makers.of_prior(level=CLASSES["D"], waviness=1.0),
        "long waves: waviness 3": lambda: makers.of_prior(waviness=3.0),
    }


def outcome(found, truth):
    """Refused, widened by a fifth, and statements on single dampers, of these wrong."""
    if found is None:
        return np.array([1, 0, 0, 0])
    said = [(found.worn(wheel), true < WORN) for wheel, true in zip(WHEELS, truth, strict=True)]
    sure = [(p >= SURE) != below for p, below in said if p >= SURE or p <= 1.0 - SURE]
    return np.array([0, found.widened > 1.2, len(sure), sum(sure)])


def main(words):
    """Print a row for each kind."""
    count = int(words[0]) if words else 3
    car = Car.load("sedan")
    diagnostics = both(car)
    table = kinds(Makers(car))
    print(f"{len(table)} inputs, {count} records each: refused, widened, statements, of these wrong (phone; eight)")
    total = {name: np.zeros(4, dtype=int) for name in diagnostics}
    for title, make in table.items():
        counts = {name: np.zeros(4, dtype=int) for name in diagnostics}
        for _ in range(count):
            samples, truth = make()
            for name, found in judged(diagnostics, samples).items():
                counts[name] += outcome(found, truth)
                total[name] += outcome(found, truth)
        print(f"  {title}: " + "; ".join(" ".join(map(str, each)) for each in counts.values()), flush=True)
    print("  all: " + "; ".join(" ".join(map(str, each)) for each in total.values()))


if __name__ == "__main__":
    main(sys.argv[1:])
