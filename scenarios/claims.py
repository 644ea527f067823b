"""Rows that compare published statements with our values, for `results.md` and `results.json`.

A row contains the place in the source, the published statement, our value and its status: only `predicted` rows are
evidence for the
model, and only they are in the headline.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
import numpy.typing as npt

from scenarios.interval_probability import AGREES_ABOVE, interval_probability
from scenarios.verdict import Verdict, verdict
from vehicle.arrays import Vector
from vehicle.digits import finite
from vehicle.runs.output.folder import write_text

Status = Literal["predicted", "fitted", "chosen", "own check", "duplicate", "not testable"]
"""`predicted`: no parameter was adjusted to it. `fitted`: unprinted parameters were fitted to it. `chosen`: one of
several readings of the source, or of several bodies, was taken with the row in view. `own check`: not a published
result. `duplicate`: the same statement again, at another place or by another definition. `not testable`: the source
leaves out what a test needs; listed with the reason, never counted."""

Source = Literal["text", "table", "axis interval", "inferred"]
"""Form in the source. `axis interval`: between two labels of an axis, the only readable part of a figure.
`inferred`: concluded by us."""

Interval = tuple[float, float]

STATUSES: tuple[Status, ...] = get_args(Status)

LEGEND = (
    "Only `predicted` rows, numbers and trends to which nothing was adjusted, count in the headline. `fitted`: "
    "what the source leaves open was fitted to it; `chosen`: one of several readings of the source, or of several "
    "bodies, was taken with it in view; `own check`: not a published result; `duplicate`: the statement of "
    "another row again; `not testable`: the source leaves out what a test needs. `source` `axis interval`: only the "
    "labels of the axes are left of the figure; the extreme of the curve lies between them. `deviation` is (ours - "
    "published) / published where both are numbers, and from the nearer end of an interval, 0 inside. `inside`: our "
    "value lies in the printed interval; `within`: the row agrees by its rule, for an interval if it is not "
    "contradicted at 5 %; `undecided`: two standard errors over seeds, roads or windows turn the verdict, or single "
    "seeds or readings differ."
)


@dataclass(frozen=True, slots=True)
class Claim:
    """Row of a published statement: printed value, our value, agreement, reason, and status."""

    name: str
    published: float | str
    ours: float | str
    deviation: float | None
    """(ours - published) / published where both are numbers, that from the nearer end of an interval, else None."""
    within: Verdict
    """True if our value agrees with the print by the rule in `why`; None if undecided, or for an untestable row."""
    why: str
    status: Status
    source: Source
    interval: Interval | None = None
    """Lowest and highest published value, infinite for an open end; None if no interval is printed."""
    place: str = ""  # Place in the source: "figure 3.13", "table 3.2", "section 3.3"
    picture: str = ""  # File name of the figure of the study that shows the row, or nothing
    probability: float | None = None  # Of the interval, where ours is a spread; see `interval_probability`
    inside: bool | None = None  # True if our value, or its mean, is inside the interval; None without interval
    evidence: str = ""  # Key in `scenarios.evidence`, or nothing for a row that had no part in the choice

    def at(self, place: str = "", picture: str = "") -> Claim:
        """Return the row with a place in the source and the figure of the study that shows it, unless it has them."""
        return replace(self, place=self.place or place, picture=self.picture or picture)


@dataclass(frozen=True, slots=True)
class Kind:
    """Makes the rows of one status from one place of the source."""

    status: Status
    source: Source

    def number(
        self, name: str, published: float, ours: float, tolerance: float, why: str, *, error: float = 0.0
    ) -> Claim:
        """Return the row of a printed number.

        Args:
            name: what is compared, with its unit.
            published: printed value, not 0.
            ours: own value.
            tolerance: largest |ours - published|, in the unit of the value.
            why: reason of the tolerance, and of a disagreement.
            error: standard error of our value over seeds, roads or windows, in the unit of the value.
        """
        value = float(ours)
        within = self._judged(verdict(lambda value: abs(value - published) <= tolerance, value, error))
        return Claim(name, published, value, (value - published) / published, within, why, self.status, self.source)

    def statement(self, name: str, published: str, ours: str, holds: Verdict, why: str, *, picture: str = "") -> Claim:
        """Return the row of a printed statement in words, `holds` is None if undecided; see `number`."""
        within = self._judged(None if holds is None else bool(holds))
        return Claim(name, published, ours, None, within, why, self.status, self.source, picture=picture)

    def _judged(self, holds: Verdict) -> Verdict:
        return None if self.status == "not testable" else holds


PREDICTED, FITTED, CHOSEN = Kind("predicted", "text"), Kind("fitted", "text"), Kind("chosen", "text")
OWN_CHECK, COMPARED = Kind("own check", "inferred"), Kind("own check", "text")
TABLE, INFERRED, DUPLICATE = Kind("predicted", "table"), Kind("predicted", "inferred"), Kind("duplicate", "text")
NOT_TESTABLE = Kind("not testable", "text")


ONE_LABEL = "only one label is known, and any smaller curve lies inside too"
"""Reason of a row whose interval reaches to 0."""


def interval_claim(name: str, interval: Interval, ours: float, why: str, *, status: Status = "predicted") -> Claim:
    """Return the row of an extreme that is only known to lie between two labels of an axis; it agrees inside.

    Where the interval reaches to 0, only one label is known: every curve of a smaller size lies inside, so a row inside
    is not testable. A row outside disagrees.

    Arguments as for `Kind.number`; the interval is infinite at an open end.
    """
    value = float(ours)
    inside = interval[0] <= value <= interval[1]
    if inside and 0.0 in interval:
        status, why = "not testable", f"{why}; {ONE_LABEL}"
    deviation = _interval_deviation(interval, value)
    within = None if status == "not testable" else inside
    row = Claim(name, between(interval), value, deviation, within, why, status, "axis interval", interval)
    return replace(row, inside=inside)


def spread_claim(
    name: str, interval: Interval, ours: npt.ArrayLike, why: str, *, status: Status = "predicted"
) -> Claim:
    """Return the row of an extreme of a random signal that is only known to lie between two labels of an axis.

    The row agrees when the probability of the interval, estimated from our values, is above 5 %; it is undecided where
    that depends on the standard error of their mean. Ours are values of independent noise seeds or windows, (n,), best
    8 or more; a single value is compared as by `interval_claim`, whose arguments these are.
    """
    values = np.atleast_1d(np.asarray(ours, dtype=float))
    middle = float(np.mean(values))
    row = interval_claim(name, interval, middle, why, status=status)
    if values.size == 1:
        return row
    probability = interval_probability(values, interval)
    text = f"{middle:.3g} +- {np.std(values, ddof=1):.2g} ({values.size} values)"
    rule = f"probability of the interval {100.0 * probability:.3g} %, must be above {100.0 * AGREES_ABOVE:g} %"
    within = None if status == "not testable" else not_contradicted(values, interval)
    return replace(row, ours=text, within=within, why=f"{rule}; {why}", probability=probability)


def not_contradicted(values: Vector, interval: Interval, error: float = 0.0) -> Verdict:
    """Return the verdict "probability of the interval above 5 %", undecided within two standard errors of the mean.

    Arguments as for `interval_probability`.
    """
    mean_error = float(np.std(values, ddof=1)) / math.sqrt(values.size) if values.size > 1 else 0.0
    return verdict(
        lambda shift: interval_probability(values + shift, interval, error=error) > AGREES_ABOVE, 0.0, mean_error
    )


def _interval_deviation(interval: Interval, ours: float) -> float | None:
    """Return (ours - nearer end) / |nearer end|, 0 inside; None if that end is 0."""
    low, high = interval
    nearest = min(max(ours, low), high)
    if low <= ours <= high:
        return 0.0
    return (ours - nearest) / abs(nearest) if nearest else None


def headline(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return how many predicted rows agree, the other rows by status, and both counts of the rows with an interval."""
    counts = {
        status: f"{len(verdicts)} {status}" + ("" if status == "not testable" else f" ({_agree(verdicts)})")
        for status in STATUSES
        if (verdicts := [row["within"] for row in rows if row["status"] == status])
    }
    predicted = [row["within"] for row in rows if row["status"] == "predicted"]
    others = ", ".join(text for status, text in counts.items() if status != "predicted")
    if not predicted:
        return f"no row is a prediction of the model; {others or 'no other rows'}"
    count = f"{sum(map(bool, predicted))} of {len(predicted)} predicted rows agree{_undecided(predicted)}"
    return "; ".join([count, *([f"in addition {others}"] if others else []), *interval_counts(rows)])


