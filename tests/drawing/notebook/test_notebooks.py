"""The notebooks of the documentation run from top to bottom and say what they said."""

import os
import re
from pathlib import Path

import pytest

from tests.patience import HANG

nbclient = pytest.importorskip("nbclient", reason="nbclient is missing: pip install 'vehicle-on-shaker[notebook]'")
nbformat = pytest.importorskip("nbformat", reason="nbformat is missing: pip install 'vehicle-on-shaker[notebook]'")

ROOT = Path(__file__).resolve().parents[3]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
NUMBER = re.compile(r"[-+]?\d+(\.\d+)?")


def kinds(cells):
    """Of each code cell, the kinds of its outputs and its words without the numbers, which differ in rounding."""
    found = []
    for cell in cells:
        if cell.cell_type == "code":
            assert not any(output.output_type == "error" or output.get("name") == "stderr" for output in cell.outputs)
            texts = [str(output.get("data", {}).get("text/plain", output.get("text", ""))) for output in cell.outputs]
            words = " ".join(NUMBER.sub("#", re.sub(r"[0-9a-f]{64}", "#", text)) for text in texts).split()
            found.append(([sorted(output.get("data", {})) for output in cell.outputs], words))
    return found


def test_there_are_two_and_they_are_small():
    assert [path.stem for path in NOTEBOOKS] == ["own_signal_to_report", "three_bushings"]
    for path in NOTEBOOKS:
        text = path.read_text(encoding="utf-8")
        assert len(text) < 300_000
        assert not re.search(r"/(home|tmp|work|root|Users)/", text), "a path of a machine"


@pytest.mark.filterwarnings("default")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_says_what_it_said(path, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]))
    committed = nbformat.read(path, as_version=4)
    fresh = nbformat.read(path, as_version=4)
    for cell in fresh.cells:
        cell.get("outputs", []).clear()
    nbclient.NotebookClient(fresh, timeout=HANG, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert kinds(fresh.cells) == kinds(committed.cells)
