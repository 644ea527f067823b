"""HTML as text: everything that comes from outside is escaped here."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence

MANY = 30
"""Rows from which on a table is folded."""


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def escaped(value: object) -> str:
    """Markup as it is, anything else as its text."""
    return value if isinstance(value, Markup) else html.escape(str(value))


def tag(name: str, *content: object, **attributes: object) -> Markup:
    """An element.

    Args:
        name: as "p".
        content: texts, which are escaped, and markup.
        attributes: a trailing underscore is dropped (class_), others become hyphens; None leaves one out.
    """
    pairs = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{html.escape(str(value))}"'
        for key, value in attributes.items()
        if value is not None
    )
    return Markup(f"<{name}{pairs}>{''.join(escaped(one) for one in content)}</{name}>")


def joined(parts: Iterable[object]) -> Markup:
    """Parts one behind the other."""
    return Markup("".join(escaped(part) for part in parts))


def table(heads: Sequence[object], rows: Iterable[Sequence[object]], *, caption: str = "", words: int = 1) -> Markup:
    """A table.

    Args:
        heads: of the columns.
        rows: cells; numbers as texts.
        caption: above it.
        words: so many first columns hold words and are set to the left, the others numbers.
    """

    def cells(name: str, row: Sequence[object]) -> Markup:
        return tag("tr", *(tag(name, cell, class_=None if i < words else "number") for i, cell in enumerate(row)))

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
    """What is shown when it is asked for, and in print."""
    return tag("details", tag("summary", title), *content)


def shortened(title: str, heads: Sequence[object], rows: Sequence[Sequence[object]], *, words: int = 1) -> Markup:
    """A table, folded under its title where it is long."""
    whole = table(heads, rows, words=words)
    return whole if len(rows) <= MANY else folded(title, whole)


def section(title: str, anchor: str, *content: object, class_: str | None = None) -> Markup:
    """A part of the page with its heading."""
    return tag("section", tag("h2", title), *content, id=anchor, class_=class_)


def number(value: float | None, digits: int = 3) -> str:
    """A number with some digits, without a power of ten up to a million; a dash for none."""
    return "–" if value is None else f"{float(f'{value:.{digits}g}'):.10g}"
