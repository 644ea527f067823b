"""Published statements beside our numbers, as `results.md` and `results.json`."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from scenarios.output_folder import write_text


@dataclass(frozen=True, kw_only=True, slots=True)
class Claim:
    """One row: what is printed, what we find, whether the two agree, and why."""

    name: str
    published: float | str
    ours: float | str
    deviation: float | None
    """(ours - published) / published where both are numbers, else None."""
    within: bool
    """Whether ours agrees with the print, by the rule given in `why`."""
    why: str


def number_claim(name: str, published: float, ours: float, tolerance: float, why: str) -> Claim:
    """Row of a printed number.

    Args:
        name: what is compared, with its unit.
        published: printed value, not 0.
        ours: own value.
        tolerance: largest |ours - published|, in the unit of the value.
        why: reason of the tolerance, and of a disagreement.
    """
    return Claim(
        name=name,
        published=published,
        ours=float(ours),
        deviation=float(ours - published) / published,
        within=bool(abs(ours - published) <= tolerance),
        why=why,
    )


def statement_claim(name: str, published: str, ours: str, holds: bool, why: str) -> Claim:
    """Row of a printed statement in words."""
    return Claim(name=name, published=published, ours=ours, deviation=None, within=bool(holds), why=why)


def write_claims(
    folder: Path, title: str, claims: Sequence[Claim], notes: Sequence[str], data: Mapping[str, Any]
) -> None:
    """Write `results.md` and `results.json`.

    Args:
        folder: where to.
        title: first line of the text.
        claims: the rows.
        notes: paragraphs below the table.
        data: further numbers for the JSON file, under their own keys.
    """
    agree = sum(claim.within for claim in claims)
    lines = [f"# {title}", "", f"{agree} of {len(claims)} statements, printed or our own check, agree.", ""]
    lines += ["| name | published | ours | deviation | within | why |", "|---|---|---|---|---|---|"]
    for claim in claims:
        deviation = "" if claim.deviation is None else f"{100.0 * claim.deviation:+.1f} %"
        cells = (claim.name, _text(claim.published), _text(claim.ours), deviation, _yes(claim.within), claim.why)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    for note in notes:
        lines += ["", note]
    write_text(folder / "results.md", "\n".join(lines) + "\n")
    content = {"title": title, "rows": [asdict(claim) for claim in claims], "notes": list(notes), **data}
    write_text(folder / "results.json", json.dumps(_plain(content), indent=1, allow_nan=False) + "\n")


def _yes(value: bool) -> str:
    return "yes" if value else "NO"


def _text(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"


def _plain(value: Any) -> Any:
    """JSON has neither infinity nor NaN: None stands for them."""
    if isinstance(value, Mapping):
        return {str(key): _plain(member) for key, member in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(member) for member in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value
