"""The work of what users call has not grown by more than a tenth; no clock, so equal on every machine."""

import json

from tests.benchmarks.counts import BASELINE, counts, grown


def test_no_count_has_grown_by_more_than_a_tenth():
    found, baseline = counts(), json.loads(BASELINE.read_text(encoding="utf-8"))
    assert grown(found, baseline) == [], "if there is a reason: python -m tests.benchmarks.counts --write"


def test_growth_names_its_piece():
    baseline = {"steps": 100, "bytes": 0, "old": 1}
    assert grown({"steps": 110, "bytes": 0, "old": 1}, baseline) == []
    found = {"steps": 111, "bytes": 1, "new": 3}
    assert grown(found, baseline) == [
        "new: no baseline", "old: not counted any more", "steps: 111 instead of 100", "bytes: 1 instead of 0",
    ]  # fmt: skip
