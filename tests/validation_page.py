"""The page `docs/validation.md`: written from rows, read back, merged, and compared with those that a test records."""

import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import asdict
from functools import cache
from itertools import groupby
from pathlib import Path

import numpy as np

from tests import validation
from tests.validation import EVIDENCE, SUBJECTS, UNQUOTED, Row

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "validation.md"
FOLDER = "VEHICLE_VALIDATION_ROWS"
"""Environment variable with the folder to which `python -m tests.validation` has the rows written."""

INTRODUCTION = """\
How far can you trust the numbers of this program? Each row below is a physical or numerical claim, and a test of the
program checks it against an independent expected value: a closed form, a second derivation, another program, a
standard, a publication, or a conservation law or symmetry. A second derivation is written for the test, or computes
the same quantity by another path of the program: the other engine, a finer step, the matrices of the linear system.
Foreign code is most often a solver, an integral or a file writer of scipy, on equations that the test writes out. Where
it works on equations, matrices or laws of this program, the row is marked own function: it verifies the integration
alone. The tests write this page.

**Verified against equations.** Force laws, static equilibrium, the linear system, time integration, reduction of
flexible bodies, FRF estimation, ISO 2631 and ISO 8608. The program solves its equations as accurately as the rows say.
Agreement of both engines, MuJoCo and the reduced one, is also verification only: they share matrices and force laws,
so a wrong parameter gives both the same wrong result.

**Validated against measurements: published values only.** The car of Bommer 2006 was measured on a shaker; the thesis
prints a part of these measurements, and we compare with what is printed. It is a scan without curves: many values are
labels of axes. [Published results](published-results.md) lists every statement of three publications, and the reason
for each one that we do not meet.

**Not validated.** No car of our own was measured. Not compared with any measurement: the four-poster, the sedan,
rolling tyres, semi-active control, road runs at speed, wheel loads and fatigue damage, the comfort of a person on a
seat. For these the equations are verified, and their parameters are assumed or come from publications. Validate the
model with your own measurement (`python -m vehicle compare`) before you trust an absolute value; differences between
variants of one car depend less on its parameters.

**How to read a row.** Above the tolerance the test fails. "Used" is the largest deviation as a
share of the tolerance, rounded up, and "< 1 %" below that. For several values the row shows the smallest and the
largest magnitude; the largest deviation of all of them counts. **NO** marks a claim that does not hold. Each claim is
a link to its test.
"""


def check_page(test: str, *, passed: bool = True) -> None:
    """Raise AssertionError if the page does not contain the rows that a test has just recorded, and no other.

    While `python -m tests.validation` runs, write them to a file instead.

    Args:
        test: its node.
        passed: False if the test failed, so that rows are missing: nothing is compared.
    """
    test = test.translate(UNQUOTED)
    rows = validation.RECORDED.get(test, [])
    if os.environ.get(FOLDER):
        path = Path(os.environ[FOLDER]) / f"{os.getpid()}.jsonl"
        with path.open("a", encoding="utf-8") as file:
            file.writelines(json.dumps(asdict(row)) + "\n" for row in rows)
    if os.environ.get(FOLDER) or not passed:
        return
    there = {(row.subject, row.claim): row for row in committed().get(test, [])}
    here = {(row.subject, row.claim): row for row in rows}
    stale = [row.claim for key, row in here.items() if key not in there or not alike(row, there[key])]
    stale += [claim for subject, claim in there.keys() - here.keys()]
    command = f"python -m tests.validation {test.split('::')[0]}"
    assert not stale, f"docs/validation.md: outdated are {'; '.join(stale)}; run {command}"


@cache
def committed() -> dict[str, list[Row]]:
    """Return the rows of the page by test; none if there is no page."""
    return by_test(read_rows(PAGE.read_text(encoding="utf-8"))) if PAGE.exists() else {}


def by_test(rows: list[Row]) -> dict[str, list[Row]]:
    """Return rows by test, in their order."""
    tests: dict[str, list[Row]] = {}
    for row in rows:
        tests.setdefault(row.test, []).append(row)
    return tests


def alike(one: Row, other: Row) -> bool:
    """Return True if rows differ in computed values, last digits and versions of foreign packages only."""
    numbers, words = zip(*(_split(f"{_largest(row.expected)} {row.tolerance}") for row in (one, other)), strict=True)
    sources = [re.sub(r"\d+(\.\d+)+", "#", row.source) for row in (one, other)]
    return (
        (one.subject, sources[0], words[0]) == (other.subject, sources[1], words[1])
        and np.allclose(numbers[0], numbers[1], rtol=2e-3, atol=0.0)
        and (one.agrees, one.reason) == (other.agrees, other.reason)
    )


