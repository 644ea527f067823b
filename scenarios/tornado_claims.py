"""What the tornado chart says, beside what source 1 concludes."""

from __future__ import annotations

from collections.abc import Sequence

from scenarios.claims import DUPLICATE, Claim
from scenarios.comfort_sensitivity_tables import number
from scenarios.road_signals import ROAD_RMS
from scenarios.tornado_bars import Bar

WAYS = (
    ("Coulomb friction", "lower friction, more comfort", True),
    ("suspension mount damping", "more damping, more comfort", False),
    ("suspension mount stiffness", "stiffer mount, more comfort", False),
)
"""Conclusions of section 4.4: parameter, statement, whether the comfort value rises with the parameter."""


def tornado_claims(bars: Sequence[Bar]) -> list[Claim]:
    """The conclusions of section 4.4 at the ends of the bars."""
    claims = []
    for name, statement, rising in WAYS:
        bar = next(bar for bar in bars if bar.label.startswith(name))
        pairs = {road: (bar.at_low[road].relative, bar.at_high[road].relative) for road in ROAD_RMS}
        claims.append(
            DUPLICATE.statement(
                f"comfort and {name}, both roads",
                statement,
                ", ".join(f"{road} {100.0 * low:.1f} to {100.0 * high:.1f} %" for road, (low, high) in pairs.items()),
                all((high > low) == rising for low, high in pairs.values()),
                f"relative comfort value from {bar.low:g} to {bar.high:g}",
            )
        )
    return claims


def bar_table(bars: Sequence[Bar]) -> str:
    """The bars as a Markdown table."""
    head = " | ".join(f"{road}: comfort value at the low, high end [%] | swing [points]" for road in ROAD_RMS)
    lines = [f"| parameter | nominal | low, high end | {head} |", "|" + "---|" * (3 + 2 * len(ROAD_RMS))]
    for bar in bars:
        cells = [
            f"{_percent(bar.at_low[road].relative, bar.at_low[road].relative_error)}, "
            f"{_percent(bar.at_high[road].relative, bar.at_high[road].relative_error)} | {100.0 * bar.swing(road):.1f}"
            for road in ROAD_RMS
        ]
        note = f" ({bar.reason})" if bar.reason else ""
        lines.append(f"| {bar.label}{note} | {bar.nominal:g} | {bar.low:g}, {bar.high:g} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _percent(relative: float, error: float) -> str:
    return f"{100.0 * relative:.2f} ± {number(100.0 * error)}"
