"""Page `published-results.md`: for each figure the published statement, our picture, our value, verdict and reason."""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from scenarios.claims import STATUSES, cell, headline, markdown
from scenarios.evidence import EVIDENCE, SLIP_STEP, half_of
from scenarios.interval_probability import AGREES_ABOVE
from scenarios.published.sources import BESIDE_NAME, SOURCES, Place, Section, Source, place_of, section_of, source_of
from scenarios.published.statements import unanswered
from scenarios.published.table import COLUMNS, Row, beside_counts, counts, statement_of, study_of
from scenarios.verdict import ERRORS

TITLE = "# Published results, figure by figure"

WRITTEN_BY = "<!-- Written by `python -m scenarios.published`; never edit by hand. -->"

INTRODUCTION = f"""\
Three publications, and the result of this program for each of their statements. Every statement has a row: the
printed value, ours, the verdict and its reason. Numbers come from `python -m scenarios.published`; the studies
write large figures, notes and further numbers to `runs/published/STUDY/`.

**What was read twice.** The thesis survives as a scan: text, tables with damaged exponents, and the labels of the
axes of its figures; the curves are lost. All of it was read twice; where both readings differ, the second one
counts. "Left" and "right" of the thesis may be as seen from the front of the car.

**What is not printed.** The thesis gives no band of its random inputs, no velocity that counts as slip, no mode
shapes and no damping of the body, and it does not settle which wheel stands on the shaker. The half car has no
numbers of its seat and no settling band. The choice of dampers has no parameters of its vehicles.

**What was chosen, and on what.** What the thesis leaves open was chosen as one set on half of {len(EVIDENCE)} of its
statements, drawn by a stated seed; the other half was held out. The status of such a row contains its half, `used` or
`held out`. A row is `fitted` if a parameter was fitted to it, in either half; `chosen` in the half that was used,
and in the held-out half if an earlier choice had it in view; `predicted` where nothing was adjusted to it. Only
`predicted` rows are evidence for the model. The vehicles of the damper study are not printed: rows to which they
were fitted are `fitted`.

**How a row agrees.** A number agrees within the tolerance that the last column gives. The extreme of a curve is only
known to lie between two labels of its axis. Column `inside`: our value, or its mean over noise seeds or windows,
lies in that interval. Column `agrees`: the interval is not contradicted at {100.0 * AGREES_ABOVE:g} %, which is
weaker: the probability that a further value lies in it is above {100.0 * AGREES_ABOVE:g} % (Student's t, with the
stated error of the model; `scenarios/interval_probability.py`); a value without seeds and error agrees inside. The
error of a slip share is half of its change from a slip velocity {100.0 * SLIP_STEP:g} % higher to one
{100.0 * SLIP_STEP:g} % lower, row by row. An axis of which only one label and 0 are known holds any smaller curve:
such a row is `not testable`, unless our value is outside.
A statement in words agrees by the rule of its row. A row is `undecided` where its verdict is not the same for our
value and for {ERRORS:g} standard errors above and below it (over seeds, roads or windows), or where single seeds,
roads or readings of the statement differ (`scenarios/verdict.py`): it does not count as agreeing. `own check` is no
published result, `duplicate` repeats the statement of another row, and `not testable` lacks a value that the source
does not give: they are listed and never counted. Figures that show the same half second of the same road
count once.

**What slip is.** The thesis does not define it. Shares of time: |v| above 6 mm/s, chosen with the other open numbers.
End of sticking, as in figures 3.12 and 3.38: above 1 mm/s, where the friction is saturated. The quarter car counts
above 0.1 mm/s (100 / eps). Rows that another definition would change give the values by the others.

**Two cars.** The printed Ixx of 1000 kg m2 has a roll mode of 6.5 Hz, in the thesis as here; the measured car had
5.8 Hz, and an axis of chapter 3 that holds a measurement holds that car too. Column `{BESIDE_NAME}` has our value
and verdict with 1080 kg m2, whose roll mode is at 5.8 Hz: the shipped car `focus_measured_roll`
(`python -m vehicle shaker --input high.csv --vehicle focus_measured_roll`). Counts are of the printed car.
"""

ROW_COLUMNS = ("statement", "published", "ours", "inside", "agrees", BESIDE_NAME, "status", "why")

ROW_CELLS = ("name", "published", "ours", "inside", "within", "beside", "status", "why")


SPARSE = ("inside", "beside")
"""Columns that a table without a value in them leaves out."""


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
    lines += [markdown(COLUMNS, counts(rows)), "", *([f"{text}", ""] if (text := beside_counts(rows)) else [])]
    missing = unanswered(rows, left_open)
    if missing:
        lines += ["Statements that no row answers: " + "; ".join(missing) + ".", ""]
    lines += _index(rows)
    lines += [*_listed(rows, "Rows that do not agree", "NO"), *_listed(rows, "Rows that are undecided", "undecided")]
    for source in SOURCES:
        lines += _source(source, [row for row in rows if source_of(study_of(row)) is source], figures, pictures)
    if notes:
        lines += ['<a id="choice"></a>\n', "## What was chosen, and on what\n", *(f"{note}\n" for note in notes)]
    return "\n".join(lines).rstrip("\n") + "\n"


def _index(rows: Sequence[Row]) -> Iterator[str]:
    """Yield links to all places, with the numbers of disagreeing and of undecided rows."""
    yield "## Figures, tables and sections\n"
    for source in SOURCES:
        links = []
        for _, location, group in _places(source, rows):
            counted = {text: sum(cell(row, "within") == text for row in group) for text in ("NO", "undecided")}
            verdicts = ", ".join(f"{count} {text}" for text, count in counted.items() if count)
            links.append(
                f"[{_heading(location)}](#{_anchor(source, location)})" + (f" ({verdicts})" if verdicts else "")
            )
        if links:
            yield f"**{_upper(source.short)}:** {', '.join(links)}.\n"


def _listed(rows: Sequence[Row], heading: str, verdict: str) -> Iterator[str]:
    """Yield all rows of a verdict, predicted rows first."""
    yield f"## {heading}\n"
    wrong = sorted(
        (row for row in rows if cell(row, "within") == verdict), key=lambda row: STATUSES.index(row["status"])
    )
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
        shown = [
            (column, name)
            for column, name in zip(ROW_COLUMNS, ROW_CELLS, strict=True)
            if name not in SPARSE or any(row[name] is not None for row in group)
        ]
        columns, names = zip(*shown, strict=True)
        yield markdown(columns, [_cells(row, names) for row in group])
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
    return [" ".join(_text(row, name).split()).replace("|", "\\|") for name in names]


def _text(row: Row, name: str) -> str:
    """Return the text of one cell."""
    if name == "name":
        return statement_of(row)
    if name == "status" and row["evidence"]:
        return f"{row['status']} ({half_of(row['evidence'])})"
    if name == "beside":
        return f"{cell(row['beside'], 'ours')}: {cell(row['beside'], 'within')}" if row["beside"] else ""
    return cell(row, name)


def _heading(location: Place) -> str:
    """Return the heading of a place; "Elsewhere" for rows without place, mostly own checks."""
    return location.text or "Elsewhere"


def _anchor(source: Source, location: Place) -> str:
    return re.sub(r"[^a-z0-9]+", "-", f"{source.key} {_heading(location)}".lower()).strip("-")


def _upper(text: str) -> str:
    return text[:1].upper() + text[1:]


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]
