"""Rows that tests of physical claims record, and the page `docs/validation.md`, which is written from them.

A test calls `validated` instead of an assertion. `python -m tests.validation [FILES]` runs the tests of these files (by
default of all that call it) and writes their rows into the page. In any other run, each test is compared with its
rows there.
"""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass
from functools import cache
from importlib.metadata import version
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "validation.md"
FOLDER = "VEHICLE_VALIDATION_ROWS"
"""Environment variable with the folder to which `python -m tests.validation` has the rows written."""

EVIDENCE = ("closed form", "second derivation", "foreign code", "standard", "publication", "conservation")
"""First words of a source: kinds of evidence, columns of the summary."""

SUBJECTS = {
    "Static equilibrium": "Wheel loads, preloads and rest of the complete car.",
    "Dampers and friction": "Force laws of dampers, Coulomb and Stribeck friction, tables, degressive valves.",
    "Bushings, springs and stops": "Laws of connections, Maxwell branches, attachments to the body, tables, stops.",
    "Tyres": "Tyres on a moving plate, tyres that can lift off, rolling tyres.",
    "Suspension kinematics": "Wheel travel, camber and toe of struts and twist beams; compliance of an axle.",
    "Body models": "Beams, imported finite elements, reduction by Rubin and by Craig and Bampton, modal tests.",
    "Integration in MuJoCo": "Time integration: order of convergence, step, energy, compiled laws, FRFs from runs.",
    "Reduced engine": "The car as a sum over its poles, against MuJoCo and stiff solvers.",
    "Linear system": "Matrices, poles, natural modes and participation of the linearised car.",
    "Quarter and half cars": "Lumped models, bumps, settling, road holding.",
    "Semi-active dampers": "Skyhook, groundhook and hybrid control, in both engines and the lumped half car.",
    "FRF estimation and spectra": "FRF, coherence, local rational models, spectra, record alignment.",
    "Comfort, ISO 2631": "Frequency weightings, weighted RMS, MTVV, dose values, SEAT value.",
    "Load histories": "Rainflow counts and equivalent amplitudes.",
    "File readers": "Measurement files of loggers and foreign programs; matrices and modes of finite elements.",
    "Roads and excitation": "ISO 8608 roads, contact patch, bumps, shaker signals.",
    "Sweeps, tuning and optimisation": "Sensitivity indices, parameter fits, Pareto fronts, drive replication.",
    "Statistics and intervals": "Standard errors, effective averages, probability that a value lies in an interval.",
    "Published cars": "Values printed by Bommer 2006, the half car with rider and the choice of dampers.",
}
"""Sections of the page in their order, and what each contains."""

INTRODUCTION = """\
How far may the numbers of this program be trusted? Each row below is a physical or numerical claim that a test of the
program checks against an expected value from elsewhere: a closed form, a second derivation, another program, a
standard, a publication, or a conservation law or symmetry. A second derivation is written for the test, or computes
the same quantity by another path of the program: the other engine, a finer step, the matrices of the linear system.
The tests write this page.

**Verified against equations.** Force laws, static equilibrium, the linear system, time integration, reduction of
flexible bodies, FRF estimation, ISO 2631 and ISO 8608. The program solves its equations as accurately as the rows say.
Agreement of both engines, MuJoCo and the reduced one, is verification too: they share matrices and force laws, and
the same wrong parameter gives both the same wrong result.

**Validated against measurements: published values only.** The car of Bommer 2006 was measured on a shaker; the thesis
prints a part of these measurements, and we compare with what is printed. It is a scan without curves: many values are
labels of axes. [Published results](published-results.md) lists every statement of three publications, and each one that
we do not meet, with the reason.

**Not validated.** No car of our own was measured. Not compared with any measurement: the four-poster, the sedan,
rolling tyres, semi-active control, road runs at speed, wheel loads and fatigue damage, the comfort of a person on a
seat. For these the equations are verified, and their parameters are assumed or come from publications. Validate the
model with your own measurement (`python -m vehicle.compare`) before you trust an absolute value; differences between
variants of one car depend less on its parameters.

**How to read a row.** The tolerance is that of the test: above it the test fails. "Used" is the largest deviation as a
share of the tolerance, rounded up, and "< 1 %" below that. For several values the row shows the smallest and the
largest magnitude; the largest deviation of all of them counts. **NO** marks a claim that does not hold. Each claim is
a link to its test.
"""


