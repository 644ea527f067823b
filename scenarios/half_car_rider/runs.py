"""Runs of the half car with rider: base case, parameter studies, speeds, semi-active laws."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from scenarios.lumped.axle import Axle
from scenarios.lumped.bump_response import bump_passage, bump_response
from scenarios.lumped.half_car_rider_model import ENDS, half_car_rider, lift_off, linear_tyre_load, output_points
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters
from scenarios.lumped.history import History
from scenarios.lumped.semi_active_half_car import simulate_bump
from vehicle.arrays import Vector
from vehicle.engines.linear.first_order import first_order
from vehicle.engines.linear.natural_modes import natural_modes
from vehicle.errors import ConfigurationError
from vehicle.model.parameters.semi_active_damper import PASSIVE
from vehicle.signals.analysis.exposure import vibration_dose_value

Motion = Literal["displacement", "acceleration"]

SETTLING_BAND = 0.005
"""Settled means: the rest is below 0.5 % of the peak, about the width of a line in a figure [-]."""

BANDS = (SETTLING_BAND, 0.01, 0.02, 0.05)
"""Bands given in the JSON file [-]."""

KMH = 1.0 / 3.6
"""[m/s]."""

SPEEDS = (20.0, 30.0, 40.0, 50.0, 60.0)
"""Speeds of the source [km/h]; the first is its base case."""

VARIED = {
    "sprung_mass": "sprung mass",
    "unsprung_mass": "unsprung mass",
    "suspension_stiffness": "suspension stiffness",
    "tyre_stiffness": "tyre stiffness",
    "tyre_damping": "tyre damping",
    "suspension_damping": "suspension damping",
}
"""Varied parameters in the order of figures 11 to 22."""

TIME_STEP = 1e-3
"""Sampling of the exact response [s]; half of it changes the dose values by less than 0.01 %."""

DURATION = 5.0
"""[s]: all motion has died away below 1 % of its peak."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """Dose values, travel and lift-off of a passage over the bump."""

    upper_vdv: float  # Vibration dose value of the upper limb [m/s^1.75]
    lower_vdv: float  # The same of the lower limb
    travel: float  # Largest magnitude of the suspension travel, front or rear [m]
    lift_off: tuple[tuple[tuple[float, float], ...], tuple[tuple[float, float], ...]]
    """Intervals in which the front and the rear wheel leave the road [s]."""
    least_load: tuple[float, float]  # Least load of a tyre glued to the road, front and rear [N]


def passive(car: HalfCarRiderParameters, speed: float) -> History:
    """Return the exact passive response at a speed [km/h]."""
    passage = bump_passage(car.bump, speed * KMH, car.body.front_arm + car.body.rear_arm)
    return bump_response(half_car_rider(car), passage, time_step=TIME_STEP, duration=DURATION)


def outcome(
    car: HalfCarRiderParameters, history: History, measure: Callable[[float, Vector], float] = vibration_dose_value
) -> Outcome:
    """Return dose values, travel and lift-off of a passage over the bump.

    The measure, a function of time step [s] and acceleration [m/s2], may replace the dose value.
    """
    step = float(history.time[1] - history.time[0])
    loads = linear_tyre_load(car, history)
    front, rear = (tuple(lift_off(history.time, load)) for load in loads)
    return Outcome(
        upper_vdv=measure(step, history.acceleration("upper_limb")),
        lower_vdv=measure(step, history.acceleration("lower_limb")),
        travel=max(peak(history.displacement(f"{end}_travel")) for end in ENDS),
        lift_off=(front, rear),
        least_load=(float(loads[0].min()), float(loads[1].min())),
    )


def varied(car: HalfCarRiderParameters, parameter: str, factor: float) -> HalfCarRiderParameters:
    """Return the car with a parameter of `VARIED` scaled, at front and rear.

    With the sprung mass the moment of inertia is constant, as in the paper.
    """
    if parameter == "sprung_mass":
        return replace(car, body=replace(car.body, mass=factor * car.body.mass))

    def scaled(axle: Axle) -> Axle:
        return replace(axle, **{parameter: factor * getattr(axle, parameter)})

    return replace(car, front=scaled(car.front), rear=scaled(car.rear))


def parameter_study(
    car: HalfCarRiderParameters,
    factors: Sequence[float],
    law: str = PASSIVE,
    measure: Callable[[float, Vector], float] = vibration_dose_value,
) -> Mapping[str, list[list[Outcome]]]:
    """Return the outcomes over every varied parameter, speed and factor: parameter -> speed -> factor -> outcome.

    With a law of `semi_active`, or "passive" for the exact response; a measure in place of the dose value is for
    passive cars only.
    """
    cases = [(name, speed, factor) for name in VARIED for speed in SPEEDS for factor in factors]
    cars = [varied(car, name, factor) for name, _, factor in cases]
    if law == PASSIVE:
        results = [
            outcome(variant, passive(variant, speed), measure)
            for variant, (_, speed, _) in zip(cars, cases, strict=True)
        ]
    else:
        results = []
        for start in range(0, len(cases), 90):  # bounds the memory: 90 runs hold 10^4 samples of 28 numbers each
            part = slice(start, start + 90)
            histories = simulate_bump(cars[part], [speed * KMH for _, speed, _ in cases[part]], law=law)
            results += [outcome(variant, history) for variant, history in zip(cars[part], histories, strict=True)]
    outcomes = iter(results)
    return {name: [[next(outcomes) for _ in factors] for _ in SPEEDS] for name in VARIED}


def driven(car: HalfCarRiderParameters, speeds: Sequence[float], law: str, *, one_sided_tyres: bool) -> list[History]:
    """Return the histories with a control law at several speeds [km/h]."""
    return simulate_bump(
        [car] * len(speeds),
        [speed * KMH for speed in speeds],
        law=law,
        one_sided_tyres=one_sided_tyres,
        duration=DURATION,
    )


WAVES = 20
"""Waves of a sine road: the last ten of them are evaluated, when the start has died away."""


def at_first_mode(car: HalfCarRiderParameters, laws: Sequence[str]) -> tuple[float, dict[str, dict[str, list[float]]]]:
    """Return the first natural frequency [Hz], and law to quantity to RMS over the passive car at `SPEEDS`.

    The road is a sine of that frequency and of the height of the bump under both axles, one wheelbase apart.
    """
    frequency = float(natural_modes(first_order(half_car_rider(car))).frequency[0])
    speeds = [speed * KMH for speed in SPEEDS]
    cars = [replace(car, bump=replace(car.bump, length=0.5 * speed / frequency)) for speed in speeds]

    def sizes(law: str) -> dict[str, list[float]]:
        histories = simulate_bump(cars, speeds, law=law, duration=WAVES / frequency, halves=2 * WAVES)
        late = [history.during(0.5 * WAVES / frequency) for history in histories]
        return {
            "body acceleration": [_rms(entry.acceleration("body")) for entry in late],
            "suspension": [max(_rms(entry.displacement(f"{end}_travel")) for end in ENDS) for entry in late],
            "tyre": [
                max(_rms(entry.displacement(f"{end}_wheel") - entry.inputs[:, n]) for n, end in enumerate(ENDS))
                for entry in late
            ],
        }

    reference = sizes(PASSIVE)
    return frequency, {
        law: {
            name: [value / base for value, base in zip(row, reference[name], strict=True)]
            for name, row in sizes(law).items()
        }
        for law in laws
    }


def _rms(signal: Vector) -> float:
    return float(np.sqrt(np.mean(signal**2)))


def peak(signal: Vector) -> float:
    """Return the largest magnitude."""
    return float(np.abs(signal).max())


def settling_time(time: npt.ArrayLike, signal: npt.ArrayLike, band: float) -> float | None:
    """Return the last instant at which |y| exceeds a share of its maximum.

    t_s = max { t : |y(t)| > band max|y| }: from there on the motion stays inside the band around its final value 0.

    Args:
        time: times [s], (m,).
        signal: signal y, (m,).
        band: share of the maximum [-], for example 0.05.

    Returns:
        Time on the clock of `time` [s]; None if the record ends outside the band, 0 for a zero signal.

    Raises:
        ConfigurationError: band not between 0 and 1.
    """
    if not 0.0 < band < 1.0:
        raise ConfigurationError(f"settling time: band: found {band!r}, must be between 0 and 1")
    instants, magnitude = np.asarray(time, dtype=float), np.abs(np.asarray(signal, dtype=float))
    outside = np.flatnonzero(magnitude > band * magnitude.max())
    if outside.size == 0:
        return 0.0
    if outside[-1] == magnitude.size - 1:
        return None
    return float(instants[outside[-1]])


def base_case_table(car: HalfCarRiderParameters, history: History) -> dict[str, dict[str, Any]]:
    """Return peaks [m, m/s2; rad, rad/s2] and settling times [s] for each band: output point -> quantity -> values."""
    quantities: tuple[Motion, ...] = ("displacement", "acceleration")

    def row(signal: Vector) -> dict[str, Any]:
        settling = {f"{band:g}": settling_time(history.time, signal, band) for band in BANDS}
        return {"peak": peak(signal), "settling_s": settling}

    return {
        name: {quantity: row(history.motion(name, quantity)) for quantity in quantities} for name in output_points(car)
    }
