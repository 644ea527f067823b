"""Printed statements about the half car with rider beside what the equations say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from scenarios.claims import COMPARED, PREDICTED, Claim
from scenarios.half_car_rider.printed_matrices import growth_rate, printed_system
from scenarios.half_car_rider.runs import (
    KMH,
    SETTLING_BAND,
    SPEEDS,
    VARIED,
    Motion,
    Outcome,
    passive,
    peak,
    settling_time,
    varied,
)
from vehicle.lumped.half_car_rider import half_car_rider
from vehicle.lumped.history import Array, History
from vehicle.parameters.half_car_rider import HalfCarRiderParameters

Study = Mapping[str, list[list[Outcome]]]
"""Varied parameter -> speed -> factor -> outcome."""

READING = 0.3
"""The printed times are read from figures, most of them with the word "about" [s]."""

STIFF_SEAT = 50000.0
"""Seat stiffness for the row on figure 10 [N/m]: the source does not print its own."""

SETTLING: tuple[tuple[str, Motion, float, bool, str], ...] = (
    ("upper_limb", "displacement", 3.5, True, "figure 5"),
    ("lower_limb", "displacement", 3.5, True, "figure 5"),
    ("upper_limb", "acceleration", 3.5, True, "figure 6"),
    ("lower_limb", "acceleration", 3.5, True, "figure 6"),
    ("front_body", "displacement", 3.0, False, "figure 7"),
    ("rear_body", "displacement", 3.5, True, "figure 7"),
    ("pitch", "displacement", 3.5, False, "figure 8"),
    ("front_wheel", "displacement", 1.7, False, "figure 9"),
    ("rear_wheel", "displacement", 1.2, False, "figure 9"),
    ("seat", "acceleration", 3.5, False, "figure 10"),
    ("body", "acceleration", 1.7, False, "figure 10"),
)
"""Place, quantity, printed settling time [s], whether it is a lower limit, figure."""

LITTLE = 0.5
"""A change of the dose value counts as "little" below this share of what the sprung mass does at that speed [-]."""

DIRECTIONS = {
    "sprung_mass": "falls",
    "unsprung_mass": "little",
    "suspension_stiffness": "rises",
    "tyre_stiffness": "rises",
    "tyre_damping": "little",
    "suspension_damping": "little",
}
"""Printed effect on the dose values."""

TRAVEL_DIRECTIONS = {"suspension_stiffness": "rises", "suspension_damping": "falls", "tyre_stiffness": "falls"}
"""Printed effect on the suspension travel (figures 23 to 25)."""


def base_case_claims(car: HalfCarRiderParameters, history: History) -> list[Claim]:
    """Rows on figures 5 to 10: sizes and settling times of the base case."""
    rows = []
    shown: tuple[tuple[Motion, str, float, str], ...] = (
        ("displacement", "mm", 1e3, "figure 5"),
        ("acceleration", "m/s2", 1.0, "figure 6"),
    )
    for quantity, unit, factor, figure in shown:
        upper, lower = (factor * peak(history.of(name, quantity)) for name in ("upper_limb", "lower_limb"))
        name = f"{figure}: peak {quantity} of the upper body above that of the lower body"
        ours = f"upper {upper:.3g} {unit}, lower {lower:.3g} {unit}"
        rows.append(PREDICTED.statement(name, "larger", ours, upper > lower, _why_upper(car, quantity)))
    stiff = passive(replace(car, seat=replace(car.seat, stiffness=STIFF_SEAT)), SPEEDS[0])
    (seat, body), stiffer = ([peak(one.acceleration(n)) for n in ("seat", "body")] for one in (history, stiff))
    rows.append(
        PREDICTED.statement(
            "figure 10: peak acceleration of the seat above that of the chassis",
            "larger",
            f"seat {seat:.3g} m/s2, chassis {body:.3g} m/s2",
            seat > body,
            "the seat is not printed; the assumed one isolates from the pulse of the bump. With a seat of "
            f"{STIFF_SEAT:.0f} N/m it would be {stiffer[0]:.3g} against {stiffer[1]:.3g} m/s2",
        )
    )
    return rows + [_settling(history, *row) for row in SETTLING]


def _why_upper(car: HalfCarRiderParameters, quantity: str) -> str:
    if quantity == "displacement":
        return "the upper limb on its spring overshoots the seat"
    isolated = float(np.sqrt(2.0 * car.upper_limb.stiffness / car.upper_limb.mass)) / (2.0 * np.pi)
    pulse = SPEEDS[0] * KMH / (2.0 * car.bump.length)
    return (
        f"above sqrt(2) times its own frequency ({isolated:.1f} Hz) the upper limb is isolated from the seat, the "
        f"stiffly held lower limb is not; the pulse of the bump has {pulse:.1f} Hz"
    )


def _settling(history: History, place: str, quantity: Motion, printed: float, limit: bool, figure: str) -> Claim:
    times = {
        band: settling_time(history.time, history.of(place, quantity), band) for band in (SETTLING_BAND, 0.02, 0.05)
    }
    found = times[SETTLING_BAND]
    ours = float(history.time[-1]) if found is None else found
    two, five = ("beyond the record" if (t := times[band]) is None else f"{t:.2f} s" for band in (0.02, 0.05))
    why = (
        f"rule: last time above 0.5 % of the peak, t = 0 when the front wheel meets the bump; 2 %: {two}, 5 %: {five}; "
        f"tolerance {READING} s, read from a figure"
    )
    label = f"{figure}: settling time of {place} {quantity} [s]"
    if limit:
        return PREDICTED.statement(label, f"longer than {printed}", f"{ours:.2f}", ours >= printed - READING, why)
    return PREDICTED.number(label, printed, ours, READING, why)


def dose_claims(car: HalfCarRiderParameters, studied: Study, factors: Sequence[float]) -> list[Claim]:
    """Rows on figures 11 to 22: direction of the dose values over each parameter."""
    change = {(name, limb): _changes(studied[name], f"{limb}_vdv") for name in VARIED for limb in ("upper", "lower")}
    reasons = _why_dose(car)
    rows = [
        _direction(
            f"VDV of the {limb} body with {VARIED[parameter]}",
            direction,
            change[parameter, limb],
            factors,
            reasons[parameter],
            LITTLE * np.abs(change["sprung_mass", limb]),
        )
        for parameter, direction in DIRECTIONS.items()
        for limb in ("upper", "lower")
    ]
    for limb in ("upper", "lower"):
        mass, unsprung, stiffness = (
            np.abs(change[name, limb]).mean() for name in ("sprung_mass", "unsprung_mass", "suspension_stiffness")
        )
        rows.append(
            PREDICTED.statement(
                f"VDV of the {limb} body: sprung mass and suspension stiffness against unsprung mass",
                "both stronger",
                f"mean change {mass:.1%}, {stiffness:.1%} against {unsprung:.1%}",
                bool(min(mass, stiffness) > unsprung),
                "mean over the five speeds of the magnitude of the change from 80 to 120 %",
            )
        )
    return rows


def travel_claims(car: HalfCarRiderParameters, studied: Study, factors: Sequence[float]) -> list[Claim]:
    """Rows on figures 23 to 25: direction of the suspension travel."""
    return [
        _direction(
            f"suspension travel with {VARIED[parameter]}",
            direction,
            _changes(studied[parameter], "travel"),
            factors,
            _why_travel(car, parameter, factors),
        )
        for parameter, direction in TRAVEL_DIRECTIONS.items()
    ]


def _direction(
    name: str, direction: str, change: Array, factors: Sequence[float], why: str, little: Array | float = 0.0
) -> Claim:
    """Row on what a parameter does at every speed; "little" is below the effects given."""
    agrees = {"little": np.abs(change) < little, "rises": change > 0.0, "falls": change < 0.0}[direction]
    rule = f"less than {LITTLE:.0%} of the effect of the sprung mass" if direction == "little" else direction
    changes = ", ".join(f"{100.0 * value:+.1f}" for value in change)
    speeds = ", ".join(f"{speed:.0f}" for speed in SPEEDS)
    ours = f"{changes} % from {factors[0]:.0%} to {factors[-1]:.0%}, at {speeds} km/h"
    return PREDICTED.statement(name, direction, ours, bool(np.all(agrees)), f"rule: {rule} at every speed; {why}")


def _changes(table: Sequence[Sequence[Outcome]], name: str) -> Array:
    return relative_changes([[getattr(one, name) for one in row] for row in table])


def relative_changes(values: Sequence[Sequence[float]]) -> Array:
    """Change from the first to the last factor over the middle of the range, one for each speed [-]."""
    table = np.asarray(values, dtype=float)
    return np.asarray((table[:, -1] - table[:, 0]) / table.mean(axis=1))


def _why_dose(car: HalfCarRiderParameters) -> dict[str, str]:
    """What moves the dose value, with the car's own numbers."""
    ratio = car.front.tyre_stiffness / car.front.suspension_stiffness
    hop = float(np.sqrt((car.front.tyre_stiffness + car.front.suspension_stiffness) / car.front.unsprung_mass))
    share = car.front.tyre_damping * hop / car.front.tyre_stiffness
    below = (
        f"the limbs answer below 6 Hz, where a wheel on a tyre {ratio:.0f} times stiffer than its suspension follows "
        f"the road; what happens near the wheel hop ({hop / (2.0 * np.pi):.1f} Hz) reaches them weakly"
    )
    return {
        "sprung_mass": "a heavier body is moved less by the same force",
        "unsprung_mass": below,
        "suspension_stiffness": "the spring force on the body grows with its stiffness",
        "tyre_stiffness": f"{below}, the lower limb more than the upper",
        "tyre_damping": f"at the wheel hop the tyre damper gives {share:.0%} of the force of the tyre spring",
        "suspension_damping": "the damper passes the quick motion of the wheel to the body; the conclusions of the "
        "source say that the discomfort rises with it, as here",
    }