def _largest(text: str) -> str:
    """Return the text of a range of magnitudes without the smallest one, which may be round-off."""
    return re.sub(r"^\S+ to (.*\()", r"\1", text)


def _split(text: str) -> tuple[list[float], str]:
    """Return the numbers of a text, and the text with # in their places."""
    number = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e-?\d+)?")
    return [float(found) for found in number.findall(text)], number.sub("#", text)


COLUMNS = ("claim", "expected", "computed", "tolerance", "used", "source")
RED = '<b style="color: #c00">NO</b>'
LINK = re.compile(r'^\[(.*)\]\(\.\./(.*?) "(.*)"\)$')


def line(row: Row) -> str:
    """Return a row as a line of a Markdown table."""
    file, name = row.test.split("::", 1)
    claim = f'[{row.claim}](../{file} "{name}")'
    used = row.used if row.agrees else f"{RED}, {row.used}" + (f": {row.reason}" if row.reason else "")
    cells = (claim, row.expected, row.computed, row.tolerance, used, row.source)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def read_rows(text: str) -> list[Row]:
    """Return the rows of a page, the inverse of `page`."""
    rows, subject = [], ""
    for written in text.split("\n"):
        if written.startswith("## "):
            subject = written[3:]
        elif subject in SUBJECTS and written.startswith("| ") and written != "| " + " | ".join(COLUMNS) + " |":
            cells = [cell.replace("\\|", "|") for cell in re.split(r"(?<!\\) \| ", written[2:-2])]
            link = LINK.match(cells[0])
            assert link, f"docs/validation.md: found {cells[0]!r}, must be a link to a test"
            agrees = not cells[4].startswith(RED)
            used, _, reason = (cells[4] if agrees else cells[4][len(RED) + 2 :]).partition(": ")
            rows.append(
                Row(
                    subject=subject,
                    claim=link[1],
                    expected=cells[1],
                    computed=cells[2],
                    tolerance=cells[3],
                    used=used,
                    source=cells[5],
                    test=f"{link[2]}::{link[3]}",
                    agrees=agrees,
                    reason=reason,
                )
            )
    return rows


def headline(rows: list[Row]) -> str:
    """Return the number of claims that hold, and of those that do not."""
    wrong = [row for row in rows if not row.agrees]
    tests = len({function_of(row.test) for row in rows})
    return f"{len(rows) - len(wrong)} of {len(rows)} claims hold, checked by {tests} tests"


def page(rows: list[Row]) -> str:
    """Return the page as Markdown; its rows are in the order of the subjects."""
    rows = sorted(rows, key=lambda row: list(SUBJECTS).index(row.subject))
    wrong = [row for row in rows if not row.agrees]
    lines = ["# Validation", "", "<!-- Written by `python -m tests.validation`; never edit by hand. -->", ""]
    lines += [f"**{headline(rows)}.**", "", INTRODUCTION, *_summary(rows), "## Claims that do not hold", ""]
    if not wrong:
        lines += ["None of the rows below. Published values that we do not meet are in the next section.", ""]
    for row in wrong:
        text = row.reason or "not explained; the test fails"
        lines.append(f"- **{row.claim}** ({row.subject}): expected {row.expected}, computed {row.computed}; {text}.")
    lines += ["", *published()]
    for subject, about in SUBJECTS.items():
        mine = [row for row in rows if row.subject == subject]
        if mine:
            lines += [f"## {subject}", "", about, "", "| " + " | ".join(COLUMNS) + " |", "|---" * len(COLUMNS) + "|"]
            lines += [*(line(row) for row in mine), ""]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).rstrip() + "\n"


