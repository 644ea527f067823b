"""A sample of the fault table; `make faults` runs all of it."""

from __future__ import annotations

import pytest

from tests.faults.cases import FAULTS
from tests.faults.table import build, counted, has_compiler, outcomes

SAMPLE = ("kinematics", "road")
"""A command that writes a folder, and one that writes two files into a folder of others."""


@pytest.mark.skipif(not has_compiler(), reason="the preloaded library needs Linux and a C compiler")
def test_a_failing_system_call_loses_nothing(tmp_path):
    lines = outcomes(build(tmp_path), tmp_path, ",".join(SAMPLE), most=2, kills=2, limit=None)
    table = counted(lines)
    assert [case for count in table.values() for case in count.wrong] == []
    assert {(name, fault) for name in SAMPLE for fault in FAULTS} < table.keys()
    for name in SAMPLE:
        assert table[name, "killed"].calls > 60 and table[name, "killed"].results.total() == 2
        assert table[name, "disk full"].results["old"] >= 1
        assert table[name, "interrupted call"].results["new"] >= 1
