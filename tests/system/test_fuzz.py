"""A few of the mutations of `python -m tests.fuzz`, and the judge that must see what is wrong."""

import json

import pytest

from tests.fuzz import judge, run_case
from vehicle.commands.command_line import FAULT


@pytest.mark.parametrize("index", range(15))
def test_mutations(index):
    outcome = run_case(index)
    assert not outcome.wrong, f"{outcome.wrong} | {outcome.said}"


@pytest.mark.parametrize("first", range(0, 60, 20))
def test_damaged_files(first):
    outcomes = [run_case(index, "file") for index in range(first, first + 20)]
    assert [(one.wrong, one.said) for one in outcomes if one.wrong] == []
    assert len({one.code for one in outcomes}) > 1


def test_the_judge_sees_what_is_wrong(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert judge(0, "", "") == "" and judge(2, "", "error: no") == ""
    assert judge(1, "", "error: no") == "exit code 1"
    assert judge(2, "", "Traceback (most recent call last):").startswith("traceback")
    assert judge(4, "", f"error: {FAULT} (X)").startswith("traceback")
    assert judge(3, "", "") == "no message"
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "summary.json").write_text(json.dumps({"a": float("inf")}))
    assert judge(0, "", "").startswith("a number that is none")
