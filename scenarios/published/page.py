"""Page `published-results.md`: for each figure the published statement, our picture, our value, verdict and reason."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from scenarios.claims import STATUSES, cell, headline, markdown
from scenarios.interval_probability import AGREES_ABOVE
from scenarios.published.sources import SOURCES, Place, Section, Source, place_of, section_of, source_of
from scenarios.published.statements import unanswered
from scenarios.published.table import COLUMNS, Row, counts, statement_of, study_of

TITLE = "# Published results, figure by figure"

WRITTEN_BY = "<!-- Written by `python -m scenarios.published`; never edit by hand. -->"

INTRODUCTION = f"""\
Three publications, and what this program computes for each statement in them. Every statement has a row: what is
printed, what we compute, whether both agree, and why. Numbers come from `python -m scenarios.published`; the studies
write large figures, notes and further numbers to `runs/published/STUDY/`.

**What was read twice.** The thesis survives as a scan: text, tables with damaged exponents, and the labels of the
axes of its figures; the curves are lost. All of it was read a second time; where both readings differ, the second
holds. "Left" and "right" of the thesis may be those of someone who stands in front of the car and faces it.

**What is not printed.** The thesis gives no band of its random inputs, no velocity that counts as slip, no mode
shapes and no damping of the body, and it does not settle which wheel stands on the shaker. The half car has no
numbers of its seat and no settling band. The choice of dampers has no parameters of its vehicles.

**What was chosen, and on what.** What the thesis leaves open was chosen as one set on half of its statements, which a
stated seed drew; the other half was held out. A row of the chosen half is `chosen`, a row to which a parameter was
fitted is `fitted`, and neither counts as evidence for the model. A row is `predicted` where nothing was adjusted to
it.

**How a row agrees.** A number agrees within the tolerance that the last column gives. The extreme of a curve is only
known to lie between two labels of its axis: ours agrees inside. Where ours depends on a random signal, it is computed
over noise seeds or windows, and the row agrees where the probability that a further value lies in the published
interval is above {100.0 * AGREES_ABOVE:g} % (Student's t, `scenarios/interval_probability.py`). A statement in words
agrees by the rule of its row. `own check` is no published result, `duplicate` is the statement of another row again,
and `not testable` lacks something that the source does not tell: it is listed and never counted.
"""

ROW_COLUMNS = ("statement", "published", "ours", "agrees", "status", "why")


def page(
    rows: Sequence[Row],
    notes: Sequence[str],
    figures: str,
    existing: Iterable[str],
    *,
    quick: bool = False,
    left_open: Sequence[str] = (),
) -> str:
    """Return the page as Markdown.

    Args:
        rows: of all studies; see `scenarios.published.table`.
        notes: of the study that chose what the thesis leaves open; may be empty.
        figures: link to the folder of the pictures.
        existing: names of the pictures in that folder; a row without one has no picture.
        quick: True if the rows come from short signals.
        left_open: "study: name" of rows that short signals cannot judge.
    """
    pictures = frozenset(existing)
    lines = [TITLE, "", WRITTEN_BY, "", f"**{headline(rows)}.**", "", INTRODUCTION]
    if notes:
        lines += ["The candidates of the choice and their likelihoods are in the [last section](#choice).", ""]
    if quick:
        lines += [f"Made with `--quick`: short signals, other numbers, {len(left_open)} rows left open.", ""]
    lines += [markdown(COLUMNS, counts(rows)), ""]
    missing = unanswered(rows, left_open)
    if missing:
        lines += ["Statements that no row answers: " + "; ".join(missing) + ".", ""]
    lines += [*_index(rows), *_disagreements(rows)]
    for source in SOURCES:
        lines += _source(source, [row for row in rows if source_of(study_of(row)) is source], figures, pictures)
    if notes:
        lines += ['<a id="choice"></a>\n', "## What was chosen, and on what\n", *(f"{note}\n" for note in notes)]
    return "\n".join(lines).rstrip("\n") + "\n"


def _index(rows: Sequence[Row]) -> Iterator[str]:
    """Yield links to all places, with the number of disagreeing rows."""
    yield "## Figures, tables and sections\n"
    for source in SOURCES:
        links = []
        for _, location, group in _places(source, rows):
            wrong = sum(row["within"] is False for row in group)
            links.append(f"[{_heading(location)}](#{_anchor(source, location)})" + (f" ({wrong} NO)" if wrong else ""))
        if links:
            yield f"**{_upper(source.short)}:** {', '.join(links)}.\n"


def _disagreements(rows: Sequence[Row]) -> Iterator[str]:
    """Yield all disagreeing rows, predicted rows first."""
    yield "## Rows that do not agree\n"
    wrong = sorted((row for row in rows if row["within"] is False), key=lambda row: STATUSES.index(row["status"]))
    if not wrong:
        yield "None.\n"
        return
    table = []
    for row in wrong:
        source, location = source_of(study_of(row)), place_of(row["place"])
        link = f"[{_upper(source.short)}: {_lower(_heading(location))}](#{_anchor(source, location)})"
        table.append((link, *_cells(row, ("name", "published", "ours", "status", "why"))))
    yield markdown(("where", "statement", "published", "ours", "status", "why"), table) + "\n"


def _source(source: Source, rows: Sequence[Row], figures: str, pictures: frozenset[str]) -> Iterator[str]:
    if not rows:
        return
    yield f"## {_upper(source.short)}\n"
    yield f"{source.title}. {headline(rows)}.\n"
    before: Section | None = None
    for section, location, group in _places(source, rows):
        if section is not None and section != before:
            yield f"### {section.number} {section.title}\n"
        before = section
        yield f'<a id="{_anchor(source, location)}"></a>\n'
        yield f"#### {_heading(location)}\n"
        yield f"{', '.join(f'`{name}`' for name in dict.fromkeys(study_of(row) for row in group))}\n"
        for picture in dict.fromkeys(row["picture"] for row in group if row["picture"] in pictures):
            yield f"![{_heading(location)}]({figures}/{picture})\n"
        yield markdown(
            ROW_COLUMNS, [_cells(row, ("name", "published", "ours", "within", "status", "why")) for row in group]
        )
        yield ""


def _places(source: Source, rows: Sequence[Row]) -> Iterator[tuple[Section | None, Place, list[Row]]]:
    """Yield section, place and rows in the order of the source; rows without place come last."""
    source_rows = [row for row in rows if source_of(study_of(row)) is source]

    def key(row: Row) -> tuple[object, ...]:
        location = place_of(row["place"])
        section = section_of(source, location)
        order = source.sections.index(section) if section else len(source.sections)
        return order, *location.sort_key

    for _, same_place in groupby(sorted(source_rows, key=key), key=key):
        group = list(same_place)
        location = place_of(group[0]["place"])
        yield section_of(source, location), location, group


def _cells(row: Row, names: Sequence[str]) -> list[str]:
    texts = [statement_of(row) if name == "name" else cell(name, row[name]) for name in names]
    return [" ".join(text.split()).replace("|", "\\|") for text in texts]


def _heading(location: Place) -> str:
    """Return the heading of a place; "Elsewhere" for rows without place, mostly own checks."""
    return location.text or "Elsewhere"


def _anchor(source: Source, location: Place) -> str:
    return re.sub(r"[^a-z0-9]+", "-", f"{source.key} {_heading(location)}".lower()).strip("-")


def _upper(text: str) -> str:
    return text[:1].upper() + text[1:]


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]
