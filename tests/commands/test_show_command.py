"""The command that shows a car: text, JSON, files, parameters, refusals."""

import csv
import json

import pytest

from vehicle.commands.show import main


def test_text_and_json(capsys):
    assert main(["sedan", "--set", "body.mass=1000"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("sedan, tyres not rolling; body.mass=1000\n")
    assert "wheelbase     2757 mm" in text and "\nwheel rate [N/mm] " in text and "heave " in text
    assert main(["sedan", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["mass_kg"] == pytest.approx(1652.924) and found["axles"][1]["geometry"]["caster_deg"] is None
    assert found["axles"][0]["brake_support_percent"] == pytest.approx(27.74, abs=0.01)


def test_files(tmp_path, capsys):
    folder = tmp_path / "car"
    assert main(["focus", "--output", str(folder)]) == 0
    assert (folder / "car.png").stat().st_size > 30_000
    assert json.loads((folder / "car.json").read_text())["wheelbase_m"] is None
    with (folder / "parameters.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["path"]: row for row in csv.DictReader(file)}
    assert rows["body.mass"]["value"] == "813" and rows["body.mass"]["source"] == "section 3.1.2"
    assert main(["focus", "--output", str(folder)]) == 2
    assert "exists" in capsys.readouterr().err


def test_a_change_without_effect_is_said_beside_a_search_too(capsys):
    assert main(["focus", "--search", "smoothing", "--set", "damper.presliding_stiffness=5e5"]) == 0
    assert "note: damper.presliding_stiffness=5e5: has no effect; it acts only with " in capsys.readouterr().out


def test_search(capsys):
    assert main(["sedan", "--search", "rear damper coulomb"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 and lines[0].split() == ["parameter", "value", "unit", "range", "source"]
    assert lines[1].startswith("rear.damper.coulomb_friction     40")
    assert main(["sedan", "--search", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)) > 200
