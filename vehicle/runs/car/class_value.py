"""Comfort over roads of a class, from a run on one road of the class that does not repeat.

The value W of one road scatters by several percent, and so does the value W' of the linear twin on the same road
(`vehicle.engines.reduced.twin_run`). The expectation E[W'] over all roads of the class is a closed integral
(`vehicle.engines.reduced.road_expectation`). The ratio estimate

    W E[W'] / W',    error sqrt(mean |C_m - (W/W') C'_m|^2) with 6 degrees of freedom,

has the slow variations C_m of the run and C'_m of the twin (`vehicle.signals.analysis.comfort_error`).

Source: Cochran, Sampling Techniques (1977), chapter 6: ratio estimators.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from vehicle.arrays import Vector
from vehicle.engines.reduced.linear_twin import linear_twin
from vehicle.engines.reduced.road_expectation import (
    band_width,
    density,
    integral_lines,
    track_sources,
    weighting_width,
)
from vehicle.engines.reduced.twin_run import damping_of_run, returning, twin_run
from vehicle.engines.simulation.recording import Recording
from vehicle.names import AXES
from vehicle.runs.car.road import Road
from vehicle.runs.car.run_twin import TwinCar, damper_channels
from vehicle.signals.analysis.comfort_error import LEAST_EXPLAINED, NORMAL_95, wave_error
from vehicle.signals.analysis.evaluated_span import evaluated_span
from vehicle.signals.analysis.evaluation import application
from vehicle.signals.analysis.ride_comfort import UNWEIGHTED, WEIGHTED, comfort_columns, waves_of
from vehicle.signals.analysis.road_level import CLASSES
from vehicle.signals.excitation.iso_road import IsoRoad
from vehicle.signals.excitation.road_drive import SHORTEST_SPAN_S, RoadDrive
from vehicle.signals.excitation.signal import Signal


class ClassValue(NamedTuple):
    """Comfort value over roads of a class [m/s2], half of its 95 % interval [m/s2], share explained by the twin [-]."""

    value: float
    half_interval: float
    explained: float


def class_values(
    car: TwinCar, signal: Signal, recording: Recording, begin: float, road: Mapping[str, Any], band: tuple[float, float]
) -> dict[str, ClassValue]:
    """Return `unweighted` and `weighted` of the seat rail over roads of the class of a run.

    Args:
        car, signal, recording: of the run.
        begin: start of the evaluated span [s].
        road: road in the summary of the run.
        band: band of the unweighted value [Hz].

    Returns:
        Name to value; empty on a road that repeats, off a class, below `SHORTEST_SPAN_S`, with cams, for a car without
        dampers or one that forces shake too, and where the twin explains less than half of the scatter.
    """
    needed, rail = damper_channels(car.vehicle), [f"seat_rail_acc_{axis}" for axis in AXES]
    step, samples = recording.timestep, recording.time.size
    span = evaluated_span(samples, step, begin)
    applies = road.get("class") and "repeats_after_s" not in road and "tyre_contact" not in road and needed
    if (
        not applies
        or car.poles.forced
        or not {*needed, *rail} <= {*recording.channels}
        or (span.stop - span.start) * step < SHORTEST_SPAN_S
    ):
        return {}
    laws = [damper.law for damper in car.vehicle.composition.dampers]
    damping = damping_of_run(car.poles, laws, recording.channels, span)
    plates, length = returning(signal)
    count = round(length / step)
    twin = twin_run(car.poles, damping, plates, length, rail, count)
    records = np.stack([[recording[name] for name in rail], [twin[name][:samples] for name in rail]])
    columns = comfort_columns(step, records, skip=begin, band=band)
    expected = _expected(car, road, 1.0 / signal.timestep, damping, band, (span.stop - span.start) * step)
    result = {}
    for name in (UNWEIGHTED, WEIGHTED):
        (value, of_twin), waves = columns[name], waves_of(columns, name)
        left = waves[0] - value / of_twin * waves[1]
        explained = 1.0 - float(np.sum(np.abs(left) ** 2) / np.sum(np.abs(waves[0]) ** 2))
        if explained >= LEAST_EXPLAINED:
            ratio = expected[name] / of_twin
            half = NORMAL_95 * float(wave_error(left[None])[0]) * ratio
            result[name] = ClassValue(float(value * ratio), half, explained)
    return result


def _expected(
    car: TwinCar, road: Mapping[str, Any], rate: float, damping: Vector, band: tuple[float, float], duration: float
) -> dict[str, float]:
    """Return the expected comfort values of the twin on roads of the class [m/s2]; duration of the record [s]."""
    speed, wheels = float(road["speed_kmh"]) / 3.6, car.poles.matrices.system.inputs
    settings = {"coherence": road.get("coherence"), "patch": road["contact_patch_m"]}
    drive = Road(road["class"], road["speed_kmh"], **settings).under(car.vehicle)
    assert isinstance(drive, RoadDrive)
    iso = IsoRoad(level=CLASSES[road["class"]], seed=1, track=drive.track, coherence=drive.coherence, patch=drive.patch)
    lines, places = integral_lines(iso, speed, rate), {name: (behind, side) for name, behind, side in drive.wheels}
    sources = track_sources(iso, speed, {wheel: places[wheel] for wheel in wheels}, lines.frequency)
    rail = [f"seat_rail_acc_{axis}" for axis in AXES]
    power = density(linear_twin(car.poles, rail, lines.frequency, sources).responses(damping))
    seat = application("seat")
    weights = [factor**2 * weighting_width(lines, name) for factor, name in
               zip(seat.comfort_factors, seat.weightings, strict=True)]  # fmt: skip
    return {
        UNWEIGHTED: float(np.sqrt(np.sum(power @ band_width(lines, band, duration)))),
        WEIGHTED: float(np.sqrt(np.sum(power * weights))),
    }
