"""Rows of printed statements about the half car with rider with the results of the equations."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from scenarios.claims import COMPARED, DUPLICATE, NOT_TESTABLE, PREDICTED, Claim, Kind
from scenarios.half_car_rider.printed_matrices import growth_rate, printed_system
from scenarios.half_car_rider.runs import KMH, SPEEDS, VARIED, Motion, Outcome, outcome, passive, peak, varied
from scenarios.half_car_rider.settling_claims import settling_claims
from scenarios.lumped.half_car_rider_model import half_car_rider
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters
from scenarios.lumped.history import History
from vehicle.arrays import Vector

Study = Mapping[str, list[list[Outcome]]]
"""Varied parameter -> speed -> factor -> outcome."""

STIFF_SEAT = 50000.0
"""Seat stiffness for the row on figure 10 [N/m]: the paper prints no value."""

RIGID_SEAT = 150000.0
"""Seat ten times as stiff as the assumed one, for the rows on the tyre stiffness [N/m]."""

CRAWL = 2.0
"""Speed at which the bump is a pulse of the body's own frequency [km/h]."""

SLOWER = (10.0, 15.0)
"""Speeds below the base case, whose pulses the upper body follows [km/h]."""

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
"""Effect on the dose values in the text of figures 11 to 22."""

CONCLUSIONS = {
    "sprung_mass": ("falls", DUPLICATE),
    "unsprung_mass": ("rises", PREDICTED),
    "suspension_stiffness": ("rises", DUPLICATE),
    "tyre_stiffness": ("rises", DUPLICATE),
    "tyre_damping": ("falls", PREDICTED),
    "suspension_damping": ("rises", PREDICTED),
}
"""Effect on the dose values in the conclusions, and True if the text agrees."""

TRAVEL_DIRECTIONS = {"suspension_stiffness": "rises", "suspension_damping": "falls", "tyre_stiffness": "falls"}
"""Printed effect on the suspension travel (figures 23 to 25)."""


def base_case_claims(car: HalfCarRiderParameters, history: History) -> list[Claim]:
    """Return the rows on figures 5 to 10: sizes and settling times of the base case."""
    rows = []
    shown: tuple[tuple[Motion, str, float, int], ...] = (
        ("displacement", "mm", 1e3, 5),
        ("acceleration", "m/s2", 1.0, 6),
    )
    for quantity, unit, factor, figure in shown:
        upper, lower = (factor * peak(history.motion(name, quantity)) for name in ("upper_limb", "lower_limb"))
        rows.append(
            PREDICTED.statement(
                f"peak {quantity} of the upper body above that of the lower body",
                "larger",
                f"upper {upper:.3g} {unit}, lower {lower:.3g} {unit}",
                upper > lower,
                _why_upper(car, quantity),
            ).at(f"figure {figure}", f"figure_{figure:02d}.png")
        )
    (seat, body), stiffer, slower = (
        [peak(simulated.acceleration(n)) for n in ("seat", "body")]
        for simulated in (history, passive(_with_seat(car, STIFF_SEAT), SPEEDS[0]), passive(car, SLOWER[0]))
    )
    rows.append(
        PREDICTED.statement(
            "peak acceleration of the seat above that of the chassis",
            "larger",
            f"seat {seat:.3g} m/s2, chassis {body:.3g} m/s2",
            seat > body,
            "the seat is not printed; the assumed one isolates from the pulse of the bump. With a seat of "
            f"{STIFF_SEAT:.0f} N/m it would be {stiffer[0]:.3g} against {stiffer[1]:.3g} m/s2, with the assumed one at "
            f"{SLOWER[0]:.0f} km/h {slower[0]:.3g} against {slower[1]:.3g} m/s2",
        ).at("figure 10", "figure_10.png")
    )
    return rows + settling_claims(car, history)


def _with_seat(car: HalfCarRiderParameters, stiffness: float) -> HalfCarRiderParameters:
    """Return the car with another seat stiffness [N/m]."""
    return replace(car, seat=replace(car.seat, stiffness=stiffness))


def _why_upper(car: HalfCarRiderParameters, quantity: str) -> str:
    if quantity == "displacement":
        return "the upper limb on its spring overshoots the seat"
    isolated = float(np.sqrt(2.0 * car.upper_limb.stiffness / car.upper_limb.mass)) / (2.0 * np.pi)
    pulse = SPEEDS[0] * KMH / (2.0 * car.bump.length)
    histories = {speed: passive(car, speed) for speed in SLOWER}
    slower = " and ".join(
        " against ".join(f"{peak(history.acceleration(name)):.2f}" for name in ("upper_limb", "lower_limb"))
        + f" m/s2 at {speed:.0f} km/h"
        for speed, history in histories.items()
    )
    return (
        f"above sqrt(2) times its own frequency ({isolated:.1f} Hz) the upper limb is isolated from the seat, the "
        f"stiffly held lower limb is not; the pulse of the bump has {pulse:.1f} Hz. Slower, with a longer pulse, it is "
        f"{slower}"
    )


