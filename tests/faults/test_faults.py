"""The fault table has every command that writes; a sample of it is run, the ways of writing without a computation."""

import pytest

from tests.faults.cases import FAULTS
from tests.faults.commands import DOOR, writing_alone
from tests.faults.jobs import commands, job_of, writing_options
from tests.faults.table import build, counted, has_compiler, outcomes


@pytest.mark.skipif(not has_compiler(), reason="the preloaded library needs Linux and a C compiler")
def test_a_failing_system_call_loses_nothing(tmp_path):
    names = [*map(writing_alone, DOOR)]
    table = counted(outcomes(build(tmp_path), tmp_path, ",".join(names), most=2, kills=2))
    assert [case for count in table.values() for case in count.wrong] == []
    assert {(name, fault) for name in names for fault in FAULTS} < table.keys()
    for name in names:
        assert table[name, "killed"].calls > 20 and table[name, "killed"].results.total() == 2
        assert table[name, "disk full"].results["old"] >= 1


def test_every_command_that_writes_has_a_job(monkeypatch, tmp_path):
    monkeypatch.setattr("tests.faults.jobs.main", lambda words: 0)  # the runs that some jobs read are not needed
    words = [list(each.new) for each in commands(tmp_path / "inputs")]
    wanted = list(writing_options())
    assert len(wanted) > 50 and {name.split()[0] for name, *_ in wanted} > {"shaker", "body", "new", "tune", "modes"}
    missing = [each for each in wanted if not any(job_of(each, words_of) for words_of in words)]
    assert not missing, "add a job to tests/faults/jobs.py, or the option to those that only read"
