"""Extremes of the time histories after the 7.5 mm bump, against the axes of figures 3.13 to 3.18 of source 1."""

from __future__ import annotations

import math

import numpy as np

from scenarios.claim import Claim, Interval, interval_claim
from scenarios.relative_acceleration import relative_acceleration
from vehicle.car import Run

SHOWN_S = 3.0
"""The figures show 3 s from the start of the bump [s]."""

RELATIVE = "relative acceleration damper top - knuckle"

AXES: dict[str, tuple[str, str, Interval, Interval]] = {
    "seat rail": ("3.13", "seat_rail_acc_z", (-0.8, -0.6), (0.4, 0.6)),
    "seat": ("3.14", "seat_acc_z", (-1.0, -0.5), (0.0, 0.5)),
    "knuckle": ("3.15", "knuckle_fr_acc_z", (-2.0, -1.0), (1.0, 2.0)),
    RELATIVE: ("3.16", "", (-5.0, 0.0), (0.0, 5.0)),
    "engine": ("3.17", "engine_acc_z", (-1.5, -1.0), (0.5, math.inf)),
    "roof left rear": ("3.18", "roof_left_rear_acc_z", (-0.8, -0.6), (0.4, 0.6)),
}
"""Point to figure, channel, and the last intervals of its axis at the lower and the upper end [m/s2]. Figure 3.16 has
ticks at -5, 0 and 5 only; the upper end of 3.17 is unreadable above 0.5."""


def extremes(run: Run, start: float) -> dict[str, tuple[float, float]]:
    """Lowest and highest vertical acceleration [m/s2] of every point, from the start of the bump on [s]."""
    shown = (run.time >= start) & (run.time <= start + SHOWN_S)
    found = {}
    for point, (_, channel, _, _) in AXES.items():
        values = (run[channel] if channel else relative_acceleration(run))[shown]
        found[point] = (float(np.min(values)), float(np.max(values)))
    return found


def extreme_claims(
    found: dict[str, tuple[float, float]], literal: dict[str, tuple[float, float]], name: str
) -> list[Claim]:
    """A row for each end of each axis.

    Args:
        found: point to lowest and highest acceleration [m/s2].
        literal: the same with the other reading of the printed amplitude, as evidence for a deviation.
        name: of the other reading.
    """
    claims = []
    for point, (figure, _, *ends) in AXES.items():
        for word, interval, ours, other in zip(("lowest", "highest"), ends, found[point], literal[point], strict=True):
            claims.append(
                interval_claim(
                    f"bump 7.5 mm, {word} {point}{'' if point == RELATIVE else ', vertical'} [m/s2]",
                    interval,
                    ours,
                    f"figure {figure}, whose axis holds model and measurement; with noise, {SHOWN_S:g} s from the "
                    f"bump. With the {name} reading {other:.2f}",
                    # The body was chosen among several with these figures in view (`vehicle.flexbody.fit`).
                    status="chosen",
                )
            )
    return claims
