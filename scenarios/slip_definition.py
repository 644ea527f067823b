"""What the one definition of slip makes agree with source 1, and what the end of stick would."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from scenarios.bump.claims import FIRST_SLIP, FIRST_SLIP_TOLERANCE, PUBLISHED_FRICTION
from scenarios.levels import PUBLISHED_SLIP, SLIP_TOLERANCE
from scenarios.road_signals import PUBLISHED_SLIP as PUBLISHED_ROAD_SLIP


def definition_lines(results: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """A section that compares both velocities, from the `results.json` of levels, bump and comfort_sensitivity.

    Args:
        results: scenario to its content; empty when one of the three is missing.
    """
    try:
        velocity = results["levels"]["slip_velocity"]
        rows = [*_level_rows(results["levels"]), *_road_rows(results["comfort_sensitivity"])]
        rows += _bump_rows(results["bump"], velocity)
    except KeyError:
        return []
    lines = [
        "## One definition of slip",
        "",
        f"A damper slips above {1e3 * velocity:g} mm/s, in every row, table, figure and film. That velocity and the "
        "band edges of shaker and road are not published; they were fitted, as one set, to the slip shares below. "
        "Above 1 mm/s the friction is saturated: stick has ended.",
        "",
        f"| result | published | slip: above {1e3 * velocity:g} mm/s | agrees | stick ended: above 1 mm/s | agrees |",
        "|---|---|---|---|---|---|",
    ]
    for name, published, *found in rows:
        cells = [cell for text, agrees in found for cell in (text, "yes" if agrees else "NO")]
        lines.append(f"| {name} | {published} | {' | '.join(cells)} |")
    return lines


Row = tuple[str, str, tuple[str, bool], tuple[str, bool]]


def _share(name: str, published: float, *ours: float) -> Row:
    slip, saturated = ((f"{100 * share:.1f} %", abs(share - published) <= SLIP_TOLERANCE) for share in ours)
    return name, f"{100 * published:g} %", slip, saturated


def _level_rows(content: Mapping[str, Any]) -> list[Row]:
    return [
        _share(
            f"slip share, {wheel} damper, {level}",
            published[side],
            content["levels"][level]["slip"][side],
            content["levels"][level]["saturated"][side],
        )
        for side, wheel in enumerate(("right", "left"))
        for level, published in PUBLISHED_SLIP.items()
    ]


def _road_rows(content: Mapping[str, Any]) -> list[Row]:
    rows = []
    for road, published in PUBLISHED_ROAD_SLIP.items():
        nominal = next(
            point for point in content["source"]["coulomb_friction"][road] if point["value"] == PUBLISHED_FRICTION
        )
        rows.append(_share(f"slip share, {road} road", published, nominal["slip"], nominal["saturated"]))
    return rows


def _bump_rows(content: Mapping[str, Any], velocity: float) -> list[Row]:
    low = content["low_bump"]
    times = [content[key][f"{PUBLISHED_FRICTION:g} N"] for key in ("first_slip_s", "first_saturated_s")]
    slip, saturated = (
        ("never", False) if time is None else (f"{time:.3f} s", abs(time - FIRST_SLIP) <= FIRST_SLIP_TOLERANCE)
        for time in times
    )
    largest = f"largest {1e3 * low['largest_velocity']:.1f} mm/s"
    return [
        ("first slip, 7.5 mm bump", f"{FIRST_SLIP:g} s", slip, saturated),
        (
            "1.5 mm bump",
            "no slip",
            (largest, low["largest_velocity"] <= velocity),
            (f"for {1e3 * low['time_above_1_mm_s']:.0f} ms", low["time_above_1_mm_s"] == 0.0),
        ),
    ]
