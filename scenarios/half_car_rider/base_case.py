"""Figures 5 to 10 of the half car with rider: sizes and settling times of the base case, printed and ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from scenarios.claims import PREDICTED, Claim
from scenarios.half_car_rider.runs import KMH, SPEEDS, passive
from vehicle.lumped.half_car_rider import places
from vehicle.lumped.motion_history import MotionHistory
from vehicle.lumped.settling import settling_time
from vehicle.parameters.half_car_rider import HalfCarRiderParameters

SETTLING_BAND = 0.005
"""Settled means: the rest is below 0.5 % of the peak, about the width of a line in a figure [-]."""

BANDS = (SETTLING_BAND, 0.01, 0.02, 0.05)
"""Bands given in the JSON file [-]."""

READING = 0.3
"""The printed times are read from figures, most of them with the word "about" [s]."""

STIFF_SEAT = 50000.0
"""Seat stiffness for the row on figure 10 [N/m]: the source does not print its own."""

SETTLING = (
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


def base_case_claims(car: HalfCarRiderParameters, history: MotionHistory) -> list[Claim]:
    """Rows on figures 5 to 10: sizes and settling times of the base case."""
    place = places(car)
    rows = []
    for quantity, unit, factor, figure in (
        ("displacement", "mm", 1e3, "figure 5"),
        ("acceleration", "m/s2", 1.0, "figure 6"),
    ):
        upper, lower = (
            factor * float(np.abs(history.of(place[name], quantity)).max()) for name in ("upper_limb", "lower_limb")
        )
        rows.append(
            PREDICTED.statement(
                f"{figure}: peak {quantity} of the upper body above that of the lower body",
                "larger",
                f"upper {upper:.3g} {unit}, lower {lower:.3g} {unit}",
                upper > lower,
                _why_upper(car, history, quantity),
            )
        )
    seat, body = _peaks(car, history, ("seat", "body"))
    stiff = replace(car, seat=replace(car.seat, stiffness=STIFF_SEAT))
    stiff_seat, stiff_body = _peaks(stiff, passive(stiff, SPEEDS[0]), ("seat", "body"))
    rows.append(
        PREDICTED.statement(
            "figure 10: peak acceleration of the seat above that of the chassis",
            "larger",
            f"seat {seat:.3g} m/s2, chassis {body:.3g} m/s2",
            seat > body,
            "the seat is not printed; the assumed one isolates from the pulse of the bump. With a seat of "
            f"{STIFF_SEAT:.0f} N/m it would be {stiff_seat:.3g} against {stiff_body:.3g} m/s2",
        )
    )
    for name, quantity, printed, limit, figure in SETTLING:
        rows.append(_settling(history, place[name], name, quantity, printed, limit, figure))
    return rows


def _why_upper(car: HalfCarRiderParameters, history: MotionHistory, quantity: str) -> str:
    if quantity == "displacement":
        return "the upper limb on its spring overshoots the seat"
    isolated = float(np.sqrt(2.0 * car.upper_limb.stiffness / car.upper_limb.mass)) / (2.0 * np.pi)
    pulse = SPEEDS[0] * KMH / (2.0 * car.bump.length)
    return (
        f"above sqrt(2) times its own frequency ({isolated:.1f} Hz) the upper limb is isolated from the seat, the "
        f"stiffly held lower limb is not; the pulse of the bump has {pulse:.1f} Hz"
    )


def _peaks(car: HalfCarRiderParameters, history: MotionHistory, names: Sequence[str]) -> list[float]:
    place = places(car)
    return [float(np.abs(history.of(place[name], "acceleration")).max()) for name in names]


def _settling(
    history: MotionHistory,
    form: Mapping[str, float],
    name: str,
    quantity: str,
    printed: float,
    limit: bool,
    figure: str,
) -> Claim:
    signal = history.of(form, quantity)
    times = {band: settling_time(history.time, signal, band) for band in (SETTLING_BAND, 0.02, 0.05)}
    found = times[SETTLING_BAND]
    ours = float(history.time[-1]) if found is None else found
    why = (
        f"rule: last time above 0.5 % of the peak, t = 0 when the front wheel meets the bump; 2 %: {_s(times[0.02])}, "
        f"5 %: {_s(times[0.05])}; tolerance {READING} s, read from a figure"
    )
    label = f"{figure}: settling time of {name} {quantity} [s]"
    if limit:
        text, holds = f"longer than {printed}", ours >= printed - READING
        return PREDICTED.statement(label, text, f"{ours:.2f}", holds, why)
    return PREDICTED.number(label, printed, ours, READING, why)


def base_case_table(car: HalfCarRiderParameters, history: MotionHistory) -> dict[str, dict[str, Any]]:
    """Peaks and settling times of every place.

    Args:
        car: base case.
        history: its motion.

    Returns:
        Place -> quantity -> peak magnitude [m, m/s2; rad, rad/s2 for pitch] and settling time [s] for each band.
    """
    table: dict[str, dict[str, Any]] = {}
    for name, form in places(car).items():
        table[name] = {}
        for quantity in ("displacement", "acceleration"):
            signal = history.of(form, quantity)
            table[name][quantity] = {
                "peak": float(np.abs(signal).max()),
                "settling_s": {f"{band:g}": settling_time(history.time, signal, band) for band in BANDS},
            }
    return table


def _s(value: float | None) -> str:
    return "beyond the record" if value is None else f"{value:.2f} s"
