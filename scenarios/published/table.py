"""Rows of all studies in one table: the source of each, and how many agree."""

from collections.abc import Mapping, Sequence
from typing import Any

from scenarios.claims import STATUSES
from scenarios.published.sources import BESIDE_NAME, PRINTED_IXX, SOURCES, source_of

Row = Mapping[str, Any]
"""A row of `results.json` of a study, with "study: " before its name."""


def collect(
    results: Mapping[str, Mapping[str, Any]], beside: Mapping[str, Mapping[str, Any]] | None = None
) -> list[dict[str, Any]]:
    """Return the rows of all studies, with the study before the name and the picture.

    Args:
        results: study to the content of its `results.json`.
        beside: results of studies with the car of `sources.BESIDE`; their values are the member `beside` of a row.
    """
    others = {
        (study, row["name"]): {name: row[name] for name in ("ours", "within", "inside", "status")}
        for study, content in (beside or {}).items()
        for row in content["rows"]
    }
    return [
        {
            **row,
            "name": f"{study}: {row['name']}",
            "picture": f"{study}_{row['picture']}" if row["picture"] else "",
            "beside": others.get((study, row["name"])),
        }
        for study, content in results.items()
        for row in content["rows"]
    ]


def beside_counts(rows: Sequence[Row]) -> str:
    """Return how many predicted rows of both cars agree with each, or "" without rows of the other car."""
    both = [row for row in rows if row["beside"] is not None and row["status"] == "predicted"]
    first, second = (sum(row["within"] is True for row in part) for part in (both, [row["beside"] for row in both]))
    text = f"Of {len(both)} predicted rows computed with both cars, {first} agree with the printed {PRINTED_IXX} and "
    return f"{text}{second} with {BESIDE_NAME}." if both else ""


def study_of(row: Row) -> str:
    """Return the study of a row of the table."""
    return str(row["name"].partition(": ")[0])


def statement_of(row: Row) -> str:
    """Return the name of a row of the table without its study."""
    return str(row["name"].partition(": ")[2])


COLUMNS = ("source", *(f"{status}, agree" if status != "not testable" else status for status in STATUSES))


def counts(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """Return the lines of the table of counts: each source, then all; columns as in `COLUMNS`."""
    parts = [(source.short, [row for row in rows if source_of(study_of(row)) is source]) for source in SOURCES]
    return [
        (name, *(_count([row for row in part if row["status"] == status]) for status in STATUSES))
        for name, part in (*parts, ("all", rows))
    ]


def _count(rows: Sequence[Row]) -> str:
    if not rows or rows[0]["status"] == "not testable":
        return f"{len(rows)}" if rows else ""
    return f"{sum(row['within'] is True for row in rows)} of {len(rows)}"
