"""The table of everything: rows collected, none left out, finished scenarios read."""

from __future__ import annotations

import importlib
import json
from types import SimpleNamespace
from typing import Any

import pytest

from scenarios import published
from scenarios.published import definition_lines


def row(name, within=True, **changes):
    return {
        "name": name, "published": 1.0, "ours": 1.02, "deviation": 0.02, "within": within, "why": "5 %",
        "status": "predicted", "source": "text", "interval": None,
        "place": "figure 3.3", "picture": "", "probability": None, **changes,
    }  # fmt: skip


KEYS = set(row(""))

CONTENT = {
    "levels": [row("slip share of the right damper, high [%]"), row("vertical wheel mode, low [Hz]", within=False)],
    "quarter_car": [
        row("stick modes [Hz]", published="4.8 | 25", ours="4.8, 25.1", deviation=None, status="own check")
    ],
}


def replace_scenarios(monkeypatch, module):
    """Have `scenarios.NAME` be what `module(NAME)` returns."""
    real = importlib.import_module

    def instead(name, package=None):
        return module(name.split(".")[1]) if name.startswith("scenarios.") else real(name, package)

    monkeypatch.setattr("importlib.import_module", instead)


@pytest.fixture
def scenarios(monkeypatch, tmp_path):
    """Two scenarios that write a file and count their runs."""
    calls: dict[str, list[list[str]]] = {name: [] for name in CONTENT}

    def module(name):
        def main(arguments):
            calls[name].append(arguments)
            folder = tmp_path / "runs" / name
            assert arguments[:2] == ["--output", str(folder)]
            folder.mkdir(parents=True, exist_ok=True)
            content: dict[str, Any] = {"title": f"title of {name}", "rows": CONTENT[name], "notes": [f"made by {name}"]}
            if name == "levels":
                content["not_judged"] = {"line of the FRFs, mid": "too short"}
            (folder / "results.json").write_text(json.dumps(content), encoding="utf-8")
            return 0

        return SimpleNamespace(main=main)

    monkeypatch.setattr(published, "SCENARIOS", tuple(CONTENT))
    replace_scenarios(monkeypatch, module)
    return calls


def command(tmp_path, *more):
    return published.main(["--output", str(tmp_path / "table"), "--runs", str(tmp_path / "runs"), *more])


def test_every_row_of_every_scenario_is_in_the_table(scenarios, tmp_path, capsys):
    assert command(tmp_path, "--quick", "--jobs", "2") == 0
    assert scenarios["levels"] == [["--output", str(tmp_path / "runs" / "levels"), "--force", "--jobs", "2", "--quick"]]
    rows = json.loads((tmp_path / "table" / "results.json").read_text(encoding="utf-8"))
    assert [row["name"] for row in rows] == [
        "levels: slip share of the right damper, high [%]",
        "levels: vertical wheel mode, low [Hz]",
        "quarter_car: stick modes [Hz]",
    ]
    assert all(set(row) == KEYS for row in rows)
    text = (tmp_path / "table" / "results.md").read_text(encoding="utf-8")
    counts = "1 of 2 predicted rows agree; in addition 1 own check (1 agree)"
    assert counts in text and counts in capsys.readouterr().out
    assert "| vertical wheel mode, low [Hz] | figure 3.3 | 1 | 1.02 | +2.0 % | NO | predicted | text | 5 % |" in text
    assert "| stick modes [Hz] | figure 3.3 | 4.8 \\| 25 | 4.8, 25.1 |  | yes | own check | text | 5 % |" in text
    assert "made by quarter_car" in text and "Made with `--quick`" in text


def test_published_results_without_a_row_are_named(scenarios, tmp_path):
    assert command(tmp_path) == 0
    text = (tmp_path / "table" / "results.md").read_text(encoding="utf-8")
    missing = text.split("Published results that no row answers: ")[1].split(".\n")[0].split("; ")
    answered = {"slip share, low / mid / high", "vertical wheel mode"}
    assert missing == [row for row in published.COMPLETE_CAR if row not in answered]


def test_finished_scenarios_are_read_and_missing_ones_run(scenarios, tmp_path):
    assert command(tmp_path) == 0
    (tmp_path / "runs" / "levels" / "results.json").unlink()
    assert command(tmp_path, "--reuse", "--force") == 0
    assert {name: len(calls) for name, calls in scenarios.items()} == {"levels": 2, "quarter_car": 1}


def test_an_occupied_folder_is_refused_before_anything_runs(scenarios, tmp_path, capsys):
    assert command(tmp_path) == 0
    assert command(tmp_path) == 2
    assert "holds files already" in capsys.readouterr().err
    assert len(scenarios["levels"]) == 1


def test_a_failed_scenario_ends_the_command(scenarios, tmp_path, monkeypatch, capsys):
    replace_scenarios(monkeypatch, lambda name: SimpleNamespace(main=lambda arguments: 3))
    assert command(tmp_path) == 4
    assert "scenarios.levels: ended with exit code 3" in capsys.readouterr().err


def test_a_broken_file_is_named(scenarios, tmp_path, capsys):
    assert command(tmp_path) == 0
    (tmp_path / "runs" / "levels" / "results.json").write_text("{", encoding="utf-8")
    assert command(tmp_path, "--reuse", "--force") == 3
    assert "results.json: cannot be read" in capsys.readouterr().err


def slip_content(bump_slip=5.055):
    shares = {"low": ([0.0, 0.0], [0.001, 0.0]), "mid": ([0.04, 0.0], [0.15, 0.01]), "high": ([0.2, 0.0], [0.35, 0.04])}
    point = {"value": 125.0, "slip": 0.3, "saturated": 0.45}
    return {
        "levels": {
            "slip_velocity": 0.012,
            "levels": {level: {"slip": slip, "saturated": loose} for level, (slip, loose) in shares.items()},
        },
        "comfort_sensitivity": {
            "source": {
                "coulomb_friction": {"smooth": [{"value": 62.5}, point], "rough": [{**point, "slip": 0.8}]},
            }
        },
        "bump": {
            "first_slip_s": {"125 N": bump_slip},
            "first_saturated_s": {"125 N": 5.038},
            "low_bump": {"largest_velocity": 0.008, "time_above_1_mm_s": 0.025},
        },
    }


def test_both_velocities_stand_beside_the_print_with_what_agrees():
    lines = definition_lines(slip_content())
    assert lines[0] == "## One definition of slip"
    assert "| slip share, right damper, mid | 3.9 % | 4.0 % | yes | 15.0 % | NO |" in lines
    assert "| slip share, left damper, high | 0 % | 0.0 % | yes | 4.0 % | NO |" in lines
    assert "| slip share, smooth road | 31.3 % | 30.0 % | yes | 45.0 % | NO |" in lines
    assert "| first slip, 7.5 mm bump | 5.035 s | 5.055 s | NO | 5.038 s | yes |" in lines
    assert "| 1.5 mm bump | no slip | largest 8.0 mm/s | yes | for 25 ms | NO |" in lines
    assert len([line for line in lines if line.startswith("| ")]) == 1 + 6 + 2 + 2
    assert "| first slip, 7.5 mm bump | 5.035 s | never | NO | 5.038 s | yes |" in definition_lines(slip_content(None))


def test_without_one_of_its_scenarios_there_is_no_section():
    part = slip_content()
    del part["bump"]
    assert definition_lines(part) == []
