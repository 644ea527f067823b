"""Rows of all studies in one table: the source of each, and how many agree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from scenarios.claims import STATUSES
from scenarios.published.sources import SOURCES, source_of

Row = Mapping[str, Any]
"""A row of `results.json` of a study, with "study: " before its name."""


def collect(results: Mapping[str, Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the rows of all studies, with the study before the name and the picture.

    Args:
        results: study to the content of its `results.json`.
    """
    return [
        {
            **row,
            "name": f"{study}: {row['name']}",
            "picture": f"{study}_{row['picture']}" if row["picture"] else "",
        }
        for study, content in results.items()
        for row in content["rows"]
    ]


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
    judged = [row["within"] for row in rows if row["within"] is not None]
    if not rows:
        return ""
    return f"{sum(judged)} of {len(judged)}" if judged else f"{len(rows)}"
