"""Pages are wrapped at 100 columns, and read as before."""

import re

import pytest

from tools import wrap_docs
from tools.wrap_docs import WIDTH, main, wrapped

LONG = " ".join(["A spring of `20 N/mm` and [a link of some words](there.md) damp"] * 5)
KEPT = f"| a | {LONG} |\n|---|---|\n| b | {LONG} |\n\n```text\n{LONG}\n```\n\n    {LONG}\n\n# {LONG}\n\n<p>{LONG}</p>\n"


def test_pages_are_wrapped():
    assert main(["--check"]) == 0


def test_only_prose_is_wrapped():
    page = wrapped(f"{KEPT}\n- {LONG}\n  1. {LONG}\n\n> {LONG}\n\n{LONG}\n")
    assert page.startswith(KEPT) and wrapped(page) == page
    prose = page.removeprefix(KEPT).split("\n")
    assert max(map(len, prose)) <= WIDTH < len(LONG) and sum(line.startswith("     A") for line in prose) <= 4
    assert all(line.count("`") % 2 == line.count("[") - line.count(")") == 0 for line in prose)


@pytest.mark.parametrize("word", ["-", "2.", "%", "#", ">", ":::", "+++", "```"])
def test_no_line_begins_another_block(word):
    for length in range(60, 100):
        lines = wrapped(f"{'a' * length} {'b' * 20} {word} {'c ' * 30}\n").split("\n")
        assert len(lines) > 2 and not any(line.startswith(word) for line in lines)


def test_a_page_that_would_change_is_refused(monkeypatch):
    monkeypatch.setattr(wrap_docs, "BLOCK", re.compile("$^"))
    with pytest.raises(ValueError, match="list"):
        wrapped(f"{'a' * 99} - {'b' * 20}\n")