def dose_claims(car: HalfCarRiderParameters, studied: Study, factors: Sequence[float]) -> list[Claim]:
    """Return the rows on figures 11 to 22: direction of the dose values over each parameter."""
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
        ).at(f"figure {_first_figure(parameter) + column}", _picture(parameter))
        for parameter, direction in DIRECTIONS.items()
        for column, limb in enumerate(("upper", "lower"))
    ]
    rows += [
        _direction(
            f"conclusions: VDV of the {limb} body with {VARIED[parameter]}",
            direction,
            change[parameter, limb],
            factors,
            reasons[parameter] if row_maker is PREDICTED else "the text on the figures agrees",
            row_maker=row_maker,
        ).at("section 4", _picture(parameter))
        for parameter, (direction, row_maker) in CONCLUSIONS.items()
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
            ).at("abstract, section 3.2", _picture("unsprung_mass"))
        )
    return rows


def _first_figure(parameter: str) -> int:
    """Return the number of the figure of the upper body; the next figure shows the lower body."""
    return 11 + 2 * list(VARIED).index(parameter)


def _picture(parameter: str) -> str:
    first = _first_figure(parameter)
    return f"figure_{first}_{first + 1}_{parameter}.png"


def travel_claims(car: HalfCarRiderParameters, studied: Study, factors: Sequence[float]) -> list[Claim]:
    """Return the rows on figures 23 to 25: direction of the suspension travel."""
    return [
        _direction(
            f"suspension travel with {VARIED[parameter]}",
            direction,
            _changes(studied[parameter], "travel"),
            factors,
            _why_travel(car, parameter, factors),
        ).at(f"figure {23 + index}", "figure_23_24_25_travel.png")
        for index, (parameter, direction) in enumerate(TRAVEL_DIRECTIONS.items())
    ]


def _direction(
    name: str,
    direction: str,
    change: Vector,
    factors: Sequence[float],
    why: str,
    little: Vector | float = 0.0,
    *,
    row_maker: Kind = PREDICTED,
) -> Claim:
    """Return the row on the effect of a parameter at every speed; "little" is below given effects."""
    agrees = {"little": np.abs(change) < little, "rises": change > 0.0, "falls": change < 0.0}[direction]
    rule = f"less than {LITTLE:.0%} of the effect of the sprung mass" if direction == "little" else direction
    speeds = ", ".join(f"{speed:.0f}" for speed in SPEEDS)
    ours = f"{_percent(change)} % from {factors[0]:.0%} to {factors[-1]:.0%}, at {speeds} km/h"
    why = f"rule: {rule} at every speed; {why}"
    return row_maker.statement(name, direction, ours, bool(np.all(agrees)), why)


def _percent(change: Vector) -> str:
    return ", ".join(f"{100.0 * value:+.1f}" for value in change)


def _changes(table: Sequence[Sequence[Outcome]], name: str) -> Vector:
    return relative_changes([[getattr(outcome, name) for outcome in row] for row in table])


def relative_changes(values: Sequence[Sequence[float]]) -> Vector:
    """Return the change from the first to the last factor over the value at the first, one for each speed [-]."""
    table = np.asarray(values, dtype=float)
    return np.asarray(table[:, -1] / table[:, 0] - 1.0)


def _why_dose(car: HalfCarRiderParameters) -> dict[str, str]:
    """Return parameter to a text on its effect on the dose value, with values of the car."""
    ratio = car.front.tyre_stiffness / car.front.suspension_stiffness
    hop = float(np.sqrt((car.front.tyre_stiffness + car.front.suspension_stiffness) / car.front.unsprung_mass))
    share = car.front.tyre_damping * hop / car.front.tyre_stiffness
    rigid = _with_seat(car, RIGID_SEAT)
    below = (
        f"the limbs respond below 6 Hz, where a wheel on a tyre {ratio:.0f} times stiffer than its suspension follows "
        f"the road; what happens near the wheel hop ({hop / (2.0 * np.pi):.1f} Hz) reaches them weakly"
    )
    return {
        "sprung_mass": "a heavier body is moved less by the same force",
        "unsprung_mass": below,
        "suspension_stiffness": "the spring force on the body grows with its stiffness",
        "tyre_stiffness": f"{below}, the lower limb more than the upper. The seat between them is not printed: with "
        f"one of {RIGID_SEAT:.0f} N/m the upper body has {_percent(_upper_changes(rigid, 'tyre_stiffness', SPEEDS))} %",
        "tyre_damping": f"at the wheel hop the tyre damper gives {share:.0%} of the force of the tyre spring",
        "suspension_damping": "the damper passes the quick motion of the wheel to the body; the text of the "
        "paper states little effect and its conclusions state that the discomfort rises. The "
        "damper helps only where the bump is a pulse of the body's own frequency: "
        f"{_percent(_upper_changes(car, 'suspension_damping', (CRAWL,)))} % for "
        f"the upper body at {CRAWL:.0f} km/h",
    }


