"""Rows of published statements about comfort on the smooth and the rough road with our values."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from scenarios.claims import NOT_TESTABLE, PREDICTED, Claim, Interval
from scenarios.comfort_runs import Changes, Curves, Numbers, Point, Variation
from scenarios.evidence import COMFORT_ENDS, SLIP_STEP, slip_error
from scenarios.evidence_claims import evidence_claim, reason
from scenarios.signals.exact_road import ROAD_EDGE_HZ

Ends = Mapping[float, Interval]
"""Value of the parameter to the interval of the relative comfort value [%]."""

PUBLISHED: Mapping[tuple[str, str], Ends] = {
    pair: {value: interval for name, _, road, _, value, interval in COMFORT_ENDS if (name, road) == pair}
    for pair in dict.fromkeys((name, road) for name, _, road, *_ in COMFORT_ENDS)
}
"""(Parameter, road) to the ends of the curve. The text of the thesis contains no curves, only the labels of their
axes: an end lies in the last interval. The lowest label of 4.4 is unreadable, 99 follows from the ticks."""

FIGURES = {(name, road): figure for name, _, road, figure, *_ in COMFORT_ENDS}
"""Parameter and road to the figure of its curve."""

TITLES = {"coulomb_friction": "Fd", "mount_damping": "mount damping", "mount_stiffness": "mount stiffness"}

RISING = {"coulomb_friction": True, "mount_damping": False, "mount_stiffness": False}

SAME_INFLUENCE = 0.25
"""Largest difference of two ranges that count as about the same, as a share of one: two divisions of 2 % in 16 %."""


def slip_claims(records: Mapping[str, Sequence[Numbers]], slip_velocity: float) -> list[Claim]:
    """Return the rows on the slip shares of the nominal car on both roads.

    Args:
        records: road to the values of the nominal car on each of its records.
        slip_velocity: velocity of the rows [m/s].
    """
    claims = []
    for road, numbers in records.items():
        shares = {
            name: np.array([100.0 * record[name] for record in numbers])
            for name in ("slip", "saturated", "slip_less", "slip_more")
        }
        less, more = (float(np.mean(shares[name])) for name in ("slip_less", "slip_more"))
        claims.append(
            evidence_claim(
                f"slip_{road}",
                f"slip share of the right damper, {road} road [%]",
                shares["slip"],
                f"above {1e3 * slip_velocity:g} mm/s, as in all rows; {np.mean(shares['saturated']):.1f} % above 1 "
                f"mm/s. One band edge for both roads, {ROAD_EDGE_HZ:g} Hz. Error: half of the change from a slip "
                f"velocity {100.0 * SLIP_STEP:g} % higher to one {100.0 * SLIP_STEP:g} % lower ({more:.1f} to "
                f"{less:.1f} %)",
                printed=100.0 * PUBLISHED_SLIP[road],
                error=slip_error(less, more),
            )
        )
    return claims


def order_claims(curves: Mapping[str, Curves]) -> list[Claim]:
    """Return the rows on the direction of each curve, and on the road with the larger change."""
    trends = [
        PREDICTED.statement(
            f"comfort value against {TITLES[name]}, {road} road",
            f"{'rises' if rising else 'falls'} over the whole range",
            ", ".join(f"{100.0 * point.relative:.1f}" for point in points) + " %",
            is_monotone(points, rising=rising),
            "from point to point by more than twice the standard error of both",
        ).at(f"figure {FIGURES[name, road]}", f"{name}.png")
        for name, rising in RISING.items()
        for road, points in curves[name].items()
    ]
    greater = ("greater on the smooth road", "largest minus smallest relative comfort value")
    same = ("about the same", f"ranges within {100.0 * SAME_INFLUENCE:g} % of each other")
    for name, (published, why) in zip(RISING, (greater, greater, same), strict=True):
        smooth, rough = (
            100.0 * np.ptp([point.relative for point in curves[name][road]]) for road in ("smooth", "rough")
        )
        trends.append(
            PREDICTED.statement(
                f"influence of {TITLES[name]}, smooth road against rough",
                published,
                f"range {smooth:.1f} against {rough:.1f} points",
                abs(rough - smooth) <= SAME_INFLUENCE * smooth if name == "mount_stiffness" else smooth > rough,
                why,
            ).at(f"figures {FIGURES[name, 'smooth']} and {FIGURES[name, 'rough']}", f"{name}.png")
        )
    return trends


Trials = Mapping[str, Mapping[tuple[str, str, float], float]]
"""Label of a modification to (parameter, road, value) to relative comfort value [%]."""


def size_claims(curves: Mapping[str, Curves], trials: Trials | None = None) -> list[Claim]:
    """Return the rows on relative comfort at the ends of the curves, with trials as evidence for a disagreement."""
    claims = []
    for name, word, road, _, value, interval in COMFORT_ENDS:
        point = _at(curves[name][road], value)
        row = (f"comfort_{name}_{road}_{value:g}".replace("+0", ""), _end_name(word, value, road))
        why = f"standard error {100.0 * point.relative_error:.2f}"
        claim = evidence_claim(*row, 100.0 * point.relative, why).at(picture=f"{name}.png")
        if not claim.within and trials:
            why += f"; {reason(interval, {label: values[name, road, value] for label, values in trials.items()})}"
            claim = evidence_claim(*row, 100.0 * point.relative, why).at(picture=f"{name}.png")
        claims.append(claim)
    return claims


def degressive_claim(points: Mapping[str, Point]) -> Claim:
    """Return the row on the degressive damper in the complete car, which the source recommends and does not compute."""
    return NOT_TESTABLE.statement(
        "degressive damper in the complete car: comfort value over that with the linear damper",
        "recommended, not computed",
        ", ".join(
            f"{road} road {100.0 * point.relative:.1f} ± {200.0 * point.relative_error:.1f} %"
            for road, point in points.items()
        ),
        None,
        "the source has this damper for the quarter car only; ours with the numbers of appendix C.2, ± two standard "
        "errors",
    ).at("section 5")


def body_claim(points: Mapping[str, Sequence[Point]]) -> Claim:
    """Return the row on the global stiffness of the body, which the source recommends and does not compute."""
    return NOT_TESTABLE.statement(
        "body of another global stiffness in the complete car: comfort value over that of the designed body",
        "recommended, not computed",
        "; ".join(
            f"{road} road "
            + ", ".join(
                f"{100.0 * point.relative:.1f} ± {200.0 * point.relative_error:.1f} % with modes x {point.value:g}"
                for point in ends
            )
            for road, ends in points.items()
        ),
        None,
        "all frequencies of the flexible body times a factor, masses unchanged; ± two standard errors",
    ).at("section 5.2", f"{BODY.name}.png")


def _end_name(word: str, value: float, road: str) -> str:
    return f"relative comfort value at {word} {value:g}, {road} road [%]"


def is_monotone(points: Sequence[Point], *, rising: bool) -> bool:
    """Return True if relative comfort rises (falls) at each point by more than twice the error of both points."""
    sign = 1.0 if rising else -1.0
    return all(
        sign * (after.relative - before.relative)
        > 2.0 * float(np.hypot(*np.nan_to_num([after.relative_error, before.relative_error])))
        for before, after in pairwise(points)
    )


def _at(points: Sequence[Point], value: float) -> Point:
    return next(point for point in points if point.value == value)


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
"""Variations of Bommer 2006: 14 points on 2 roads, 28 runs, the nominal car counted once for each parameter."""

DEGRESSIVE: Changes = ("damper.viscous_law=degressive",)
"""The damper that the source has for the quarter car only (appendix C.2)."""

RIGID_BODY: Changes = ("body.flexible=false",)
"""Leaves out the flexible modes of the body, whose shapes are assumed."""

PUBLISHED_SLIP = {"smooth": 0.313, "rough": 0.794}
"""Share of the time in slip of the right damper (Bommer 2006, chapter 4)."""
