"""Vibration of a car over a whole measured profile, from a run over some pieces of it.

A profile has no class, and nothing of it repeats. The linear twin (`vehicle.engines.reduced.twin_run`) drives the whole
profile in one product over frequency, whose energies in pieces of `PIECE_S` choose the pieces for a run of the car
(`vehicle.signals.analysis.piece_sample`): in the order of their levels, so that smooth and rough ones are in it. Pieces
in which a tyre of the twin leaves the road, or a stop or table leaves its segment, are in it always. The run drives the
chosen pieces one after the other (`vehicle.signals.excitation.joined_parts`). With the energies E of the run and E' of
its twin in each piece, the twin also on the joined road, which takes out the effect of the lead-in,

    y_s = E_s E'_s,whole / E'_s,joined,    x'_j = E'_j,whole,

give the energy of the whole profile and its error. The constants of the twin, mean((F - mean F) v)/mean(v^2) of each
damper, come from the run, where each piece has the weight 1/p_s, as in the whole profile. What the twin lacks, friction
above all, is in the ratios of the run pieces, whose spread is the stated error.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from vehicle.arrays import Vector
from vehicle.digits import number
from vehicle.engines.reduced.equivalent_damping import equivalent_damping
from vehicle.engines.reduced.statistical_linearisation import START, line_segments
from vehicle.engines.reduced.twin_run import LAW, returning, twin_run
from vehicle.errors import ConfigurationError
from vehicle.names import AXES
from vehicle.runs.car.estimate_limits import MOST_ENGAGED, MOST_LIFTED
from vehicle.runs.car.road import Road
from vehicle.runs.car.run import Run
from vehicle.runs.car.run_twin import damper_channels
from vehicle.signals.analysis.comfort import COMFORT_BAND
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.piece_sample import PieceSample, half_interval, sample_pieces
from vehicle.signals.analysis.ride_comfort import SEAT_PREFIX, SEAT_VALUE, UNWEIGHTED, WEIGHTED, comfort_units
from vehicle.signals.analysis.samples import band_shares
from vehicle.signals.analysis.seat_value import weighted_axes
from vehicle.signals.excitation.joined_parts import LEAD_S, joined_parts
from vehicle.signals.excitation.road_drive import RoadDrive, evaluated_from
from vehicle.signals.excitation.signal import Signal
from vehicle.threads import one_blas_thread

PIECE_S = 4.0
"""Length of a piece [s]: four periods of a body mode of 1 Hz, twice its lead-in."""

FEWEST = 8
"""Minimum number of drawn pieces, for 4.9 degrees of freedom of the error."""

USUAL_PRECISION = 1.0
"""Default of half of the 95 % interval of the weighted comfort [%]."""

PILOTS = 3
"""Maximum number of pilot runs."""


@dataclass(frozen=True, kw_only=True, eq=False)
class ProfileValue:
    """Vibration over a whole profile.

    Attributes:
        road: name of the drive, for example "road_profile_80".
        run: run over the chosen pieces, one after the other.
        length: evaluated length of the profile [s].
        parts: start and end of each run piece in the drive over the whole profile [s].
        pieces: number of pieces of the profile.
        values: comfort values by their names in sweeps and RMS of the dynamic load of each tyre ("tyre_load_fr" [N]).
        half_intervals: half of the 95 % interval of each value, in its unit; 0 if all pieces were run.
    """

    road: str
    run: Run
    length: float
    parts: tuple[tuple[float, float], ...]
    pieces: int
    values: Mapping[str, float]
    half_intervals: Mapping[str, float]

    @cached_property
    def units(self) -> dict[str, str]:
        """Return the unit of each value."""
        return {name: comfort_units(seated=True).get(name, "N") for name in self.values}

    def text(self, name: str) -> str:
        """Return a value with its unit and error, for example "0.4953 m/s2 ± 0.8 %"."""
        value, half = self.values[name], self.half_intervals[name]
        error = f" ± {number(100.0 * half / value, 2)} %" if half > 0.0 else ""
        unit = self.units[name]
        return f"{number(value, 4)}{'' if unit == '-' else f' {unit}'}{error}"

    @property
    def words(self) -> str:
        """Return road, evaluated length and run pieces as text."""
        run = f"{len(self.parts)} of {self.pieces} pieces run ({self.run.signal.duration:.3g} s"
        engine = self.run.recording.statistics.engine
        return f"{self.road}: {self.length:.4g} s evaluated, {run}, {engine}); ± is the 95 % interval"

    @property
    def notices(self) -> tuple[str, ...]:
        """Return the messages of profile and run."""
        statistics = self.run.recording.statistics
        return (*self.run.signal.notices, *statistics.warnings, *statistics.notices)

    def __repr__(self) -> str:
        """Return the values, a line each."""
        return "\n".join([self.words, *(f"  {name} {self.text(name)}" for name in self.values)])


@one_blas_thread()
def over_profile(car: Any, source: Road, engine: str = "reduced", *, skip: float | None = None) -> ProfileValue:
    """Return comfort and tyre loads of a car over a whole measured profile, from a run over some pieces of it.

    Args:
        car: the car.
        source: profile, speed and wanted precision, for example road("profile.csv", 80, precision=1): half of the 95 %
            interval of the weighted comfort [%]; 1 by default. Pilot runs with the reduced engine choose the number of
            pieces.
        engine: engine of the run, as in `Car.run`.
        skip: excluded time at the beginning of the profile [s], as in `Car.run`.

    Returns:
        Values of the whole profile with their errors.

    Raises:
        ConfigurationError: no measured profile, cams, a car without dampers, or one that forces shake too.
    """
    drive = source.under(car.vehicle, car.overrides)
    if not isinstance(drive, RoadDrive) or source.file is None:
        raise ConfigurationError(
            f"over_profile: {source.road} is no measured profile; run the car, for example "
            f"with road({str(source.road)!r}, {source.speed!r}, precision=1)"
        )
    wanted = USUAL_PRECISION if drive.precision is None else drive.precision
    drive = evaluated_from(replace(drive, precision=None), skip)
    driven = car._of_drive(drive.overrides)
    _require_car(driven, drive)
    survey = _Survey(driven, drive)
    count = FEWEST
    for pilot in range(1, PILOTS + 1):
        sample = survey.sample(count)
        value = survey.value(sample, "reduced")
        half = 100.0 * value.half_intervals[WEIGHTED] / value.values[WEIGHTED]
        if half <= wanted or not sample.drawn.any() or pilot == PILOTS:
            break
        count = math.ceil(count * (half / wanted) ** 2)
    return value if engine == "reduced" else survey.value(sample, engine)


def _require_car(car: Any, drive: RoadDrive) -> None:
    """Check that the twin of a car has the excitation of the run, and the dampers that make its constants."""
    reasons = {
        "cams, which have no linear twin; set --contact patch": drive.envelope is not None,
        "a car without dampers; run the whole profile": not damper_channels(car.vehicle),
        "forces that shake the car too; leave them out with --set apply_forces=false": car.poles.forced,
        f"--skip below the lead-in of a piece, {LEAD_S:g} s; choose a later one": drive.skip < LEAD_S,
    }
    for reason, applies in reasons.items():
        if applies:
            raise ConfigurationError(f"{drive.name}: the value of a whole profile from pieces does not cover {reason}")


class _Survey:
    """Pieces of a profile, and the twin over all of them.

    Args:
        car: the car with the speed of the drive.
        drive: drive over the profile.
    """

    def __init__(self, car: Any, drive: RoadDrive) -> None:
        self.car, self.signal, self.name = car, drive.signal(), drive.name
        self.step = 1.0 / car.vehicle.solver.record_rate
        points = ("seat_rail", "seat") if car.vehicle.seated else ("seat_rail",)
        self.points = {"" if point == "seat_rail" else SEAT_PREFIX: point for point in points}
        self.loads = {f"tyre_{wheel}_force_z": load for wheel, load in car.static.tyre_load.items()}
        self.channels = (*(f"{point}_acc_{axis}" for point in points for axis in AXES), *self.loads)
        first, end = round(drive.skip / self.step), round(self.signal.duration / self.step)
        if end <= first:
            raise ConfigurationError(
                f"{drive.name}: lasts {self.signal.duration:.3g} s, but is evaluated from {drive.skip:g} s on; choose "
                "a longer profile, or a lower --speed"
            )
        pieces = max(round((end - first) * self.step / PIECE_S), 1)
        edges = np.linspace(first, end, pieces + 1).round().astype(int)
        self.spans = [slice(begin, end) for begin, end in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True)]
        self.sizes, self.levels, self.always = self._survey()

    def _survey(self) -> tuple[Vector, Vector, Any]:
        """Return the weighted energy of the twin in each piece, its level, and True where a tyre lifts or a stop acts.

        The level is the mean square at which the energy occurs, sum a^4/sum a^2: high for a single obstacle too.
        """
        laws = [damper.law for damper in self.car.vehicle.composition.dampers]
        damping = np.array([line_segments(law).damping(START) for law in laws])
        others = {f"{LAW}{index}": law for index, law in enumerate(self.car.poles.laws)
                  if not law.friction and not law.one_sided}  # fmt: skip
        rows = self._twin(self.signal, damping, (*self.channels, *others))
        lifted = [rows[name] < -load for name, load in self.loads.items() if load > 0.0]
        engaged = [(rows[name] < law.low) | (rows[name] > law.high) for name, law in others.items()]
        always = np.zeros(len(self.spans), dtype=np.bool_)
        for outside, limit in ((lifted, MOST_LIFTED), (engaged, MOST_ENGAGED)):
            for each in outside:
                always |= np.array([np.mean(each[span]) > limit for span in self.spans])
        weighted = weighted_axes(self.step, np.stack([rows[f"seat_rail_acc_{axis}"] for axis in AXES]))
        power = np.square(application("seat").comfort_factors) @ weighted**2
        sizes, fourth = np.array([[np.sum(power[span]), np.sum(power[span] ** 2)] for span in self.spans]).T
        return sizes, np.divide(fourth, sizes, out=np.zeros_like(sizes), where=sizes > 0.0), always

    def sample(self, count: int) -> PieceSample:
        """Return a sample of pieces with a number of drawn ones."""
        return sample_pieces(self.sizes, self.levels, count, self.always)

    def value(self, sample: PieceSample, engine: str) -> ProfileValue:
        """Return the value over the profile by a run of a sample."""
        chosen = [self.spans[piece] for piece in sample.chosen.tolist()]
        parts = [(span.start * self.step, span.stop * self.step) for span in chosen]
        signal, begins = joined_parts(self.signal, parts)
        signal = replace(signal, source=f"{len(parts)} pieces of {self.name}")
        dampers = damper_channels(self.car.vehicle)
        run = self.car.run(signal, engine, channels=[*self.channels, *dampers])
        spans = [
            slice(begin := round(start / self.step), begin + span.stop - span.start)
            for start, span in zip(begins, chosen, strict=True)
        ]
        damping = self._damping(run, spans, sample)
        whole = self._energies(self._twin(self.signal, damping, self.channels), self.spans)
        joined = self._energies(self._twin(signal, damping, self.channels), spans)
        rows = {name: run[name] - self.loads.get(name, 0.0) for name in self.channels}
        samples = self.spans[-1].stop - self.spans[0].start
        values, halves, relative = {}, {}, {}
        for name, energy in self._energies(rows, spans).items():
            adapted = np.divide(energy * whole[name][sample.chosen], joined[name],
                                out=np.zeros_like(energy), where=joined[name] > 0.0)  # fmt: skip
            total, residuals = sample.total(adapted, whole[name])
            # d ln RMS = dE/(2 E).
            relative[name] = 0.5 * residuals / total if total > 0.0 else residuals
            values[name] = math.sqrt(total / samples)
            halves[name] = values[name] * half_interval(relative[name])
        if SEAT_PREFIX in self.points and values[f"{WEIGHTED}_z"] > 0.0:
            above, below = f"{SEAT_PREFIX}{WEIGHTED}_z", f"{WEIGHTED}_z"
            values[SEAT_VALUE] = values[above] / values[below]
            halves[SEAT_VALUE] = values[SEAT_VALUE] * half_interval(relative[above] - relative[below])
        return ProfileValue(
            road=self.name,
            run=run,
            length=samples * self.step,
            parts=tuple(parts),
            pieces=len(self.spans),
            values=values,
            half_intervals=halves,
        )

    def _damping(self, run: Run, spans: Sequence[slice], sample: PieceSample) -> Vector:
        """Return the damping constants of the run, with weight 1/p for each piece."""
        weights = np.concatenate(
            [
                np.full(span.stop - span.start, p**-0.5)
                for span, p in zip(spans, sample.probability.tolist(), strict=True)
            ]
        )
        constants = []
        for damper in self.car.vehicle.composition.dampers:
            velocity, force = (
                np.concatenate([run[f"{damper.name}_{quantity}"][span] for span in spans])
                for quantity in ("velocity", "force")
            )
            constants.append(equivalent_damping(damper.law, velocity * weights, (force - force.mean()) * weights))
        return np.array(constants)

    def _twin(self, signal: Signal, damping: Vector, channels: Sequence[str]) -> dict[str, Vector]:
        """Return the twin over a signal that begins at rest."""
        plates, length = returning(signal)
        rows = twin_run(self.car.poles, damping, plates, length, channels, round(length / self.step))
        return {name: row[: round(signal.duration / self.step) + 1] for name, row in rows.items()}

    def _energies(self, rows: Mapping[str, Vector], spans: Sequence[slice]) -> dict[str, Vector]:
        """Return the energies sum y^2 of the values in the pieces."""
        energies: dict[str, Vector] = {}
        seat, evaluated = application("seat"), slice(spans[0].start, spans[-1].stop)
        for prefix, point in self.points.items():
            xyz = np.stack([rows[f"{point}_acc_{axis}"] for axis in AXES])
            # Without the start, which would ring in this filter.
            in_band = np.zeros_like(xyz)
            lines = np.fft.rfft(xyz[:, evaluated], axis=1)
            frequency = np.fft.rfftfreq(count := evaluated.stop - evaluated.start, self.step)
            lines *= np.sqrt(band_shares(frequency, frequency[1], COMFORT_BAND))
            in_band[:, evaluated] = np.fft.irfft(lines, count, axis=1)
            for name, axes, factors in (
                (UNWEIGHTED, in_band, (1.0, 1.0, 1.0)),
                (WEIGHTED, weighted_axes(self.step, xyz), seat.comfort_factors),
            ):
                each = np.array([[np.sum(row[span] ** 2) for span in spans] for row in axes])
                energies |= {f"{prefix}{name}_{axis}": row for axis, row in zip(AXES, each, strict=True)}
                energies[f"{prefix}{name}"] = np.square(factors) @ each
        for name in self.loads:
            wheel = name.removeprefix("tyre_").removesuffix("_force_z")
            energies[f"tyre_load_{wheel}"] = np.array([np.sum(rows[name][span] ** 2) for span in spans])
        return energies