def _upper_changes(car: HalfCarRiderParameters, parameter: str, speeds: Sequence[float]) -> Vector:
    """Return the change of the dose value of the upper body from 80 to 120 % of a parameter at each speed [km/h]."""
    cars = [varied(car, parameter, factor) for factor in (0.8, 1.0, 1.2)]
    return relative_changes(
        [[outcome(car_variant, passive(car_variant, speed)).upper_vdv for car_variant in cars] for speed in speeds]
    )


def _why_travel(car: HalfCarRiderParameters, parameter: str, factors: Sequence[float]) -> str:
    """Return a text on the peaks of the parts of the travel, wheel minus body, at the base speed."""
    ends = [passive(varied(car, parameter, factor), SPEEDS[0]) for factor in (factors[0], factors[-1])]
    wheel, body = (
        [1e3 * peak(car_variant.displacement(f"front_{name}")) for car_variant in ends] for name in ("wheel", "body")
    )
    crawl = [
        outcome(car_variant, passive(car_variant, CRAWL)).travel
        for car_variant in (varied(car, parameter, f) for f in factors)
    ]
    return (
        f"the travel is body minus wheel; at the base speed the peak of the front wheel goes from {wheel[0]:.1f} to "
        f"{wheel[1]:.1f} mm, that of the body above it from {body[0]:.1f} to {body[1]:.1f} mm. At {CRAWL:.0f} km/h the "
        f"travel goes from {1e3 * crawl[0]:.2f} to {1e3 * crawl[-1]:.2f} mm"
    )


def speed_claims(
    car: HalfCarRiderParameters, scan: Mapping[str, Sequence[float]], upper: Sequence[float], one_sided: Sequence[float]
) -> list[Claim]:
    """Return the rows on the dose value over speed.

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
        ).at("figures 11 to 22, section 4", "speed.png"),
        COMPARED.statement(
            "VDV of 15 m/s^1.75 is severe discomfort",
            "limit of BS 6841",
            f"largest of the study {max(upper):.2f} m/s^1.75",
            max(upper) < 15.0,
            "one bump stays far below the limit; unweighted acceleration, as in the source",
        ).at("section 3.2", "speed.png"),
    ]


def matrix_claim(car: HalfCarRiderParameters) -> Claim:
    """Return the row on the printed matrices."""
    printed, ours = growth_rate(printed_system(car)), growth_rate(half_car_rider(car))
    return COMPARED.statement(
        "matrices [C] and [K] below equation 16",
        "equations of motion of the passive car",
        f"largest real part of the poles {printed:+.2f} 1/s as printed, {ours:+.2f} 1/s derived from the energies",
        printed < 0.0,
        "typing errors: neither is symmetric and the pitch damping is negative, so the printed equations grow for "
        "ever; the figures of the source cannot come from them as they stand",
    ).at("equation 16")


def law_claim(doses: Mapping[str, Sequence[float]]) -> Claim:
    """Return the row on the control law of the title, which is not printed."""
    return NOT_TESTABLE.statement(
        "semi-active suspension: control forces uf and ur",
        "a magneto-rheological damper, no law",
        "; ".join(f"{law} {_list(values)}" for law, values in doses.items()) + " m/s^1.75",
        None,
        "the title and equations 4 to 7 have control forces, but no law and no number of a damper is printed; VDV of "
        f"the upper body with usual laws at {_list(SPEEDS)} km/h, all numbers assumed",
    ).at("section 2")


def first_mode_claim(frequency: float, ratios: Mapping[str, Mapping[str, Sequence[float]]]) -> Claim:
    """Return the row on semi-active dampers at the first natural frequency.

    Args:
        frequency: first natural frequency of the passive car [Hz].
        ratios: law to quantity to its RMS over the passive car at each of `SPEEDS` [-].
    """
    return NOT_TESTABLE.statement(
        "semi-active suspension at the first natural frequency: body acceleration, suspension and tyre deflection",
        "all significantly improved",
        "; ".join(
            f"{law}: " + ", ".join(f"{name} x {min(row):.2f} to {max(row):.2f}" for name, row in quantities.items())
            for law, quantities in ratios.items()
        ),
        None,
        "no law and no number of a damper is printed, and the law turns the row; RMS over that of the passive car on a "
        f"sine road of {frequency:.2f} Hz, steady, at {SPEEDS[0]:.0f} to {SPEEDS[-1]:.0f} km/h, the larger of both "
        "axles; all numbers of the laws assumed",
    ).at("section 1")


def _list(values: Sequence[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in values)
