"""Published statements beside our numbers, as `results.md` and `results.json`.

A row says where its published side stands in the source and what ours is: only `predicted` rows are evidence for the
model, and only they are in the headline.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from vehicle.output.folder import write_text

Status = Literal["predicted", "fitted", "chosen", "own check", "duplicate"]
"""`predicted`: nothing was adjusted to it. `fitted`: what the source leaves open was fitted to it. `chosen`: one of
several readings of the source, or of several bodies, was taken with the row in view. `own check`: not a published
result. `duplicate`: the same statement again, at another place or by another definition."""

Source = Literal["text", "table", "axis interval", "inferred"]
"""Where the source has it. `axis interval`: between two labels of an axis, which are all that is left of a figure.
`inferred`: concluded by us."""

Interval = tuple[float, float]

STATUSES: tuple[Status, ...] = get_args(Status)

LEGEND = (
    "Only `predicted` rows, numbers and trends to which nothing was adjusted, count in the headline. `fitted`: "
    "what the source leaves open was fitted to it; `chosen`: one of several readings of the source, or of several "
    "bodies, was taken with it in view; `own check`: not a published result; `duplicate`: the statement of "
    "another row again. `source` `axis interval`: only the labels of the axes are left of the figure; the extreme "
    "of the curve lies in `interval`. `deviation` is (ours - published) / published where both are numbers, and "
    "from the nearer end of an interval, 0 inside."
)


@dataclass(frozen=True, slots=True)
class Claim:
    """One row: what is printed, what we find, whether the two agree, why, and what kind of row it is."""

    name: str
    published: float | str
    ours: float | str
    deviation: float | None
    """(ours - published) / published where both are numbers, that from the nearer end of an interval, else None."""
    within: bool
    """Whether ours agrees with the print, by the rule given in `why`."""
    why: str
    status: Status
    source: Source
    interval: Interval | None = None
    """Lowest and highest published value, infinite where it is open; None where the print is no interval."""


@dataclass(frozen=True, slots=True)
class Kind:
    """Makes the rows of one status from one place of the source."""

    status: Status
    source: Source

    def number(self, name: str, published: float, ours: float, tolerance: float, why: str) -> Claim:
        """Row of a printed number.

        Args:
            name: what is compared, with its unit.
            published: printed value, not 0.
            ours: own value.
            tolerance: largest |ours - published|, in the unit of the value.
            why: reason of the tolerance, and of a disagreement.
        """
        deviation = float(ours - published) / published
        within = bool(abs(ours - published) <= tolerance)
        return Claim(name, published, float(ours), deviation, within, why, self.status, self.source)

    def statement(self, name: str, published: str, ours: str, holds: bool, why: str) -> Claim:
        """Row of a printed statement in words."""
        return Claim(name, published, ours, None, bool(holds), why, self.status, self.source)


PREDICTED, FITTED, CHOSEN = Kind("predicted", "text"), Kind("fitted", "text"), Kind("chosen", "text")
OWN_CHECK, COMPARED = Kind("own check", "inferred"), Kind("own check", "text")
TABLE, INFERRED, DUPLICATE = Kind("predicted", "table"), Kind("predicted", "inferred"), Kind("duplicate", "text")


def interval_claim(name: str, interval: Interval, ours: float, why: str, *, status: Status = "predicted") -> Claim:
    """Row of an extreme that is only known to lie between two labels of an axis; it agrees inside.

    Args:
        name: what is compared, with its unit.
        interval: lowest and highest value; infinite where it is open.
        ours: own value.
        why: which axis, and the reason of a disagreement.
        status: as of `Claim`.
    """
    low, high = interval
    nearest = min(max(ours, low), high)
    inside = bool(low <= ours <= high)
    deviation = 0.0 if inside else float(ours - nearest) / abs(nearest) if nearest else None
    return Claim(name, _between(interval), float(ours), deviation, inside, why, status, "axis interval", interval)


def spread_claim(
    name: str, interval: Interval, ours: npt.ArrayLike, why: str, *, status: Status = "predicted"
) -> Claim:
    """Row of an extreme of one stretch of a random signal, against ours over many stretches.

    It agrees when the whole interval lies between the 5th and the 95th percentile of ours: wherever in it the published
    extreme is, it is an ordinary one.

    Args:
        name: what is compared, with its unit.
        interval: lowest and highest value of the published extreme.
        ours: own values, one for each stretch, (n,).
        why: which axis and stretches, and the reason of a disagreement.
        status: as of `Claim`.
    """
    values = np.asarray(ours)
    low, middle, high = (float(value) for value in np.percentile(values, (5.0, 50.0, 95.0)))
    text = f"5th to 95th percentile {low:.3g} to {high:.3g}, median {middle:.3g}"
    within = bool(low <= interval[0] and interval[1] <= high)
    inside = np.mean((values >= interval[0]) & (values <= interval[1]))
    why = f"the whole interval must lie between our percentiles; {100.0 * inside:.0f} % of ours are inside it; {why}"
    return Claim(name, _between(interval), text, None, within, why, status, "axis interval", interval)


def headline(rows: Sequence[Mapping[str, Any]]) -> str:
    """How many predicted rows agree, and how many rows are of another kind: "3 of 4 predicted rows agree; ..."."""
    counts = {status: [bool(row["within"]) for row in rows if row["status"] == status] for status in STATUSES}
    others = [
        f"{len(found)} {status} ({sum(found)} agree)" for status, found in counts.items() if status != "predicted"
    ]
    predicted = counts["predicted"]
    if not predicted:
        kinds = [f"{len(found)} {status} ({sum(found)} agree)" for status, found in counts.items() if found]
        return f"no row is a prediction of the model; {', '.join(kinds) or 'no other rows'}"
    return f"{sum(predicted)} of {len(predicted)} predicted rows agree; beside them {', '.join(others)}"


def markdown(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table of a heading and rows of cells."""
    lines = [f"| {' | '.join(cells)} |" for cells in (columns, *rows)]
    return "\n".join([lines[0], "|" + "---|" * len(columns), *lines[1:]])


