"""Numbers that README.md and docs/trust.md quote from the table of published results are those of the table."""

import json
import re
from collections.abc import Callable
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import pytest

from scenarios.claims import STATUSES, UNCOUNTED
from scenarios.evidence import EVIDENCE, evidence_of
from scenarios.published.__main__ import HOME, PAGE
from scenarios.published.page import page
from vehicle.signals.excitation.slip_set import CHOSEN

ROOT = Path(__file__).parents[2]

TABLE: dict[str, Any] = json.loads((ROOT / HOME / "results.json").read_text(encoding="utf-8"))

ROWS: list[dict[str, Any]] = TABLE["rows"]

PAGES = {name: " ".join((ROOT / name).read_text(encoding="utf-8").split()) for name in ("README.md", "docs/trust.md")}
"""Pages that quote numbers, docs/trust.md all of them."""


def named(pattern: str) -> dict[str, Any]:
    """Return the only row of the table whose "study: name" matches a pattern."""
    (row,) = [row for row in ROWS if fnmatchcase(row["name"], pattern)]
    return row


def ours(pattern: str) -> list[float]:
    """Return all numbers of our value of a row, the mean first."""
    return [float(text) for text in re.findall(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", str(named(pattern)["ours"]))]


def predicted() -> list[str]:
    verdicts = [row["within"] for row in ROWS if row["status"] == "predicted"]
    return [f"{count}" for count in (len(verdicts), verdicts.count(True), verdicts.count(None))]


def intervals() -> list[str]:
    rows = [row for row in ROWS if row["inside"] is not None and row["status"] not in UNCOUNTED]
    return [f"{len(rows)}", *(f"{[row[name] for row in rows].count(True)}" for name in ("inside", "within"))]


def halves() -> dict[tuple[str, str], str]:
    """Return name and place of every statement in the list of the choice to its half: "chose" or "held out"."""
    cells = [line.split(" | ") for note in TABLE["choice"] for line in note.split("\n")]
    return {(row[0].removeprefix("| "), row[1]): row[2] for row in cells if len(row) > 2 and row[2] in HALVES}


HALVES = {"chose": "used", "held out": "held out"}
"""Word of a half in the list of the choice, and behind the status of a row."""


def number_of(status: str) -> list[str]:
    return [f"{sum(row['status'] == status for row in ROWS)}"]


def shares(wheel: str) -> list[str]:
    patterns = [f"levels: slip share of the {wheel} damper, {level} *" for level in ("low", "mid", "high")]
    published = [f"{float(named(pattern)['published']):g}" for pattern in patterns]
    return [*published, *(f"{ours(pattern)[0]:.1f}" for pattern in patterns)]


def first(pattern: str, digits: int) -> list[str]:
    return [f"{ours(pattern)[0]:.{digits}f}"]


N = r"(-?[\d.]+)"

QUOTES: dict[str, Callable[[], list[str]]] = {
    rf"Of {N} \[?published results\S* that nothing was fitted to, {N} agree and {N} are undecided": predicted,
    rf"Of {N} results printed as an interval, our value is inside {N}, and {N} are not contradicted": intervals,
    rf"{N} more are fitted": lambda: number_of("fitted"),
    rf"more are fitted, {N} chosen": lambda: number_of("chosen"),
    rf"slip share[^|]*, right damper[^|]*\| {N} / {N} / {N} % \| {N} / {N} / {N} % \|": lambda: shares("right"),
    rf"slip share[^|]*, left damper[^|]*\| {N} / {N} / {N} % \| {N} / {N} / {N} % \|": lambda: shares("left"),
    rf"above {N} mm/s; the share above 1 mm/s": lambda: [f"{1e3 * CHOSEN.slip_velocity:g}"],
    rf"constant velocity PSD from {N} Hz": lambda: [f"{CHOSEN.shaker_edge_hz:g}"],
    rf"to 50 Hz, roads from {N} Hz": lambda: [f"{CHOSEN.road_edge_hz:g}"],
    rf"vertical wheel mode[^|]*\| 28 Hz \| {N} Hz": lambda: first("levels: vertical wheel mode, low *", 1),
    rf"body roll, Ixx 1000[^|]*\| 6.5 Hz \| {N} Hz": lambda: first("inertia: roll peak*, Ixx 1000 [[]Hz]", 2),
    rf"body roll, Ixx 1200[^|]*\| [^|]*\| {N} Hz, {N} % lower": lambda: [
        f"{value:g}" for value in ours("inertia: roll peak*, Ixx 1200 against 1000")
    ],
    rf"first slip \(end of sticking[^|]*\| 5.035 s \| {N} s": lambda: first("bump: *end of stick* with Fd 125 N*", 3),
}
"""Pattern of a quoted sentence, and the numbers of the table, or of the chosen set, that belong there."""


@pytest.mark.parametrize("sentence", QUOTES)
def test_a_quoted_number_is_that_of_the_table(sentence):
    quotes = [match.groups() for text in PAGES.values() for match in re.finditer(sentence, text)]
    assert re.search(sentence, PAGES["docs/trust.md"]), f"docs/trust.md has no sentence like {sentence}; change QUOTES"
    assert [list(quote) for quote in quotes] == [QUOTES[sentence]()] * len(quotes)


@pytest.mark.parametrize(
    ("words", "pattern"),
    [
        ("slip share", "levels: slip share of the right damper, high *"),
        ("vertical wheel mode", "levels: vertical wheel mode, low *"),
        ("body roll, Ixx 1000", "inertia: roll peak*, Ixx 1000 [[]Hz]"),
        ("body roll, Ixx 1200", "inertia: roll peak*, Ixx 1200 against 1000"),
        ("first slip (end of sticking", "bump: *end of stick* with Fd 125 N*"),
    ],
)
def test_a_quoted_row_says_whether_it_is_fitted(words, pattern):
    rows = [row for text in PAGES.values() for row in re.findall(r"\| ([^|]+) \|", text) if row.startswith(words)]
    assert rows and all(named(pattern)["status"] in row for row in rows), rows


def test_statuses_are_those_of_the_list_of_the_choice():
    rows = {row["evidence"]: row for row in ROWS if row["evidence"]}
    listed = halves()
    assert set(listed) == {(one.name, one.place) for one in EVIDENCE}
    # Both ends of the range of the engine modes are one row of the page.
    assert set(rows) == {one.key for one in EVIDENCE} - {"engine_lowest", "engine_highest"}
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    for key, row in rows.items():
        half, status = listed[evidence_of(key).name, evidence_of(key).place], row["status"]
        assert status in {"chose": ("chosen", "fitted", "duplicate", "not testable")}.get(half, STATUSES), key
        if not evidence_of(key).before and half == "held out":
            assert status in ("predicted", "duplicate"), key
        # Of the evidence only an axis that reaches to 0 cannot be tested.
        assert (status == "not testable") == (0.0 in evidence_of(key).interval and key.startswith("bump_7p5_rel")), key
        name = row["name"].partition(": ")[2].replace("|", "\\|")
        line = next(one for one in text.split("\n") if one.startswith(f"| {name} |"))
        assert f"| {status} ({HALVES[half]}) |" in line, key


def test_the_page_is_that_of_the_table():
    figures = ROOT / HOME / "figures"
    written = (ROOT / PAGE).read_text(encoding="utf-8")
    assert written == page(ROWS, TABLE["choice"], f"../{HOME}/figures", [path.name for path in figures.glob("*.png")])


def test_every_link_of_the_page_has_its_target():
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    assert set(re.findall(r"\]\(#([^)]*)\)", text)) <= set(re.findall(r'<a id="([^"]*)"></a>', text))
    pictures = re.findall(r"!\[[^]]*\]\(([^)]*)\)", text)
    assert all((ROOT / PAGE).parent.joinpath(picture).is_file() for picture in pictures)


def test_kept_pictures_are_small_and_all_are_on_the_page():
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    for picture in (ROOT / HOME / "figures").glob("*.png"):
        assert picture.stat().st_size <= 120_000, picture.name
        assert f"figures/{picture.name})" in text, picture.name
