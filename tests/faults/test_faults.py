"""A sample of the fault table, the ways of writing without a computation; `make faults` runs all of it."""

from __future__ import annotations

import pytest

from tests.faults.cases import FAULTS
from tests.faults.commands import DOOR, writing_alone
from tests.faults.table import build, counted, has_compiler, outcomes


@pytest.mark.skipif(not has_compiler(), reason="the preloaded library needs Linux and a C compiler")
def test_a_failing_system_call_loses_nothing(tmp_path):
    names = [*map(writing_alone, DOOR)]
    table = counted(outcomes(build(tmp_path), tmp_path, ",".join(names), most=2, kills=2, limit=None))
    assert [case for count in table.values() for case in count.wrong] == []
    assert {(name, fault) for name in names for fault in FAULTS} < table.keys()
    for name in names:
        assert table[name, "killed"].calls > 20 and table[name, "killed"].results.total() == 2
        assert table[name, "disk full"].results["old"] >= 1
