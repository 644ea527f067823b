"""Printed statements about the half car with rider beside what the equations say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from scenarios.claims import COMPARED, PREDICTED, Claim
from scenarios.half_car_rider.runs import KMH, SPEEDS, VARIED, Outcome, passive, varied
from vehicle.lumped.half_car_rider import places
from vehicle.lumped.half_car_rider_printed import growth_rate
from vehicle.parameters.half_car_rider import HalfCarRiderParameters

Array = npt.NDArray[np.float64]

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


def dose_claims(
    car: HalfCarRiderParameters, studied: Mapping[str, list[list[Outcome]]], factors: Sequence[float]
) -> list[Claim]:
    """Rows on figures 11 to 22: direction of the dose values over each parameter."""
    rows = []
    reasons = _why_dose(car)
    for parameter, direction in DIRECTIONS.items():
        for limb in ("upper", "lower"):
            change = relative_changes([[getattr(o, f"{limb}_vdv") for o in row] for row in studied[parameter]])
            mass = relative_changes([[getattr(o, f"{limb}_vdv") for o in row] for row in studied["sprung_mass"]])
            rows.append(
                PREDICTED.statement(
                    f"VDV of the {limb} body with {VARIED[parameter]}",
                    direction,
                    f"{_changes(change)} from {factors[0]:.0%} to {factors[-1]:.0%}, at {_speeds()} km/h",
                    _agrees(direction, change, LITTLE * np.abs(mass)),
                    f"rule: {_rule(direction)} at every speed; {reasons[parameter]}",
                )
            )
    for limb in ("upper", "lower"):
        mass, unsprung, stiffness = (
            np.abs(relative_changes([[getattr(o, f"{limb}_vdv") for o in row] for row in studied[name]]))
            for name in ("sprung_mass", "unsprung_mass", "suspension_stiffness")
        )
        rows.append(
            PREDICTED.statement(
                f"VDV of the {limb} body: sprung mass and suspension stiffness against unsprung mass",
                "both stronger",
                f"mean change {mass.mean():.1%}, {stiffness.mean():.1%} against {unsprung.mean():.1%}",
                bool(min(mass.mean(), stiffness.mean()) > unsprung.mean()),
                "mean over the five speeds of the magnitude of the change from 80 to 120 %",
            )
        )
    return rows


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


def travel_claims(
    car: HalfCarRiderParameters, studied: Mapping[str, list[list[Outcome]]], factors: Sequence[float]
) -> list[Claim]:
    """Rows on figures 23 to 25: direction of the suspension travel."""
    rows = []
    for parameter, direction in TRAVEL_DIRECTIONS.items():
        change = relative_changes([[o.travel for o in row] for row in studied[parameter]])
        rows.append(
            PREDICTED.statement(
                f"suspension travel with {VARIED[parameter]}",
                direction,
                f"{_changes(change)} from {factors[0]:.0%} to {factors[-1]:.0%}, at {_speeds()} km/h",
                _agrees(direction, change, np.zeros_like(change)),
                f"rule: {_rule(direction)} at every speed; {_why_travel(car, parameter, factors)}",
            )
        )
    return rows


def _why_travel(car: HalfCarRiderParameters, parameter: str, factors: Sequence[float]) -> str:
    """Peaks of the parts of the travel, wheel minus body, at the base speed."""
    wheel, body = [], []
    for factor in (factors[0], factors[-1]):
        one = varied(car, parameter, factor)
        history = passive(one, SPEEDS[0])
        wheel.append(1e3 * float(np.abs(history.of(places(one)["front_wheel"])).max()))
        body.append(1e3 * float(np.abs(history.of(places(one)["front_body"])).max()))
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
    printed, ours = growth_rate(car, printed=True), growth_rate(car, printed=False)
    return COMPARED.statement(
        "matrices [C] and [K] below equation 16",
        "equations of motion of the passive car",
        f"largest real part of the poles {printed:+.2f} 1/s as printed, {ours:+.2f} 1/s derived from the energies",
        printed < 0.0,
        "typing errors: neither is symmetric and the pitch damping is negative, so the printed equations grow for "
        "ever; the figures of the source cannot come from them as they stand",
    )


def relative_changes(values: Sequence[Sequence[float]]) -> Array:
    """Change from the first to the last factor over the middle of the range, one for each speed [-]."""
    table = np.asarray(values, dtype=float)
    return np.asarray((table[:, -1] - table[:, 0]) / table.mean(axis=1))


def _agrees(direction: str, change: Array, little: Array) -> bool:
    if direction == "little":
        return bool(np.all(np.abs(change) < little))
    return bool(np.all(change > 0.0) if direction == "rises" else np.all(change < 0.0))


def _rule(direction: str) -> str:
    return f"less than {LITTLE:.0%} of the effect of the sprung mass" if direction == "little" else direction


def _changes(change: Array) -> str:
    return ", ".join(f"{100.0 * value:+.1f}" for value in change) + " %"


def _speeds() -> str:
    return ", ".join(f"{speed:.0f}" for speed in SPEEDS)


def _list(values: Sequence[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in values)