def _why_travel(car: HalfCarRiderParameters, parameter: str, factors: Sequence[float]) -> str:
    """Peaks of the parts of the travel, wheel minus body, at the base speed."""
    ends = [passive(varied(car, parameter, factor), SPEEDS[0]) for factor in (factors[0], factors[-1])]
    wheel, body = ([1e3 * peak(one.displacement(f"front_{name}")) for one in ends] for name in ("wheel", "body"))
    return (
        f"the travel is body minus wheel; at the base speed the peak of the front wheel goes from {wheel[0]:.1f} to "
        f"{wheel[1]:.1f} mm, that of the body above it from {body[0]:.1f} to {body[1]:.1f} mm"
    )


def speed_claims(
    car: HalfCarRiderParameters, scan: Mapping[str, Sequence[float]], upper: Sequence[float], one_sided: Sequence[float]
) -> list[Claim]:
    """Rows on the dose value over speed.

    Args:
        car: base case.
        scan: "speed" [km/h] and "upper" [m/s^1.75] of the exact passive response over a wide range.
        upper: dose value of the upper limb at `SPEEDS`, passive, tyres glued to the road.
        one_sided: the same with tyres that can leave the road.
    """
    peak = int(np.argmax(scan["upper"]))
    at_peak, slow, fast = (1e3 * car.bump.length / (v * KMH) for v in (scan["speed"][peak], SPEEDS[0], SPEEDS[-1]))
    return [
        PREDICTED.statement(
            "VDV with speed, 20 to 60 km/h",
            "rises",
            f"upper body {_list(upper)}; tyres that can leave the road {_list(one_sided)} m/s^1.75",
            bool(np.all(np.diff(upper) > 0.0)),
            f"a wheel is on the bump for wb / v, {slow:.0f} ms at the lowest and {fast:.0f} ms at the highest speed: "
            "the impulse h0 wb 2 / (pi v) k that reaches the body falls as 1 / v. The dose value is largest at "
            f"{scan['speed'][peak]:.0f} km/h ({scan['upper'][peak]:.2f}, {at_peak:.0f} ms on the bump) and falls from "
            "there on, with linear and with one-sided tyres",
        ),
        COMPARED.statement(
            "VDV of 15 m/s^1.75 is severe discomfort",
            "limit of BS 6841",
            f"largest of the study {max(upper):.2f} m/s^1.75",
            max(upper) < 15.0,
            "one bump stays far below the limit; unweighted acceleration, as in the source",
        ),
    ]


def matrix_claim(car: HalfCarRiderParameters) -> Claim:
    """Row on the printed matrices."""
    printed, ours = growth_rate(printed_system(car)), growth_rate(half_car_rider(car))
    return COMPARED.statement(
        "matrices [C] and [K] below equation 16",
        "equations of motion of the passive car",
        f"largest real part of the poles {printed:+.2f} 1/s as printed, {ours:+.2f} 1/s derived from the energies",
        printed < 0.0,
        "typing errors: neither is symmetric and the pitch damping is negative, so the printed equations grow for "
        "ever; the figures of the source cannot come from them as they stand",
    )


def _list(values: Sequence[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in values)