@dataclass(frozen=True)
class Row:
    """A claim as on the page; all cells are text.

    Attributes:
        subject: section of the page.
        claim: statement that is checked.
        expected, computed: values with unit.
        tolerance: allowed deviation.
        used: largest deviation as a share of the tolerance.
        source: kind of evidence and place of the expected value.
        test: node of the test, as pytest names it.
        agrees: True if the deviation is at most the tolerance.
        reason: explanation of a known disagreement; empty if there is none.
    """

    subject: str
    claim: str
    expected: str
    computed: str
    tolerance: str
    used: str
    source: str
    test: str
    agrees: bool = True
    reason: str = ""


UNQUOTED = str.maketrans('"|', "'/")
RECORDED: dict[str, list[Row]] = {}
"""Rows of this process by test."""


def validated(
    subject: str,
    claim: str,
    value: Any,
    expected: Any,
    *,
    source: str,
    rel: float = 0.0,
    abs: float = 0.0,
    peak: float = 0.0,
    within: tuple[float, float] | None = None,
    unit: str = "",
    reason: str = "",
) -> None:
    """Record a row of the validation page, and raise AssertionError if the claim does not hold.

    A value agrees if its deviation is at most the largest of rel |expected|, abs and peak max |expected|. Without any
    of them, only an equal value agrees.

    Args:
        subject: section of the page, one of `SUBJECTS`.
        claim: statement that is checked, unique in its section.
        value: computed by the code under test, number or array, real or complex.
        expected: of the same shape, or one number for all.
        source: first words of `EVIDENCE`, a colon, and where the expected value comes from.
        rel: tolerance relative to each expected value.
        abs: tolerance in the unit of the value.
        peak: tolerance relative to the largest magnitude of the expected values.
        within: lowest and highest allowed value, instead of a tolerance.
        unit: of value and expected; empty without one.
        reason: explanation of a known disagreement; the claim must then not hold.
    """
    assert subject in SUBJECTS, f"subject: found {subject!r}, must be one of {', '.join(SUBJECTS)}"
    assert source.split(": ")[0] in EVIDENCE, f"source: found {source!r}, must begin with one of {', '.join(EVIDENCE)}"
    got, want = np.asarray(value), np.asarray(expected)
    same = got.size > 0 and (want.ndim == 0 or got.shape == want.shape)
    high = float(np.max(np.abs(want), initial=0.0))
    allowed = np.maximum(np.maximum(rel * np.abs(want), abs), peak * high)
    gap = np.abs(got - want) if same else np.array(np.inf)
    if within is not None:
        allowed = np.where(np.real(got) < want, want - within[0], within[1] - want)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = float(np.max(np.where(gap == 0.0, 0.0, gap / allowed), initial=0.0))
    agrees = same and share <= 1.0
    finest = float(np.max(allowed)) / 10.0
    row = Row(
        subject=subject,
        claim=claim,
        expected=_values(want, finest, unit),
        computed=_values(got, finest, unit),
        tolerance=_tolerance(rel, abs, peak, within, unit),
        used=_share(share),
        source=source,
        test=current_test(),
        agrees=agrees,
        reason=reason,
    )
    RECORDED.setdefault(row.test, []).append(row)
    if reason:
        assert not agrees, f"{claim}: agrees now; remove its reason: {reason}"
        return
    assert agrees, (
        f"{claim}: computed {value}, expected {expected}, tolerance {row.tolerance}, used {row.used}; {source}"
    )


