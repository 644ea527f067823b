"""Tables of comfort over a parameter, as Markdown and as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict

import numpy as np

from scenarios.comfort_sensitivity_runs import Curves


def curve_table(label: str, curves: Curves) -> str:
    """Relative comfort of a variation on both roads as a Markdown table."""
    head = " | ".join(
        f"{road}: relative comfort value [%] | comfort value [m/s²] | slip shares [%] | lowest load [N] (time below 0)"
        for road in curves
    )
    lines = [f"| {label} | {head} |", "|" + "---|" * (1 + 4 * len(curves))]
    for row in zip(*curves.values(), strict=True):
        cells = [
            f"{100.0 * one.relative:.2f} ± {number(100.0 * one.relative_error)} | {one.comfort:.4f} ± "
            f"{number(one.comfort_error, 4)} | {100.0 * one.slip:.1f}, {100.0 * one.saturated:.1f}, "
            f"{100.0 * one.slip_left:.1f} | {one.lowest_load:.0f} ({100.0 * one.pulling:.2g} %)"
            for one in row
        ]
        lines.append(f"| {row[0].value:g} | {' | '.join(cells)} |")
    return "\n".join(lines)


def number(value: float, digits: int = 2) -> str:
    """A standard error, or a question mark where a single record tells none."""
    return f"{value:.{digits}f}" if np.isfinite(value) else "?"


def edge_table(edges: Curves) -> str:
    """Slip shares and comfort over the band edge of the roads; `value` of the points is the edge [Hz]."""
    head = " | ".join(f"{road}: slip share, right [%] | above 1 mm/s | left | comfort value [m/s²]" for road in edges)
    lines = [f"| lower band edge [Hz] | {head} |", "|" + "---|" * (1 + 4 * len(edges))]
    for row in zip(*edges.values(), strict=True):
        cells = [
            f"{100.0 * one.slip:.2f} ± {number(100.0 * one.slip_error)} | {100.0 * one.saturated:.1f} | "
            f"{100.0 * one.slip_left:.1f} | {one.comfort:.4f} ± {number(one.comfort_error, 4)}"
            for one in row
        ]
        lines.append(f"| {row[0].value:g} | {' | '.join(cells)} |")
    return "\n".join(lines)


def plain(curves: Mapping[str, Curves]) -> dict[str, dict[str, list[dict[str, float]]]]:
    """All points of variations for a JSON file."""
    return {
        name: {road: [asdict(one) for one in points] for road, points in by_road.items()}
        for name, by_road in curves.items()
    }
