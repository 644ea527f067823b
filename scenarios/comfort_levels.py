"""How far road and seat rail move, in windows of both roads, against the axes of figures 2.6, 4.1 and 4.2."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from scenarios.claims import Claim, Interval, spread_claim
from scenarios.comfort_sensitivity_runs import ComfortRuns
from scenarios.road_signals import RATE_HZ, ROAD_RMS
from vehicle.analysis.window_extremes import window_extremes

Vector = npt.NDArray[np.float64]

WINDOW_S = 0.5
"""The figures show 27 to 27.5 s."""

LEVELS: Mapping[str, tuple[Interval, str]] = {
    "smooth": ((0.6, 0.8), "figure 4.1; 4.5 and 4.9 hold the same run and end at 0.8"),
    "rough": ((3.0, 4.0), "figures 4.2 and 4.10"),
}
"""Road to the interval of the largest |acceleration| [m/s2], and where it is read off."""

SWING_S = 30.0
"""Length of the road in figure 2.6 [s]."""

SWING: Interval = (0.15, 0.2)
"""From the lowest to the highest displacement there [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoadLevels:
    """Windows of one road, over all records.

    Attributes:
        seat_rail: largest |vertical acceleration| in each 0.5 s, nominal car [m/s2], (w,).
        swing: highest minus lowest displacement of the road in each 30 s [m], (s,).
    """

    seat_rail: Vector
    swing: Vector


def road_levels(comfort: ComfortRuns) -> dict[str, RoadLevels]:
    """Windows of both roads, the lead left out."""
    found = {}
    for road in ROAD_RMS:
        extremes, swings = [], []
        for question in comfort.questions((), road):
            run = comfort.run_of(question)
            record = slice(round(comfort.records.lead * RATE_HZ) + 1, None)
            extremes.append(window_extremes(run.recording.timestep, run["seat_rail_acc_z"][record], WINDOW_S))
            plate = question.source.signal().displacement["fr"][record]
            samples = min(round(SWING_S * RATE_HZ), plate.size)
            swings.append(np.ptp(plate[: plate.size // samples * samples].reshape(-1, samples), axis=1))
        found[road] = RoadLevels(seat_rail=np.concatenate(extremes), swing=np.concatenate(swings))
    return found


def level_claims(levels: Mapping[str, RoadLevels]) -> list[Claim]:
    """Level of the seat rail on both roads, swing of the road."""
    rows = [
        spread_claim(
            f"largest |seat rail, vertical| in {WINDOW_S:g} s, {road} road [m/s2]",
            interval,
            levels[road].seat_rail,
            f"{levels[road].seat_rail.size} windows of the nominal car; {figure}. The body was fitted to it",
            status="fitted",
        )
        for road, (interval, figure) in LEVELS.items()
    ]
    smooth = 1e3 * np.median(levels["smooth"].swing)
    rows.append(
        spread_claim(
            f"swing of a road over {SWING_S:g} s, figure 2.6 [m]",
            SWING,
            levels["rough"].swing,
            f"{levels['rough'].swing.size} stretches of the rough road, as its caption says; the smooth road of "
            f"{1e3 * ROAD_RMS['smooth']:g} mm RMS swings by {smooth:.0f} mm and cannot be meant",
        )
    )
    return rows