def current_test() -> str:
    """Return the node of the test that runs; without the characters that end a cell or a title of the page."""
    return os.environ["PYTEST_CURRENT_TEST"].rsplit(" (", 1)[0].translate(UNQUOTED)


def foreign(package: str, what: str = "") -> str:
    """Return the source text of a foreign package with its installed version."""
    return f"foreign code: {package} {version(package)}{', ' if what else ''}{what}"


def _values(values: Any, finest: float, unit: str) -> str:
    """Return a number, or the range of magnitudes of an array, to four digits or a tenth of the tolerance."""
    if values.size == 1 and not np.iscomplexobj(values):
        return f"{_number(float(values.reshape(())), finest)} {unit}".strip()
    ends = [_number(float(end), finest) for end in (np.min(np.abs(values)), np.max(np.abs(values)))]
    text = f"{ends[0] if ends[0] == ends[1] else ' to '.join(ends)} {unit}".strip()
    return f"{text} ({values.size} values)" if values.size > 1 else f"{text} (magnitude)"


def _number(value: float, finest: float = 0.0, digits: int = 4) -> str:
    """Return a number with at most these digits, 0 below the finest resolution."""
    if math.isfinite(value) and value != 0.0 and math.isfinite(finest) and finest > 0.0:
        digits = min(digits, math.floor(math.log10(abs(value))) - math.floor(math.log10(finest)) + 1)
    if digits <= 0:
        return "0"
    return re.sub(r"e([+-])0*", lambda found: "e" + found[1].strip("+"), f"{float(f'{value:.{digits - 1}e}'):.6g}")


def _tolerance(rel: float, absolute: float, peak: float, within: tuple[float, float] | None, unit: str) -> str:
    """Return the tolerance as text."""
    if within is not None:
        return f"{_number(within[0])} to {_number(within[1])} {unit}".strip()
    parts = [
        *([_percent(rel)] if rel else []),
        *([f"{_number(absolute, digits=2)} {unit}".strip()] if absolute else []),
        *([f"{_percent(peak)} of the largest"] if peak else []),
    ]
    return " or ".join(parts) or "equal"


def _percent(share: float) -> str:
    """Return a share in percent, or as a power of ten below 0.01 %."""
    return f"{_number(100.0 * share, digits=2)} %" if share >= 1e-4 else f"{_number(share)} relative"


def _share(share: float) -> str:
    """Return a share of the tolerance in percent, rounded up to one digit."""
    if share == 0.0:
        return "0"
    if share <= 0.01:
        return "< 1 %"
    if not math.isfinite(share):
        return "no limit"
    size = 10.0 ** math.floor(math.log10(100.0 * share))
    return f"{math.ceil(100.0 * share / size - 1e-9) * size:g} %"


def check_page(test: str, *, passed: bool = True) -> None:
    """Raise AssertionError if the page does not contain the rows that a test has just recorded, and no other.

    While `python -m tests.validation` runs, write them to a file instead.

    Args:
        test: its node.
        passed: False if the test failed, so that rows are missing: nothing is compared.
    """
    test = test.translate(UNQUOTED)
    rows = RECORDED.get(test, [])
    if os.environ.get(FOLDER):
        path = Path(os.environ[FOLDER]) / f"{os.getpid()}.jsonl"
        with path.open("a", encoding="utf-8") as file:
            file.writelines(json.dumps(asdict(row)) + "\n" for row in rows)
    if os.environ.get(FOLDER) or not passed:
        return
    there = {row.claim: row for row in committed().get(test, [])}
    stale = [row.claim for row in rows if row.claim not in there or not alike(row, there[row.claim])]
    stale += [claim for claim in there if claim not in {row.claim for row in rows}]
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
        and np.allclose(*numbers, rtol=2e-3, atol=0.0)
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
    """Return the page as Markdown."""
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
    wrong = [row[:4] for row in rows if len(row) == 6 and row[4] == "predicted"]
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
        if "import validated" in (text := path.read_text(encoding="utf-8")) or ", validated" in text
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


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
