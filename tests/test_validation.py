"""The validation page: rows that are recorded, compared with the page and written into it."""

import dataclasses
import re

import numpy as np
import pytest

from tests import validation, validation_page
from tests.validation import Row, validated
from tests.validation_page import PAGE, RED, ROOT, check_page, exists, headline, merged, page, read_rows, twice
from vehicle.signals.analysis.weighting import weighting

LEAST_ROWS = 300


@pytest.fixture
def recorded(monkeypatch):
    """Rows that are recorded by this test, and none on the page."""
    rows: dict[str, list[Row]] = {}
    monkeypatch.setattr(validation, "RECORDED", rows)
    monkeypatch.setattr(validation, "current_test", lambda: "tests/test_validation.py::test_an_example")
    monkeypatch.delenv(validation_page.FOLDER, raising=False)
    return lambda: [row for each in rows.values() for row in each]


def record(value, expected=10.0, claim="force of a spring", **changes):
    options = {"rel": 1e-3, "unit": "N", "source": "closed form: F = k x", **changes}
    validated("Tyres", claim, value, expected, **options)


def test_the_page_is_written_from_its_rows():
    text = PAGE.read_text(encoding="utf-8")
    rows = read_rows(text)
    assert page(rows) == text, "docs/validation.md: run python -m tests.validation"
    assert len(rows) >= LEAST_ROWS and not twice(rows)


def test_other_pages_quote_its_numbers():
    text = PAGE.read_text(encoding="utf-8")
    for path in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md")):
        for quoted in re.findall(r"\d+ of \d+ claims hold", path.read_text(encoding="utf-8")):
            assert quoted in text, f"{path.relative_to(ROOT)}: found {quoted!r}, must be that of docs/validation.md"


def test_every_row_has_its_test():
    gone = [row.test for row in read_rows(PAGE.read_text(encoding="utf-8")) if not exists(row.test)]
    assert not gone, "docs/validation.md: run python -m tests.validation"


def test_rows_of_a_page_are_read_back(recorded):
    record(10.001)
    with pytest.raises(AssertionError, match=r"force of a spring: computed 10\.02, expected 10\.0, tolerance 0\.1 %"):
        record(10.02)
    record(11.0, reason="a | b: the spring is progressive")
    with pytest.raises(AssertionError, match="agrees now; remove its reason: none"):
        record(10.0, reason="none")
    rows = recorded()[:3]
    assert [(row.agrees, row.used) for row in rows] == [(True, "10 %"), (False, "200 %"), (False, "more than 10 times")]
    text = page(rows)
    assert read_rows(text) == rows and text.count(RED) == 2
    assert "- **force of a spring** (Tyres): expected 10 N, computed 11 N; a | b: the spring is progressive." in text
    assert "- **force of a spring** (Tyres): expected 10 N, computed 10.02 N; not explained; the test fails." in text
    assert headline(rows) == "1 of 3 claims hold, checked by 1 tests" and twice(rows) == ["Tyres: force of a spring"]


@pytest.mark.parametrize(
    ("value", "expected", "options", "used"),
    [
        (np.array([1.0, 2.018]), np.array([1.0, 2.0]), {"rel": 0.01}, "90 %"),
        (np.array([1.001, 2.0]), np.array([1.0, 2.0]), {"peak": 1e-3}, "50 %"),
        (1e-9, 0.0, {"rel": 0.0, "abs": 1e-6}, "< 1 %"),
        (1j, 1j * (1.0 + 5e-4), {}, "50 %"),
        (2.1, 2.0, {"within": (1.7, 2.5)}, "20 %"),
        (1.8, 2.0, {"within": (1.7, 2.5)}, "70 %"),
        (3, 3, {"rel": 0.0}, "0"),
    ],
)
def test_the_largest_deviation_counts(recorded, value, expected, options, used):
    record(value, expected, **options)
    assert [row.used for row in recorded()] == [used]


@pytest.mark.parametrize("value", [np.nan, np.array([10.0, np.nan]), np.array([10.0, 10.0])])
def test_what_is_not_finite_or_of_another_shape_does_not_agree(recorded, value):
    with pytest.raises(AssertionError, match="force of a spring"):
        record(value, expected=np.array([10.0, 10.0, 10.0]))
    assert not recorded()[0].agrees and RED in page(recorded())


def test_a_row_without_a_subject_or_a_source_is_refused(recorded):
    with pytest.raises(AssertionError, match="subject: found 'Wheels', must be one of Static equilibrium, "):
        validated("Wheels", "", 1.0, 1.0, source="closed form: 1")
    with pytest.raises(AssertionError, match="source: found 'a book', must begin with one of closed form, "):
        record(10.0, source="a book")


def test_a_wrong_constant_turns_its_row_red(recorded):
    """Wk of ISO 2631-1 at 8 Hz, table 3, once with its own transition frequency and once with another."""
    right = weighting("Wk")
    record(right.spectrum_factor(8.0), 1.036, unit="", source="standard: ISO 2631-1:1997, table 3")
    wrong = dataclasses.replace(right, f3=right.f3 * 1.1)
    with pytest.raises(AssertionError, match=r"expected 1\.036"):
        record(wrong.spectrum_factor(8.0), 1.036, claim="Wk", unit="", source="standard: ISO 2631-1:1997, table 3")
    good, bad = (row for row in page(recorded()).split("\n") if row.startswith("| ") and "test_validation" in row)
    assert RED not in good and RED in bad


def test_an_outdated_page_fails_with_the_command_that_writes_it(recorded, monkeypatch):
    record(10.001)
    (row,) = recorded()
    for there in ([], [dataclasses.replace(row, expected="11 N")], [row, dataclasses.replace(row, claim="another")]):
        monkeypatch.setattr(validation_page, "committed", lambda there=there: {row.test: there})
        with pytest.raises(AssertionError, match=r"outdated are .*; run python -m tests\.validation tests/test_valid"):
            check_page(row.test)
    # Round-off of another machine, and other versions of a foreign package, are no reason.
    monkeypatch.setattr(
        validation_page, "committed", lambda: {row.test: [dataclasses.replace(row, computed="9.999 N")]}
    )
    check_page(row.test)


def test_a_page_changes_only_where_its_tests_ran(recorded, monkeypatch):
    record(10.001)
    (row,) = recorded()
    elsewhere, other_case = (
        dataclasses.replace(row, test=f"tests/{test}")
        for test in (
            "physics/test_static.py::test_the_residual_is_below_a_micrometre",
            "test_validation.py::test_an_example[1]",
        )
    )
    deleted = dataclasses.replace(row, test="tests/physics/test_static.py::test_x")
    monkeypatch.setattr(validation_page, "exists", lambda test: "test_x" not in test)
    assert merged([elsewhere, row, deleted], []) == [elsewhere, row]
    assert merged([elsewhere, other_case], [row]) == [elsewhere, row]
    assert merged([row], [dataclasses.replace(row, used="20 %")]) == [row]
    other = dataclasses.replace(row, used="90 %")
    assert merged([row], [other]) == [other]


def test_rows_of_tests_that_are_gone_are_dropped():
    assert exists("tests/physics/test_static.py::test_the_residual_is_below_a_micrometre")
    assert not exists("tests/physics/test_static.py::test_x")
    assert not exists("tests/physics/test_no_such_file.py::test_x[1]")
