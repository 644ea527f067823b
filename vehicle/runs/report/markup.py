"""HTML elements as text; all texts of the run are escaped."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence

MANY = 30
"""Maximum number of rows of a table that is not folded."""


class Markup(str):
    """HTML text, which needs no escaping."""

    __slots__ = ()


def escaped(value: object) -> str:
    """Return the escaped text of a value; markup is returned unchanged."""
    return value if isinstance(value, Markup) else html.escape(str(value))


def tag(name: str, *content: object, **attributes: object) -> Markup:
    """Return an HTML element.

    Args:
        name: tag name, as "p".
        content: texts, which are escaped, and markup.
        attributes: a trailing underscore is dropped (class_), others become hyphens; None omits an attribute.
    """
    pairs = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{html.escape(str(value))}"'
        for key, value in attributes.items()
        if value is not None
    )
    return Markup(f"<{name}{pairs}>{''.join(escaped(item) for item in content)}</{name}>")


def joined(parts: Iterable[object]) -> Markup:
    """Return the concatenated parts as markup."""
    return Markup("".join(escaped(part) for part in parts))


def table(
    heads: Sequence[object], rows: Iterable[Sequence[object]], *, caption: str = "", text_columns: int = 1
) -> Markup:
    """Return an HTML table.

    Args:
        heads: heads of the columns.
        rows: cells; numbers as texts.
        caption: caption above the table.
        text_columns: number of first columns with texts, aligned left; the others contain numbers.
    """

    def cells(name: str, row: Sequence[object]) -> Markup:
        return tag(
            "tr", *(tag(name, cell, class_=None if i < text_columns else "number") for i, cell in enumerate(row))
        )

    body = list(rows)
    return tag(
        "div",
        tag(
            "table",
            *([tag("caption", caption)] if caption else []),
            tag("thead", cells("th", heads)),
            tag("tbody", *(cells("td", row) for row in body)),
        ),
        class_="table whole" if len(body) <= MANY else "table",
    )


def folded(title: str, *content: object) -> Markup:
    """Return content folded under a title; print shows it only if it is unfolded."""
    return tag("details", tag("summary", title), *content)


def shortened(
    title: str, heads: Sequence[object], rows: Sequence[Sequence[object]], *, text_columns: int = 1
) -> Markup:
    """Return a table, folded under its title if it has more than `MANY` rows."""
    whole = table(heads, rows, text_columns=text_columns)
    return whole if len(rows) <= MANY else folded(title, whole)


def section(title: str, anchor: str, *content: object) -> Markup:
    """Return a section of the page with its heading."""
    return tag("section", tag("h2", title), *content, id=anchor)
