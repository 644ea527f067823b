"""Statements of Bommer 2006 for the choice of its unprinted parameters: a row for each, one half held out.

The thesis does not print the sides of the car, the minimum velocity of slip, band edges, modal damping and the body's
mode shapes. They are chosen together (`scenarios.source_choice`) on half of these rows; the other half is a prediction.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from scenarios.claims import Interval, Status
from vehicle.arrays import Vector

Topic = Literal["shaker slip", "no slip", "road slip", "bump 7.5 mm", "bump 1.5 mm", "comfort", "level", "mode"]
"""Strata of the draw: rows of one topic, so that every unprinted parameter keeps rows that depend on it
(for example, only `shaker slip` depends on the lower edge of the shaker inputs)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Evidence:
    """Statement of the thesis as an interval of a quantity."""

    key: str  # short name, for tables and `status_of`
    name: str  # name of the compared quantity
    unit: str  # unit of the quantity
    place: str  # figure, table or section of the thesis
    interval: Interval  # lowest and highest value, as printed or from the labels of an axis; infinite for an open end
    topic: Topic  # stratum of the row
    how: str  # computation of our value
    # standard deviation of a normal error of the model, in the unit of the quantity; 0 if the scatter of the input over
    # its unpublished seeds is larger, and for a slip share, whose error is `slip_error` of its own shares
    error: float = 0.0
    weight: float = 1.0  # weight in the sum of log-likelihoods; 1 / k for each of k rows from one curve or run
    # status of the row in both halves: the body was fitted to it, or an earlier choice had it in view; None if neither
    # did
    before: Status | None = None
    # key of the row that counts in place of this row: another figure with the same half second of the same road; empty
    # by default
    same: str = ""


SLIP_STEP = 0.1
"""Error of the velocity of a damper, or of the velocity that counts as slip, as a share of it [-]."""


def slip_error(above_less: Vector | float, above_more: Vector | float) -> float:
    """Return the error of a slip share: half of its change over the slip velocity v +- 10 %.

    e = (S(0.9 v) - S(1.1 v)) / 2, S the share of the time above a velocity. The error differs from row to row: where
    the velocity is seldom near v, an error of v changes little.

    Args:
        above_less: shares above 0.9 v, of each record, (n,).
        above_more: shares above 1.1 v of the same records, (n,).

    Returns:
        Error in the unit of the shares, from their means.
    """
    return 0.5 * float(np.mean(above_less) - np.mean(above_more))


SHARE_READING = 1.0
"""Half width of the interval around a printed share [points]: the treatment of crossings between samples is unknown."""

MODE_ERROR = 0.02
"""Error of a frequency, as a share: 4 % of a stiffness, which is how near the tuned values of appendix F are rounded
(2.5e5 against 2.4e5 or 2.6e5)."""

ROUND_ERROR = 0.05
"""The same where the source prints a range in round numbers."""

SLIP_INSTANT, INSTANT_READING = 5.035, 0.010
"""End of sticking of the right damper in figure 3.12, and reading error of an axis with ticks of 50 ms [s]."""


def _slip() -> list[Evidence]:
    right = "share of the time of the damper over the shaker above the slip velocity, 60 s"
    rows = [
        _share("slip_right_low", "right damper, low", "table 3.2", 0.0, right),
        _share("slip_right_mid", "right damper, mid", "table 3.2", 3.9, right),
        _share("slip_right_high", "right damper, high", "table 3.2", 21.8, right),
    ]
    left = "the same of the other damper"
    # A damper that sticks at the high level also sticks at lower levels of the same signal: three rows, one statement.
    rows += [
        _share(f"slip_left_{level}", f"left damper, {level}", "section 3.3.1", 0.0, left, weight=1 / 3)
        for level in ("low", "mid", "high")
    ]
    on_road = "share of the time of the damper over the shaker above the slip velocity, after a lead of 10 s"
    rows.append(_share("slip_smooth", "right damper, smooth road", "chapter 4", 31.3, on_road))
    rows.append(_share("slip_rough", "right damper, rough road", "chapter 4", 79.4, on_road))
    return rows


def _share(key: str, name: str, place: str, percent: float, how: str, weight: float = 1.0) -> Evidence:
    # A printed 0, with 3.9 for the other side, is below half a percent.
    low, high = (percent - SHARE_READING, percent + SHARE_READING) if percent else (-math.inf, 0.5)
    topic: Topic = ("road slip" if "road" in name else "shaker slip") if percent else "no slip"
    return Evidence(
        key=key,
        name=f"slip share of the {name}",
        unit="%",
        place=place,
        interval=(low, high),
        topic=topic,
        how=how,
        weight=weight,
        # All eight chose among slip velocities that the half leaves equally likely
        # (`vehicle.signals.excitation.slip_set`).
        before="chosen",
    )


Panel = tuple[str, str, str, Interval, Interval, float]
"""Key of the point, its name, the figure, last intervals of the axis below and above [m/s2], weight of each."""

# Seat and seat rail are 0.18 m apart on one stiff frame: two figures, one motion.
SEAT = 0.5

