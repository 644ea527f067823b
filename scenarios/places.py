"""Place and picture of rows that share them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from scenarios.claims import Claim


def placed(rows: Iterable[Claim], place: str, picture: str = "") -> list[Claim]:
    """Set place and picture of rows that have none.

    Args:
        rows: rows of one place.
        place: figure, table or section of the source.
        picture: file name of the figure of the study that shows the rows.

    Returns:
        The rows with both.
    """
    return [replace(row, place=row.place or place, picture=row.picture or picture) for row in rows]
