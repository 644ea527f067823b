"""A sample of the fault table; `make faults` runs all of it."""

from __future__ import annotations

import pytest

from tests.faults.cases import FAULTS
from tests.faults.table import build, counted, has_compiler, outcomes

SAMPLE = "kinematics"
"""A command that replaces a folder with a table and a picture."""


@pytest.mark.skipif(not has_compiler(), reason="the preloaded library needs Linux and a C compiler")
def test_a_failing_system_call_loses_nothing(tmp_path):
    table = counted(outcomes(build(tmp_path), tmp_path, SAMPLE, most=3, kills=2, limit=None))
    assert [case for count in table.values() for case in count.wrong] == []
    assert {fault for _, fault in table} > FAULTS.keys()
    assert table[SAMPLE, "killed"].calls > 60 and table[SAMPLE, "killed"].results.total() == 3
    assert table[SAMPLE, "disk full"].results["old"] >= 2
    assert table[SAMPLE, "interrupted call"].results["new"] >= 1
