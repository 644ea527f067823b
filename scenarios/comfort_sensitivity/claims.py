"""Published statements about comfort on the smooth and the rough road beside ours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from scenarios.claims import FITTED, PREDICTED, Claim, Interval, interval_claim, spread_claim
from scenarios.comfort_runs import Changes, ComfortRuns, Curves, Point, Variation
from vehicle.analysis.segments import window_extremes
from vehicle.excitation.exact_road import RATE_HZ, ROAD_EDGE_HZ, ROAD_RMS
from vehicle.sweeps.case import signal_of

Ends = Mapping[float, Interval]
"""Value of the parameter to the interval of the relative comfort value [%]."""

PUBLISHED: Mapping[tuple[str, str], tuple[str, Ends]] = {
    ("coulomb_friction", "smooth"): ("4.3", {62.5: (70.0, 80.0), 250.0: (120.0, 130.0)}),
    ("coulomb_friction", "rough"): ("4.4", {62.5: (99.0, 100.0), 250.0: (107.0, 108.0)}),
    ("mount_damping", "smooth"): ("4.7", {2000.0: (95.0, 96.0)}),
    ("mount_damping", "rough"): ("4.8", {2000.0: (99.0, 99.5)}),
    ("mount_stiffness", "smooth"): ("4.11", {3.5e5: (108.0, 110.0), 14.0e5: (90.0, 92.0)}),
    ("mount_stiffness", "rough"): ("4.12", {3.5e5: (105.0, 110.0), 14.0e5: (95.0, 100.0)}),
}
"""Figure and ends of its curve. The curves are not in the text of the source, only the labels of their axes: an end
lies in the last interval. The lowest label of 4.4 is unreadable, 99 follows from the ticks."""

TITLES = {"coulomb_friction": "Fd", "mount_damping": "mount damping", "mount_stiffness": "mount stiffness"}

RISING = {"coulomb_friction": True, "mount_damping": False, "mount_stiffness": False}

SLIP_TOLERANCE = 0.03
"""As for the shaker levels: three points are what a quarter of the slip velocity changes."""

SAME_INFLUENCE = 0.25
"""Largest difference of two ranges that count as about the same, as a share of one: two divisions of 2 % in 16 %."""


WHY = {
    ("coulomb_friction", "smooth"): (
        "the lower end hardly depends on what is assumed: 81 to 82 % with a rigid body and, tried once each with an "
        "earlier one, with modal damping of 2 to 8 %, rigid attachments or Ixx 1200; the upper end depends on the body"
    ),
    ("coulomb_friction", "rough"): "friction matters through body modes, whose shapes are not published",
    ("mount_damping", "smooth"): "part of the comfort value lies in body modes that are driven through the mount",
    ("mount_damping", "rough"): "more than printed even with a rigid body",
    ("mount_stiffness", "smooth"): (
        "a seat rail that moves less with the body modes gains less from both mount parameters: what helps the rows of "
        "mount damping harms this one"
    ),
}
"""Where ours differs, the reason as far as it is known."""


def slip_claims(nominal: Mapping[str, Point], slip_velocity: float) -> list[Claim]:
    """Slip shares of both roads, nominal car."""
    return [
        FITTED.number(
            f"slip share of the right damper, {road} road [%]",
            100.0 * PUBLISHED_SLIP[road],
            100.0 * found.slip,
            100.0 * SLIP_TOLERANCE,
            f"above {1e3 * slip_velocity:g} mm/s, as fixed by the shaker inputs; standard error "
            f"{100.0 * found.slip_error:.2f} points; {100.0 * found.saturated:.1f} % above 1 mm/s. One band edge, "
            f"{ROAD_EDGE_HZ:g} Hz, fitted to both shares: tolerance {100.0 * SLIP_TOLERANCE:g} points, what a quarter "
            "of the slip velocity changes",
        )
        for road, found in nominal.items()
    ]


def order_claims(curves: Mapping[str, Curves]) -> list[Claim]:
    """Rising and falling, and which road feels it more."""
    trends = [
        PREDICTED.statement(
            f"comfort value against {TITLES[name]}, {road} road",
            f"{'rises' if rising else 'falls'} over the whole range",
            ", ".join(f"{100.0 * one.relative:.1f}" for one in points) + " %",
            is_monotone(points, rising=rising),
            "from point to point by more than twice the standard error of both",
        )
        for name, rising in RISING.items()
        for road, points in curves[name].items()
    ]
    greater = ("greater on the smooth road", "largest minus smallest relative comfort value")
    same = ("about the same", f"ranges within {100.0 * SAME_INFLUENCE:g} % of each other")
    for name, (published, why) in zip(RISING, (greater, greater, same), strict=True):
        smooth, rough = (100.0 * np.ptp([one.relative for one in curves[name][road]]) for road in ("smooth", "rough"))
        trends.append(
            PREDICTED.statement(
                f"influence of {TITLES[name]}, smooth road against rough",
                published,
                f"range {smooth:.1f} against {rough:.1f} points",
                abs(rough - smooth) <= SAME_INFLUENCE * smooth if name == "mount_stiffness" else smooth > rough,
                why,
            )
        )
    return trends


def size_claims(curves: Mapping[str, Curves], rigid: Mapping[str, Curves] | None = None) -> list[Claim]:
    """Relative comfort at the ends of the curves.

    Args:
        curves: variation to its points.
        rigid: the same with a rigid body, as evidence for the reason of a deviation.
    """
    claims = []
    for (name, road), (figure, ends) in PUBLISHED.items():
        for value, interval in ends.items():
            found = _at(curves[name][road], value)
            ours = 100.0 * found.relative
            why = f"axis of figure {figure}; standard error {100.0 * found.relative_error:.2f}"
            if rigid is not None:
                why += f"; with a rigid body {100.0 * _at(rigid[name][road], value).relative:.1f} %"
            if not interval[0] <= ours <= interval[1] and (name, road) in WHY:
                why += f"; {WHY[(name, road)]}"
            claims.append(
                interval_claim(
                    f"relative comfort value at {TITLES[name]} {value:g}, {road} road [%]",
                    interval,
                    ours,
                    why,
                    # The body was chosen among several with figures 4.3 to 4.12 in view (`vehicle.flexbody.fit`). Their
                    # trends, in `order_claims`, held with the body before it too.
                    status="chosen",
                )
            )
    return claims


def is_monotone(points: Sequence[Point], *, rising: bool) -> bool:
    """Whether relative comfort goes one way from each point to the next, by more than twice the error of both."""
    sign = 1.0 if rising else -1.0
    return all(
        sign * (after.relative - before.relative)
        > 2.0 * float(np.hypot(*np.nan_to_num([after.relative_error, before.relative_error])))
        for before, after in pairwise(points)
    )


def _at(points: Sequence[Point], value: float) -> Point:
    return next(point for point in points if point.value == value)


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
    record = slice(round(comfort.records.lead * RATE_HZ) + 1, None)
    for road in ROAD_RMS:
        extremes, swings = [], []
        for number in range(comfort.records.count):
            (rail,) = comfort.histories([()], road, record=number)
            extremes.append(window_extremes(1.0 / RATE_HZ, rail[record], WINDOW_S))
            plate = signal_of(comfort.cases((), road)[number].source).displacement[comfort.runs.wheel][record]
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


FRICTION = Variation(
    name="coulomb_friction",
    label="Coulomb friction Fd [N]",
    path="damper.coulomb_friction",
    values=(62.5, 93.75, 125.0, 187.5, 250.0),
    figures="4.1 to 4.4",
)

MOUNT_DAMPING = Variation(
    name="mount_damping",
    label="suspension mount damping, z [N s/m]",
    path="bushings.suspension_mount.damping.z",
    values=(0.0, 500.0, 1000.0, 2000.0),
    figures="4.5 to 4.8",
)

MOUNT_STIFFNESS = Variation(
    name="mount_stiffness",
    label="suspension mount stiffness, z [N/m]",
    path="bushings.suspension_mount.stiffness.z",
    values=(3.5e5, 5.25e5, 7.0e5, 10.5e5, 14.0e5),
    figures="4.9 to 4.12",
)

BODY = Variation(
    name="body_stiffness",
    label="factor on the frequencies of the body modes [-]",
    path="body.frequency_scale",
    values=(0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2, 1.25),
)

SOURCE = (FRICTION, MOUNT_DAMPING, MOUNT_STIFFNESS)
"""Variations of source 1: 14 points on 2 roads, 28 runs, the nominal car counted once for each parameter."""

DEGRESSIVE: Changes = ("damper.viscous_law=degressive",)
"""The damper that the source has for the quarter car only (appendix C.2)."""

RIGID_BODY: Changes = ("body.flexible=false",)
"""Leaves out the flexible modes of the body, whose shapes are assumed."""

PUBLISHED_SLIP = {"smooth": 0.313, "rough": 0.794}
"""Share of the time in slip of the right damper (source 1, chapter 4)."""