def published() -> list[str]:
    """Return the section on published values: counts of `published-results.md`, and predictions that do not agree."""
    text = (ROOT / "docs" / "published-results.md").read_text(encoding="utf-8").split("\n")
    counts = text[
        (start := next(i for i, one in enumerate(text) if one.startswith("| source |"))) : text.index("", start)
    ]
    first = text.index("## Rows that do not agree")
    last = next(i for i, one in enumerate(text) if i > first and one.startswith("## "))
    rows = [re.split(r"(?<!\\) \| ", one[2:-2]) for one in text[first:last]]
    wrong = [row[:4] for row in rows if len(row) == 6 and row[4].startswith("predicted")]
    return [
        "## Published values that we do not meet",
        "",
        "Counts of [Published results](published-results.md). Nothing was adjusted to a `predicted` row; only these",
        "are evidence for the model. The predicted rows that do not agree follow; the links lead to the reasons.",
        "",
        *counts,
        "",
        "| where | statement | published | ours |",
        "|---|---|---|---|",
        *("| " + " | ".join([row[0].replace("](#", "](published-results.md#"), *row[1:]]) + " |" for row in wrong),
        "",
    ]


def _summary(rows: list[Row]) -> list[str]:
    """Return the table of subjects: rows that hold, and rows by kind of evidence."""
    lines = ["| subject | rows | " + " | ".join(EVIDENCE) + " |", "|---" * (len(EVIDENCE) + 2) + "|"]
    for subject in (*SUBJECTS, "all"):
        mine = [row for row in rows if subject in (row.subject, "all")]
        if mine:
            anchor = re.sub("[^a-z0-9 -]", "", subject.lower()).replace(" ", "-")
            agree = sum(row.agrees for row in mine)
            cells = [f"[{subject}](#{anchor})" if subject != "all" else subject]
            cells.append(f"{len(mine)}" if agree == len(mine) else f"{agree} of {len(mine)}")
            kinds = [sum(row.source.startswith(f"{kind}: ") for row in mine) for kind in EVIDENCE]
            lines.append("| " + " | ".join([*cells, *(str(count) if count else "" for count in kinds)]) + " |")
    return [*lines, ""]


def function_of(test: str) -> str:
    """Return the file and name of a test without its parameters."""
    return test.split("[")[0]


def exists(test: str) -> bool:
    """Return True if the function of a test is defined in its file, and the file records rows."""
    file, name = function_of(test).split("::")[:2]
    text = (ROOT / file).read_text(encoding="utf-8") if (ROOT / file).exists() else ""
    return f"def {name}(" in text and "validated(" in text


def merged(old: list[Row], new: list[Row]) -> list[Row]:
    """Return the rows of a page after some tests ran; those of tests that did not run or were skipped remain.

    A row whose expected value, tolerance and verdict are those of the page keeps its text there, so that round-off
    of another machine changes nothing.
    """
    before = {(row.test, row.claim): row for row in old}
    ran = {function_of(row.test) for row in new}
    kept = [row for row in old if function_of(row.test) not in ran and exists(row.test)]
    for row in new:
        there = before.get((row.test, row.claim))
        kept.append(there if there and alike(row, there) and near(row.used, there.used) else row)
    return sorted(kept, key=lambda row: row.test.split("::")[0])


def near(one: str, other: str) -> bool:
    """Return True if shares of a tolerance are equal but for a factor of 3."""
    shares = [float(text.split()[0]) if text[0].isdigit() and text != "0" else 1.0 for text in (one, other)]
    return 1.0 / 3.0 <= shares[0] / shares[1] <= 3.0


def twice(rows: list[Row]) -> list[str]:
    """Return the claims that a section of the page contains more than once."""
    keys = sorted((row.subject, row.claim) for row in rows)
    return [f"{subject}: {claim}" for (subject, claim), group in groupby(keys) if len(list(group)) > 1]


def main(arguments: list[str]) -> int:
    """Run the tests of files, all that call `validated` by default, and write their rows into the page."""
    files = arguments or sorted(
        str(path.relative_to(ROOT))
        for path in (ROOT / "tests").rglob("test_*.py")
        if path.name != "test_validation.py" and "validated(" in path.read_text(encoding="utf-8")
    )
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pytest", "-q", *files]
        status = subprocess.run(command, cwd=ROOT, env={**os.environ, FOLDER: folder}, check=False).returncode
        written = [text for path in sorted(Path(folder).iterdir()) for text in path.read_text("utf-8").splitlines()]
    rows = merged(
        read_rows(PAGE.read_text(encoding="utf-8")) if PAGE.exists() else [],
        [Row(**json.loads(text)) for text in written],
    )
    PAGE.write_text(page(rows), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)}: {headline(rows)}")
    if repeated := twice(rows):
        print("claims that occur more than once: " + "; ".join(repeated))
    return int(status or bool(repeated))
