"""The examples run alone, print numbers with units, and save at most one picture."""

import ast
import re
import runpy
import time
import warnings
from pathlib import Path

import pytest
from matplotlib import pyplot

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "examples"
SCRIPTS = sorted(FOLDER.glob("*.py"))
UNIT = re.compile(r"\d\s?(m/s2|m/s3|m/s\^1\.75|mm/s2|Hz|N/mm|N s/m|N|mm|ms|s|%|kg|deg|MB|-)(?![\w/])")


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_an_example_runs(script, tmp_path, monkeypatch, capsys, record_property):
    pyplot.switch_backend("agg")
    monkeypatch.chdir(tmp_path)
    began = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        runpy.run_path(str(script), run_name="__main__")
    pyplot.close("all")
    record_property("processor_seconds", round(time.process_time() - began, 2))
    assert UNIT.search(capsys.readouterr().out)
    pictures = list(tmp_path.glob("*.png"))
    assert [path.stem for path in pictures] == [script.stem] * len(pictures)
    assert all(path.stat().st_size > 5_000 for path in pictures)


def test_examples_are_numbered_short_and_listed():
    assert [script.stem[:2] for script in SCRIPTS] == [f"{number:02}" for number in range(1, 25)]
    rows = re.findall(r"^\| \[(\w+)\]\((\w+\.py)\) \| (.*) \|$", (FOLDER / "index.md").read_text("utf-8"), re.MULTILINE)
    assert [name for _, name, _ in rows] == [script.name for script in SCRIPTS]
    for script, (_, _, words) in zip(SCRIPTS, rows, strict=True):
        text = script.read_text("utf-8")
        assert ast.get_docstring(ast.parse(text)) == words and len(text.splitlines()) <= 45