HIGH_PANELS: Sequence[Panel] = (
    ("seat_rail_z", "seat rail, vertical", "3.13", (-0.8, -0.6), (0.4, 0.6), SEAT),
    ("seat_z", "seat, vertical", "3.14", (-1.0, -0.5), (0.5, 1.0), SEAT),
    ("knuckle_z", "knuckle, vertical", "3.15", (-2.0, -1.0), (1.0, 2.0), 1.0),
    ("relative", "damper top less knuckle", "3.16", (-5.0, 0.0), (0.0, 5.0), 1.0),
    ("engine_z", "engine, vertical", "3.17", (-1.5, -1.0), (0.5, 1.0), 1.0),
    ("roof_z", "roof left rear, vertical", "3.18", (-0.8, -0.6), (0.4, 0.6), 1.0),
    ("seat_rail_y", "seat rail, lateral", "3.20", (-0.8, -0.6), (0.4, 0.6), 1.0),
)

LOW_PANELS: Sequence[Panel] = (
    ("seat_rail_z", "seat rail, vertical", "3.13", (-0.3, -0.2), (0.3, 0.4), SEAT),
    ("seat_z", "seat, vertical", "3.14", (-0.4, -0.2), (0.2, 0.4), SEAT),
    ("engine_z", "engine, vertical", "3.17", (-0.4, -0.2), (0.4, 0.6), 1.0),
    ("roof_z", "roof left rear, vertical", "3.18", (-0.4, -0.2), (0.2, 0.4), 1.0),
    ("seat_rail_x", "seat rail, longitudinal", "3.19", (-0.2, -0.15), (0.1, 0.15), 1.0),
)


def _bumps() -> list[Evidence]:
    rows = [
        Evidence(
            key="bump_7p5_end_of_stick",
            name="bump 7.5 mm, end of sticking",
            unit="s",
            place="figure 3.12",
            interval=(SLIP_INSTANT - INSTANT_READING, SLIP_INSTANT + INSTANT_READING),
            topic="bump 7.5 mm",
            how="first sample of the damper over the shaker above 1 mm/s after the bump begins at 5 s",
        ),
        Evidence(
            key="bump_1p5_no_slip",
            name="bump 1.5 mm, largest velocity of the damper over the slip velocity",
            unit="-",
            place="section 3.2.2.1",
            interval=(0.0, 1.0),
            topic="no slip",
            how="3 s from the beginning of the bump",
        ),
    ]
    sizes: tuple[tuple[str, Topic, Sequence[Panel]], ...] = (
        ("7p5", "bump 7.5 mm", HIGH_PANELS),
        ("1p5", "bump 1.5 mm", LOW_PANELS),
    )
    for size, topic, panels in sizes:
        for point, name, figure, low, high, weight in panels:
            rows += [
                Evidence(
                    key=f"bump_{size}_{point}_{word}",
                    name=f"{topic}, {word} {name}",
                    unit="m/s2",
                    place=f"figure {figure}",
                    interval=interval,
                    topic=topic,
                    how="3 s from the beginning of the bump, with noise; the axis holds model and measurement",
                    weight=weight,
                    before="chosen" if size == "7p5" and point != "seat_rail_y" else None,
                )
                for word, interval in (("lowest", low), ("highest", high))
            ]
    return rows


COMFORT_ENDS: Sequence[tuple[str, str, str, str, float, Interval]] = (
    ("coulomb_friction", "Fd", "smooth", "4.3", 62.5, (70.0, 80.0)),
    ("coulomb_friction", "Fd", "smooth", "4.3", 250.0, (120.0, 130.0)),
    ("coulomb_friction", "Fd", "rough", "4.4", 62.5, (99.0, 100.0)),
    ("coulomb_friction", "Fd", "rough", "4.4", 250.0, (107.0, 108.0)),
    ("mount_damping", "mount damping", "smooth", "4.7", 2000.0, (95.0, 96.0)),
    ("mount_damping", "mount damping", "rough", "4.8", 2000.0, (99.0, 99.5)),
    ("mount_stiffness", "mount stiffness", "smooth", "4.11", 3.5e5, (108.0, 110.0)),
    ("mount_stiffness", "mount stiffness", "smooth", "4.11", 14.0e5, (90.0, 92.0)),
    ("mount_stiffness", "mount stiffness", "rough", "4.12", 3.5e5, (105.0, 110.0)),
    ("mount_stiffness", "mount stiffness", "rough", "4.12", 14.0e5, (95.0, 100.0)),
)
"""Parameter, its name, road, figure, value of the end of the curve, interval of the relative comfort value [%]."""

COMFORT_ERROR = 0.5
"""Error of a relative comfort value [points]. The published runs are of one road each and of unknown length: ratios of
single records of 60 s scatter by 0.1 to 0.6 points."""


