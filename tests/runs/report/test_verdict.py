"""First page of a report with targets."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from vehicle.commands.report import main
from vehicle.digits import number
from vehicle.runs.report.verdict_section import verdict_section


@pytest.mark.usefixtures("no_figures")
def test_targets_come_first(reported, tmp_path, monkeypatch, capsys):
    """Sentence, limit and value of a figure on the first page; a figure without a run, and a wrong file."""
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "targets.toml"
    file.write_text(
        '[loud]\nquantity = "rms"\nchannels = ["seat rail x", "seat rail y", "seat rail z"]\nweighting = "seat"\n'
        'unit = "m/s2"\nat_most = 1e-3\nsource = "of this test"\n'
        '[rough]\nquantity = "tyre_load"\nroad = "C"\nunit = "-"\nat_most = 0.3\n',
        encoding="utf-8",
    )
    assert main([str(reported.folder), "--targets", "targets.toml", "--output", "verdict.html"]) == 0
    noted = capsys.readouterr().out
    assert "note        1 of 2 targets have no run; run class C: python -m vehicle shaker --vehicle " in noted
    assert " --road C --set damper.coulomb_friction=100\n" in noted
    page = Path("verdict.html").read_text(encoding="utf-8")
    first = page[page.index('<section id="targets">') : page.index('<section id="result">')]
    assert "meets 0 of 1 targets and misses loud; rough had no run." in first
    comfort = json.loads((reported.folder / "summary.json").read_text(encoding="utf-8"))["comfort"]["seat_rail"]
    value = number(comfort["iso2631"]["vector_sum"]["weighted_rms"])
    assert f'<td class="number">{value}</td><td class="missed">missed</td><td class="number">≤ 0.001</td>' in first
    assert "of this test" in first and '<td class="no-run">no run</td>' in first
    file.write_text(file.read_text(encoding="utf-8").replace("seat rail x", "seat rail q"), encoding="utf-8")
    assert main([str(reported.folder), "--targets", "targets.toml", "--output", "wrong.html"]) == 2
    assert "loud on run: " in capsys.readouterr().err and not Path("wrong.html").exists()


def test_cars_with_equal_words_stay_apart():
    cars = ["focus, front.bushings.mount.x=1", "focus, front.hardpoints.mount.x=1"]
    runs: list[Any] = [SimpleNamespace(label=car) for car in cars]
    section = verdict_section({}, runs)
    assert all(f'<th class="number">{car}</th>' in section for car in cars)
    assert "front mount x 1" in verdict_section({}, runs[:1])
