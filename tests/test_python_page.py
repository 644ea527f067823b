"""The examples of docs/python.md and of the README, run from top to bottom."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import vehicle
from vehicle.model.parameters.paths import value_of

ROOT = Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")


def run(blocks, name, monkeypatch, folder):
    monkeypatch.chdir(folder)
    space = {"__name__": "__main__"}
    for block in blocks:
        exec(compile(block, name, "exec"), space)
    return space


def test_the_examples_of_the_page(tmp_path, monkeypatch):
    pytest.importorskip("pymoo", reason="pymoo is missing: pip install 'vehicle-on-shaker[optimisation]'")
    pytest.importorskip("pandas", reason="pandas is missing: pip install 'vehicle-on-shaker[notebook]'")
    space = run(BLOCK.findall(PAGE), "python.md", monkeypatch, tmp_path)
    # What the page claims of its own examples.
    assert space["ride"].skip >= 2.0 and space["ride"].car.vehicle.driving.speed == pytest.approx(80 / 3.6)
    comfort = space["table"].column("comfort_overall")
    again = (
        space["sedan"]
        .varied({"front.damper.coulomb_friction": 120})
        .run(vehicle.Road("B", speed=80, duration=6), engine="reduced")
    )
    assert comfort[1] == pytest.approx(again.comfort().overall, rel=1e-3) and comfort[0] != comfort[1]
    (response,) = space["comparison"].responses
    assert 0.5 < response.frac < 0.9999
    path = "bushings.suspension_mount.stiffness.z"
    assert value_of(space["tuned"].vehicle, path) == space["result"].values[path] == pytest.approx(6.8e5, rel=0.02)
    assert space["damper"].values["damper.viscous"] == pytest.approx(2000.0, rel=1e-3)
    assert space["drive"].error < 0.5 and "best comfort" in repr(space["found"])
    rms = space["run"].weighted_comfort()
    assert space["seat"].overall == pytest.approx(rms["overall"], rel=1e-9)
    assert space["seat"].weighted_rms["z"] == pytest.approx(rms["z"], rel=1e-9)
    for name in ("runs/high/summary.json", "runs/compared/compare.json", "report.html", "runs/drive/drive.csv"):
        assert (tmp_path / name).is_file()


def test_the_example_of_the_readme(tmp_path, monkeypatch):
    blocks = BLOCK.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    assert len(blocks) == 1 and len([line for line in blocks[0].splitlines() if line]) == 8
    run([blocks[0].replace('"high.csv"', '"high.csv", engine="reduced"')], "README.md", monkeypatch, tmp_path)


def test_the_page_shows_every_public_function():
    functions = [name for name in vehicle.__all__ if name[0].islower()]
    assert [name for name in functions if f"{name}(" not in PAGE] == []
