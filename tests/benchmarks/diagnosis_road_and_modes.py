"""Do the roughness index and the modes of a diagnosis hold? Drives of cars of the prior, whose values are known.

    python -m tests.benchmarks.diagnosis_road_and_modes

The sedan at 79 km/h for 39 s, the default number of drives, 120 new drives on 40 roads: a phone at the seat rail, its
horizontal axes known or in any direction, and eight sensors. Then classes A to D through the contact cams, against the
index of `road --iri`. At last the phone at other speeds: RMS error of the dampers in prior standard deviations.
"""

import sys

import numpy as np

from vehicle import Car, road
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.diagnosis.diagnosis import Diagnostics
from vehicle.studies.diagnosis.drawn_car import CarPrior
from vehicle.studies.diagnosis.drive_record import DriveRecord, Parts
from vehicle.studies.diagnosis.driven_modes import driven_modes, equivalent_constants
from vehicle.studies.diagnosis.roughness import road_index
from vehicle.studies.diagnosis.simulated_drives import RATE, SETTLED, drawn_road, plates_of, recorded, simulated

PHONE = tuple(f"seat_rail_acc_{axis}" for axis in "xyz")
EIGHT = tuple(f"{point}_{wheel}_acc_z" for point in ("knuckle", "damper_top") for wheel in ("fr", "fl", "rr", "rl"))
SETS = {"phone": (PHONE, ()), "phone in any direction": (PHONE, ("seat_rail",)), "eight": (EIGHT, ())}
SPEED, SECONDS, SEED = 22.0, 39.0, 20260064


def judged(diagnostics, samples, rate=RATE):
    record = DriveRecord(name="made", channels=diagnostics.channels, samples=samples, rate=rate, highest=40.0,
                         speeds=(SPEED, SPEED))  # fmt: skip
    seconds = samples.shape[1] / rate
    parts = Parts(spans=((0, samples.shape[1]),), seconds=seconds, speeds=(SPEED, SPEED), left_out={})
    return diagnostics.diagnosis(record, parts)


def inside(posterior, value):
    return posterior.quantile(0.05) <= value <= posterior.quantile(0.95)


def inside_the_prior(title, diagnostics, car):
    prior, rng, channels = CarPrior(car, SPEED), np.random.default_rng(SEED), diagnostics.channels
    index, pieces, modes = [], [], []
    for _ in range(40):
        cars = [prior.with_dampers(prior.draw(rng), rng) for _ in range(3)]
        where = drawn_road(prior.car, SPEED * 1.02 ** rng.uniform(-1.0, 1.0), rng)
        plates = plates_of(where, prior.car, SECONDS, rng)
        batch = simulated(cars, plates, channels, prior.car.poles)
        overall, ratios = road_index(plates, ["fr", "fl"], where.speed / RATE, SETTLED)
        constants = equivalent_constants(batch, prior.car.poles, SETTLED)
        for each, samples, c in zip(cars, recorded(batch, channels, rng), constants, strict=True):
            found, true = judged(diagnostics, samples), driven_modes(each.poles, c)
            posterior = found.unknowns["roughness"]
            index.append((np.log(10.0) * (posterior.quantile(0.5) - overall), inside(posterior, overall)))
            pieces += [(np.log(piece.index.quantile(0.5)) - np.log(10.0) * overall - ratio,
                        inside(piece.index, 10.0**overall * np.exp(ratio)))
                       for piece, ratio in zip(found.road_pieces, ratios, strict=False)]  # fmt: skip
            modes.append([(np.log(10.0) * (mode.frequency.quantile(0.5) - np.log10(true[mode.motion].frequency)),
                           inside(mode.frequency, np.log10(true[mode.motion].frequency)),
                           mode.damping.quantile(0.5) - true[mode.motion].damping,
                           inside(mode.damping, true[mode.motion].damping)) for mode in found.modes])  # fmt: skip
    for name, table in {"IRI": index, "IRI of 100 m": pieces}.items():
        print(f"{title}: {name}: RMS error {rms(table)[0]:.3f}, 90 % interval holds {np.mean(table, axis=0)[1]:.2f}")
    for mode, table in zip(found.modes, np.moveaxis(np.array(modes, dtype=float), 1, 0), strict=True):
        holds = table.mean(axis=0)
        print(f"{title}: {mode.motion}: frequency {rms(table)[0]:.3f}, holds {holds[1]:.2f}; damping ratio "
              f"{rms(table)[2]:.3f}, holds {holds[3]:.2f}", flush=True)  # fmt: skip


def rms(table):
    return np.sqrt(np.mean(np.square(np.array(table, dtype=float)), axis=0))


def classes(diagnostics, car):
    for letter in "ABCD":
        drive = road(letter, 3.6 * SPEED, duration=SECONDS + 4.0, seed=7, period="record")
        run = car.run(drive, "reduced", channels=diagnostics.channels)
        samples = np.array([run[name] for name in diagnostics.channels])[:, run.time >= 4.0]
        found = judged(diagnostics, samples, 1.0 / (run.time[1] - run.time[0])).roughness
        under = drive.under(car.vehicle)
        assert isinstance(under, RoadDrive)
        true = np.mean([index.overall for index, _ in under.roughness().values()])
        print(
            f"class {letter}: IRI {true:.2f} m/km, found {found[0]:.2f} ({found[1]:.2f} to {found[2]:.2f})", flush=True
        )


def main(words):
    car = Car.load("sedan")
    for title, (channels, free) in SETS.items() if "speeds" not in words else ():
        diagnostics = Diagnostics.of(car, channels, (SPEED, SPEED), SECONDS, highest=40.0, free=free)
        rows = [row for row, name in enumerate(diagnostics.drives.names) if name.startswith("damper ")]
        print(f"{title}: dampers {rms(diagnostics.learned.left_out[:, rows].ravel()):.3f} prior standard deviations")
        inside_the_prior(title, diagnostics, car)
        if title == "phone":
            classes(diagnostics, car.with_({"rear.left.damper.viscous": 600.0}))
    for speed in (40, 60, 80, 110, 140):
        diagnostics = Diagnostics.of(car, PHONE, (speed / 3.6, speed / 3.6), SECONDS, highest=40.0)
        rows = [row for row, name in enumerate(diagnostics.drives.names) if name.startswith("damper ")]
        assert diagnostics.at_wheels is not None
        print(f"{speed} km/h: phone {rms(diagnostics.learned.left_out[:, rows].ravel()):.3f}, eight "
              f"{rms(diagnostics.at_wheels.left_out[:, rows].ravel()):.3f}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1:])