def _comfort() -> list[Evidence]:
    curves = [(name, road) for name, _, road, *_ in COMFORT_ENDS]
    return [
        Evidence(
            key=f"comfort_{name}_{road}_{value:g}".replace("+0", ""),
            name=f"relative comfort value at {word} {value:g}, {road} road",
            unit="%",
            place=f"figure {figure}",
            interval=interval,
            topic="comfort",
            how="ratio to the nominal car on the same record",
            error=COMFORT_ERROR,
            weight=1.0 / curves.count((name, road)),
            before="chosen",
        )
        for name, word, road, figure, value, interval in COMFORT_ENDS
    ]


LEVELS: Sequence[tuple[str, str, str, Interval, float]] = (
    ("4.1", "coulomb_friction", "smooth", (0.6, 0.8), 1 / 3),
    ("4.5", "mount_damping", "smooth", (0.6, 0.8), 1 / 3),
    ("4.9", "mount_stiffness", "smooth", (0.6, 0.8), 1 / 3),
    ("4.2", "coulomb_friction", "rough", (3.0, 4.0), 1 / 2),
    ("4.10", "mount_stiffness", "rough", (3.0, 4.0), 1 / 2),
)
"""Figure, parameter whose curves its axis holds, road, interval of the largest |acceleration| [m/s2], weight: all
figures of a road show the same half second of the same road."""


def _levels() -> list[Evidence]:
    first = {road: _level_key(figure) for figure, _, road, *_ in reversed(LEVELS)}
    rows = [
        Evidence(
            key=_level_key(figure),
            name=f"largest |seat rail, vertical| in 0.5 s of all cars of the figure, {road} road",
            unit="m/s2",
            place=f"figure {figure}",
            interval=interval,
            topic="level",
            how=f"nominal car and both ends of {name.replace('_', ' ')}, in every half second of the records",
            weight=weight,
            before="fitted" if figure in ("4.1", "4.2") else None,
            same=first[road] if first[road] != _level_key(figure) else "",
        )
        for figure, name, road, interval, weight in LEVELS
    ]
    rows.append(
        Evidence(
            key="swing_2_6",
            name="swing of a road of 50 mm RMS over 30 s",
            unit="m",
            place="figure 2.6",
            interval=(0.1, 0.2),
            topic="level",
            how="highest less lowest displacement; the roads of chapter 4 are made as those of chapter 2",
        )
    )
    return rows


def _level_key(figure: str) -> str:
    return f"level_{figure.replace('.', '_')}"


def _modes() -> list[Evidence]:
    def mode(key: str, name: str, place: str, interval: Interval, how: str, error: float) -> Evidence:
        return Evidence(
            key=key,
            name=name,
            unit="Hz",
            place=place,
            interval=interval,
            topic="mode",
            how=how,
            error=error,
            before=None if key in ("roll_mode", "rigid_modes") else "fitted",
        )

    stuck = "matrices, dampers stuck"
    return [
        mode("wheel_mode", "vertical wheel mode", "section 3.2.1", (27.5, 28.5),
             f"phase of the knuckle FRF through 90 degrees, {stuck}", MODE_ERROR * 28.0),
        mode("roll_mode", "roll mode of the body", "section 3.2.1", (6.45, 6.55), stuck, MODE_ERROR * 6.5),
        mode("rigid_modes", "highest of the six rigid body modes", "section 3.2.1", (0.0, 10.0), stuck,
             ROUND_ERROR * 10.0),
        mode("engine_lowest", "lowest engine mode", "section 3.2.1", (10.0, math.inf), stuck, ROUND_ERROR * 10.0),
        mode("engine_highest", "highest engine mode", "section 3.2.1", (0.0, 20.0), stuck, ROUND_ERROR * 20.0),
    ]  # fmt: skip


EVIDENCE: tuple[Evidence, ...] = (*_slip(), *_bumps(), *_comfort(), *_levels(), *_modes())

HALF_SEED = 2006
"""Of the permutation that draws the half that is used: the year of the source, taken before any result was seen."""


def _half() -> frozenset[str]:
    """Return the keys of the rows used for the choice: shuffled, sorted by topic, every second row."""
    drawn = [EVIDENCE[number] for number in np.random.default_rng(HALF_SEED).permutation(len(EVIDENCE))]
    topics = list(dict.fromkeys(row.topic for row in EVIDENCE))
    drawn.sort(key=lambda row: topics.index(row.topic))
    return frozenset(row.key for row in drawn[::2])


USED = _half()

_BY_KEY = {row.key: row for row in EVIDENCE}


def evidence_of(key: str) -> Evidence:
    """Return the row of a key."""
    return _BY_KEY[key]


def status_of(key: str) -> Status:
    """Return the status of a row.

    "fitted" if a parameter was fitted to the row, in either half; "chosen" in the half used for the choice, and in the
    held-out half if an earlier choice had the row in view; "predicted" in the held-out half otherwise; "duplicate" if
    another row counts for it.
    """
    row = evidence_of(key)
    if row.same:
        return "duplicate"
    if row.before == "fitted":
        return "fitted"
    return "chosen" if key in USED else row.before or "predicted"


def half_of(key: str) -> str:
    """Return the half of a row: "used" for the choice, or "held out"."""
    return "used" if key in USED else "held out"
