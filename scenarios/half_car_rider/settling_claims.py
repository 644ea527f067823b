"""Printed settling times of the base case, figures 5 to 10, and their order."""

import numpy as np

from scenarios.claims import CHOSEN, PREDICTED, Claim
from scenarios.half_car_rider.runs import BANDS, KMH, SETTLING_BAND, SPEEDS, Motion, settling_time
from scenarios.lumped.half_car_rider_parameters import HalfCarRiderParameters
from scenarios.lumped.history import History
from vehicle.arrays import Vector

READING = 0.3
"""The printed times are read from figures, most of them with the word "about" [s]."""

SETTLING: tuple[tuple[str, Motion, float, bool, int], ...] = (
    ("upper_limb", "displacement", 3.5, True, 5),
    ("lower_limb", "displacement", 3.5, True, 5),
    ("upper_limb", "acceleration", 3.5, True, 6),
    ("lower_limb", "acceleration", 3.5, True, 6),
    ("front_body", "displacement", 3.0, False, 7),
    ("rear_body", "displacement", 3.5, True, 7),
    ("pitch", "displacement", 3.5, False, 8),
    ("front_wheel", "displacement", 1.7, False, 9),
    ("rear_wheel", "displacement", 1.2, False, 9),
    ("seat", "acceleration", 3.5, False, 10),
    ("body", "acceleration", 1.7, False, 10),
)
"""Place, quantity, printed settling time [s], whether it is a lower limit, figure."""

ORDER: tuple[tuple[str, str, Motion, int], ...] = (
    ("upper_limb", "lower_limb", "acceleration", 6),
    ("rear_body", "front_body", "displacement", 7),
    ("front_wheel", "rear_wheel", "displacement", 9),
    ("seat", "body", "acceleration", 10),
)
"""(point that settles later, point that settles earlier, quantity, figure)."""


def settling_claims(car: HalfCarRiderParameters, history: History) -> list[Claim]:
    """Return the rows on the settling times of the base case, and on the later of two settling times."""
    delay = (car.body.front_arm + car.body.rear_arm) / (SPEEDS[0] * KMH)
    return [*(_time(history, *row) for row in SETTLING), *(_order(history, delay, *row) for row in ORDER)]


def _time(history: History, point: str, quantity: Motion, printed: float, limit: bool, figure: int) -> Claim:
    motion = history.motion(point, quantity)
    settling = settling_time(history.time, motion, SETTLING_BAND)
    ours = float(history.time[-1]) if settling is None else settling
    others = ", ".join(f"{100.0 * b:g} %: {_seconds(settling_time(history.time, motion, b))}" for b in BANDS[1:])
    why = (
        f"the band is not printed: {100.0 * SETTLING_BAND:g} % of the peak is the nearest of {len(BANDS)} bands "
        f"to all printed times; {others}. The printed time needs a band of {_needed(history.time, motion, printed)}; "
        f"t = 0 when the front wheel meets the bump; tolerance {READING} s, read from a figure"
    )
    name, where = f"settling time of {point} {quantity} [s]", f"figure {figure}"
    picture = f"figure_{figure:02d}.png"
    if limit:
        holds = ours >= printed - READING
        text = f"longer than {printed}"
        return CHOSEN.statement(name, text, f"{ours:.2f}", holds, why).at(where, picture)
    return CHOSEN.number(name, printed, ours, READING, why).at(where, picture)


def _needed(time: Vector, motion: Vector, printed: float) -> str:
    """Return the band in which the motion has settled at a time: largest later magnitude over the peak."""
    magnitude = np.abs(motion)
    return f"{100.0 * float(magnitude[time >= printed].max() / magnitude.max()):.2g} %"


def _order(history: History, delay: float, late: str, early: str, quantity: Motion, figure: int) -> Claim:
    times = {
        band: [settling_time(history.time, history.motion(point, quantity), band) for point in (late, early)]
        for band in BANDS
    }
    pairs = "; ".join(f"{100.0 * band:g} %: {_seconds(a)}, {_seconds(b)}" for band, (a, b) in times.items())
    holds = all(_later(a, b) for a, b in times.values())
    count = sum(_later(a, b) for a, b in times.values())
    why = f"rule: at each of {len(BANDS)} bands, as the paper prints none; it holds at {count} of them"
    if "rear_wheel" in (late, early):
        other_bands = "; ".join(f"{100.0 * band:g} %: {_seconds(_less(b, delay))}" for band, (_, b) in times.items())
        why += (
            f"; the rear wheel meets the bump {delay:.2f} s later. From its own meeting it takes {other_bands}, less "
            "than the front wheel at every band"
        )
    name = f"settling of {late} {quantity} against {early}"
    return PREDICTED.statement(name, "later", pairs, holds, why).at(f"figure {figure}", f"figure_{figure:02d}.png")


def _later(late: float | None, early: float | None) -> bool:
    """Return True if the first settling time is later; None is a time after the end of the record."""
    return early is not None and (late is None or late > early)


def _less(time: float | None, delay: float) -> float | None:
    return None if time is None else time - delay


def _seconds(time: float | None) -> str:
    return "beyond the record" if time is None else f"{time:.2f} s"