def interval_counts(rows: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return a text with both counts of the rows with a printed interval; an empty list without these rows."""
    compared = [row for row in rows if row["inside"] is not None and row["status"] not in UNCOUNTED]
    inside, allowed = (sum(row[name] is True for row in compared) for name in ("inside", "within"))
    text = f"of {len(compared)} rows with a printed interval our value is inside in {inside}, not contradicted at "
    return [f"{text}{100.0 * AGREES_ABOVE:g} % in {allowed}"] if compared else []


UNCOUNTED = ("duplicate", "not testable")
"""Statuses of rows that are listed and counted nowhere."""


def _agree(verdicts: Sequence[Verdict]) -> str:
    return f"{sum(map(bool, verdicts))} agree{_undecided(verdicts)}"


def _undecided(verdicts: Sequence[Verdict]) -> str:
    count = list(verdicts).count(None)
    return f", {count} undecided" if count else ""


def markdown(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table with a heading and rows of cells."""
    lines = [f"| {' | '.join(cells)} |" for cells in (columns, *rows)]
    return "\n".join([lines[0], "|" + "---|" * len(columns), *lines[1:]])


def claim_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return the rows as a Markdown table."""
    columns = ("name", "place", "published", "ours", "deviation", "inside", "within", "status", "source", "why")
    return markdown(columns, [[cell(row, name).replace("|", "\\|") for name in columns] for row in rows])


@dataclass(frozen=True, kw_only=True, slots=True)
class Findings:
    """Result of a study."""

    title: str  # heading of the text
    claims: Sequence[Claim]  # rows of published statements with our values
    # name of a row to the reason why short signals cannot judge it; None if all rows are judged
    unjudged: Mapping[str, str] | None = field(default_factory=dict)
    notes: Sequence[str] = ()  # paragraphs below the table
    data: Mapping[str, Any] = field(default_factory=dict)  # further numbers for `results.json`, under their own keys
    values: Sequence[str] = ()  # lines for the console, for example fitted values
    tyres: str = ""  # state of the tyres of the cars, see `tyre_words`

    def write(self, folder: Path) -> str:
        """Write `results.md` and `results.json` without the unjudged rows; return the line to print."""
        left = self.unjudged or {}
        rows = [asdict(claim) for claim in self.claims if claim.name not in left]
        counts = headline(rows)
        table = [f"{counts}.", LEGEND, claim_table(rows)] if self.claims else []
        notes = [f"Tyres: {self.tyres}."] if self.tyres else []
        notes += [*(f"Not judged here: {name}: {why}." for name, why in left.items()), *self.notes]
        write_text(folder / "results.md", "\n\n".join([f"# {self.title}", *table, *notes]) + "\n")
        open_rows = {} if self.unjudged is None else {"not_judged": dict(left)}
        content = {"title": self.title, "rows": rows, "notes": notes, "tyre": self.tyres, **open_rows, **self.data}
        write_text(folder / "results.json", json.dumps(_plain(content), indent=1, allow_nan=False) + "\n")
        tyres = f"; tyres {self.tyres}" if self.tyres else ""
        return f"{counts}{f', {len(left)} not judged' if left else ''}{tyres}; see results.md"


def placed(rows: Iterable[Claim], place: str, picture: str = "") -> list[Claim]:
    """Return rows that share place and picture, see `Claim.at`."""
    return [row.at(place, picture) for row in rows]


def between(interval: Interval) -> str:
    """Return an interval in words: "0.4 to 0.6", "0.5 or more"."""
    low, high = interval
    if math.isinf(high):
        return f"{low:g} or more"
    return f"{high:g} or less" if math.isinf(low) else f"{low:g} to {high:g}"


VERDICTS = {True: "yes", False: "NO", None: "undecided"}


def cell(row: Mapping[str, Any], name: str) -> str:
    """Return the text of a member of a row."""
    value = row[name]
    if name == "within":
        return VERDICTS[value] if row["status"] != "not testable" else str(row["status"])
    if value is None:
        return ""
    if name == "inside":
        return "yes" if value else "no"
    if name == "deviation":
        return f"{100.0 * value:+.1f} %"
    return value if isinstance(value, str) else f"{value:.4g}"


def _plain(value: Any) -> Any:
    """Convert values to JSON types; infinity and NaN become None, as JSON has neither."""
    if isinstance(value, Mapping):
        return {str(key): _plain(member) for key, member in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(member) for member in value]
    if isinstance(value, float):
        return finite(value)
    return value