OWN_COLUMNS = ("name", "found", "within", "why")
"""Of a table on data of the user."""


def claim_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """The rows as a Markdown table."""
    columns = ("name", "published", "ours", "deviation", "within", "status", "source", "interval", "why")
    return markdown(columns, [[_cell(name, row[name]).replace("|", "\\|") for name in columns] for row in rows])


@dataclass(frozen=True, kw_only=True, slots=True)
class Findings:
    """Result of a study.

    Attributes:
        title: first line of the text.
        claims: published statements beside ours.
        unjudged: statements that short signals cannot judge: name, and why; None where they judge all.
        notes: paragraphs below the table.
        data: further numbers for `results.json`, under their own keys.
        values: lines for the console, as fitted values.
        own_data: whether they are about data of the user, of which nothing is published: the rows say what was found.
        tyres: what the tyres of its cars do, see `tyre_words`.
    """

    title: str
    claims: Sequence[Claim]
    unjudged: Mapping[str, str] | None = field(default_factory=dict)
    notes: Sequence[str] = ()
    data: Mapping[str, Any] = field(default_factory=dict)
    values: Sequence[str] = ()
    own_data: bool = False
    tyres: str = ""

    def write(self, folder: Path) -> str:
        """Write `results.md` and `results.json`, without the rows that are not judged; returns the line to print."""
        left = self.unjudged or {}
        rows = [asdict(claim) for claim in self.claims if claim.name not in left]
        counts, legend, table = headline(rows), [LEGEND], claim_table(rows)
        if self.own_data:
            rows = [{"name": r["name"], "found": r["ours"], "within": r["within"], "why": r["why"]} for r in rows]
            counts, legend = f"{sum(row['within'] for row in rows)} of {len(rows)} checks hold", []
            table = markdown(OWN_COLUMNS, [[_cell(name, row[name]) for name in OWN_COLUMNS] for row in rows])
        notes = [f"Tyres: {self.tyres}."] if self.tyres else []
        notes += [*(f"Not judged here: {name}: {why}." for name, why in left.items()), *self.notes]
        write_text(
            folder / "results.md",
            "\n\n".join([f"# {self.title}", f"{counts}.", *legend, table, *notes]) + "\n",
        )
        open_rows = {} if self.unjudged is None else {"not_judged": dict(left)}
        content = {"title": self.title, "rows": rows, "notes": notes, "tyre": self.tyres, **open_rows, **self.data}
        write_text(folder / "results.json", json.dumps(_plain(content), indent=1, allow_nan=False) + "\n")
        tyres = f"; tyres {self.tyres}" if self.tyres else ""
        return f"{counts}{f', {len(left)} not judged' if left else ''}{tyres}; see results.md"


def _between(interval: Interval) -> str:
    low, high = interval
    if math.isinf(high):
        return f"{low:g} or more"
    return f"{high:g} or less" if math.isinf(low) else f"{low:g} to {high:g}"


def _cell(name: str, value: Any) -> str:
    if value is None:
        return ""
    if name == "deviation":
        return f"{100.0 * value:+.1f} %"
    if name == "within":
        return "yes" if value else "NO"
    if name == "interval":
        # An open end is None in the JSON file, infinite before.
        return "[" + ", ".join("" if end is None or math.isinf(end) else f"{end:g}" for end in value) + "]"
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
