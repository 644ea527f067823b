"""Coverage of the stated errors by Monte Carlo: `python -m tests.benchmarks.coverage [PART ...] [--repetitions N]`.

Parts: `comfort`, comfort_error and the error of a difference, of a linear car on generated and on Gaussian roads;
`length`, comfort of 10, 30 and 60 s of one class with the reduced engine; `twin`, comfort and differences of cars on
roads that repeat, with their linear twins; `kinds`, the same for five kinds of cars; `ratio`, comfort over a class from
roads that do not repeat; `precision`, runs whose length a precision has chosen; `profile`, values of a whole profile
from pieces of it; `quantile`, quantiles of made cars; `sobol`, intervals of Sobol indices; `tuning`, standard errors of
fitted parameters.
"""

import argparse
import itertools
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy

from tests.benchmarks.car_kinds import kinds
from tests.benchmarks.profile_pieces import profile
from tests.benchmarks.road_precision import precision
from tests.studies.tuning.two_masses import FREQUENCY, SIGMA, TRUE, MeasuredMasses
from vehicle.engines.reduced.batch_simulation import COARSE_STEP
from vehicle.model.parameters.ranges import Range
from vehicle.names import AXES
from vehicle.runs.car import Car, Road
from vehicle.runs.car.class_value import class_values
from vehicle.signals.analysis.comfort import COMFORT_BAND, comfort_values
from vehicle.signals.analysis.comfort_error import STUDENT_95, WAVES, difference_error
from vehicle.signals.analysis.ride_comfort import ERROR, UNWEIGHTED, WEIGHTED, comfort_columns, wave_names, waves_of
from vehicle.signals.analysis.road_level import CLASSES, REFERENCE
from vehicle.signals.excitation.iso_road import isotropic_coherence
from vehicle.signals.excitation.road_drive import RoadDrive
from vehicle.studies.optimisation.trials import Spread, bands, samples_for
from vehicle.studies.sweeps.case_evaluation import measured_batch
from vehicle.studies.sweeps.indices import sobol_indices, sobol_sample
from vehicle.studies.sweeps.measure import ComfortMeasure
from vehicle.studies.tuning.least_squares import fit

Vector = npt.NDArray[np.float64]
Rows = list[dict[str, Any]]

RAIL = tuple(f"seat_rail_acc_{axis}" for axis in AXES)
RATE = 250.0
SKIP = 2.0
PERIOD = 32
"""Length of the road whose cut is Gaussian, over that of the record."""


class LinearRide:
    """Seat rail of a linear car with sliding dampers on roads of a class, in steady state.

    Args:
        name: of the car.
        road: class of ISO 8608.
        speed: [km/h].
        overrides: other parameters of the car.
    """

    def __init__(self, name: str, road: str, speed: float, overrides: Sequence[str] = ()) -> None:
        car = Car.load(name, overrides)
        drive = Road(road, speed, seed=1).under(car.vehicle)
        assert isinstance(drive, RoadDrive)
        self.drive = drive
        self.level, self.speed = CLASSES[road], speed / 3.6
        self.grid = np.arange(0.5, 60.0, 0.02)
        self.to_wheel = {
            wheel: car.matrix_frf(RAIL, self.grid, damper="sliding", wheel=wheel) for wheel in car.vehicle.wheels
        }

    def record(self, duration: float, period: float, seed: int) -> Vector:
        """Accelerations of the last `duration` [s] of a generated road of `period` [s]; (axes, samples)."""
        lines = np.arange(int(np.ceil(0.5 * period)), int(59.9 * period))
        frequency = lines / period
        related = isotropic_coherence(frequency / self.speed, self.drive.track)
        phase = np.exp(2j * np.pi * np.random.default_rng(seed).random((2, lines.size)))
        density = self.level * (frequency / self.speed / REFERENCE) ** -2.0 / self.speed
        tracks = np.sqrt(density / period * np.array([1.0 + related, 1.0 - related])) * phase
        spectrum = np.zeros((3, round(period * RATE) // 2 + 1), dtype=np.complex128)
        for wheel, behind, side in self.drive.wheels:
            plate = tracks[0] + (1.0 if side == "right" else -1.0) * tracks[1]
            late = plate * np.exp(-2j * np.pi * frequency * behind / self.speed)
            for axis, response in enumerate(self.to_wheel[wheel]):
                real, imaginary = (np.interp(frequency, self.grid, part) for part in (response.real, response.imag))
                spectrum[axis, lines] += (real + 1j * imaginary) * late
        history = np.fft.irfft(spectrum, round(period * RATE), axis=1) * (0.5 * round(period * RATE))
        return np.asarray(history[:, -round(duration * RATE) :])


def comfort(repetitions: int) -> Rows:
    """Stated error of comfort and of the difference of two cars, against their scatter over roads."""
    cars = [LinearRide("focus_road", "A", 80.0, more) for more in ((), ("*.damper.viscous=1500",))]
    factor = float(scipy.stats.t.ppf(0.975, 2 * WAVES))
    rows: Rows = []
    for duration in (10.0, 30.0, 60.0):
        for kind, length in (("generated road", 1), ("Gaussian road", PERIOD)):
            found = [
                comfort_columns(
                    1.0 / RATE, np.array([car.record(duration, length * duration, seed) for car in cars]), skip=SKIP
                )
                for seed in range(repetitions)
            ]
            for name in (UNWEIGHTED, WEIGHTED):
                values = np.array([one[name] for one in found])
                error = np.array([one[f"{name}{ERROR}"][0] * one[name][0] for one in found])
                waves = np.array([[one[each] for each in wave_names(name)] for one in found])
                apart = difference_error(*np.moveaxis(waves[:, 0::2] + 1j * waves[:, 1::2], 2, 0))
                gap = values[:, 0] - values[:, 1]
                rows.append(
                    {
                        "road": kind,
                        "value": name,
                        "duration": duration,
                        "comfort": values[:, 0].mean(),
                        "scatter": values[:, 0].std(ddof=1),
                        "stated": np.sqrt(np.mean(error**2)),
                        "covers_95": np.mean(np.abs(values[:, 0] - values[:, 0].mean()) < 1.96 * error),
                        "difference": gap.mean(),
                        "its_scatter": gap.std(ddof=1),
                        "its_error": np.sqrt(np.mean(apart**2)),
                        "it_covers_95": np.mean(np.abs(gap - gap.mean()) < factor * apart),
                    }
                )
    return rows


def length(repetitions: int) -> Rows:
    """Comfort of 10, 30 and 60 s of class B at 80 km/h with the reduced engine, from the default of --skip on."""
    car = Car.load("focus_road")
    rows: Rows = []
    for duration in (10.0, 30.0, 60.0):
        found, whole = [], []
        for seed in range(1, min(repetitions, 30) + 1):
            drive = Road("B", 80.0, duration=duration, seed=seed, period="record").under(car.vehicle)
            run = replace(car.run(drive.signal(), engine="reduced", channels=RAIL), skip=drive.skip)
            step = run.recording.timestep
            found.append(comfort_values(step, np.array([run.at("seat_rail")])))
            whole.append(comfort_values(step, [[run[name] for name in RAIL]]).overall[0])
        values = np.array([one.overall[0] for one in found])
        error = np.array([one.error[0] * one.overall[0] for one in found])
        rows.append(
            {
                "duration": duration,
                "seeds": values.size,
                "comfort": values.mean(),
                "error_of_mean": values.std(ddof=1) / np.sqrt(values.size),
                "scatter": values.std(ddof=1),
                "stated_for_class": np.sqrt(np.mean(error**2)),
                "comfort_without_skip": np.mean(whole),
            }
        )
    return rows


CHANGES = {
    "sedan": ("rear.damper.viscous=1530", "front.damper.coulomb_friction=100", "body.mass=1200"),
    "focus_road": ("front.damper.viscous=1800", "front.damper.coulomb_friction=100"),
}
"""Car to the changes of the other cars on the same roads."""


def twin(repetitions: int) -> Rows:
    """Errors of 10 s of a road that repeats, 50 and 100 km/h, classes A to C, against the scatter over its seeds."""
    rows: Rows = []
    for name, speed, road in itertools.product(CHANGES, (50.0, 100.0), "ABC"):
        cars = [Car.load(name, [f"driving.speed={speed / 3.6!r}", *change]) for change in ((), *zip(CHANGES[name]))]
        found = []
        for seed in range(1, repetitions + 1):
            drive = Road(road, speed, seed=seed).under(cars[0].vehicle)
            assert isinstance(drive, RoadDrive)
            signal = replace(drive, duration=drive.skip + 10.0).signal()
            measure = ComfortMeasure(skip=drive.skip, timestep=COARSE_STEP)
            results = measured_batch(cars, signal, measure, accept_invalid=True)
            found.append([each.values for each in results if each is not None])
        for value in (UNWEIGHTED, WEIGHTED):
            table = {key: np.array([[row[key] for row in run] for run in found]) for key in found[0][0]}
            comfort, error = table[value], table[value] * table[f"{value}{ERROR}"]
            waves = np.stack([waves_of({key: column[:, car] for key, column in table.items()}, value)
                              for car in range(len(cars))])  # fmt: skip
            percent = 100.0 / comfort[:, 0].mean()
            rows.append(
                {
                    "car": f"{name} {speed:g} km/h {road}",
                    "value": value,
                    "comfort": comfort[:, 0].mean(),
                    "scatter_percent": percent * comfort[:, 0].std(ddof=1),
                    "half_width_percent": percent * 1.96 * np.sqrt(np.mean(error[:, 0] ** 2)),
                    "covers_95": np.mean(np.abs(comfort[:, 0] - comfort[:, 0].mean()) < 1.96 * error[:, 0]),
                }
            )
            for number, change in enumerate(CHANGES[name], 1):
                gap, stated = comfort[:, number] - comfort[:, 0], difference_error(waves[number], waves[0])
                rows.append(
                    {
                        "car": f"  {change}",
                        "value": value,
                        "change_percent": percent * gap.mean(),
                        "scatter_percent": percent * gap.std(ddof=1),
                        "half_width_percent": percent * STUDENT_95 * np.sqrt(np.mean(stated**2)),
                        "covers_95": np.mean(np.abs(gap - gap.mean()) < STUDENT_95 * stated),
                    }
                )
    return rows


def ratio(repetitions: int) -> Rows:
    """Comfort over roads of a class from 10 s of roads that do not repeat, against 5 roads of 100 s that repeat."""
    rows: Rows = []
    for name, speed, road in itertools.product(CHANGES, (50.0, 100.0), "ABC"):
        car = Car.load(name)
        long = [car.run(Road(road, speed, duration=102.0, seed=seed), engine="reduced") for seed in range(1, 6)]
        reference = np.mean([run.comfort().weighted.overall for run in long])
        found, values = [], []
        for seed in range(1, repetitions + 1):
            run = car.run(Road(road, speed, duration=12.0, seed=seed, period="record"), engine="reduced")
            assert run.road is not None
            comfort = run.comfort()
            found.append(comfort.weighted.overall)
            each = class_values(run.car, run.signal, run.recording, run.skip, run.road, run.signal.band(COMFORT_BAND))
            # Where the twin explains less than half, the run itself counts.
            alone = found[-1], 1.96 * comfort.errors[WEIGHTED] * found[-1]
            values.append(each[WEIGHTED][:2] if WEIGHTED in each else alone)
        value, half = np.array(values).T
        rows.append(
            {
                "car": f"{name} {speed:g} km/h {road}",
                "scatter_of_run_percent": 100.0 * np.std(found, ddof=1) / reference,
                "scatter_percent": 100.0 * value.std(ddof=1) / reference,
                "bias_percent": 100.0 * (value.mean() / reference - 1.0),
                "half_width_percent": 100.0 * np.sqrt(np.mean(half**2)) / reference,
                "covers_95": np.mean(np.abs(value - reference) < half),
            }
        )
    return rows


def quantile(repetitions: int) -> Rows:
    """Share of new cars within a stated quantile of made cars, for responses of one to six tolerances."""
    responses: dict[str, Callable[[Vector], Vector]] = {
        "sum": lambda u: np.sum(u, axis=-1),
        "falling weights": lambda u: np.asarray(u @ 0.6 ** np.arange(u.shape[-1])),
        "curved": lambda u: np.asarray((u**2 + 0.3 * u) @ 0.6 ** np.arange(u.shape[-1])),
        "product": lambda u: np.prod(1.0 + 0.9 * u, axis=-1),
        "largest": lambda u: np.max(u, axis=-1),
    }
    rng = np.random.default_rng(0)
    rows: Rows = []
    for share in (0.85, 0.9, 0.95):
        samples = max(8, samples_for(share))
        for count in (1, 3, 6):
            spreads = [
                Spread(tolerances=(), bands=bands(count, samples, seed), quantile=share) for seed in range(repetitions)
            ]
            for name, response in responses.items():
                reference = np.sort(response(rng.uniform(-1.0, 1.0, (100_000, count))))
                stated = [float(one.statistic_of(response(one.bands)[None])[0]) for one in spreads]
                reached = np.searchsorted(reference, stated) / reference.size
                rows.append(
                    {
                        "quantile": share,
                        "cars": samples,
                        "tolerances": count,
                        "response": name,
                        "reached": reached.mean(),
                        "scatter": reached.std(ddof=1),
                    }
                )
    return rows


def sobol(repetitions: int) -> Rows:
    """Coverage of the 95 % intervals of Sobol indices of two functions whose indices are known."""
    a, b = 7.0, 0.1
    alone = np.array([0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2, a**2 / 8.0, 0.0])
    shared = b**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    whole = alone.sum() + shared
    weights = np.array([0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0])
    parts = 1.0 / 3.0 / (1.0 + weights) ** 2
    product = np.prod(1.0 + parts)
    cases = (
        (
            "Ishigami",
            [Range(path=f"x{i}", low=-np.pi, high=np.pi) for i in range(3)],
            1024,
            lambda x: np.sin(x[:, 0]) + a * np.sin(x[:, 1]) ** 2 + b * x[:, 2] ** 4 * np.sin(x[:, 0]),
            (alone / whole, (alone + shared * np.array([1.0, 0.0, 1.0])) / whole),
        ),
        (
            "g-function",
            [Range(path=f"x{i}", low=0.0, high=1.0) for i in range(8)],
            512,
            lambda x: np.prod((np.abs(4.0 * x - 2.0) + weights) / (1.0 + weights), axis=1),
            (parts / (product - 1.0), parts * product / (1.0 + parts) / (product - 1.0)),
        ),
    )
    rows: Rows = []
    for name, ranges, base, function, exact in cases:
        found = [sobol_indices(ranges, function(sobol_sample(ranges, base, seed=seed))) for seed in range(repetitions)]
        for index, one in enumerate(("first", "total")):
            values = np.array([getattr(each, one) for each in found])
            widths = np.array([getattr(each, f"{one}_error") for each in found])
            for number, path in enumerate(found[0].paths):
                inside = np.abs(values[:, number] - exact[index][number]) <= widths[:, number]
                rows.append(
                    {
                        "function": name,
                        "index": one,
                        "parameter": path,
                        "exact": exact[index][number],
                        "error": np.sqrt(np.mean((values[:, number] - exact[index][number]) ** 2)),
                        "half_width": widths[:, number].mean(),
                        "covers_95": inside.mean(),
                    }
                )
    return rows


class MeasuredNoise:
    """FRFs of two masses with noise of 3 % that is correlated over the lines or between the channels.

    Args:
        rho: correlation of neighbouring lines (autoregression of first order) [-].
        shared: both channels have the same noise.
        seed: of the noise.
    """

    rows = MeasuredMasses.rows

    def __init__(self, rho: float, shared: bool, seed: int) -> None:
        white = np.random.default_rng(seed).standard_normal((2, 1 if shared else 2, FREQUENCY.size + 50))
        noise = scipy.signal.lfilter([np.sqrt(1.0 - rho**2)], [1.0, -rho], white, axis=2)[:, :, 50:]
        self.target = MeasuredMasses(sigma=0.0)
        self.target.data = self.target.data * np.exp(SIGMA * (noise[0] + 1j * noise[1]))
        self.recorded, self.half_sample = (), 0.0
        self.response, self.misfit = self.target.response, self.target.misfit


def tuning(repetitions: int) -> Rows:
    """Coverage of value +- 1.96 standard errors of three fitted parameters, 60 lines of two channels."""
    parameters = (
        Range(path="lower", low=5e4, high=1e6, start=1.6e5),
        Range(path="upper", low=5e3, high=2e5, start=5e4),
        Range(path="damping", low=2e2, high=1e4, start=700.0),
    )
    rows: Rows = []
    for rho, shared in ((0.0, False), (0.3, False), (0.5, False), (0.8, False), (0.0, True)):
        found = [fit(parameters, [MeasuredNoise(rho, shared, seed)], dict) for seed in range(repetitions)]
        for path, value in TRUE.items():
            away = np.array([one.deviation(path, value) for one in found])
            rows.append(
                {
                    "neighbouring lines": rho,
                    "channels": "same noise" if shared else "own noise",
                    "parameter": path,
                    "scatter_over_stated": away.std(ddof=1),
                    "covers_95": np.mean(np.abs(away) < 1.96),
                }
            )
    return rows


PARTS: dict[str, Callable[[int], Rows]] = {
    "comfort": comfort, "length": length, "twin": twin, "kinds": kinds, "ratio": ratio, "precision": precision,
    "profile": profile,
    "quantile": quantile, "sobol": sobol, "tuning": tuning,
}  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables."""
    parser = argparse.ArgumentParser(prog="tests.benchmarks.coverage", description=(__doc__ or "").split(":")[0])
    parser.add_argument("parts", nargs="*", default=[*PARTS], metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--repetitions", type=int, default=200, metavar="N", help="%(default)s by default")
    options = parser.parse_args(arguments)
    for part in options.parts:
        print(part)
        for row in PARTS[part](options.repetitions):
            cells = (
                f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}" for name, value in row.items()
            )
            print("  " + ", ".join(cells), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
